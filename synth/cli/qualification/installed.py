"""The installed program and its libraries: are their files those that were installed? And the machine and the
software that a qualification holds for.

pip notes the SHA-256 of every file of a package in `RECORD`. A checkout that is installed editable has no such notes;
there git tells whether the files are those of a commit.
"""

from __future__ import annotations

import base64
import hashlib
import json
import os
import platform
import re
import shutil
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from importlib.metadata import Distribution, PackageNotFoundError, distribution, requires
from pathlib import Path
from typing import Final
from urllib.parse import urlsplit
from urllib.request import url2pathname

from synth.cli.qualification.check import Check, checked, not_checked, process
from synth.frame.exhibits import Row
from synth.frame.machine import available, processor_name
from synth.frame.version import Defect

PROGRAM: Final = "retarder-synth"
PACKAGES: Final = ("plant_models", "synth", "tuning_tables")
WHAT, FILES = "Program", "Libraries"
HOW: Final = "SHA-256 of every file against the list made when it was installed (RECORD)"
BESIDE: Final = re.compile(r"^\.\./|\.dist-info/")
"""Files that the installer makes, which differ from place to place."""

LIMIT: Final = "no file differs, is missing or was added"


@dataclass(frozen=True)
class Installed:
    """A package as it lies on the disk.

    `sha256`: of the names of all its files of code and data with theirs, the same wherever the same wheel is installed.
    `changed`: files that differ from the list made at the installation, or are not there.
    """

    name: str
    version: str
    files: int
    sha256: str
    changed: tuple[str, ...]


def installed(found: Distribution) -> Installed:
    """The package, with every file read."""
    listed = [(file, file.hash.value, sha256_of(Path(str(file.locate())))) for file in found.files or () if file.hash]
    changed = tuple(str(file) for file, before, now in listed if before != now)
    content = {file.as_posix(): now for file, _, now in listed if not BESIDE.search(file.as_posix())}
    return Installed(found.metadata["Name"], found.version, len(listed), digest_of(content), changed)


def digest_of(content: Mapping[str, str | None]) -> str:
    """SHA-256 over names of files and their SHA-256, sorted."""
    lines = (f"{name} {sha256}\n" for name, sha256 in sorted(content.items()))
    return hashlib.sha256("".join(lines).encode()).hexdigest()


def sha256_of(file: Path) -> str | None:
    """SHA-256 as `RECORD` writes it; None where the file cannot be read."""
    try:
        return base64.urlsafe_b64encode(hashlib.sha256(file.read_bytes()).digest()).decode().rstrip("=")
    except OSError:
        return None


def libraries() -> tuple[Installed, ...]:
    """What the program needs to run, by name: those that are named in its own list."""
    names = sorted({re.split(r"[^\w.-]", each, maxsplit=1)[0] for each in requires(PROGRAM) or () if ";" not in each})
    return tuple(installed(each) for each in map(found_distribution, names) if each is not None)


def found_distribution(name: str) -> Distribution | None:
    """The package `name`, where it is installed."""
    try:
        return distribution(name)
    except PackageNotFoundError:
        return None


def library_check(found: tuple[Installed, ...]) -> Check:
    """Whether every file of the libraries is as it was installed."""
    changed = [f"{each.name}: {name}" for each in found for name in each.changed]
    unlisted = [each.name for each in found if not each.files]
    if unlisted:
        return not_checked(FILES, HOW, f"no list of files: {', '.join(unlisted)}", LIMIT, "install them with pip")
    count = sum(each.files for each in found)
    said = f"{len(found)} libraries, {count} files; {few(changed) or 'none differs'}"
    return checked(FILES, HOW, said, LIMIT, not changed)


def few(names: list[str]) -> str:
    """How many files differ, and the first of them."""
    return f"{len(names)} differ: {', '.join(names[:3])}{' …' if len(names) > 3 else ''}" if names else ""


def program_check() -> Check:
    """Whether every file of the program is that of a release, or of a commit."""
    found = distribution(PROGRAM)
    checkout = editable_root(found)
    if checkout is not None:
        return checkout_check(checkout)
    own = installed(found)
    listed = {Path(str(file.locate())).resolve() for file in found.files or ()}
    added = [f"{path.name} was added" for path in present(site_of(found)) if path.resolve() not in listed]
    wrong = [*own.changed, *added]
    said = f"{own.name} {own.version}, {own.files} files; {few(wrong) or 'none differs'}"
    return checked(WHAT, HOW, said, LIMIT, not wrong)


def defect_check(known: tuple[Defect, ...]) -> Check:
    """Whether this version has one of the `known` defects that is unsafe."""
    version = distribution(PROGRAM).version
    found = [f"{each.id}{', unsafe' if each.unsafe else ''}: {each.wrong}" for each in known if each.is_in(version)]
    safe = not any(each.unsafe for each in known if each.is_in(version))
    said = f"version {version}: {'; '.join(found) or 'none'}"
    return checked("Known defects", "the list of defects that comes with the program", said, "none is unsafe", safe)


def site_of(found: Distribution) -> Path:
    """The folder that holds the packages of the program."""
    return editable_root(found) or Path(str(found.locate_file("")))


def own_content() -> Installed:
    """The program itself by the files of its packages, installed or in a checkout."""
    found = distribution(PROGRAM)
    site = site_of(found)
    content = {path.relative_to(site).as_posix(): sha256_of(path) for path in present(site)}
    return Installed(found.metadata["Name"], found.version, len(content), digest_of(content), ())


def present(site: Path) -> Iterator[Path]:
    """Every file of the program's packages below `site`, but what Python compiles by itself."""
    files = (path for package in PACKAGES for path in (site / package).rglob("*") if path.is_file())
    return (path for path in files if "__pycache__" not in path.parts)


def editable_root(found: Distribution) -> Path | None:
    """The checkout that is installed editable; None where files were installed."""
    told = json.loads(found.read_text("direct_url.json") or "{}")
    if not told.get("dir_info", {}).get("editable"):
        return None
    return Path(url2pathname(urlsplit(told["url"]).path))


def checkout_check(root: Path) -> Check:
    """Whether the files of the checkout at `root` are those of a commit."""
    how, limit = "git: the installed checkout against its commit", "no file differs or was added"
    commit = git(root, "rev-parse", "HEAD")
    changes = git(root, "status", "--porcelain", "--untracked-files=all", "--", *PACKAGES)
    if commit is None or changes is None:
        reason = f"editable installation of {root}, of which git tells nothing"
        return not_checked(WHAT, how, reason, limit, "install the wheel of a release")
    changed = [line[3:] for line in changes.splitlines()]
    if changed:
        reason = f"editable installation of commit {commit.strip()}, with changes: {few(changed)}"
        return not_checked(WHAT, how, reason, limit, "install the wheel of a release, or commit the changes")
    return checked(WHAT, how, f"editable installation of commit {commit.strip()}; no file differs", limit, True)


def git(root: Path, *words: str) -> str | None:
    """What git says of the checkout; None where there is no git, or it refuses."""
    path = shutil.which("git")
    if path is None:
        return None
    ran = process([path, "-C", str(root), *words], root)
    return ran.out if ran.code == 0 else None


SETTINGS: Final = ("NUMBA_", "OPENBLAS_", "MKL_", "OMP_", "NPY_", "RETARDER_SYNTH_PLAIN", "PYTHONOPTIMIZE")
"""Beginnings of the names of environment variables that change what is computed, or how."""

OWN: Final = ("NUMBA_CACHE_DIR", "OPENBLAS_NUM_THREADS")
"""Those that the program sets for itself."""


def machine_rows() -> Iterator[Row]:
    """What it is, a fact a row."""
    facts = {
        "name": platform.node(),
        "processor": processor_name(),
        "processors to work on": str(available()),
        "system": platform.platform(),
        "Python": f"{platform.python_implementation()} {platform.python_version()}",
        "settings": " ".join(settings()) or "none that change a computation",
    }
    yield from ({"fact": fact, "value": value} for fact, value in facts.items())


def settings() -> Iterator[str]:
    """Environment variables of the user that change what is computed."""
    named = (name for name in sorted(os.environ) if name.startswith(SETTINGS) and name not in OWN)
    return (f"{name}={os.environ[name]}" for name in named)


def version_rows(found: tuple[Installed, ...]) -> Iterator[Row]:
    """Packages, a row each."""
    for each in found:
        yield {"name": each.name, "version": each.version, "files": each.files, "sha256": each.sha256}
