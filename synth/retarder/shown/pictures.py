"""All charts of a book: what is drawn, and what is said under it.

What draws one is imported where it is called, in a process of its own where there are several: it needs matplotlib.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING

from synth.frame.exhibits import Chapter, Chart
from synth.retarder.case_names import by_class, case_name, file_stem
from synth.retarder.case_result import CaseResult
from synth.retarder.exit_bins import NARROW_M_S, WIDE_M_S, prediction_origin
from synth.retarder.pareto.pareto_front import ParetoFront
from synth.simulation.exit_statistics import OVERSPEED_M_S

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def chapters(cases: Sequence[CaseResult]) -> Iterator[Chapter]:
    """The pictures of classes and cases; surfaces and sample passes for the middle target of a class only."""
    classes = by_class(cases)
    middles = [group[len(group) // 2] for group in classes]
    yield Chapter("Predicted and simulated exit speed", tuple(exits_chart(group) for group in classes))
    yield Chapter("Switching surfaces", tuple(surfaces_chart(case) for case in middles))
    yield Chapter("Sample passes", tuple(passes_chart(case) for case in middles))
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


def exits_chart(cases: Sequence[CaseResult]) -> Chart:
    """The exits of one class over its targets."""
    label = cases[0].label
    return Chart(
        file_stem("exit-density", label),
        f"Exit speed of {label}",
        f"{label}: density of the exported table ({prediction_origin(cases)}), over the simulated passes in bins of "
        f"{NARROW_M_S:g} m/s, beyond ±{OVERSPEED_M_S:g} m/s of {WIDE_M_S:g} m/s; above near the target, below on a "
        "logarithmic scale with the tails. The step of the grid widens the predicted peak, most at low targets. "
        "Hatched: the prediction is smaller than the error of its grid there, and is not drawn.",
        partial(exit_density, tuple(cases)),
    )


def surfaces_chart(case: CaseResult) -> Chart:
    """The lines of one case over path and pressure."""
    name = case_name(case)
    return Chart(
        file_stem("surfaces", name),
        f"Switching surfaces of {name}",
        f"{name}: the exported lines (bold) over path and pressure, joined linearly between the stages.",
        partial(surfaces, case),
    )


def passes_chart(case: CaseResult) -> Chart:
    """A few passes of one case."""
    name = case_name(case)
    return Chart(
        file_stem("sample-passes", name),
        f"Sample passes, {name}",
        f"{name}: passes with low, nominal and high friction under the exported table.",
        partial(sample_passes, case),
    )


def lines_chart(case: CaseResult) -> Chart:
    """The command by stage of one case."""
    name = case_name(case)
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


def exit_density(cases: Sequence[CaseResult]) -> Figure:
    """See `rms_by_controller`."""
    from synth.retarder.pictures.exit_density import exit_density

    return exit_density(cases)


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
