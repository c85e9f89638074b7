"""What it takes to bind a large book: a process of its own, for its memory.

`python -m` of this module DIRECTORY COUNT binds so many copies of the tables that a sweep left in DIRECTORY.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass, replace
from itertools import count as counting
from itertools import islice
from pathlib import Path

from synth.sweep.unit_result import from_bytes
from synth.sweep.work import peak_bytes
from tuning_tables import ControllerTable, write_book

MIB = 2**20


@dataclass(frozen=True)
class Binding:
    """Seconds to read and to write, size of the book, memory of the process before and at most."""

    tables: int
    read_s: float
    write_s: float
    book_mib: float
    bare_mib: float
    peak_mib: float


def bound(directory: Path, tables: int) -> Binding:
    """Bind in another process."""
    command = [sys.executable, "-m", __spec__.name, str(directory), str(tables)]
    ran = subprocess.run(command, capture_output=True, text=True, check=True)
    return Binding(**json.loads(ran.stdout))


def copies(directory: Path) -> Iterator[ControllerTable]:
    """The tables of a sweep over and over, each time with another id and read anew, as binding does."""
    units = sorted((directory / "sweep" / "units").iterdir())
    for turn in counting():
        for unit in units:
            for row in from_bytes(unit.read_bytes(), str(unit)).rows:
                yield replace(row.table, id=f"{turn}-{row.table.id}")


def bind_here(directory: Path, tables: int) -> Binding:
    """The work of that process."""
    bare, begun = peak_bytes() / MIB, time.monotonic()
    found = list(islice(copies(directory), tables))
    read = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        book = Path(folder) / "book.h5"
        write_book(found, book)
        size = book.stat().st_size / MIB
    return Binding(len(found), read - begun, time.monotonic() - read, size, bare, peak_bytes() / MIB)


if __name__ == "__main__":
    print(json.dumps(asdict(bind_here(Path(sys.argv[1]), int(sys.argv[2])))))
