"""The exported C controller compiled for this or another processor, in all ways that it is proved with, and asked
through a pipe; with the words that it holds of a table.
"""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from importlib.resources import files
from pathlib import Path
from types import MappingProxyType
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import Bools
from synth.cli.qualification.c_code import CONTRACT as CONTRACT
from tuning_tables.active_table import ActiveTable
from tuning_tables.controller_code.code import crc32_of, words_of
from tuning_tables.controller_code.line_code import held_values, room_of
from tuning_tables.export_names import RETARDER
from tuning_tables.exports import c_files
from tuning_tables.language.records import SizedRecord
from tuning_tables.programs.held import LINE_TABLE
from tuning_tables.self_test_size import FULL, SelfTestSize
from tuning_tables.table_book import TableBook


def held_record(book: TableBook) -> SizedRecord:
    """The table of the book's export."""
    return LINE_TABLE.sized(room_of(book.tables))


def table_words(book: TableBook) -> int:
    """How many words of 32 bits each table of the book has, checksum included."""
    return held_record(book).words() + 1


def held_words(book: TableBook, number: int, lines: ActiveTable | None = None) -> NDArray[np.uint32]:
    """The words of table `number`, or of `lines` made from it, uint32 (words,): the last is the checksum."""
    record = held_record(book)
    return sealed(words_of(record, held_values(book, number, record, lines)))


def sealed(words: NDArray[np.uint32]) -> NDArray[np.uint32]:
    """The words without a checksum, and theirs behind them."""
    return np.append(words, np.uint32(crc32_of(words)))


def places(book: TableBook) -> Mapping[str, slice]:
    """Where the members of a table of the book's export lie among its words."""
    record, found, begin = held_record(book), {}, 0
    for name in record.members:
        end = begin + int(np.prod(record.shape(name), dtype=int))
        found[name] = slice(begin, end)
        begin = end
    return found


EXPORTED = ("retarder_table.c", "retarder_self_test.c")
TIMEOUT_S = 300.0

READING = np.dtype([("table", "i4"), ("stage", "i4"), ("s_m", "f4"), ("v_m_s", "f4"), ("pressure_kpa", "f4")])
"""The pressure is looked at where the table has a gauge."""

ESTIMATE_WORDS = 16
ANSWER_WORDS = 1 + ESTIMATE_WORDS + 1
"""To a sample: the estimated speed, the estimate after it, the alarm word."""

SAMPLE = np.dtype(
    [("table", "i4"), ("start", "i4"), ("s_m", "f4"), ("v_m_s", "f4"), ("overpressure_kpa", "f4"),
     ("given", "u4", ESTIMATE_WORDS)]
)  # fmt: skip
"""`start`: ON, BEGIN or GIVEN: the estimate goes on, begins, or is `given`, whatever that is."""

ON, BEGIN, GIVEN = 0, 1, 2
COMMAND = np.dtype([("category", "i4"), ("axles", "i4"), ("speed_m_s", "f4")])


class BuildError(RuntimeError):
    """The compiler refused; the message is its own."""


@dataclass(frozen=True)
class Controller:
    """A compiled controller of a book: the command that runs it, and the words of one of its tables.

    Processors of the other byte order read and write words turned around: `order` is "<" or ">".
    """

    command: tuple[str, ...]
    table_words: int
    order: Literal["<", ">"] = "<"

    def decide(self, readings: NDArray[np.void]) -> NDArray[np.int32]:
        """The stages to command at `readings`, dtype READING, (n,)."""
        return np.frombuffer(self._answer(("decide",), readings), f"{self.order}i4").astype(np.int32)

    def observe(self, samples: NDArray[np.void]) -> NDArray[np.uint32]:
        """For `samples`, dtype SAMPLE, (n,): bits of the estimated speed, of the estimate, alarm word, (n, 18)."""
        words = np.frombuffer(self._answer(("observe",), samples), f"{self.order}u4")
        return words.reshape(len(samples), ANSWER_WORDS).astype(np.uint32)

    def select(self, commands: NDArray[np.void]) -> tuple[NDArray[np.int32], NDArray[np.uint32]]:
        """For commands, dtype COMMAND, (n,): statuses (n,), and the words of the chosen tables (n, words)."""
        words = np.frombuffer(self._answer(("select",), commands), f"{self.order}u4")
        answers = words.reshape(len(commands), 1 + self.table_words).astype(np.uint32)
        return answers[:, 0].view(np.int32), answers[:, 1:]

    def intact(self, words: NDArray[np.uint32]) -> Bools:
        """Whether the checksums of the tables `words` (n, words) are right: (n,)."""
        sound: Bools = np.frombuffer(self._answer(("intact",), words), f"{self.order}i4") == 1
        return sound

    def dump(self) -> NDArray[np.uint32]:
        """The words of all tables, (tables, words)."""
        words = np.frombuffer(self._answer(("dump",), np.empty(0, np.uint32)), f"{self.order}u4")
        return words.reshape(-1, self.table_words).astype(np.uint32)

    def self_test(self) -> str:
        """What the exported self-test says; "fault 0 at 0" if all is well."""
        ran = subprocess.run(
            [*self.command, "self-test"], capture_output=True, text=True, timeout=TIMEOUT_S, check=False
        )
        return ran.stdout.strip() or f"exit {ran.returncode}: {ran.stderr.strip()}"

    def _answer(self, mode: Sequence[str], request: NDArray[np.generic]) -> bytes:
        content = request.astype(request.dtype.newbyteorder(self.order)).tobytes()
        ran = subprocess.run([*self.command, *mode], input=content, capture_output=True, timeout=TIMEOUT_S, check=False)
        if ran.returncode != 0 or ran.stderr:
            raise RuntimeError(f"{' '.join([*self.command, *mode])}: exit {ran.returncode}: {ran.stderr.decode()}")
        return ran.stdout


@lru_cache(maxsize=8)
def sources_of(book: TableBook, self_test: SelfTestSize = FULL) -> Mapping[str, bytes]:
    """The export of `book` and the program around it, by name: made once for all the ways in which it is compiled."""
    program = (files("scripts.studies.in_the_loop") / "controller_process.c").read_bytes()
    return MappingProxyType({**c_files(book, RETARDER, self_test), "controller_process.c": program})


def write_sources(book: TableBook, directory: Path) -> None:
    """Write `sources_of` the book into `directory`, which exists."""
    for name, content in sources_of(book).items():
        (directory / name).write_bytes(content)


def build_controller(
    book: TableBook,
    directory: Path,
    compiler: str = "gcc",
    flags: Sequence[str] = ("-O2",),
    contract: Sequence[str] = CONTRACT,
    link: Sequence[str] = (),
    runner: Sequence[str] = (),
    order: Literal["<", ">"] = "<",
) -> Controller:
    """Export `book` into `directory` and compile it there with `contract` and `flags`; `BuildError` if that fails.

    The program around it is no part of the contract: it is compiled with `flags` alone and linked with `link`.
    `runner`: what runs the program, such as an emulator, for a processor of byte `order`.
    """
    write_sources(book, directory)
    sources = [str(directory / name) for name in EXPORTED]
    objects = [str(Path(name).with_suffix(".o")) for name in sources]
    for source, made in zip(sources, objects, strict=True):
        compile_with([compiler, *contract, *flags, "-c", source, "-o", made])
    program = directory / "controller"
    compile_with([compiler, *flags, *link, str(directory / "controller_process.c"), *objects, "-o", str(program)])
    return Controller((*runner, str(program)), table_words(book), order)


def compile_with(command: Sequence[str]) -> str:
    """Run a compiler or checker and return what it said; `BuildError` unless it succeeds."""
    ran = subprocess.run(command, capture_output=True, text=True, timeout=TIMEOUT_S, check=False)
    if ran.returncode != 0:
        raise BuildError(f"{' '.join(command)}: exit {ran.returncode}\n{ran.stdout}{ran.stderr}")
    return ran.stdout + ran.stderr


FREELY = ("-Wall", "-Wextra", "-Werror")
"""Without -std=c99, with which GCC never fuses a multiplication and an addition."""


@dataclass(frozen=True)
class Build:
    """One way of compiling, `link` for the program around; `emulator` runs it where the processor is another."""

    compiler: str
    flags: tuple[str, ...]
    contract: tuple[str, ...] = CONTRACT
    link: tuple[str, ...] = ()
    emulator: tuple[str, ...] = ()
    order: Literal["<", ">"] = "<"

    def __str__(self) -> str:
        shown = " ".join((self.compiler, *self.flags))
        return shown if self.contract is CONTRACT else f"{shown} without -std=c99"

    def missing(self) -> tuple[str, ...]:
        """The programs that this machine lacks for it."""
        return tuple(name for name in (self.compiler, *self.emulator) if shutil.which(name) is None)

    def controller(self, book: TableBook, directory: Path) -> Controller:
        """The controller of `book`, built in `directory`; raises as `build_controller`."""
        return build_controller(
            book, directory, self.compiler, self.flags, self.contract, self.link, self.emulator, self.order
        )


SANITIZED = ("-g", "-O1", "-fsanitize=address,undefined", "-fno-sanitize-recover=all", "-fno-omit-frame-pointer")
STATIC = ("-static",)

BUILDS: tuple[Build, ...] = (
    *(Build(compiler, (f"-O{level}",)) for compiler in ("gcc", "clang") for level in range(4)),
    *(Build(compiler, ("-O3", "-mfma", "-ffp-contract=fast"), FREELY) for compiler in ("gcc", "clang")),
    Build("gcc", ("-O2", "-mfpmath=387"), FREELY),  # 80-bit registers
    *(Build(compiler, SANITIZED) for compiler in ("gcc", "clang")),
    *(
        Build("arm-linux-gnueabihf-gcc", flags, CONTRACT, STATIC, ("qemu-arm",))
        for flags in (("-O0",), ("-O2", "-mthumb"), ("-O3", "-marm", "-mfpu=vfpv4", "-ffp-contract=fast"))
    ),
    Build("powerpc-linux-gnu-gcc", ("-O2",), CONTRACT, STATIC, ("qemu-ppc",), ">"),  # highest byte first
)
"""On an x86-64 machine with the programs of scripts/setup_toolchain."""
