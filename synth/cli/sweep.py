"""`retarder-synth sweep status` and `failed`: how far a sweep is, and what failed."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path

from synth.frame.terminal.printed_page import print_page
from synth.frame.terminal.telling import OK
from synth.retarder.sweep.status import failed_units, status_of


def status_command(path: Path, as_json: bool) -> int:
    """Print how far a sweep is."""
    status = status_of(path)
    if as_json:
        print(json.dumps({**asdict(status), "path": str(path)}, indent=1, ensure_ascii=False))
        return OK
    state = "running" if status.running else "complete" if status.complete else "not running, not complete"
    refused = f", targets without a table: {status.refused_targets}" if status.refused_targets else ""
    page = [
        f"{path}: {status.title}: {state}; {status.done} of {status.units} units done, {status.failed} failed{refused}"
    ]
    if status.rate_units_per_min is not None and status.remaining_s is not None:
        page.append(f"  {status.rate_units_per_min:.1f} units a minute, about {status.remaining_s:.0f} s left")
    if status.in_flight:
        page.append(f"  under way: {', '.join(status.in_flight)}")
    if status.bad_ledger_lines:
        page.append(f"  {status.bad_ledger_lines} lines of the ledger are torn or damaged and were passed over")
    print_page(*page)
    return OK


def failed_command(path: Path, as_json: bool) -> int:
    """Print the units that have failed and the targets without a table, with the reason."""
    found = failed_units(path)
    if as_json:
        print(json.dumps([asdict(unit) for unit in found], indent=1, ensure_ascii=False))
        return OK
    print_page(*(f"{unit.name}: {unit.reason}" for unit in found))
    if not found:
        print_page(f"{path}: no unit has failed")
    return OK
