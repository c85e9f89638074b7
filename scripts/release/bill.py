"""The bill of materials of an installation of the wheel, and the texts of all licences in it."""

from __future__ import annotations

import json
import re
from importlib.metadata import Distribution, distributions
from pathlib import Path
from typing import Any, Final

from scripts.release.bare import environment
from scripts.release.step import ReleaseFault, ran

TOOL: Final = "cyclonedx-bom==7.5.0"
"""In an environment of its own: the project does not depend on it."""

BILL: Final = "sbom.cdx.json"
TEXTS: Final = "LICENCES.txt"
TEXT: Final = re.compile(r"\.dist-info/(?:.+/)?(?:licen[cs]e|copying|notice|authors)[^/]*$", re.IGNORECASE)
"""Where packages keep the texts of their licences: beside their metadata, or in a folder there."""


def billed(root: Path, python: str, bare: Path, work: Path, into: Path) -> str:
    """Write the bill of the environment `bare` in CycloneDX, and the licences; `ReleaseFault` where one is unknown."""
    programs = environment(python, work / "bill", TOOL)
    path = into / BILL
    program: list[str | Path] = [programs / "cyclonedx-py", "environment", "--output-reproducible", "--of", "JSON"]
    ran([*program, "--pyproject", root / "pyproject.toml", "-o", path, bare / "bin" / "python"], work)
    components: list[dict[str, Any]] = json.loads(path.read_text(encoding="utf-8"))["components"]
    unknown = [each["name"] for each in components if not each.get("licenses")]
    if unknown:
        raise ReleaseFault(f"no licence is known of {', '.join(unknown)}")
    (site,) = bare.glob("lib/python*/site-packages")
    found = {each.metadata["Name"]: texts_of(each) for each in distributions(path=[str(site)])}
    parts = (f"{'=' * 100}\n{name}: {file}\n\n{text}\n" for name in sorted(found) for file, text in found[name].items())
    (into / TEXTS).write_text("".join(parts), encoding="utf-8")
    textless = [name for name, texts in sorted(found.items()) if not texts]
    without = f"; no text came with {', '.join(textless)}" if textless else ""
    return f"{BILL}: {len(components)} packages, the licence of each; {TEXTS}: those of {len(found)}{without}"


def texts_of(package: Distribution) -> dict[str, str]:
    """The licences that came with a package, by the names of their files."""
    files = (file for file in package.files or () if TEXT.search(file.as_posix()))
    return {file.name: file.read_text(encoding="utf-8") for file in files}
