"""The end of an aim in words and figures, on stdout."""

from __future__ import annotations

import math
from pathlib import Path

from synth.book.printed_numbers import ABSENT, counted, percent
from synth.yard.aim_acceptance import AimBookVerdict
from synth.yard.aim_book import AimBook

SHOWN = 4
"""Free distances of a printed row."""


def print_aims(book: AimBook, verdict: AimBookVerdict, directory: Path) -> None:
    """Gaps of the shortest and the longest cuts at some distances, the verdict, and where the files are."""
    distances = book.config.aim.free_distances_m
    some = sorted({round(k * (len(distances) - 1) / (SHOWN - 1)) for k in range(SHOWN)})
    head = "".join(f"{f'{distances[j]:g} m':>10}" for j in some)
    print(f"{'mean gap of a cut, m, at a free distance of':<46}{head}   worst cell, over-speed % [95 %]")
    for made, judged in zip(book.tables, verdict.tables, strict=True):
        figures = made.speeds.of_all
        worst = [ABSENT if math.isnan(p) else percent(p) for p in judged.worst]
        for i in sorted({0, len(book.config.cars) - 1}):
            name = f"{made.category.name} by {made.knowledge}, {counted(book.config.cars[i], 'car')}"
            gaps = "".join(f"{figures.gap_m[i, j]:>10.1f}" for j in some)
            print(f"{name:<46}{gaps}" + (f"   {worst[0]} [{worst[1]}, {worst[2]}]" if i == 0 else ""))
    print(f"{'accepted' if verdict.accepted else 'not accepted'}: {verdict.sentence}")
    print(f"{directory}: tables/, c/, st/{', plots/' * book.config.output.plots}, summary.json", end="")
    print(", report.html" if book.config.output.report else "")
