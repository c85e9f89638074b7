"""The bill of materials: what an installation of the wheel holds, with versions, hashes of origin and licence texts."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, Final

from scripts.release.bare import environment
from scripts.release.step import ReleaseFault, ran

TOOL: Final = "cyclonedx-bom==7.5.0"
"""In an environment of its own: the project does not depend on it."""

BILL: Final = "sbom.cdx.json"


def billed(root: Path, python: str, bare: Path, work: Path, into: Path) -> str:
    """Write the bill of the environment `bare` in CycloneDX; `ReleaseFault` where a licence is not known."""
    programs = environment(python, work / "bill", TOOL)
    path = into / BILL
    words: list[str | Path] = [
        "environment",
        "--pyproject",
        root / "pyproject.toml",
        "--of",
        "JSON",
        "--output-reproducible",
    ]
    ran([programs / "cyclonedx-py", *words, "--gather-license-texts", "-o", path, bare / "bin" / "python"], work)
    components: list[dict[str, Any]] = json.loads(path.read_text(encoding="utf-8"))["components"]
    unknown = [each["name"] for each in components if not each.get("licenses")]
    if unknown:
        raise ReleaseFault(f"no licence is known of {', '.join(unknown)}")
    textless = [each["name"] for each in components if not any(map(has_text, each["licenses"]))]
    without = f"; no text of {', '.join(textless)}" if textless else ""
    return f"{into.name}/{BILL}: {len(components)} packages, the licence of each{without}"


def has_text(entry: dict[str, Any]) -> bool:
    """Whether a licence is there as text, and not by its name alone."""
    return "text" in entry.get("license", {}) or "text" in entry
