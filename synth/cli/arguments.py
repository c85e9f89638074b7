"""What the command line makes of a word: a value, or one sentence that tells what is allowed."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

SourceOrDirectory = Annotated[
    Path, typer.Argument(metavar="TABLE|BOOK|DIR", help="A table (.json), a book (.h5), or what a tune left.")
]
ExportSource = Annotated[
    Path, typer.Argument(metavar="TABLE|BOOK|DIR", help="A table (.json), a book (.h5), or a folder of tables.")
]
