"""The commands of the yard behind the retarders; `synth.cli.commands` names them.

Annotations are not postponed here: typer would compile every one of them anew at each start.
"""

from pathlib import Path
from typing import Annotated

import typer

from synth.cli import hump_commands, sensors_commands
from synth.cli.arguments import Config
from synth.frame.arguments import Json, directory, whole_number

Configuration = Annotated[Path | None, typer.Argument(metavar="CONFIG.toml", help="Built-in unless given.")]
Output = Annotated[Path, typer.Option("-o", "--output", parser=directory, metavar="DIR", help="Where the results go.")]
Seed = Annotated[
    int | None,
    typer.Option(parser=whole_number(0, 2**53), metavar="N", help="Of the random numbers; as configured unless given."),
]


def add_yard_commands(app: typer.Typer) -> None:
    """Add the commands of the yard to `app`."""
    app.command()(watch)
    app.add_typer(hump_commands.app, name="hump")
    app.add_typer(sensors_commands.app, name="sensors")


def watch(
    logs: Annotated[list[Path], typer.Argument(metavar="LOGS...", help="Measured passes: files, or folders of them.")],
    config: Config = None,
    mapping: Annotated[
        Path | None, typer.Option("--mapping", metavar="M", help="TOML file that maps foreign columns and units.")
    ] = None,
    reference: Annotated[
        list[Path] | None,
        typer.Option(metavar="LOG", help="Passes known to be in order: drifts are counted from their numbers."),
    ] = None,
    output: Output = Path("out/watch"),
    as_json: Json = False,
) -> int:
    """Watch measured passes of a position for drifts.

    What drifted, since when, what it costs, whether to retune or to repair. Exit code 1 if something drifted.
    """
    from synth.cli.watch import AskedWatch, watch_command

    return watch_command(AskedWatch(logs, reference or (), config, mapping, output), as_json)
