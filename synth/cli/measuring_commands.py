"""The commands about the numbers and the hardware of a yard; `synth.cli.commands` names them.

Annotations are not postponed here: typer would compile every one of them anew at each start.
"""

from pathlib import Path
from typing import Annotated

import typer

from synth.cli.arguments import Json, directory, whole_number


def add_measuring_commands(app: typer.Typer) -> None:
    """Add the commands to `app`."""
    app.command()(sensitivity)
    app.command()(permissions)


def sensitivity(
    config: Annotated[Path | None, typer.Argument(metavar="CONFIG.toml", help="Built-in unless given.")] = None,
    output: Annotated[
        Path, typer.Option("-o", "--output", parser=directory, metavar="DIR", help="Where the results go.")
    ] = Path("out/sensitivity"),
    table: Annotated[
        Path | None,
        typer.Option("--table", metavar="TABLE|BOOK|DIR", help="Tables to ask; those of a tune unless given."),
    ] = None,
    points: Annotated[
        int, typer.Option(parser=whole_number(200, 100_000), metavar="N", help="Plants that are tried.")
    ] = 1000,
    passes: Annotated[
        int, typer.Option(parser=whole_number(100, 100_000), metavar="N", help="Passes of a table on each plant.")
    ] = 200,
    seed: Annotated[
        int | None,
        typer.Option(
            parser=whole_number(0, 2**53), metavar="N", help="Of plants and passes; as configured unless given."
        ),
    ] = None,
    as_json: Json = False,
) -> int:
    """Tell which number of a configuration to measure first.

    The table stays; the numbers vary over their ranges. Shares of the variance of rms, mean and over-speed by number.
    """
    from synth.cli.sensitivity import sensitivity_command

    return sensitivity_command(config, table, output, (points, passes, seed), as_json)


def permissions(
    config: Annotated[Path | None, typer.Argument(metavar="CONFIG.toml", help="Built-in unless given.")] = None,
    output: Annotated[
        Path, typer.Option("-o", "--output", parser=directory, metavar="DIR", help="Where the results go.")
    ] = Path("out/permissions"),
    workers: Annotated[
        int, typer.Option("--workers", parser=whole_number(1, 256), metavar="N", help="Cases compared at a time.")
    ] = 2,
    as_json: Json = False,
) -> int:
    """Tell what to ask of the hardware: what each permission would give in every case.

    Commands during a change of stage, with and without a pressure gauge; an estimator; the approach. Simulated on the
    same passes as the tables that a tune makes.
    """
    from synth.cli.permissions import permissions_command

    return permissions_command(config, output, workers, as_json)
