"""The commands, their arguments and their help; what they do is in the modules that they import.

Annotations are not postponed here: typer would compile every one of them anew at each start.
"""

from pathlib import Path
from typing import Annotated

import typer

from synth.cli import hump_commands, sweep_commands
from synth.cli.guide import TOP
from synth.cli.init_commands import add_init_command
from synth.cli.listed import COMMANDS
from synth.frame.arguments import directory, in_its_manner, whole_number
from synth.frame.command_line import add_listed, listed_group
from synth.frame.terminal.manner import Manner

SourceOrDirectory = Annotated[
    Path, typer.Argument(metavar="TABLE|BOOK|DIR", help="A table (.json), a book (.h5), or what a tune left.")
]
PageFolder = Annotated[
    Path | None,
    typer.Option("-o", "--output", parser=directory, metavar="DIR", help="Also write a page there, report.html."),
]
ExportSource = Annotated[
    Path, typer.Argument(metavar="TABLE|BOOK|DIR", help="A table (.json), a book (.h5), or a folder of tables.")
]

app = typer.Typer(
    name="retarder-synth",
    cls=listed_group(COMMANDS, TOP),
    help="Designs the controller of a hump-yard car retarder: switching lines, controller tables, and their proof.",
    add_completion=True,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def run(arguments: list[str]) -> int:
    """Run the command in `arguments`; the exit code. A fault of use is told in one line and gives 2."""
    from synth.frame.terminal.telling import INPUT_FAULT, say

    try:
        code = app(arguments, prog_name="retarder-synth", standalone_mode=False)
    except typer.TyperException as fault:
        if not arguments:
            typer.echo(fault.format_message(), err=True)
        else:
            say(f"{fault.format_message().rstrip('.')}; see 'retarder-synth --help'")
        return INPUT_FAULT
    return code or 0


def show_version(wanted: bool) -> None:
    """Print the version and end."""
    if wanted:
        from importlib.metadata import version

        typer.echo(f"retarder-synth {version('retarder-synth')}")
        raise typer.Exit


@app.callback(no_args_is_help=True)
def common(
    version: Annotated[
        bool, typer.Option("--version", help="Show the version and exit.", callback=show_version, is_eager=True)
    ] = False,
) -> None:
    """Designs the controller of a hump-yard car retarder: switching lines, controller tables, and their proof."""


app.add_typer(hump_commands.app, name="hump")
app.add_typer(sweep_commands.app, name="sweep")
add_listed(app, COMMANDS)


@app.command()
@in_its_manner
def verify(
    source: SourceOrDirectory,
    manner: Manner,
    passes: Annotated[
        int,
        typer.Option(
            parser=whole_number(100, 1_000_000), metavar="N", help="Coarse passes of each table; 0.6 ms each."
        ),
    ] = 300,
    seed: Annotated[
        int, typer.Option(parser=whole_number(0, 2**63 - 1), metavar="N", help="Of the random numbers.")
    ] = 1,
    output: PageFolder = None,
) -> int:
    """Check exported tables by a second, independent program.

    Checksums, order of lines, agreement of all exports, and claims against a coarse simulation. Exit code 1 if a claim
    is not confirmed, 3 if a file is damaged, exports disagree or lines cross.
    """
    from synth.cli.verify import verify_command

    return verify_command(source, passes, seed, output, manner)


@app.command()
@in_its_manner
def inspect(
    source: SourceOrDirectory,
    manner: Manner,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o", "--output", parser=directory, metavar="DIR", help="Draw the tables too, into this folder, and a page."
        ),
    ] = None,
    config: Annotated[
        Path | None,
        typer.Option(
            "--config", metavar="C", help="With -o: configuration with the plant; that of the tables unless given."
        ),
    ] = None,
) -> int:
    """Tell what is in exported tables, and draw them.

    What they are for, what they promise, where their lines run; checksums are checked. Pictures of lines, surfaces and
    exit speeds; where the plant is known, of simulated passes. Nothing is solved.
    """
    from synth.cli.inspect import inspect_command
    from synth.cli.inspect_drawn import asked_drawing

    return inspect_command(source, asked_drawing(output, config), manner)


@app.command()
@in_its_manner
def export(
    source: ExportSource,
    form: Annotated[
        str, typer.Option("--format", metavar="json|csv|c|st|plcopen|twincat|scl|fmu|fmu2", help="Form of the tables.")
    ],
    manner: Manner,
    output: Annotated[
        Path, typer.Option("-o", "--output", parser=directory, metavar="DIR", help="Where they go.")
    ] = Path("out/export"),
    prefix: Annotated[
        str | None, typer.Option(metavar="NAME", help="First word of all names in code, instead of RETARDER.")
    ] = None,
    self_test: Annotated[
        str | None, typer.Option(metavar="full|small", help="What the self-test of code asks; full unless given.")
    ] = None,
    split: Annotated[bool, typer.Option("--split", help="Structured Text with a file each unit.")] = False,
    correction: Annotated[
        float | None, typer.Option(metavar="LIMIT", help="With code that corrects by the last exits, up to LIMIT m/s.")
    ] = None,
) -> int:
    """Write tables in another form.

    JSON and CSV: a file each. C99 and Structured Text: all tables together, with the rule and a self-test. Structured
    Text as bare text (st), as one XML file of PLCopen (CODESYS, Beremiz), for TwinCAT 3, or in SCL (TIA Portal). FMU:
    the controller and its position as units of FMI 3.0 (fmu) or 2.0 (fmu2) for co-simulation.
    """
    from synth.cli.export import AskedCode, export_command

    return export_command(source, form, output, AskedCode(prefix, self_test, split, correction), manner)


add_init_command(app)


@app.command(context_settings={"allow_extra_args": True, "ignore_unknown_options": True, "help_option_names": []})
@in_its_manner
def study(
    context: typer.Context,
    manner: Manner,
    name: Annotated[str | None, typer.Argument(metavar="NAME", help="The study; --list tells all.")] = None,
    output: Annotated[
        Path, typer.Option("-o", "--output", parser=directory, metavar="DIR", help="Where its results go.")
    ] = Path("out/studies"),
    show_list: Annotated[bool, typer.Option("--list", help="Only tell all studies and how long they take.")] = False,
    small: Annotated[bool, typer.Option("--small", help="Its smallest form: seconds, no figure to rely on.")] = False,
    document: Annotated[bool, typer.Option("--document", help="Fill the tables of a checkout's documents.")] = False,
    check: Annotated[bool, typer.Option("--check", help="Tell which documents are stale.")] = False,
) -> int:
    """Run a study that figures of the documentation come from, in a checkout; NAME --help tells its options.

    Writes NAME.json, NAME.md and pictures. Exit code 1 if a claim that the study checks does not hold.
    """
    from synth.cli.study import Wanted, study_command

    wanted = Wanted(output, show_list, small, document, check, manner)
    return study_command(name, context.args, wanted, context.get_help)
