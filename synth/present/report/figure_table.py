"""The figures of many humped trains as a table: value, interval, and of how many."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from synth.frame.page.markup import Cell, Markup, head_row, table
from synth.frame.printed_numbers import ABSENT
from synth.yard.humping.train_figures import TrainFigure

TITLES = {
    "hump_speed": "Mean hump speed",
    "cars_per_hour": "Cars an hour",
    "catch_ups": "Catch-ups",
    "misrouted": "Misrouted",
    "contacts": "In contact",
    "contacts_in_last_position": "In contact in the last position alone",
    "caught_on_track": "Caught up on the track",
    "stopped_on_the_way": "Stopped on the way",
    "unseparated_elements_per_cut": "Elements where a cut was not separated",
    "overspeed": "Over-speed",
    "overspeed_to_1_5": "Over-speed up to 1.5 m/s",
    "overspeed_to_2": "Over-speed above 1.5, up to 2 m/s",
    "overspeed_above_2": "Over-speed above 2 m/s",
    "gap_per_cut": "Gap a cut",
    "strokes_per_pass": "Commands to valves a pass",
}
"""What a figure is called; others go by their names."""

HEAD = ("figure", "value", "95 % interval", "unit", "n", "of", "n for the interval wanted")


def figure_table(figures: Sequence[TrainFigure]) -> Markup:
    """A row for each figure; shares in per cent."""
    return table("Figures", (head_row(*HEAD),), [(cells(figure), "") for figure in figures], kind="cases")


@dataclass(frozen=True)
class ShownFigure:
    """A figure in words: shares in per cent."""

    title: str
    value: str
    interval: str
    unit: str


def shown_figure(figure: TrainFigure) -> ShownFigure:
    """`figure` as it is shown."""
    scale, unit = (100.0, "%") if is_share(figure) else (1.0, "" if figure.unit == "1" else figure.unit)
    value, low, high = (printed(scale * number) for number in (figure.value, figure.low95, figure.high95))
    interval = ABSENT if ABSENT in (low, high) else f"[{low}, {high}]"
    return ShownFigure(TITLES.get(figure.name, figure.name.replace("_", " ")), value, interval, unit)


def is_share(figure: TrainFigure) -> bool:
    """A share is of cuts, a mean of trains."""
    return not math.isnan(figure.enough_n)


def cells(figure: TrainFigure) -> list[str | Cell]:
    """The row of a figure."""
    shown = shown_figure(figure)
    return [
        Cell(shown.title, note=figure.name),
        shown.value,
        shown.interval,
        shown.unit,
        str(figure.n),
        "cuts" if is_share(figure) else "trains",
        f"{math.ceil(figure.enough_n)}" if is_share(figure) and figure.enough_n > 0.0 else ABSENT,
    ]


def printed(number: float) -> str:
    """Three figures, all of them before the point."""
    if not math.isfinite(number):
        return ABSENT
    return f"{number:.0f}" if abs(number) >= 1000.0 else f"{number:.3g}"
