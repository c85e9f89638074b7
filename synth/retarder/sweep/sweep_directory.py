"""The directory of a sweep: what lies where in it, that one run at a time holds it, its ledger, and what is said of the
sweep from these alone, while it runs or later.

DIR/sweep/ledger.jsonl      what was begun, done and failed, and when
DIR/sweep/units/KEY.json    one result a unit, named by the hash of all it depends on
DIR/book.h5 …               book and configuration; in DIR/CONDITION/, with a summary, where conditions are listed
DIR/summary.json, sheets/, plots/, report.html        as every command leaves them

The ledger has a line an event, only ever appended, forced to the disk: the canonical JSON of an object with a CRC-32
(see `tuning_tables.json_text`). A process that is killed can leave a torn last line: the next writer ends it, every
reader passes over it. What was computed is told by the files of the units; the ledger tells when, how long, and why
something failed.
"""

from __future__ import annotations

import errno
import json
import os
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any, Final

from synth.frame.faults import InputError
from synth.frame.own_files import is_held
from synth.frame.results_directory import SUMMARY, ResultsDirectory
from synth.retarder.sweep.unit_result import UnitResult, from_bytes, to_bytes
from tuning_tables import DamagedTable
from tuning_tables.json_text import CHECKSUM_KEY, canonical_json, document_checksum
from tuning_tables.whole_file import faults_naming

PLAN, STARTED, DONE, FAILED, ENDED = "plan", "started", "done", "failed", "ended"

Event = dict[str, Any]


@dataclass(frozen=True)
class Ledger:
    """The sound events in their order, and how many lines were not."""

    events: tuple[Event, ...]
    bad_lines: int

    @property
    def created(self) -> str | None:
        """The date that the first run gave the tables, None before there was one."""
        return next((str(event["created"]) for event in self.of(PLAN)), None)

    @property
    def plan(self) -> Event | None:
        """The last plan, None before there was one."""
        return next(reversed(self.of(PLAN)), None)

    def of(self, kind: str) -> list[Event]:
        """All events of a kind."""
        return [event for event in self.events if event["event"] == kind]

    def since_plan(self) -> list[Event]:
        """What happened since the last run began."""
        starts = [place for place, event in enumerate(self.events) if event["event"] == PLAN]
        return list(self.events[starts[-1] + 1 :]) if starts else []


def read_ledger(path: Path) -> Ledger:
    """Every sound line of the ledger at `path`; nothing where there is no file."""
    try:
        lines = path.read_bytes().split(b"\n")
    except FileNotFoundError:
        return Ledger((), 0)
    events = [event_in(line) for line in lines if line]
    sound = tuple(event for event in events if event is not None)
    return Ledger(sound, len(events) - len(sound))


def event_in(line: bytes) -> Event | None:
    """The event in a line, None where it is torn or changed."""
    try:
        event = json.loads(line)
        if isinstance(event, dict) and event.get(CHECKSUM_KEY) == document_checksum(event):
            return event if isinstance(event.get("event"), str) else None
    except (ValueError, RecursionError):
        pass
    return None


class LedgerWriter:
    """Appends to the ledger at a path; a context manager. Only the holder of the directory may write."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._file = path.open("ab+", buffering=0)
        with faults_naming(path):
            if self._file.tell():
                self._file.seek(-1, os.SEEK_END)
                if self._file.read(1) != b"\n":
                    self._file.write(b"\n")

    def __enter__(self) -> LedgerWriter:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, fault: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._file.close()

    def write(self, kind: str, facts: Mapping[str, Any]) -> None:
        """Append one event with the time; on the disk when this returns. Raises `OSError` that names the ledger."""
        event = {"event": kind, "time_s": round(time.time(), 3), **facts}
        line = canonical_json({**event, CHECKSUM_KEY: document_checksum(event)}) + b"\n"
        with faults_naming(self._path):
            if self._file.write(line) != len(line):
                raise OSError(errno.ENOSPC, "the disk took only a part of a line")
            os.fsync(self._file.fileno())


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


@dataclass(frozen=True)
class Status:
    """`in_flight`: units that a run is at; `rate_units_per_min`, `remaining_s` of the run under way, else None."""

    path: Path
    title: str
    running: bool
    complete: bool
    units: int
    done: int
    failed: int
    refused_targets: int
    in_flight: tuple[str, ...]
    rate_units_per_min: float | None
    remaining_s: float | None
    bad_ledger_lines: int


@dataclass(frozen=True)
class FailedUnit:
    """A unit of the last plan that has no result, or a target of one that has no table, and why."""

    name: str
    reason: str
    key: str


def status_of(path: Path) -> Status:
    """How far the sweep in `path` is; `InputError` where there is none."""
    directory = SweepDirectory(path)
    ledger, plan = ledger_and_plan(directory)
    running = is_held(path)
    names = {str(key): str(name) for key, name in plan["units"]}
    done = {key for key in names if directory.unit_file(key).exists()}
    recent = ledger.since_plan()
    ended = {event["unit"] for event in recent if event["event"] in (DONE, FAILED)}
    begun = {event["unit"] for event in recent if event["event"] == STARTED}
    rate, left = pace(recent, plan, len(ended)) if running else (None, None)
    return Status(
        path=path,
        title=str(plan["title"]),
        running=running,
        complete=(path / SUMMARY).exists() and not running,
        units=len(names),
        done=len(done),
        failed=len(without_result(directory, ledger, plan)),
        refused_targets=len(without_table(directory, ledger, plan)),
        in_flight=tuple(names[key] for key in names if running and key in begun - ended),
        rate_units_per_min=rate,
        remaining_s=left,
        bad_ledger_lines=ledger.bad_lines,
    )


def pace(recent: list[Event], plan: Event, ended: int) -> tuple[float | None, float | None]:
    """Units a minute since the run began, and seconds left at that rate; None before the first has ended."""
    elapsed = max(time.time() - float(plan["time_s"]), 1e-3)
    if not ended:
        return None, None
    return 60.0 * ended / elapsed, elapsed / ended * (len(plan["missing"]) - ended)


def failed_units(path: Path) -> tuple[FailedUnit, ...]:
    """The units of the last plan that have failed and have no result, then targets that have no table."""
    directory = SweepDirectory(path)
    ledger, plan = ledger_and_plan(directory)
    return without_result(directory, ledger, plan) + without_table(directory, ledger, plan)


def without_result(directory: SweepDirectory, ledger: Ledger, plan: Event) -> tuple[FailedUnit, ...]:
    """Units of `plan` that have failed, in its order."""
    last: dict[Any, Event] = {event["unit"]: event for event in ledger.of(FAILED)}
    return tuple(
        FailedUnit(str(name), str(last[key]["reason"]), str(key))
        for key, name in plan["units"]
        if key in last and not directory.unit_file(key).exists()
    )


def without_table(directory: SweepDirectory, ledger: Ledger, plan: Event) -> tuple[FailedUnit, ...]:
    """Targets of the other units for which there is no table, in the order of `plan`."""
    last: dict[Any, Event] = {event["unit"]: event for event in ledger.of(DONE)}
    return tuple(
        FailedUnit(f"{name} to {each['target_m_s']:g} m/s", str(each["reason"]), str(key))
        for key, name in plan["units"]
        if key in last and directory.unit_file(key).exists()
        for each in last[key].get("refused", ())  # an earlier version did not write it
    )


def ledger_and_plan(directory: SweepDirectory) -> tuple[Ledger, Event]:
    """The ledger and its last plan; `InputError` where there is none."""
    ledger = directory.ledger()
    plan = ledger.plan
    if plan is None:
        raise InputError(f"{directory.path}: there is no sweep in it; give the directory that a sweep was given by -o")
    return ledger, plan
