"""What compiled code costs: instructions of the dearest call (callgrind), bytes in object files."""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from scripts.studies.in_the_loop.controller_process import CONTRACT, compile_with, write_sources
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
