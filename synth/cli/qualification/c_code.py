"""The exported C under every compiler that is found: its self-test, and whether that finds a changed number."""

from __future__ import annotations

import platform
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from synth.cli.qualification.check import Check, Ran, checked, not_checked, process
from synth.cli.qualification.second_program import CODE, with_other_number
from synth.cli.qualification.tuned import Tuned

COMPILERS: Final = ("gcc", "clang")
CONTRACT: Final = ("-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-ffreestanding")
"""What the exported files must compile with."""

FUSED: Final = "-O3 -ffp-contract=fast"
"""Products and sums in one operation, where the processor has one."""

SOURCES: Final = ("retarder_table.c", "retarder_self_test.c")
MAIN: Final = """\
#include <stdio.h>
#include "retarder_self_test.h"

int main(void)
{
    uint32_t where = 0;
    const int32_t fault = retarder_self_test(&where);
    printf("fault %ld at %lu\\n", (long)fault, (unsigned long)where);
    return fault == RETARDER_SOUND ? 0 : 1;
}
"""
SOUND: Final = "fault 0 at 0"
LIMIT: Final = f"no message of the compiler, then '{SOUND}' at every level"
REMEDY: Final = "put a C compiler on PATH, best that of the controller, and run this again"


def levels() -> tuple[str, ...]:
    """The levels at which each compiler is tried."""
    native = " -march=native" if platform.machine().lower() in ("x86_64", "amd64") else ""
    return "-O0", "-O2", f"{FUSED}{native}"


def c_checks(book: Tuned) -> Iterator[Check]:
    """A check for each compiler that is there, one that tells of the others, and one of the self-test itself."""
    there = [name for name in COMPILERS if shutil.which(name)]
    how = f"its self-test, compiled with {' '.join(CONTRACT)}"
    if not book.content:
        yield not_checked("C code", how, "the tune failed", LIMIT)
        return
    code = {name.removeprefix("c/"): content for name, content in book.content.items() if name.startswith("c/")}
    folder = book.folder.parent
    for compiler in there:
        yield compiler_check(compiler, how, code, folder)
    if there:
        yield fault_check(there[0], code, folder)
    if absent := [name for name in COMPILERS if name not in there]:
        yield not_checked("C code: other compilers", how, f"not on PATH: {', '.join(absent)}", LIMIT, REMEDY)


def compiler_check(compiler: str, how: str, code: dict[str, bytes], folder: Path) -> Check:
    """The self-test at every level."""
    said = {level: self_test(compiler, level, code, folder / "code") for level in levels()}
    version = next(iter(process([compiler, "--version"], folder).out.splitlines()), "it tells no version")
    found = f"{version}: " + "; ".join(f"{level}: {answer}" for level, answer in said.items())
    return checked(f"C code: {compiler}", how, found, LIMIT, all(answer == SOUND for answer in said.values()))


def fault_check(compiler: str, code: dict[str, bytes], folder: Path) -> Check:
    """Whether the self-test finds that the code is not that of the tables."""
    name = Path(CODE).name
    changed = {**code, name: with_other_number(code[name])}
    said = self_test(compiler, "-O2", changed, folder / "code")
    what, how = "C code: the self-test finds a fault", "one digit of one coefficient is one more"
    return checked(what, f"{how}; {compiler} -O2", said, "a fault is told", said.startswith("fault") and said != SOUND)


def self_test(compiler: str, level: str, code: dict[str, bytes], folder: Path) -> str:
    """What the self-test of the files `code` says, compiled in `folder`, which is made and removed."""
    folder.mkdir()
    try:
        for name, content in {**code, "main.c": MAIN.encode()}.items():
            (folder / name).write_bytes(content)
        switches = [*CONTRACT, *level.split()]
        for source in SOURCES:
            built = process([compiler, *switches, "-c", source], folder)
            if built.code != 0 or built.err:
                return f"{source}: {first_complaint(built)}"
        objects = [Path(source).with_suffix(".o").name for source in SOURCES]
        linked = process([compiler, *level.split(), "main.c", *objects, "-o", "self_test"], folder)
        if linked.code != 0:
            return f"main.c: {first_complaint(linked)}"
        ran = process([str(folder / "self_test")], folder)
        return ran.out.strip() or ran.sentence
    finally:
        shutil.rmtree(folder)


def first_complaint(ran: Ran) -> str:
    """The first line of what a compiler says."""
    return next((line for line in ran.err.splitlines() if line.strip()), f"exit code {ran.code}")
