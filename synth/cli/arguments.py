"""What the command line makes of a word: a value, or one sentence that tells what is allowed."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from synth.frame.arguments import directory

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
