"""The directory of a sweep: what lies where in it, and that one run at a time holds it.

DIR/sweep/ledger.jsonl      what was begun, done and failed, and when
DIR/sweep/units/KEY.json    one result a unit, named by the hash of all it depends on
DIR/sweep/summary.json      the figures of the whole sweep
DIR/book.h5 …               book, summary, picture, configuration; in DIR/CONDITION/ where conditions are listed
"""

from __future__ import annotations

import contextlib
import fcntl
import os
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from synth.book.output_directory import LEFTOVER, SUMMARY, SWEEP_LEDGER, make_directory
from synth.faults.input_error import InputError
from synth.sweep.ledger import Ledger, read_ledger
from synth.sweep.unit_result import UnitResult, from_bytes, to_bytes
from tuning_tables import DamagedTable, write_atomically
from tuning_tables.seal import unsealed

TUNED = ("book.h5", SUMMARY, "report.html", "c/retarder_table.c")
"""What a tune leaves, in the directory that a book of the sweep goes to."""

TRIES, PAUSE_S = 10, 0.05
"""The lock is asked for so often: `sweep status` takes it for a moment to see whether it is free."""


@dataclass(frozen=True)
class SweepDirectory:
    """Names of the files below `path`."""

    path: Path

    @property
    def ledger_file(self) -> Path:
        """The ledger."""
        return self.path / SWEEP_LEDGER

    @property
    def units(self) -> Path:
        """The folder of results."""
        return self.path / "sweep" / "units"

    @property
    def summary(self) -> Path:
        """The figures of the whole sweep; written last."""
        return self.path / "sweep" / "summary.json"

    def book_folder(self, condition: str) -> Path:
        """Where book and summary of a condition go."""
        return self.path / condition if condition else self.path

    def unit_file(self, key: str) -> Path:
        """The file of one result."""
        return self.units / f"{key}.json"

    def ledger(self) -> Ledger:
        """What the ledger says; empty where there is none."""
        return read_ledger(self.ledger_file)

    def store(self, result: UnitResult) -> None:
        """Write a result, complete or not at all; raises `OSError`."""
        write_atomically(self.unit_file(result.key), to_bytes(result))

    def has(self, key: str) -> bool:
        """Whether the result of a unit is there, its seal unbroken; `DamagedTable` where it is broken."""
        path = self.unit_file(key)
        try:
            unsealed(path.read_bytes(), str(path))
        except FileNotFoundError:
            return False
        return True

    def stored(self, key: str) -> UnitResult:
        """The result of a unit. `TableError` for a file that is damaged or of another unit; `OSError`."""
        path = self.unit_file(key)
        result = from_bytes(path.read_bytes(), str(path))
        if result.key != key:
            raise DamagedTable(f"{path}: it holds the result of another unit, {result.key}.")
        return result


@contextlib.contextmanager
def held(path: Path) -> Iterator[SweepDirectory]:
    """Make and hold `path` for one sweep; `InputError` if it cannot be written or another run holds it.

    Within: no summary of the sweep, which would not belong to what comes, and no leftovers of a killed run.
    """
    directory = SweepDirectory(path)
    make_directory(path)
    descriptor = os.open(path, os.O_RDONLY)
    try:
        if not locked(descriptor):
            raise InputError(f"{path}: another sweep or tune is writing there; wait for it, or give another one by -o")
        if not directory.ledger_file.exists():
            require_no_tune(path)
        for folder in (path / "sweep", directory.units):
            make_directory(folder)
            for file in folder.glob(".*.part"):
                if LEFTOVER.fullmatch(file.name):
                    file.unlink(missing_ok=True)
        directory.summary.unlink(missing_ok=True)
        yield directory
    finally:
        os.close(descriptor)


def require_no_tune(path: Path) -> None:
    """`InputError` if `path` holds what a tune leaves."""
    if any((path / name).exists() for name in TUNED):
        raise InputError(f"{path}: it holds the results of something else; give another directory by -o")


def locked(descriptor: int) -> bool:
    """Lock the open directory for this process.

    The lock is the kernel's and ends with the process, however it ends: there is no stale one. True also on file
    systems without locks.
    """
    for _ in range(TRIES):
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            time.sleep(PAUSE_S)
        except OSError:
            return True
        else:
            return True
    return False


def is_held(path: Path) -> bool:
    """Whether a run holds the directory `path` now."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    except OSError:
        return False
    finally:
        os.close(descriptor)
    return False
