"""The commands on measured passes; `synth.cli.commands` names them.

Annotations are not postponed here: typer would compile every one of them anew at each start.
"""

from pathlib import Path
from typing import Annotated

import typer

from synth.cli.arguments import Config
from synth.frame.arguments import Json, directory

Logs = Annotated[list[Path], typer.Argument(metavar="LOGS...", help="Files of measured passes, or folders of them.")]
Mapping = Annotated[
    Path | None, typer.Option("--mapping", metavar="FILE", help="Names and units of foreign columns (.toml).")
]
Output = Annotated[Path, typer.Option("-o", "--output", parser=directory, metavar="DIR", help="Where the results go.")]


def add_measured_commands(app: typer.Typer) -> None:
    """Add the commands on measured passes to `app`."""
    app.command()(identify)
    app.command()(replay)
    app.command()(retune)


def identify(
    logs: Logs,
    mapping: Mapping = None,
    config: Config = None,
    output: Output = Path("out/identify"),
    as_json: Json = False,
) -> int:
    """Tell the numbers of a position from its measured passes, and write them as a configuration.

    Exit code 1 if a test says that the model does not hold for these passes.
    """
    from synth.cli.identify import identify_command

    return identify_command(logs, mapping, config, output, as_json)


def replay(
    logs: Logs,
    table: Annotated[Path, typer.Option("--table", metavar="TABLE|BOOK", help="The tables to try.")],
    own: Annotated[
        Path | None,
        typer.Option("--own", metavar="BOOK", help="What drove the log; the configuration's own tables unless given."),
    ] = None,
    mapping: Mapping = None,
    config: Config = None,
    output: Output = Path("out/replay"),
    as_json: Json = False,
) -> int:
    """Tell what other tables would have commanded in measured passes, and how the cuts would have left.

    Exit code 1 if the measured exits are not those that the configuration predicts for the tables of the log.
    """
    from synth.cli.replay import replay_command

    return replay_command(logs, table, own, mapping, config, output, as_json)


def retune(
    logs: Logs,
    table: Annotated[
        Path | None,
        typer.Option("--table", metavar="BOOK", help="What runs now; the configuration's own tables unless given."),
    ] = None,
    mapping: Mapping = None,
    config: Config = None,
    output: Output = Path("out/retune"),
    as_json: Json = False,
) -> int:
    """Make new tables for what measured passes say of the plant, and tell what they gain.

    Exit code 1, and no book, if the gain is within noise in every case; also 1 if a case has no new table.
    """
    from synth.cli.retune import retune_command

    return retune_command(logs, table, mapping, config, output, as_json)
