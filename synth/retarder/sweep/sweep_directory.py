"""The directory of a sweep: what lies where in it, and that one run at a time holds it.

DIR/sweep/ledger.jsonl      what was begun, done and failed, and when
DIR/sweep/units/KEY.json    one result a unit, named by the hash of all it depends on
DIR/sweep/summary.json      the figures of the whole sweep
DIR/book.h5 …               book, summary, picture, configuration; in DIR/CONDITION/ where conditions are listed
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from synth.frame.results_directory import ResultsDirectory, make_directory, results_directory
from synth.retarder.sweep.ledger import Ledger, read_ledger
from synth.retarder.sweep.unit_result import UnitResult, from_bytes, to_bytes
from tuning_tables import DamagedTable
from tuning_tables.seal import unsealed

LEDGER, UNITS, SWEEP_SUMMARY = "sweep/ledger.jsonl", "sweep/units", "sweep/summary.json"


@dataclass(frozen=True)
class SweepDirectory:
    """Names of the files below `path`."""

    path: Path

    @property
    def ledger_file(self) -> Path:
        """The ledger."""
        return self.path / LEDGER

    @property
    def units(self) -> Path:
        """The folder of results."""
        return self.path / UNITS

    @property
    def summary(self) -> Path:
        """The figures of the whole sweep; written last."""
        return self.path / SWEEP_SUMMARY

    def book_folder(self, condition: str) -> Path:
        """Where book and summary of a condition go."""
        return self.path / condition if condition else self.path

    def unit_file(self, key: str) -> Path:
        """The file of one result."""
        return self.units / f"{key}.json"

    def ledger(self) -> Ledger:
        """What the ledger says; empty where there is none."""
        return read_ledger(self.ledger_file)

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


@dataclass(frozen=True)
class HeldSweep(SweepDirectory):
    """The directory of a sweep that is running, which alone writes its `results`."""

    results: ResultsDirectory

    def store(self, result: UnitResult) -> None:
        """Write a result, complete or not at all; raises `OSError`."""
        self.results.store(f"{UNITS}/{result.key}.json", to_bytes(result))


@contextlib.contextmanager
def held_sweep(path: Path, reads: Iterable[Path] = ()) -> Iterator[HeldSweep]:
    """Make and hold `path` for one sweep, which reads the files `reads`; `InputError` as `results_directory`.

    Within: no summary of the sweep, which would not belong to what comes. What was computed before stays.
    """
    with results_directory(path, "sweep", reads, summary=SWEEP_SUMMARY) as results:
        make_directory(path / UNITS)
        results.retain(*results.names_below("sweep"))
        yield HeldSweep(path, results)
