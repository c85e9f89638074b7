"""The commands `retarder-synth sweep …`: how far a sweep is, and what failed.

Annotations are not postponed here: typer would compile every one of them anew at each start.
"""

from collections.abc import Iterator
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from synth.cli.guide import GUIDES
from synth.cli.listed import SWEEP
from synth.frame.arguments import in_its_manner
from synth.frame.command_line import add_listed, listed_group
from synth.frame.terminal.manner import Manner
from synth.frame.terminal.telling import OK

if TYPE_CHECKING:
    from synth.retarder.sweep.sweep_directory import Status

app = typer.Typer(
    cls=listed_group(SWEEP, GUIDES["sweep"]),
    help="Make books over a grid of cut classes, targets and conditions; how far it is.",
)

Swept = Annotated[Path, typer.Argument(metavar="DIR", help="The directory of a sweep.")]


add_listed(app, SWEEP)


@app.command()
@in_its_manner
def status(path: Swept, manner: Manner) -> int:
    """Tell how far a sweep is, while it runs or later."""
    from synth.retarder.sweep.sweep_directory import status_of

    found = status_of(path)
    manner.give(lambda: {**asdict(found), "path": str(path)}, partial(status_page, found))
    return OK


def status_page(status: "Status") -> Iterator[str]:
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


@app.command()
@in_its_manner
def failed(path: Swept, manner: Manner) -> int:
    """Tell which units of a sweep have failed, which targets have no table, and why."""
    from synth.retarder.sweep.sweep_directory import failed_units

    found = failed_units(path)
    words = [f"{unit.name}: {unit.reason}" for unit in found] or [f"{path}: no unit has failed"]
    manner.give(lambda: [asdict(unit) for unit in found], lambda: words)
    return OK
