"""The checkout: nothing uncommitted, one version everywhere, and a lock that fits what the project asks for."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from scripts.release.step import ReleaseFault, ran

LOCKED: Final = re.compile(r"^([\w.-]+)==([\w.+!-]+)", re.MULTILINE)
HEADING: Final = re.compile(r"^## \[([^]]+)\] - \d{4}-\d\d-\d\d$", re.MULTILINE)
"""Of a release; one that has no day yet is none."""
CITED: Final = re.compile(r"^version: (\S+)$", re.MULTILINE)


def project(root: Path) -> dict[str, Any]:
    """The table [project] of pyproject.toml."""
    found: dict[str, Any] = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    return found


def clean(root: Path) -> str:
    """Every file is committed."""
    changed = ran(["git", "status", "--porcelain"], root).splitlines()
    if changed:
        raise ReleaseFault(f"{len(changed)} files are not committed, {changed[0][3:]} for one; what is built is HEAD")
    return f"commit {ran(['git', 'rev-parse', 'HEAD'], root).strip()}"


def one_version(root: Path) -> str:
    """pyproject.toml, the first heading of the changelog, and the citation tell one version."""
    version = project(root)["version"]
    stated = {
        "CHANGELOG.md": HEADING.search((root / "CHANGELOG.md").read_text(encoding="utf-8")),
        "CITATION.cff": CITED.search((root / "CITATION.cff").read_text(encoding="utf-8")),
    }
    other = {name: found[1] if found else "none" for name, found in stated.items() if not found or found[1] != version}
    if other:
        told = ", ".join(f"{name} tells {found}" for name, found in other.items())
        raise ReleaseFault(f"pyproject.toml tells {version}, but {told}")
    return f"version {version}"


def locked(root: Path) -> dict[str, str]:
    """The version of each package in requirements.lock."""
    text = (root / "requirements.lock").read_text(encoding="utf-8")
    return {canonicalize_name(name): version for name, version in LOCKED.findall(text)}


def requirements(root: Path) -> Iterator[Requirement]:
    """All that the project asks for, its extras too."""
    told = project(root)
    extras = told["optional-dependencies"].values()
    yield from map(Requirement, (*told["dependencies"], *(each for extra in extras for each in extra)))


def lock_fits(root: Path) -> str:
    """The lock has a version of every requirement, one that is allowed."""
    versions = locked(root)
    unlocked = [str(each) for each in requirements(root) if not allowed(each, versions)]
    if unlocked:
        raise ReleaseFault(
            f"requirements.lock has nothing that fits {', '.join(unlocked)}; lock anew (CONTRIBUTING.md)"
        )
    return f"{len(versions)} packages locked; every requirement has an allowed version"


def allowed(wanted: Requirement, versions: dict[str, str]) -> bool:
    """Whether the lock has a version that is allowed."""
    version = versions.get(canonicalize_name(wanted.name))
    return version is not None and wanted.specifier.contains(version, prereleases=True)
