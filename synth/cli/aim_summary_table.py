"""The end of an aim in words and figures, on stdout."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from synth.frame.printed_numbers import ABSENT, percent
from synth.frame.terminal.printed_page import Verdict, print_page
from synth.frame.terminal.printed_table import Column, PrintedTable
from synth.frame.terminal.printed_words import NO_BREAK
from synth.yard.aim.aim_acceptance import AimBookVerdict
from synth.yard.aim.aim_book import AimBook

SHOWN = 4
"""Free distances of a printed row."""


class AimRow(NamedTuple):
    """Cuts of one length under one table; gaps in m by free distance, worst over-speed of the table with its ends."""

    cuts: str
    cars: int
    gap_m: Sequence[float]
    worst: Sequence[float]


def print_aims(book: AimBook, verdict: AimBookVerdict, directory: Path) -> None:
    """Gaps of the shortest and the longest cuts at some distances, the verdict, and where the files are."""
    distances = book.config.aim.free_distances_m
    some = sorted({round(k * (len(distances) - 1) / (SHOWN - 1)) for k in range(SHOWN)})
    columns = (
        Column[AimRow]("cuts", lambda row: row.cuts, words=True, once=True),
        Column[AimRow]("cars", lambda row: str(row.cars)),
        *(gap_column(place, distances[place], last=place == some[-1]) for place in some),
        Column[AimRow]("worst cell, over-speed, %", worst, once=True),
    )
    table = PrintedTable(columns, tuple(rows(book, verdict)), "summary.json", "mean gap of a cut by free distance")
    output = book.config.output
    files = f"{directory}: tables/, c/, st/{', plots/' * output.plots}, summary.json{', report.html' * output.report}"
    print_page(table, Verdict(verdict.accepted, verdict.sentence), files)


def rows(book: AimBook, verdict: AimBookVerdict) -> Iterator[AimRow]:
    """Of every table the shortest and the longest cuts."""
    for made, judged in zip(book.tables, verdict.tables, strict=True):
        for i in sorted({0, len(book.config.cars) - 1}):
            gaps = made.speeds.of_all.gap_m[i]
            yield AimRow(f"{made.category.name} by {made.knowledge}", book.config.cars[i], gaps, judged.worst)


def gap_column(place: int, distance_m: float, last: bool) -> Column[AimRow]:
    """The mean gap at one free distance; those between go before the last on a narrow terminal."""

    def cell(row: AimRow) -> str | None:
        return None if math.isnan(row.gap_m[place]) else f"{row.gap_m[place]:.1f}"

    return Column(f"gap, m, at {distance_m:g}{NO_BREAK}m", cell, spare=1 if last else 2)


def worst(row: AimRow) -> str:
    """The greatest probability of over-speed with its 95 % interval."""
    p, low, high = (ABSENT if math.isnan(each) else percent(each) for each in row.worst)
    return f"{p} [{low}, {high}]"
