"""All charts of a tune for point sensors: what is drawn, and what is said under it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING

from synth.frame.exhibits import Chapter, Chart
from synth.problem.aim import OVERSPEED_M_S
from synth.retarder.case_names import by_class, file_stem
from synth.retarder.exit_bins import NARROW_M_S, WIDE_M_S, prediction_origin
from synth.retarder.sensors.sensor_case import SensorCase

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def chapters(cases: Sequence[SensorCase]) -> Iterator[Chapter]:
    """The pictures of each class over its targets; sample passes for the middle target only."""
    classes = by_class(cases)
    middles = [group[len(group) // 2] for group in classes]
    yield Chapter("Switching speeds", tuple(speeds_chart(group) for group in classes))
    yield Chapter("Predicted and simulated exit speed", tuple(exits_chart(group) for group in classes))
    yield Chapter("Sample passes", tuple(passes_chart(case) for case in middles))


def speeds_chart(cases: Sequence[SensorCase]) -> Chart:
    """The tables of one class."""
    label = cases[0].label
    return Chart(
        file_stem("switching-speeds", label),
        f"Stage wanted at each passage, {label}",
        f"{label}: at each passage a column over the speed that is read. Its colour and number tell the stage that the "
        "table wants there while the stage of the panel is in force.",
        partial(switching_speeds, tuple(cases)),
    )


def exits_chart(cases: Sequence[SensorCase]) -> Chart:
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


def passes_chart(case: SensorCase) -> Chart:
    """A few passes of one case."""
    return Chart(
        file_stem("sample-passes", case.name),
        f"Sample passes, {case.name}",
        f"{case.name}: passes with low, nominal and high friction, and what the regulator read.",
        partial(sample_passes, case),
    )


def switching_speeds(cases: Sequence[SensorCase]) -> Figure:
    """Drawn by modules that need matplotlib, as all of these."""
    from synth.retarder.sensors.pictures.switching_speeds import switching_speeds

    return switching_speeds(cases[0].cut_name, [case.table for case in cases], [case.traces for case in cases])


def sample_passes(case: SensorCase) -> Figure:
    """See `switching_speeds`."""
    from synth.retarder.sensors.pictures.passes_with_readings import passes_with_readings

    return passes_with_readings(case)


def exit_density(cases: Sequence[SensorCase]) -> Figure:
    """See `switching_speeds`."""
    from synth.retarder.pictures.exit_density import exit_density

    return exit_density(cases)
