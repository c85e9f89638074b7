"""The commands `retarder-synth sensors …`, their arguments and their help; what they do is in modules of their own.

Annotations are not postponed here: typer would compile every one of them anew at each start.
"""

from pathlib import Path
from typing import Annotated

import typer

from synth.cli.arguments import Json, directory, whole_number

sensors_app = typer.Typer(help="Make tables for point sensors: a regulator that sees a cut only where it passes one.")


def add_sensors_commands(app: typer.Typer) -> None:
    """Add the commands to `app`."""
    app.add_typer(sensors_app, name="sensors")


@sensors_app.command()
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

    Exit code 1 if the table of a feasible case misses a limit of the configuration.
    """
    from synth.cli.sensors_tune import sensors_tune_command

    return sensors_tune_command(config, output, workers, as_json)
