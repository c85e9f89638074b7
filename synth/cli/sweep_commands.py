"""The commands `retarder-synth sweep …`, their arguments and their help; what they do is in modules of their own.

Annotations are not postponed here: typer would compile every one of them anew at each start.
"""

from pathlib import Path
from typing import Annotated

import typer

from synth.cli.guide import GUIDES
from synth.cli.listed import SWEEP
from synth.frame.arguments import in_its_manner
from synth.frame.command_line import add_listed, listed_group
from synth.frame.terminal.manner import Manner

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
    from synth.cli.sweep import status_command

    return status_command(path, manner)


@app.command()
@in_its_manner
def failed(path: Swept, manner: Manner) -> int:
    """Tell which units of a sweep have failed, which targets have no table, and why."""
    from synth.cli.sweep import failed_command

    return failed_command(path, manner)
