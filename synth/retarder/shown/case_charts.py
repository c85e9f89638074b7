"""Charts of the cases of every tune: what is drawn, and what is said under it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING

from synth.frame.exhibits import Chart
from synth.retarder.case_names import file_stem
from synth.retarder.exit_bins import NARROW_M_S, WIDE_M_S, prediction_origin
from synth.retarder.tuned_case import Case, TunedCase
from synth.simulation.exit_statistics import OVERSPEED_M_S

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def exits_chart(cases: Sequence[TunedCase]) -> Chart:
    """The exits of one class over its targets."""
    label = cases[0].label
    return Chart(
        file_stem("exit-density", label),
        f"Exit speed of {label}",
        f"{label}: density of the exported table ({prediction_origin(cases)}), over the simulated passes in bins of "
        f"{NARROW_M_S:g} m/s, beyond ±{OVERSPEED_M_S:g} m/s of {WIDE_M_S:g} m/s; above near the target, below on a "
        "logarithmic scale with the tails. The step of the grid widens the predicted peak, most at low targets. "
        "No prediction below 0.0001 s/m is drawn.",
        partial(exit_density, tuple(cases)),
    )


def passes_chart(case: Case, seen: str, draw: Callable[[Case], Figure]) -> Chart:
    """A few passes of one case, as `draw` has them; `seen`: what else of them is seen."""
    return Chart(
        file_stem("sample-passes", case.name),
        f"Sample passes, {case.name}",
        f"{case.name}: passes with low, nominal and high friction{seen}.",
        partial(draw, case),
    )


def exit_density(cases: Sequence[TunedCase]) -> Figure:
    """Drawn by the module of that name, which needs matplotlib."""
    from synth.retarder.pictures.exit_density import exit_density

    return exit_density(cases)
