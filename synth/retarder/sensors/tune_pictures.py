"""All charts of a tune for point sensors: what is drawn, and what is said under it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING

from synth.frame.exhibits import Chapter, Chart
from synth.retarder.case_names import by_class, file_stem
from synth.retarder.sensors.sensor_case import SensorCase
from synth.retarder.shown.case_charts import exits_chart, passes_chart

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def chapters(cases: Sequence[SensorCase]) -> Iterator[Chapter]:
    """The pictures of each class over its targets; sample passes for the middle target only."""
    classes = by_class(cases)
    middles = [group[len(group) // 2] for group in classes]
    seen = ", and what the regulator read"
    yield Chapter("Switching speeds", tuple(speeds_chart(group) for group in classes))
    yield Chapter("Predicted and simulated exit speed", tuple(exits_chart(group) for group in classes))
    yield Chapter("Sample passes", tuple(passes_chart(case, seen, sample_passes) for case in middles))


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


def switching_speeds(cases: Sequence[SensorCase]) -> Figure:
    """Drawn by modules that need matplotlib, as all of these."""
    from synth.retarder.sensors.pictures.switching_speeds import switching_speeds

    return switching_speeds(cases[0].cut_name, [case.table for case in cases], [case.traces for case in cases])


def sample_passes(case: SensorCase) -> Figure:
    """See `switching_speeds`."""
    from synth.retarder.sensors.pictures.passes_with_readings import passes_with_readings

    return passes_with_readings(case)
