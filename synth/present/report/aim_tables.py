"""The tables of an aim on its report: exit speeds by category, and gaps and over-speeds of every kind of knowledge."""

from __future__ import annotations

import math
from collections.abc import Iterator

from synth.frame.page.markup import Cell, Markup, element, head_row, joined, table
from synth.frame.printed_numbers import counted, percent
from synth.yard.aim.aim_book import AimBook, MadeAim

KNOWN = {"category": "category alone", "measured": "resistance measured"}
"""What the page calls a kind of knowledge."""

COLUMNS = (
    "cars", "free distance, m", "exit speed, m/s", "mean gap of a cut, m [95 %]", "over-speed, % [95 %]",
    "without an exit speed, % of cuts",
)  # fmt: skip


def aim_tables(book: AimBook) -> Markup:
    """A heading and a table for each aim table."""
    parts: list[Markup] = []
    for made in book.tables:
        parts += [element("h3", heading(made)), table(made.table.id, (head_row(*COLUMNS),), rows(made), kind="cases")]
    return joined(parts)


def heading(made: MadeAim) -> str:
    """What the table is of."""
    order = made.speeds.order
    return (
        f"Category {made.category.name}, {KNOWN[made.knowledge]}: chosen on {order.design_cuts} cuts of each number of "
        f"cars, judged on {order.report_cuts} others"
    )


def rows(made: MadeAim) -> Iterator[tuple[list[str | Cell], str]]:
    """A row for each number of cars and distance; those without exit speed are marked."""
    speeds, figures = made.speeds, made.speeds.of_all
    for i, cars in enumerate(speeds.order.cars):
        for j, distance in enumerate(speeds.order.free_distances_m):
            gap = figures.gap_m[i, j], figures.gap_low95_m[i, j], figures.gap_high95_m[i, j]
            cells: list[str | Cell] = [
                counted(cars, "car"),
                f"{distance:g}",
                span_of(made, i, j),
                f"{gap[0]:.1f} [{gap[1]:.1f}, {gap[2]:.1f}]",
                share(figures.overspeed[i, j], figures.overspeed_low95[i, j], figures.overspeed_high95[i, j]),
                percent(figures.without[i, j]),
            ]
            yield cells, "infeasible" if figures.without[i, j] == 1.0 else ""


def span_of(made: MadeAim, i: int, j: int) -> str:
    """The exit speed, or from the lowest to the highest over the readings."""
    found = made.speeds.speed_m_s[i, j]
    known = [float(v) for v in found.flat if math.isfinite(v)]
    if not known:
        return "none"
    low, high = min(known), max(known)
    return f"{low:.3f}" if made.speeds.readings is None else f"{low:.2f} to {high:.2f}"


def share(p: float, low: float, high: float) -> str:
    """A probability in per cent, with its interval."""
    return f"{percent(p)} [{percent(low)}, {percent(high)}]"
