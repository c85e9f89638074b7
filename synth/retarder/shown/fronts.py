"""Accuracy against time in the position: every price of every case."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from synth.frame.exhibits import Column, Exhibit, Row, Sentence, Table
from synth.frame.printed_numbers import decimals
from synth.retarder.exit_figures import CASE, LOOP, PREDICTED, loop_row, told
from synth.retarder.pareto.pareto_front import ParetoFront, ParetoPoint
from synth.retarder.shown.pictures import fronts_chart

FRONTS: Final = (
    *CASE,
    Column("time_price_m2_s3", "price", "m²/s³"),
    Column("ratio", "rms / rms without price", form=decimals(3)),
    PREDICTED,
    *LOOP,
)
LEAD: Final = (
    "Each row is a table of its own, tuned for this price of a second and simulated on the same passes. The ratio is "
    "paired."
)


def fronts(found: Sequence[ParetoFront]) -> Iterator[Exhibit]:
    """A row for each price, and a picture."""
    yield Sentence(LEAD)
    yield Table(
        "fronts", "Accuracy against time", FRONTS, [row_of(each, point) for each in found for point in each.points]
    )
    yield fronts_chart(found)


def row_of(front: ParetoFront, point: ParetoPoint) -> Row:
    """One price."""
    return {
        "label": front.label,
        "target_speed_m_s": front.target_speed_m_s,
        "time_price_m2_s3": point.time_price_m2_s3,
        "ratio": told(point.ratio, point.ratio_ci95, point.statistics.passes),
        "predicted_rms_m_s": point.predicted_rms_m_s,
        **loop_row(point.statistics),
    }
