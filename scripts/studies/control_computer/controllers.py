"""Which of today's controllers carries how many positions, from counted instructions of our exported code."""

from __future__ import annotations

import math
from dataclasses import dataclass

from scripts.studies.markdown_table import ABSENT, MarkdownTable, table
from synth.computer.sizing.carried_positions import PositionTimes, carried, most_positions
from synth.computer.sizing.trackside_controllers import TracksideController, usual_controllers

POSITIONS = (1, 3, 10, 38, 100, 1000)
"""3 on a route, 38 on the large hump with its park positions."""


@dataclass(frozen=True)
class CarriedRow:
    """So many positions on one controller: the longest times to an answer and to a table; None: not all is done."""

    controller: str
    positions: int
    answer_s: float | None
    answer_margin_s: float | None
    table_s: float | None
    used_share: float
    in_time: bool


@dataclass(frozen=True)
class Limit:
    """What a controller is, where its figures come from, and the most positions that are always in time."""

    controller: str
    sample_us: float
    cut_us: float
    most: int
    counted: str
    source: str


@dataclass(frozen=True)
class Controllers:
    """All of them; deadlines in s."""

    answer_deadline_s: float
    table_deadline_s: float
    rows: tuple[CarriedRow, ...]
    limits: tuple[Limit, ...]

    def tables(self) -> dict[str, MarkdownTable]:
        """`controllers`, `controller-limits`."""
        return {
            "controllers": table(
                f"positions on a controller: answers within {1e3 * self.answer_deadline_s:g} ms, tables within "
                f"{1e3 * self.table_deadline_s:g} ms",
                ("controller", "positions", "longest answer, ms", "margin, ms", "longest table, ms", "used, %",
                 "in time"),
                ((r.controller, str(r.positions), ms(r.answer_s), ms(r.answer_margin_s), ms(r.table_s),
                  f"{100 * r.used_share:.3g}", "yes" if r.in_time else "**no**") for r in self.rows),
            ),
            "controller-limits": table(
                "most positions that are always in time",
                ("controller", "a sample, µs", "a cut, µs", "most positions", "counts", "speed"),
                ((m.controller, f"{m.sample_us:.3g}", f"{m.cut_us:.3g}", str(m.most), m.counted, m.source)
                 for m in self.limits),
            ),
        }  # fmt: skip

    def faults(self) -> tuple[str, ...]:
        """The most positions must be in time in the rows, and more must not."""
        most = {limit.controller: limit.most for limit in self.limits}
        return tuple(
            f"{row.controller} with {row.positions} positions: the row and the most positions, {most[row.controller]}, "
            "contradict each other"
            for row in self.rows
            if row.in_time != (row.positions <= most[row.controller])
        )


def ms(value_s: float | None) -> str:
    """In milliseconds."""
    return ABSENT if value_s is None else f"{1e3 * value_s:.3g}"


def controllers() -> Controllers:
    """All of them."""
    times, usual = PositionTimes(), usual_controllers()
    rows = tuple(carried_row(each, times, count) for each in usual for count in POSITIONS)
    limits = tuple(
        Limit(each.name, 1e6 * each.sample_s, 1e6 * each.cut_s, most_positions(each, times), each.costs.source,
              each.source)
        for each in usual
    )  # fmt: skip
    return Controllers(times.answer_s, times.table_s, rows, limits)


def carried_row(controller: TracksideController, times: PositionTimes, positions: int) -> CarriedRow:
    """One of them."""
    found = carried(controller, times, positions)
    return CarriedRow(
        controller.name, positions, finite(found.answer_s), finite(found.answer_margin_s), finite(found.table_s),
        found.used_share, found.in_time,
    )  # fmt: skip


def finite(value: float) -> float | None:
    """None for what never ends."""
    return value if math.isfinite(value) else None
