"""The commands `retarder-synth hump …`, their arguments and their help; what they do is in `synth.cli.hump`.

Annotations are not postponed here: typer would compile every one of them anew at each start.
"""

from pathlib import Path
from typing import Annotated

import typer

from synth.cli.guide import GUIDES
from synth.cli.listed import HUMP
from synth.frame.arguments import directory, in_its_manner, whole_number
from synth.frame.command_line import add_listed, listed_group
from synth.frame.terminal.manner import Manner

app = typer.Typer(
    cls=listed_group(HUMP, GUIDES["hump"]), help="Check, list and draw a hump; hump whole trains over it."
)

Hump = Annotated[
    Path, typer.Argument(metavar="FILE|HUMP", help="A hump file (.toml, .railml, .csv, .xlsx), or one of the library.")
]


@app.command()
@in_its_manner
def check(source: Hump, manner: Manner) -> int:
    """Check a hump file, and tell what it holds and what it leaves open."""
    from synth.cli.hump import check_command

    return check_command(source, manner)


@app.command()
@in_its_manner
def routes(source: Hump, manner: Manner) -> int:
    """Tell the route to every track: elements, metres from the crest, positions of the switches."""
    from synth.cli.hump import routes_command

    return routes_command(source, manner)


@app.command()
@in_its_manner
def draw(
    source: Hump,
    manner: Manner,
    output: Annotated[
        Path, typer.Option("-o", "--output", parser=directory, metavar="DIR", help="Where the pictures go.")
    ] = Path("out/hump"),
    track: Annotated[
        int | None,
        typer.Option(
            parser=whole_number(1, 199),
            metavar="N",
            help="Whose profile is drawn; by default that with the most turning.",
        ),
    ] = None,
) -> int:
    """Draw the track plan, and below it the profile of a route with speed heads of a good, a mean and a bad runner."""
    from synth.cli.hump import draw_command

    return draw_command(source, output, track, manner)


@app.command()
@in_its_manner
def export(
    source: Hump,
    form: Annotated[str, typer.Option("--format", metavar="railml|csv|xlsx|toml", help="Form of the hump.")],
    manner: Manner,
    output: Annotated[
        Path, typer.Option("-o", "--output", parser=directory, metavar="DIR", help="Where it goes.")
    ] = Path("out/hump-export"),
) -> int:
    """Write a hump as railML 3, as a table for spreadsheets with a row an element, or as TOML."""
    from synth.cli.hump import export_command

    return export_command(source, form, output, manner)


add_listed(app, HUMP)
