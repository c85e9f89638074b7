"""What is said of a sweep from its directory alone, while it runs or later."""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from synth.frame.held_directory import is_held
from synth.frame.input_error import InputError
from synth.frame.results_directory import SUMMARY
from synth.retarder.sweep.ledger import DONE, FAILED, STARTED, Event, Ledger
from synth.retarder.sweep.sweep_directory import SweepDirectory


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
