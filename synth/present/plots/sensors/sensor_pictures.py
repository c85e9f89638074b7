"""All pictures of a tune for point sensors: what is drawn, and what is said under it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from synth.book.case_names import file_stem
from synth.book.sensors.sensor_case import SensorCase
from synth.frame.picture.picture import Picture
from synth.present.plots.exit_density import NARROW_M_S, WIDE_M_S, DrawnExits, density_figure
from synth.present.plots.picture_book import picture
from synth.present.plots.sensors.passes_with_readings import passes_with_readings
from synth.present.plots.sensors.switching_speeds import switching_speeds
from synth.simulation.exit_statistics import OVERSPEED_M_S

ORIGIN = "predicted by the forward equation"


def sensor_pictures(cases: Sequence[SensorCase]) -> Iterator[Picture]:
    """Every picture in the order of the report; each is drawn when it is asked for."""
    labels = list(dict.fromkeys(case.label for case in cases))
    for label in labels:
        yield from class_pictures([case for case in cases if case.label == label])


def class_pictures(cases: Sequence[SensorCase]) -> Iterator[Picture]:
    """The pictures of one cut class over its targets; sample passes for the middle target only."""
    label, middle, subject = cases[0].label, cases[len(cases) // 2], cases[0].cut_name
    yield picture(
        switching_speeds(subject, [case.table for case in cases], [case.traces for case in cases]),
        file_stem("switching-speeds", label),
        "Switching speeds",
        f"Stage wanted at each passage, {label}",
        f"{label}: at each passage a column over the speed that is read. Its colour and number tell the stage that the "
        "table wants there while the stage of the panel is in force.",
    )
    yield picture(
        density_figure(subject, [drawn_exits(case) for case in cases], ORIGIN),
        file_stem("exit-density", label),
        "Predicted and simulated exit speed",
        f"Exit speed of {label}",
        f"{label}: density of the exported table ({ORIGIN}), over the simulated passes in bins of {NARROW_M_S:g} m/s, "
        f"beyond ±{OVERSPEED_M_S:g} m/s of {WIDE_M_S:g} m/s; above near the target, below on a logarithmic scale.",
    )
    yield picture(
        passes_with_readings(middle),
        file_stem("sample-passes", middle.name),
        "Sample passes",
        f"Sample passes, {middle.name}",
        f"{middle.name}: passes with low, nominal and high friction, and what the regulator read.",
    )


def drawn_exits(case: SensorCase) -> DrawnExits:
    """What the density picture shows of a case."""
    return DrawnExits(
        case.target_speed_m_s,
        case.exit_speeds_m_s,
        case.exit_weight,
        case.predicted,
        case.table.predicted.rms_m_s,
        case.statistics,
    )
