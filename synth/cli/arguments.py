"""What the command line makes of a word: a value, or one sentence that tells what is allowed."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated

import typer

from synth.frame.arguments import whole_number

LARGEST_STD_KPA = 100.0
"""What a pressure gauge takes."""

Source = Annotated[Path, typer.Argument(metavar="TABLE|BOOK", help="A table (.json) or a book (.h5).")]
SourceOrDirectory = Annotated[
    Path, typer.Argument(metavar="TABLE|BOOK|DIR", help="A table (.json), a book (.h5), or what a tune left.")
]
ExportSource = Annotated[
    Path, typer.Argument(metavar="TABLE|BOOK|DIR", help="A table (.json), a book (.h5), or a folder of aim tables.")
]
Config = Annotated[
    Path | None, typer.Option("--config", metavar="C", help="Configuration with the plant; built-in unless given.")
]


LogFile = Annotated[
    Path | None, typer.Option("--log", metavar="FILE.csv|.h5", help="Also log passes as a controller would.")
]


def pressure_std(word: str) -> float:
    """Standard deviation in kPa; NaN for the word `none`: there is no gauge, and readings are NaN."""
    if word == "none":
        return math.nan
    try:
        value = float(word)
    except ValueError:
        value = math.nan
    if not 0.0 <= value <= LARGEST_STD_KPA:
        raise typer.BadParameter(f"it is {str(word)[:40]!r}; give 0 to {LARGEST_STD_KPA:g} kPa, or none")
    return value


LogPasses = Annotated[
    int | None,
    typer.Option(
        "--log-passes", parser=whole_number(1, 100_000), metavar="N", help="Logged of each table; 200 unless given."
    ),
]
GaugeStd = Annotated[
    float | None,
    typer.Option(
        "--gauge-std", parser=pressure_std, metavar="KPA|none", help="Noise of the logged pressure; 2 unless given."
    ),
]

NAME_OPTIONS = (
    "--retarder", "--position", "--car", "--sensor", "--wheel-sensor", "--sensors", "--weight-categories", "--aim",
    "--hump", "--computer",
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
