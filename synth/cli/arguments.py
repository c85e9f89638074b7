"""What the command line makes of a word: a value, or one sentence that tells what is allowed."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from synth.frame.arguments import directory

SourceOrDirectory = Annotated[
    Path, typer.Argument(metavar="TABLE|BOOK|DIR", help="A table (.json), a book (.h5), or what a tune left.")
]
ExportSource = Annotated[
    Path, typer.Argument(metavar="TABLE|BOOK|DIR", help="A table (.json), a book (.h5), or a folder of tables.")
]
Config = Annotated[
    Path | None, typer.Option("--config", metavar="C", help="Configuration with the plant; built-in unless given.")
]
PageFolder = Annotated[
    Path | None,
    typer.Option("-o", "--output", parser=directory, metavar="DIR", help="Also write a page there, report.html."),
]


NAME_OPTIONS = (
    "--retarder", "--position", "--car", "--sensor", "--wheel-sensor", "--sensors", "--weight-categories", "--aim",
    "--hump", "--short-hump", "--computer", "--sweep",
)  # fmt: skip
"""Options of init whose value may be left out."""


def with_names(arguments: list[str]) -> list[str]:
    """`arguments` with an empty value after each of init's options that has none, for a parser that wants one."""
    if arguments[:1] != ["init"]:
        return arguments
    given: list[str] = []
    for place, word in enumerate(arguments):
        given.append(word)
        if word in NAME_OPTIONS and (arguments[place + 1 : place + 2] or ["-"])[0].startswith("-"):
            given.append("")
    return given
