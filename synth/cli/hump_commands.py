"""The commands `retarder-synth hump …`, their arguments and their help; what they do is in `synth.cli.hump`.

Annotations are not postponed here: typer would compile every one of them anew at each start.
"""

from pathlib import Path
from typing import Annotated

import typer

from synth.cli.listed import HUMP
from synth.frame.arguments import Json, directory, whole_number
from synth.frame.command_line import add_listed, listed_group

app = typer.Typer(cls=listed_group(HUMP), help="Check, list and draw a hump; hump whole trains over it.")

Trial = Annotated[
    Path | None,
    typer.Argument(metavar="CONFIG.toml|HUMP", help="A hump trial, or a hump for the built-in trial."),
]
Trains = Annotated[
    int | None,
    typer.Option(parser=whole_number(1, 10_000_000), metavar="N", help="Trains; as configured unless given."),
]
Seed = Annotated[
    int | None,
    typer.Option(parser=whole_number(0, 2**53), metavar="N", help="Of the random numbers; as configured unless given."),
]
SortingCsv = Annotated[
    Path | None,
    typer.Option("--list", metavar="CSV", help="A sorting list, that of every train."),
]

Hump = Annotated[
    Path, typer.Argument(metavar="FILE|NAME", help="A hump file (.toml, .railml), or a hump of the library.")
]


@app.command()
def check(source: Hump, as_json: Json = False) -> int:
    """Check a hump file, and tell what it holds and what it leaves open."""
    from synth.cli.hump import check_command

    return check_command(source, as_json)


@app.command()
def routes(source: Hump, as_json: Json = False) -> int:
    """Tell the route to every track: elements, metres from the crest, positions of the switches."""
    from synth.cli.hump import routes_command

    return routes_command(source, as_json)


@app.command()
def draw(
    source: Hump,
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
    as_json: Json = False,
) -> int:
    """Draw the track plan, and below it the profile of a route with speed heads of a good, a mean and a bad runner."""
    from synth.cli.hump import draw_command

    return draw_command(source, output, track, as_json)


@app.command()
def export(
    source: Hump,
    output: Annotated[Path, typer.Option("-o", "--output", metavar="FILE.railml", help="The railML file.")],
) -> int:
    """Write a hump as railML 3; retarders and the like in a namespace of their own."""
    from synth.cli.hump import export_command

    return export_command(source, output)


@app.command()
def schema() -> int:
    """Print the JSON Schema of hump files, for editors that check TOML by it."""
    from synth.cli.hump import schema_command

    return schema_command()


@app.command()
def simulate(
    source: Trial = None,
    output: Annotated[
        Path, typer.Option("-o", "--output", parser=directory, metavar="DIR", help="Where the results go.")
    ] = Path("out/trains"),
    trains: Trains = None,
    sorting_list: SortingCsv = None,
    seed: Seed = None,
    workers: Annotated[
        int | None,
        typer.Option(parser=whole_number(1, 1024), metavar="N", help="Processes on this machine."),
    ] = None,
    scheduler: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="Compute on the workers of this Dask scheduler instead.")
    ] = None,
    as_json: Json = False,
) -> int:
    """Hump whole trains: catch-ups, couplings, gaps and cars an hour, with intervals; resumable.

    The same command goes on after an end of any kind. Exit code 1 if a limit of the configuration is missed.
    """
    from synth.cli.hump_trial import AskedTrains, simulate_command

    return simulate_command(source, AskedTrains(trains, seed, sorting_list), output, workers, scheduler, as_json)


@app.command()
def speed(
    source: Trial = None,
    output: Annotated[
        Path, typer.Option("-o", "--output", parser=directory, metavar="DIR", help="Where the files go.")
    ] = Path("out/speed"),
    train: Annotated[
        int, typer.Option(parser=whole_number(1, 10_000_000), metavar="K", help="Which train of the trial.")
    ] = 1,
    sorting_list: SortingCsv = None,
    seed: Seed = None,
    as_json: Json = False,
) -> int:
    """Plan one train: hump speeds for the locomotive, and the uncoupler's sheet."""
    from synth.cli.hump_trial import AskedTrains, speed_command

    return speed_command(source, AskedTrains(None, seed, sorting_list), train, output, as_json)


@app.command()
def report(
    path: Annotated[Path, typer.Argument(metavar="DIR", help="What hump simulate left.")], as_json: Json = False
) -> int:
    """Make figures, pictures and pages again from the trains that hump simulate left."""
    from synth.cli.hump_trial import report_command

    return report_command(path, as_json)


add_listed(app, HUMP)
