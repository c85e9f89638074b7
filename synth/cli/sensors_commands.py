"""The commands `retarder-synth sensors …`, their arguments and their help; what they do is in modules of their own.

Annotations are not postponed here: typer would compile every one of them anew at each start.
"""

from pathlib import Path
from typing import Annotated

import typer

from synth.cli.listed import SENSORS
from synth.frame.arguments import Json, directory, whole_number
from synth.frame.command_line import add_listed, listed_group

app = typer.Typer(
    cls=listed_group(SENSORS),
    help="Point sensors along a retarder position: where they should stand, and tables for them.",
)


@app.command()
def tune(
    config: Annotated[
        Path | None,
        typer.Argument(metavar="CONFIG.toml", help="With [sensors]; what 'init --sensors' prints unless given."),
    ] = None,
    output: Annotated[
        Path, typer.Option("-o", "--output", parser=directory, metavar="DIR", help="Where the results go.")
    ] = Path("out/sensors"),
    workers: Annotated[
        int | None,
        typer.Option(
            parser=whole_number(1, 256), metavar="N", help="Cut classes solved at once; by default one a processor."
        ),
    ] = None,
    as_json: Json = False,
) -> int:
    """Make tables that decide where axles pass point sensors, with their code, pictures and report.

    Exit code 1 if the table of a feasible case misses a limit of the configuration, or a case has no table.
    """
    from synth.cli.sensors_tune import sensors_tune_command

    return sensors_tune_command(config, output, workers, as_json)


add_listed(app, SENSORS)
