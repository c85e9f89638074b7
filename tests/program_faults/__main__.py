"""Plant faults in copies of the program, one by one, and see what finds each: `python -m tests.program_faults -o DIR`.

In each copy a small tune is made with every export; then its tests, `verify`, the self-test of its C code (gcc) and
`qualify` are asked. The first row has no fault: there nothing may be found. Hours; `--only 3` asks about one fault.

All copies have one path: kernels are kept by path and content, so only what a fault changes is compiled anew.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Final

from tests.checker.conftest import CONFIG
from tests.program_faults.faults import FAULTS, PACKAGES, TESTS, ProgramFault

ROOT: Final = Path(__file__).parents[2]
SECONDS: Final = 3600
PROGRAM: Final = (sys.executable, "-c", "from synth.cli import main; raise SystemExit(main())")
SELF_TEST: Final = (
    '#include "retarder_self_test.h"\nint main(void) { return retarder_self_test(0) != RETARDER_SOUND; }\n'
)


def main(arguments: Sequence[str] | None = None) -> int:
    """Print a row for each fault, and keep what every finder said."""
    parser = argparse.ArgumentParser(prog="python -m tests.program_faults", description=__doc__)
    parser.add_argument("--only", type=int, action="append", choices=range(len(FAULTS)), help="the number of a fault")
    parser.add_argument("--finder", action="append", choices=tuple(FINDERS), help="ask only this one; may be repeated")
    parser.add_argument("-o", "--output", type=Path, default=Path("out/program-faults"), help="what was said")
    asked = parser.parse_args(arguments)
    asked.output.mkdir(parents=True, exist_ok=True)
    finders = {name: find for name, find in FINDERS.items() if not asked.finder or name in asked.finder}
    print("| fault | " + " | ".join(["tune", *finders]) + " |\n|---|" + "---|" * (len(finders) + 1), flush=True)
    for number in [None, *(asked.only or range(len(FAULTS)))]:
        fault = None if number is None else FAULTS[number]
        found = found_by(fault, finders, asked.output / ("none" if number is None else f"{number:02}"))
        told = "none" if fault is None else f"{number} {fault.part}: `{fault.right}` → `{fault.wrong}`"
        print(f"| {told} | " + " | ".join(found) + " |", flush=True)
    return 0


def found_by(
    fault: ProgramFault | None,
    finders: Mapping[str, Callable[[Path, ProgramFault | None], list[list[str]]]],
    said: Path,
) -> list[str]:
    """What the tune and each finder come to in a copy with the fault; their print goes into files that begin so."""
    copy = said.with_name("copy").absolute()
    make_copy(copy, fault)
    tune = outcome(copy, tuning(copy), said.with_suffix(".tune.txt"), (0, 1)) if TUNED & finders.keys() else "not asked"
    asked = {name: find(copy, fault) for name, find in finders.items()}
    return [tune, *(outcome(copy, what, said.with_suffix(f".{name}.txt"), (0,)) for name, what in asked.items())]


def make_copy(copy: Path, fault: ProgramFault | None) -> None:
    """Make the folder `copy` a checkout with the fault; files keep their times, by which kernels are told apart."""
    shutil.rmtree(copy, ignore_errors=True)
    for name in (*PACKAGES, "tests", "scripts", "docs"):
        shutil.copytree(ROOT / name, copy / name, ignore=shutil.ignore_patterns("__pycache__"))
    for name in ("pyproject.toml", "README.md"):
        shutil.copy(ROOT / name, copy)
    if fault is not None:
        fault.plant(copy)


def outcome(copy: Path, orders: Sequence[Sequence[str]], said: Path, sound: tuple[int, ...]) -> str:
    """`found` where an order ends with another code than `sound` ones, with that code and the seconds; else `-`."""
    begun = time.monotonic()
    environment = {**os.environ, "PYTHONPATH": str(copy), "PYTHONDONTWRITEBYTECODE": "1"}
    with said.open("w", encoding="utf-8") as out:
        for order in orders:
            try:
                code = subprocess.run(
                    order, cwd=copy, env=environment, stdout=out, stderr=subprocess.STDOUT, timeout=SECONDS, check=False
                ).returncode
            except subprocess.TimeoutExpired:
                return f"found (no end, {SECONDS} s)"
            if code not in sound:
                return f"found ({code}, {time.monotonic() - begun:.0f} s)"
    return f"- ({time.monotonic() - begun:.0f} s)"


def tuning(copy: Path) -> list[list[str]]:
    """A small tune with every export."""
    (copy / "config.toml").write_text(f"{CONFIG}[regulator]\napproach_m = 4.0\nestimator = true\n", encoding="utf-8")
    export = ["export", "tuned/book.h5", "--format", "st", "-o", "tuned/st"]
    return [[*PROGRAM, "tune", "config.toml", "-o", "tuned", "--workers", "1"], [*PROGRAM, *export]]


def tests(_: Path, fault: ProgramFault | None) -> list[list[str]]:
    """The marked tests about the part."""
    folders = (
        TESTS[fault.part] if fault is not None else sorted({each for folders in TESTS.values() for each in folders})
    )
    return [[sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", "-m", "requirement", *folders]]


def self_test(copy: Path, _: ProgramFault | None) -> list[list[str]]:
    """That of the exported C, compiled and run."""
    (copy / "main.c").write_text(SELF_TEST, encoding="ascii")
    sources = ["tuned/c/retarder_table.c", "tuned/c/retarder_self_test.c"]
    return [["gcc", "-std=c99", "-O2", "-Ituned/c", "main.c", *sources, "-o", "self_test"], ["./self_test"]]


FINDERS: Final[Mapping[str, Callable[[Path, ProgramFault | None], list[list[str]]]]] = {
    "verify": lambda _, __: [[*PROGRAM, "verify", "tuned", "--passes", "2000"]],
    "self-test": self_test,
    "qualify": lambda _, __: [[*PROGRAM, "qualify", "-o", "qualified"]],
    "tests": tests,
}

TUNED: Final = {"verify", "self-test"}
"""Those that ask about a tune."""

if __name__ == "__main__":
    sys.exit(main())
