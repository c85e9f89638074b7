"""The wheel in environments that hold nothing else: qualified, used, and its tables read with numpy alone."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from scripts.release.step import ReleaseFault, ran
from scripts.release.tree import locked

PYTHONS: Final = ("python3.11", "python3.12", "python3.13", "python3.14")
NUMPY_ALONE: Final = """
import sys
import tuning_tables
table = tuning_tables.read_json(sys.argv[1])
answer = tuning_tables.decide_for(table, 0, 5.0, 30.0)
loaded = {name.partition(".")[0] for name in sys.modules}
heavy = sorted(loaded & {"control", "h5py", "matplotlib", "numba", "scipy", "synth"})
assert answer > 0 and not heavy, (answer, heavy)
print(table.id, "at stage 0, 5 m, 30 m/s commands stage", answer)
"""
"""Far too fast, so the table must brake."""


def pythons(named: list[str]) -> tuple[list[str], list[str]]:
    """(those of the supported interpreters that start here, or those `named`; the others)."""
    wanted = named or list(PYTHONS)
    there = [name for name in wanted if starts(name)]
    return there, [name for name in wanted if name not in there]


def starts(name: str) -> bool:
    """Whether there is such an interpreter; a shim of pyenv may be there and start nothing."""
    path = shutil.which(name)
    if path is None:
        return False
    return subprocess.run([path, "-c", "import ensurepip, venv"], capture_output=True, check=False).returncode == 0


def environment(python: str, folder: Path, *words: str | Path) -> Path:
    """A new environment of `python` in `folder` with what pip installs of `words`; its folder of programs."""
    ran([python, "-m", "venv", "--clear", folder], folder.parent)
    programs = folder / "bin"
    ran([programs / "python", "-m", "pip", "--quiet", "--no-input", "install", *words], folder.parent)
    return programs


def constraints(root: Path, work: Path) -> Path:
    """The lock without hashes: pip takes these versions of what the wheel needs."""
    path = work / "constraints.txt"
    path.write_text("".join(f"{name}=={version}\n" for name, version in locked(root).items()), encoding="ascii")
    return path


def used(python: str, wheel: Path, limits: Path, work: Path) -> str:
    """Install the wheel, qualify it, tune, export, and read the table with numpy alone."""
    work.mkdir()
    programs = environment(python, work / "bare", wheel, "-c", limits)
    program = programs / "retarder-synth"
    ran([program, "qualify", "-o", "qualified", "-q"], work)
    tables = json.loads((work / "qualified" / "summary.json").read_text(encoding="utf-8"))["tables"]
    checks, content = tables["checks"], tables["versions"][0]["sha256"]
    if checks[0]["outcome"] != "passed":
        raise ReleaseFault(f"{python}: {checks[0]['what']}: {checks[0]['found']}")
    ran([program, "tune", "qualified/estimated/configuration.toml", "-o", "tuned", "-q"], work)
    for form in ("c", "st", "json"):
        ran([program, "export", "tuned", "--format", form, "-o", f"export-{form}"], work)
    alone = environment(python, work / "alone", "numpy", "-c", limits)
    ran([alone / "python", "-m", "pip", "--quiet", "install", "--no-deps", wheel], work)
    (table,) = (work / "export-json").glob("*.json")
    answer = ran([alone / "python", "-I", "-c", NUMPY_ALONE, table], work).strip()
    version = re.sub(r"\s+", " ", ran([programs / "python", "--version"], work)).strip()
    return (
        f"{version}: {len(checks)} checks, {', '.join(counted(checks))}; content {content}; with numpy alone: {answer}"
    )


def counted(checks: list[dict[str, str]]) -> Iterator[str]:
    """How many checks came to what."""
    outcomes = [check["outcome"] for check in checks]
    return (f"{outcomes.count(outcome)} {outcome}" for outcome in dict.fromkeys(outcomes))
