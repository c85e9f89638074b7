"""All pictures of a book: what is drawn, and what is said under it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from matplotlib.figure import Figure

from synth.book.case_names import case_name, file_stem
from synth.book.case_result import CaseResult
from synth.frame.picture.figure_file import draw
from synth.frame.picture.picture import Picture
from synth.present.plots.exit_density import NARROW_M_S, WIDE_M_S, exit_density, prediction_origin
from synth.present.plots.feasibility import feasibility
from synth.present.plots.pareto_fronts import pareto_fronts
from synth.present.plots.policy_map import policy_map
from synth.present.plots.rms_by_controller import rms_by_controller
from synth.present.plots.sample_passes import sample_passes
from synth.present.plots.surfaces import surfaces
from synth.simulation.exit_statistics import OVERSPEED_M_S


def book_pictures(cases: Sequence[CaseResult], limit_m_s: float) -> Iterator[Picture]:
    """The pictures that set all cases side by side; `limit_m_s`: acceptance limit of the rms."""
    yield picture(
        rms_by_controller(cases, limit_m_s),
        "rms-by-controller",
        "Accuracy",
        "Exit-speed error by controller",
        "Simulated rms with its 95 % interval, the same passes for every controller. Hollow: the rms that is "
        "predicted of the table. Grey: infeasible, no controller keeps the limit.",
    )
    yield picture(
        feasibility(cases),
        "feasibility",
        "Accuracy",
        "Entry speeds that can be served",
        "Rms of the error that no controller avoids, over entry speed: what the position can do at all.",
    )
    fronts = [case.front for case in cases if case.front is not None]
    if fronts:
        yield picture(
            pareto_fronts(fronts),
            "pareto-fronts",
            "Accuracy against time",
            "Accuracy against time in the position",
            "Rms of the exit speed over the mean time in the position, tables for several prices of a second (m²/s³, "
            "at the marks), the same passes for all, bars: 95 %. Crosses: predicted rms.",
        )


def class_pictures(cases: Sequence[CaseResult]) -> Iterator[Picture]:
    """The pictures of one cut class over its targets; surfaces and sample passes for the middle target only."""
    label, middle = cases[0].label, cases[len(cases) // 2]
    yield picture(
        exit_density(cases),
        file_stem("exit-density", label),
        "Predicted and simulated exit speed",
        f"Exit speed of {label}",
        f"{label}: density of the exported table ({prediction_origin(cases)}), over the simulated passes in bins of "
        f"{NARROW_M_S:g} m/s, beyond ±{OVERSPEED_M_S:g} m/s of {WIDE_M_S:g} m/s; above near the target, below on a "
        "logarithmic scale with the tails. The step of the grid widens the predicted peak, most at low targets. "
        "Hatched: the prediction is smaller than the error of its grid there, and is not drawn.",
    )
    yield picture(
        surfaces(middle),
        file_stem("surfaces", case_name(middle)),
        "Switching surfaces",
        f"Switching surfaces of {case_name(middle)}",
        f"{case_name(middle)}: the exported lines (bold) over path and pressure, joined linearly between the stages.",
    )
    yield picture(
        sample_passes(middle),
        file_stem("sample-passes", case_name(middle)),
        "Sample passes",
        f"Sample passes, {case_name(middle)}",
        f"{case_name(middle)}: passes with low, nominal and high friction under the exported table.",
    )


def case_pictures(case: CaseResult) -> Iterator[Picture]:
    """The pictures of one case."""
    name = case_name(case)
    yield picture(
        policy_map(case),
        file_stem("policy-map", name),
        "Switching lines",
        f"Best command by stage, {name}",
        f"{name}: best command by stage, the region of indifferent control (hatched), the solver's switching lines "
        "(dots), the exported polynomial lines (bold), and simulated passes while they were in the stage.",
    )


def picture(figure: Figure, name: str, section: str, title: str, caption: str) -> Picture:
    """Draw `figure` as a picture."""
    return Picture(name, section, title, caption, draw(figure))
