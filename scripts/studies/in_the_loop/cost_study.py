"""What the exported C controller costs: instructions of the dearest call (callgrind), bytes of code and data in
object files.

Instructions are counted by callgrind over all golden vectors of the book, each call of its own: a decision has no loop
whose length depends on the reading, so the dearest vector is the worst case of the compiled code. An estimate has one,
over the breaks of its table, and the golden tracks reach the last break with both ends of a step. x86-64, because
valgrind runs there; sizes also for a Cortex-M4. What needs a program that is not installed is left out.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from scripts.studies.in_the_loop.agreement_study import tuned_book
from scripts.studies.in_the_loop.controller_process import (
    COMMAND,
    CONTRACT,
    READING,
    SAMPLE,
    build_controller,
    compile_with,
    table_words,
    write_sources,
)
from scripts.studies.in_the_loop.hard_questions import golden_readings, golden_samples, hard_commands
from scripts.studies.study import Findings, MarkdownTable, Method, Tell, option, table
from synth.frame.faults import InputError
from tuning_tables.table_book import TableBook

SECTIONS = (("code", ".text"), ("constants", ".rodata"), ("constants", ".data.rel.ro"), ("variables", ".data"),
            ("variables", ".bss"))  # fmt: skip


@dataclass(frozen=True)
class CodeSize:
    """Bytes."""

    code: int
    constants: int
    variables: int


def missing(*programs: str) -> tuple[str, ...]:
    """Those that this machine lacks."""
    return tuple(program for program in programs if shutil.which(program) is None)


def dearest_call(command: Sequence[str], function: str, content: bytes, folder: Path) -> int:
    """The most instructions that a single call of `function` takes in the program `command` fed with `content`."""
    output = folder / "calls"
    for old in folder.glob("calls*"):
        old.unlink()
    callgrind = ["valgrind", "--tool=callgrind", f"--toggle-collect={function}", f"--dump-after={function}",
                 f"--callgrind-out-file={output}"]  # fmt: skip
    ran = subprocess.run([*callgrind, *command], input=content, capture_output=True, check=True)
    counts = [count for file in folder.glob("calls.*") for count in totals_in(file.read_text())]
    if not counts:
        raise RuntimeError(f"callgrind saw no call of {function}: {ran.stderr.decode()}")
    return max(counts)


def totals_in(dump: str) -> list[int]:
    """The instructions that a dump of callgrind tells."""
    return [int(count) for count in re.findall(r"^totals: (\d+)", dump, re.M)]


def object_size(book: TableBook, compiler: str, flags: Sequence[str], folder: Path) -> CodeSize:
    """Sizes of retarder_table.c alone, as a controller needs it."""
    write_sources(book, folder)
    made = folder / "retarder_table.o"
    compile_with([compiler, *CONTRACT, *flags, "-c", str(folder / "retarder_table.c"), "-o", str(made)])
    return size_in(compile_with([size_program(compiler), "-A", str(made)]))


def size_program(compiler: str) -> str:
    """The one that belongs to a cross compiler."""
    return compiler.replace("gcc", "size") if "-" in compiler else "size"


def size_in(listing: str) -> CodeSize:
    """The sums over the sections that `size -A` lists."""
    found = {"code": 0, "constants": 0, "variables": 0}
    for line in listing.splitlines():
        name, _, rest = line.partition(" ")
        for kind, section in SECTIONS:
            if name == section or name.startswith(f"{section}."):
                found[kind] += int(rest.split()[0])
                break
    return CodeSize(**found)


LEVELS = ("-O0", "-O1", "-O2", "-O3", "-Os")
WORK = {
    "decide": "retarder_decide",
    "observe": "retarder_observe",
    "select": "retarder_select",
    "intact": "retarder_table_intact",
}
"""Modes of the controller process, and the function that each asks."""

CORTEX_M4 = ("-mcpu=cortex-m4", "-mthumb", "-mfloat-abi=hard", "-mfpu=fpv4-sp-d16")
TARGETS = {
    "Cortex-M4, -Os": ("arm-linux-gnueabihf-gcc", ("-Os", *CORTEX_M4)),
    "x86-64, -O2": ("gcc", ("-O2",)),
}


@dataclass(frozen=True)
class Options:
    """Which levels of optimisation, of which book."""

    config: Path | None = option(None, "configuration; the built-in default book without it")
    masses_t: tuple[float, ...] = option((), "only cuts of these masses, t")
    levels: tuple[str, ...] = option(LEVELS, "levels of optimisation")


@dataclass(frozen=True)
class Dearest:
    """Instructions of the dearest call at one level, by mode, without and with estimators in the book."""

    level: str
    plain: dict[str, int]
    estimated: dict[str, int]


@dataclass(frozen=True)
class Sizes:
    """Bytes for one target of so many tables, without and with estimators."""

    target: str
    tables: int
    plain: CodeSize
    estimated: CodeSize


@dataclass(frozen=True)
class Cost(Findings):
    """Everything that could be counted here; `bytes_a_table` without and with estimators."""

    config_sha256: tuple[str, str]
    compiler: str
    tables_in_book: int
    bytes_a_table: tuple[int, int]
    dearest: tuple[Dearest, ...]
    sizes: tuple[Sizes, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`instructions`: a row a level; `sizes`: a row a target. Those that could not be counted are not there."""
        heads = ("gcc", *(f"`{function}`" for function in WORK.values()))
        instructions = [
            (each.level, *(f"{thousands(each.plain[mode])} / {thousands(each.estimated[mode])}" for mode in WORK))
            for each in self.dearest
        ]
        sizes = [
            (f"{s.target}, {s.tables} table{'s' if s.tables > 1 else ''}", f"{s.plain.code} / {s.estimated.code} bytes",
             f"{s.plain.constants} / {s.estimated.constants} bytes",
             f"{s.plain.variables} / {s.estimated.variables}")
            for s in self.sizes
        ]  # fmt: skip
        found = {
            "instructions": table("Instructions of the dearest call, without / with estimators", heads, instructions),
            "sizes": table("Bytes", ("without / with estimators", "code", "constants", "variables"), sizes),
        }
        return {name: each for name, each in found.items() if each.rows}

    def sentences(self) -> tuple[str, ...]:
        """The book and the compiler."""
        plain, estimated = self.bytes_a_table
        return (f"{self.tables_in_book} tables of {plain} bytes, {estimated} with estimators; {self.compiler}",)


def thousands(count: int) -> str:
    """'33 187'; no space in numbers of four digits."""
    return f"{count:,}".replace(",", " ") if count > 9999 else str(count)


def run(options: Options, tell: Tell) -> Cost:
    """Tune both books, compile, count. Raises `InputError` where there is no gcc."""
    if missing("gcc", "size"):
        raise InputError("study controller-cost: gcc is not installed; scripts/setup_toolchain installs what it needs")
    books = [tuned_book(options.config, estimator, options.masses_t, tell) for estimator in (False, True)]
    plain, estimated = (each.book for each in books)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        dearest = []
        for level in options.levels if not missing("valgrind") else ():
            dearest.append(Dearest(level, instructions(plain, level, folder), instructions(estimated, level, folder)))
            tell(f"{level}: instructions counted")
        sizes = [size for target in TARGETS for size in sizes_of(target, (plain, estimated), folder)]
    return Cost(
        config_sha256=(books[0].config_sha256, books[1].config_sha256),
        compiler=compile_with(["gcc", "--version"]).splitlines()[0],
        tables_in_book=len(plain.tables),
        bytes_a_table=(4 * table_words(plain), 4 * table_words(estimated)),
        dearest=tuple(dearest),
        sizes=tuple(sizes),
    )


def instructions(book: TableBook, level: str, folder: Path) -> dict[str, int]:
    """Of the dearest call by mode: every golden vector of every table once; all commands; all tables."""
    controller = build_controller(book, folder, "gcc", (level,))
    fed = {
        "decide": np.unique(golden_readings(book).astype(READING)).tobytes(),
        "observe": golden_samples(book).astype(SAMPLE).tobytes(),
        "select": hard_commands(book, 200, 2).astype(COMMAND).tobytes(),
        "intact": controller.dump().tobytes(),
    }
    return {
        mode: dearest_call((*controller.command, mode), function, fed[mode], folder) for mode, function in WORK.items()
    }


def sizes_of(target: str, books: Sequence[TableBook], folder: Path) -> list[Sizes]:
    """Of the whole book and of its first table; nothing where the compiler is not there."""
    compiler, flags = TARGETS[target]
    if missing(compiler):
        return []
    return [
        Sizes(target, count, *(object_size(TableBook(book.tables[:count]), compiler, flags, folder) for book in books))
        for count in (len(books[0].tables), 1)
    ]


METHOD = Method(Options, Options(masses_t=(52.0,), levels=("-O2",)), Cost, run)
