"""The commands `retarder-synth sensors …`, their arguments and their help; what they do is in modules of their own.

Annotations are not postponed here: typer would compile every one of them anew at each start.
"""

from pathlib import Path
from typing import Annotated

import typer

from synth.cli.arguments import Json, directory, whole_number

app = typer.Typer(help="Point sensors along a retarder position: where they should stand, and tables for them.")


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


@app.command()
def plan(
    config: Annotated[Path | None, typer.Argument(metavar="CONFIG.toml", help="Built-in unless given.")] = None,
    output: Annotated[
        Path, typer.Option("-o", "--output", parser=directory, metavar="DIR", help="Where the results go.")
    ] = Path("out/sensors-plan"),
    sensors: Annotated[
        str, typer.Option("--sensors", metavar="N-M|N,M", help="Numbers of sensors; the one behind the exit counts.")
    ] = "2-12",
    rms: Annotated[
        float | None, typer.Option("--rms", metavar="M_S", help="Wanted rms, m/s; 1.1 times the radar's unless given.")
    ] = None,
    workers: Annotated[
        int, typer.Option("--workers", parser=whole_number(1, 256), metavar="N", help="Layouts tried at a time.")
    ] = 2,
    as_json: Json = False,
) -> int:
    """Plan where point sensors stand: the least rms for each number, and the fewest for a wanted rms.

    Compared with equal sections, with the rule that each change of stage ends inside its section, and with the radar.
    Exit code 1 if none of the numbers gives the wanted rms.
    """
    from synth.cli.sensors_plan import sensors_plan_command

    return sensors_plan_command(config, output, sensors, rms, workers, as_json)
