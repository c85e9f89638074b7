"""What every command line makes of a word: a value, or one sentence that tells what is allowed."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Annotated

import typer

Json = Annotated[bool, typer.Option("--json", help="Machine-readable results on stdout.")]


def directory(word: str) -> Path:
    """The directory called `word`; no word at all, as from an unset variable of a shell, is none."""
    if not str(word):
        raise typer.BadParameter("it is empty; give a directory, '.' for the current one")
    return Path(word)


def whole_number(low: int, high: int) -> Callable[[str], int]:
    """The function that reads a whole number from `low` to `high`."""

    def number(word: str) -> int:
        try:
            value = int(word)
        except ValueError:
            value = low - 1
        if not low <= value <= high:
            raise typer.BadParameter(f"it is {str(word)[:40]!r}; give a whole number from {low} to {high}")
        return value

    return number
