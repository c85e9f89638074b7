"""The directory of a sweep: what lies where in it, and that one run at a time holds it.

DIR/sweep/ledger.jsonl      what was begun, done and failed, and when
DIR/sweep/units/KEY.json    one result a unit, named by the hash of all it depends on
DIR/book.h5 …               book and configuration; in DIR/CONDITION/, with a summary, where conditions are listed
DIR/summary.json, sheets/, plots/, report.html        as every command leaves them
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Final

from synth.frame.results_directory import ResultsDirectory
from synth.retarder.sweep.ledger import Ledger, read_ledger
from synth.retarder.sweep.unit_result import UnitResult, from_bytes, to_bytes
from tuning_tables import DamagedTable

SWEEP: Final = "sweep run"
"""The command, as directories are marked."""

LEDGER, UNITS = "sweep/ledger.jsonl", "sweep/units"


@dataclass(frozen=True)
class SweepDirectory:
    """Names of the files below `path`."""

    path: Path

    def unit_file(self, key: str) -> Path:
        """The file of one result."""
        return self.path / UNITS / f"{key}.json"

    def ledger(self) -> Ledger:
        """What the ledger says; empty where there is none."""
        return read_ledger(self.path / LEDGER)

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
