"""All charts of a book of tables with lines: what is drawn, and what is said under it.

What draws one is imported where it is called, in a process of its own where there are several: it needs matplotlib.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING

from synth.frame.exhibits import Chapter, Chart
from synth.retarder.case_names import by_class, file_stem
from synth.retarder.case_result import CaseResult
from synth.retarder.pareto.pareto_front import ParetoFront
from synth.retarder.shown.case_charts import exits_chart, passes_chart

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def chapters(cases: Sequence[CaseResult]) -> Iterator[Chapter]:
    """The pictures of classes and cases; surfaces and sample passes for the middle target of a class only."""
    classes = by_class(cases)
    middles = [group[len(group) // 2] for group in classes]
    seen = " under the exported table"
    yield Chapter("Predicted and simulated exit speed", tuple(exits_chart(group) for group in classes))
    yield Chapter("Switching surfaces", tuple(surfaces_chart(case) for case in middles))
    yield Chapter("Sample passes", tuple(passes_chart(case, seen, sample_passes) for case in middles))
    yield Chapter("Switching lines", tuple(lines_chart(case) for case in cases))


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


def surfaces_chart(case: CaseResult) -> Chart:
    """The lines of one case over path and pressure."""
    name = case.name
    return Chart(
        file_stem("surfaces", name),
        f"Switching surfaces of {name}",
        f"{name}: the exported lines (bold) over path and pressure, joined linearly between the stages.",
        partial(surfaces, case),
    )


def lines_chart(case: CaseResult) -> Chart:
    """The command by stage of one case."""
    name = case.name
    return Chart(
        file_stem("policy-map", name),
        f"Best command by stage, {name}",
        f"{name}: best command by stage, the region of indifferent control (hatched), the solver's switching lines "
        "(dots), the exported polynomial lines (bold), and simulated passes while they were in the stage.",
        partial(policy_map, case),
    )


def rms_by_controller(cases: Sequence[CaseResult], limit_m_s: float) -> Figure:
    """Drawn by the module of that name, as all of these."""
    from synth.retarder.pictures.rms_by_controller import rms_by_controller

    return rms_by_controller(cases, limit_m_s)


def feasibility(cases: Sequence[CaseResult]) -> Figure:
    """See `rms_by_controller`."""
    from synth.retarder.pictures.feasibility import feasibility

    return feasibility(cases)


def pareto_fronts(fronts: Sequence[ParetoFront]) -> Figure:
    """See `rms_by_controller`."""
    from synth.retarder.pictures.pareto_fronts import pareto_fronts

    return pareto_fronts(fronts)


def surfaces(case: CaseResult) -> Figure:
    """See `rms_by_controller`."""
    from synth.retarder.pictures.surfaces import surfaces

    return surfaces(case)


def sample_passes(case: CaseResult) -> Figure:
    """See `rms_by_controller`."""
    from synth.retarder.pictures.sample_passes import sample_passes

    return sample_passes(case)


def policy_map(case: CaseResult) -> Figure:
    """See `rms_by_controller`."""
    from synth.retarder.pictures.policy_map import policy_map

    return policy_map(case)
