"""What the self-test of an exported C controller reaches of it: lines, branches, and MC/DC (clang from 18 on).

MC/DC: for every condition of a decision two of the questions show that it alone changes the decision. Printed for a
book or for tables as JSON: python -m scripts.studies.in_the_loop.code_coverage BOOK.h5|FOLDER
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from scripts.studies.in_the_loop.controller_process import TIMEOUT_S, compile_with
from tuning_tables import from_json, read_book
from tuning_tables.exports import c_files
from tuning_tables.table_book import TableBook

RELEASES: Final = range(25, 17, -1)
SWITCHES: Final = ("-std=c99", "-O0", "-ffp-contract=off", "-fprofile-instr-generate", "-fcoverage-mapping",
                   "-fcoverage-mcdc")  # fmt: skip
MAIN: Final = """\
#include "{test}.h"

int main(void)
{{
    uint32_t where;
    return {function}(&where) != 0;
}}
"""


@dataclass(frozen=True)
class Coverage:
    """(reached, all there are) of lines, branches and MC/DC; `rest`: what is not reached, a line each."""

    lines: tuple[int, int]
    branches: tuple[int, int]
    conditions: tuple[int, int]
    rest: tuple[str, ...]

    def __str__(self) -> str:
        kinds = {"lines": self.lines, "branches": self.branches, "MC/DC": self.conditions}
        return ", ".join(f"{name} {part} of {whole}" for name, (part, whole) in kinds.items())


def mcdc_release() -> int | None:
    """The newest clang installed that measures MC/DC, with its tools; None if there is none."""
    for release in RELEASES:
        if all(shutil.which(f"{tool}-{release}") for tool in ("clang", "llvm-profdata", "llvm-cov")):
            return release
    return None


def coverage_of(export: Mapping[str, bytes], folder: Path, release: int) -> Coverage:
    """What the self-test of an export in C reaches of the code; it must find no fault. Compiled in `folder`."""
    (test,) = (name.removesuffix(".c") for name in export if name.endswith("_self_test.c"))
    (code,) = (name for name in export if name.endswith(".c") and not name.startswith(test))
    main = MAIN.format(test=test, function=test)
    for name, content in {**export, "main.c": main.encode("ascii")}.items():
        (folder / name).write_bytes(content)
    program, raw, profile = (str(folder / name) for name in ("covered", "covered.raw", "covered.profile"))
    sources = [str(folder / name) for name in (code, f"{test}.c", "main.c")]
    compile_with([f"clang-{release}", *SWITCHES, *sources, "-o", program])
    subprocess.run([program], env={"LLVM_PROFILE_FILE": raw}, check=True, timeout=TIMEOUT_S, capture_output=True)
    compile_with([f"llvm-profdata-{release}", "merge", raw, "-o", profile])
    told = compile_with([f"llvm-cov-{release}", "export", program, f"-instr-profile={profile}", str(folder / code)])
    (file,) = json.loads(told)["data"][0]["files"]
    text = (folder / code).read_text("ascii").splitlines()
    lines, branches, conditions = (reached(file["summary"][kind]) for kind in ("lines", "branches", "mcdc"))
    return Coverage(lines, branches, conditions, tuple(rest_of(file, text)))


def reached(summary: dict[str, Any]) -> tuple[int, int]:
    """(reached, all there are)."""
    return summary["covered"], summary["count"]


def rest_of(file: dict[str, Any], text: list[str]) -> list[str]:
    """Every branch and every condition that is not reached, in the order of the lines."""
    found = []
    for begin, first, end, last, yes, no, *_ in file["branches"]:
        missing = [name for name, count in (("true", yes), ("false", no)) if count == 0]
        found += [(begin, first, f"`{cut(text, begin, first, end, last)}` is never {name}") for name in missing]
    for begin, first, end, last, _, _, shown in file["mcdc_records"]:
        alone = [str(place + 1) for place, is_shown in enumerate(shown) if not is_shown]
        if alone:
            whole = cut(text, begin, first, end, last)
            found.append((begin, first, f"`{whole}`: condition {', '.join(alone)} of {len(shown)} never decides alone"))
    return [f"line {line}: {said}" for line, _, said in sorted(found)]


def cut(text: list[str], begin: int, first: int, end: int, last: int) -> str:
    """The text between two places, on one line."""
    lines = text[begin - 1 : end]
    lines[-1] = lines[-1][: last - 1]
    lines[0] = lines[0][first - 1 :]
    return re.sub(r"\s+", " ", " ".join(lines))


def main(path: Path) -> None:
    """Print it for the book at `path`: an HDF5 file, or a folder of tables as JSON."""
    release = mcdc_release()
    if release is None:
        sys.exit("MC/DC: no clang from 18 on with llvm-profdata and llvm-cov is installed")
    files = sorted(path.glob("*.json"))
    tables = read_book(path) if path.is_file() else tuple(from_json(each.read_bytes()) for each in files)
    with tempfile.TemporaryDirectory() as folder:
        found = coverage_of(c_files(TableBook(tables)), Path(folder), release)
    print(found, *found.rest, sep="\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
