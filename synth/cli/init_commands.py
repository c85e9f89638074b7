"""The command `init`, its options and their help; what it does is in `synth.cli.init`.

Annotations are not postponed here: typer would compile every one of them anew at each start.
"""

from pathlib import Path
from textwrap import fill
from typing import Annotated

import typer

from synth.cli.file_kinds import FILE_KINDS
from synth.frame.arguments import in_its_manner, whole_number
from synth.frame.terminal.manner import Manner


def kinds_beginning(incomplete: str) -> list[tuple[str, str]]:
    """The words of kinds that begin so, for completion."""
    return [(kind.word, kind.title) for kind in FILE_KINDS if kind.word.startswith(incomplete)]


def names_beginning(context: typer.Context, incomplete: str) -> list[str]:
    """The names of the library of the kind that is typed, for completion."""
    word = context.params.get("kind")
    return [name for kind in FILE_KINDS if kind.word == word for name in kind.names if name.startswith(incomplete)]


def add_init_command(app: typer.Typer) -> None:
    """Add the command to `app`."""
    app.command(help=f"{init.__doc__}\n\n\b\nKIND is one of\n{kinds_in_lines()}")(in_its_manner(init))


def kinds_in_lines() -> str:
    """The words of kinds, whole words in lines for the narrowest terminal."""
    words = ", ".join(kind.word for kind in FILE_KINDS)
    return fill(words, 54, initial_indent="  ", subsequent_indent="  ", break_on_hyphens=False)


def init(
    kind: Annotated[
        str | None,
        typer.Argument(
            metavar="KIND",
            autocompletion=kinds_beginning,
            help=f"Of file, as above; {FILE_KINDS[0].word} unless given.",
        ),
    ] = None,
    name: Annotated[
        str | None,
        typer.Argument(
            metavar="NAME",
            autocompletion=names_beginning,
            help="Of the library, as --list tells; a usual one unless given. Of configurations, a position.",
        ),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o", "--output", metavar="FILE", help="A new file, with its schema beside it; printed unless given."
        ),
    ] = None,
    schema: Annotated[
        bool, typer.Option("--schema", help="The JSON Schema of such a file instead, for editors.")
    ] = False,
    show_list: Annotated[bool, typer.Option("--list", help="Only list all kinds, and what the library holds.")] = False,
    for_trial: Annotated[
        Path | None,
        typer.Option(
            "--for",
            metavar="TRIAL.toml|HUMP",
            help="Configuration of the tables that a position needs in this hump trial.",
        ),
    ] = None,
    position_number: Annotated[
        int | None,
        typer.Option(
            parser=whole_number(1, 10),
            metavar="N",
            help="With --for: which position, 1 being the first behind the crest.",
        ),
    ] = None,
    *,
    manner: Manner,
) -> int:
    """Print or write a commented file to start from, or its schema."""
    from synth.cli.init import AskedFile, init_command, print_list, tables_command

    if show_list:
        return print_list(manner)
    asked = AskedFile(kind or "", name or "", schema, output)
    if for_trial is not None or position_number is not None:
        return tables_command(for_trial, position_number, asked, manner)
    return init_command(asked, manner)
