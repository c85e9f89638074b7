"""All charts of a book of tables with lines: what is drawn, and what is said under it; and accuracy against time in the
position, every price of every case.

What draws a chart is imported where it is called, in a process of its own where there are several: it needs matplotlib.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, Final

from synth.frame.exhibits import Chart, Column, Exhibit, Row, Sentence, Table
from synth.frame.printed_numbers import decimals, of_ten_thousand, speed
from synth.problem.problem import OVERSPEED_M_S
from synth.retarder.case_result import ParetoFront, ParetoPoint
from synth.retarder.exit_figures import CASE, LOOP, PREDICTED, loop_row, told
from synth.retarder.shown_case import ShownCase, prediction_origin, shown_case
from synth.retarder.tuned_case import file_stem

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from synth.retarder.case_result import CaseResult

RUN: Final = (
    "Left: one run of mean friction. The colour and the number tell the stage in force; thin lines are the switching "
    "lines of that stage, where it is in force; grey: the retarders; the dot: where the cut leaves. Right: the speed "
    "axis enlarged around the target, with the simulated cuts and the density that is"
)
GRID: Final = "The step of the grid widens the peak of that density, most at low targets."
MORE: Final = (
    "Further pictures of every table are drawn by 'retarder-synth inspect DIR -o PICTURES': its switching lines in all "
    "stages, its switching surfaces, and passes of low and high friction."
)


def case_pictures(cases: Sequence[CaseResult]) -> Iterator[Exhibit]:
    """A picture of each case."""
    yield Sentence(f"{RUN} {prediction_origin(cases)}. {GRID}")
    yield from (case_chart(case) for case in cases)
    yield Sentence(MORE)


def accuracy_charts(cases: Sequence[CaseResult], limit_m_s: float) -> Iterator[Chart]:
    """All cases side by side; `limit_m_s`: acceptance limit of the rms."""
    yield Chart(
        "rms-by-controller",
        "Exit-speed error by controller",
        "Simulated rms with its 95 % interval, the same passes for every controller. Hollow: the rms that is "
        "predicted of the table. Grey: infeasible, no controller keeps the limit.",
        partial(rms_by_controller, tuple(cases), limit_m_s),
    )
    yield Chart(
        "feasibility",
        "Entry speeds that can be served",
        "Rms of the error that no controller avoids, over entry speed: what the position can do at all.",
        partial(feasibility, tuple(cases)),
    )


def fronts_chart(fronts: Sequence[ParetoFront]) -> Chart:
    """Accuracy over time."""
    return Chart(
        "pareto-fronts",
        "Accuracy against time in the position",
        "Rms of the exit speed over the mean time in the position, tables for several prices of a second (m²/s³, "
        "at the marks), the same passes for all, bars: 95 %. Crosses: predicted rms.",
        partial(pareto_fronts, tuple(fronts)),
    )


def case_chart(case: CaseResult) -> Chart:
    """One case: a run, and how all leave."""
    found = case.statistics
    low, high = (speed(each) for each in found.p95_ci95_m_s)
    return Chart(
        file_stem("case", case.name),
        case.name,
        f"95 of 100 cuts leave within ±{speed(found.p95_m_s)} [{low}, {high}] m/s of the target; "
        f"{of_ten_thousand(found.overspeed)} in 10\u00a0000 leave more than {OVERSPEED_M_S:g} m/s above it.",
        partial(case_picture, shown_case(case)),
    )


def rms_by_controller(cases: Sequence[CaseResult], limit_m_s: float) -> Figure:
    """Drawn by the module of that name, as all of these."""
    from synth.retarder.pictures.accuracy import rms_by_controller

    return rms_by_controller(cases, limit_m_s)


def feasibility(cases: Sequence[CaseResult]) -> Figure:
    """See `rms_by_controller`."""
    from synth.retarder.pictures.accuracy import feasibility

    return feasibility(cases)


def pareto_fronts(fronts: Sequence[ParetoFront]) -> Figure:
    """See `rms_by_controller`."""
    from synth.retarder.pictures.accuracy import pareto_fronts

    return pareto_fronts(fronts)


def case_picture(case: ShownCase) -> Figure:
    """See `rms_by_controller`."""
    from synth.retarder.pictures.exits import case_picture

    return case_picture(case)


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
