"""`retarder-synth sweep status` and `failed`: how far a sweep is, and what failed."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict
from functools import partial
from pathlib import Path

from synth.frame.terminal.manner import Manner
from synth.frame.terminal.telling import OK
from synth.retarder.sweep.status import Status, failed_units, status_of


def status_command(path: Path, manner: Manner) -> int:
    """Print how far a sweep is."""
    status = status_of(path)
    manner.give(lambda: {**asdict(status), "path": str(path)}, partial(status_page, status))
    return OK


def status_page(status: Status) -> Iterator[str]:
    """How far it is, in words."""
    state = "running" if status.running else "complete" if status.complete else "not running, not complete"
    refused = f", targets without a table: {status.refused_targets}" if status.refused_targets else ""
    yield (
        f"{status.path}: {status.title}: {state}; {status.done} of {status.units} units done, {status.failed} "
        f"failed{refused}"
    )
    if status.rate_units_per_min is not None and status.remaining_s is not None:
        yield f"  {status.rate_units_per_min:.1f} units a minute, about {status.remaining_s:.0f} s left"
    if status.in_flight:
        yield f"  under way: {', '.join(status.in_flight)}"
    if status.bad_ledger_lines:
        yield f"  {status.bad_ledger_lines} lines of the ledger are torn or damaged and were passed over"


def failed_command(path: Path, manner: Manner) -> int:
    """Print the units that have failed and the targets without a table, with the reason."""
    found = failed_units(path)
    words = [f"{unit.name}: {unit.reason}" for unit in found] or [f"{path}: no unit has failed"]
    manner.give(lambda: [asdict(unit) for unit in found], lambda: words)
    return OK
