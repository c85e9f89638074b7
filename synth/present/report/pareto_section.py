"""Accuracy against time in the position: every price of every case, with its intervals."""

from __future__ import annotations

from collections.abc import Sequence

from synth.book.pareto.pareto_front import ParetoFront, ParetoPoint, told
from synth.frame.page.markup import Cell, Markup, element, head_row, joined, table
from synth.frame.printed_numbers import interval, quotient, quotient_interval, speed

HEAD = ("case", "price, m²/s³", "rms, m/s", "rms / rms without price", "predicted rms, m/s", "time, s", "switchings")

LEAD = (
    "Each row is a table of its own, tuned for this price of a second and simulated on the same passes. The ratio is "
    "paired; brackets: 95 %."
)


def pareto_section(fronts: Sequence[ParetoFront]) -> Markup:
    """What is nearly free, and the table."""
    rows = [(row_of(front, point), "") for front in fronts for point in front.points]
    figures = table("Accuracy against time", (head_row(*HEAD),), rows, kind="cases")
    return joined((element("p", told(fronts)), element("p", LEAD), figures))


def row_of(front: ParetoFront, point: ParetoPoint) -> list[str | Cell]:
    """The cells of one price."""
    found = point.statistics
    return [
        front.name,
        f"{point.time_price_m2_s3:g}",
        f"{speed(found.rms_m_s)} {interval(found.rms_ci95_m_s)}",
        f"{quotient(point.ratio, 3)} {quotient_interval(point.ratio_ci95, 3)}",
        speed(point.predicted_rms_m_s),
        f"{found.time_s:.2f} {quotient_interval(found.time_ci95_s)}",
        f"{found.switchings:.1f}",
    ]
