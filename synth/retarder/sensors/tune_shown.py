"""What is shown of a tune for point sensors: a row for each case, the passages that went wrong, the doubts, and all
charts: what is drawn, and what is said under it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Final

from synth.frame.exhibits import Chapter, Chart, Column, Exhibit, Row, Sentence, Table
from synth.frame.printed_numbers import per_cent
from synth.problem.problem import OVERSPEED_M_S
from synth.retarder.acceptance import FoundBook
from synth.retarder.configuration.resolved_position import ResolvedSensors
from synth.retarder.exit_figures import CASE, DETAILS, EFFORT, TOLD, told
from synth.retarder.sensors.sensor_case import SensorCase
from synth.retarder.shown.cases import (
    ESCAPED,
    KEYS,
    POLISH,
    PROMISE,
    UNAVOIDABLE,
    VERDICT,
    case_row,
    cases_table,
    design_row,
    doubts,
    identity_row,
    passes_told,
    tiles,
    to_do,
)
from synth.retarder.shown_case import NARROW_M_S, WIDE_M_S, prediction_origin
from synth.retarder.tuned_case import by_class, file_stem

if TYPE_CHECKING:
    from matplotlib.figure import Figure

CASES: Final = (*CASE, VERDICT, *TOLD, UNAVOIDABLE, *EFFORT, *DETAILS, *KEYS, *PROMISE)
HOW_TO_READ: Final = (
    "Unavoidable: rms of what cuts leave too fast by under the harder braking of the table and of a regulator that "
    "goes to the highest stage at every passage, and too slow by if never braked; where that alone is above the limit, "
    "the case is infeasible and outside the verdict."
)
PASSAGES: Final = (
    *CASE,
    Column("sensor", "sensor"),
    Column("axle", "axle"),
    Column("path_m", "path", "m"),
    Column("unfinished", "change unfinished", form=per_cent),
    Column("mistaken", "pulses mistaken", form=per_cent),
)
HEARD: Final = (
    "Passages at which is decided. A change of stage that a cut finds unfinished there leaves nothing to decide. "
    "Mistaken: its pulses are taken for no passage, or for another. Shares are of the cuts that come there. Axles and "
    "sensors are counted from 0, as in files."
)
DECIDES: Final[Mapping[str, str]] = {"first_axle": "its first axle passes", "every_axle": "each of its axles passes"}
DESIGNS: Final = (
    *CASE,
    *POLISH,
    ESCAPED,
)


def results(found: FoundBook[SensorCase]) -> Iterator[Exhibit]:
    """The table of cases, and what is to be known of it."""
    yield tiles(found)
    yield from cases_table(found, CASES, case_row)
    criterion = {"criterion": found.book.config.criterion.sentence}
    yield Sentence(f"{passes_told(found.book.cases)} {HOW_TO_READ}", criterion, brief=True)
    yield from to_do(found)
    if found.no_st:
        yield Sentence(f"No Structured Text is written: {found.no_st}.", brief=True)


def heard(sensors: ResolvedSensors, cases: Sequence[SensorCase]) -> Iterator[Exhibit]:
    """Where the sensors stand, whose passages decide, and what came of each."""
    places_m = sensors.sensors.path_m
    yield Sentence(
        f"{len(places_m)} sensors {sensors.type} stand at {', '.join(f'{place:g}' for place in places_m)} m from the "
        f"entrance. The regulator decides on a cut when {DECIDES[sensors.decides_on]} one, if the change of stage "
        "before has ended."
    )
    yield Sentence(HEARD)
    yield Table("passages", "Passages", PASSAGES, [row for case in cases for row in passage_rows(case)])


def passage_rows(case: SensorCase) -> Iterator[Row]:
    """The passages of one case."""
    heard = case.heard
    shares = zip(heard.unfinished, heard.taken, heard.mistaken, heard.heard, strict=True)
    for row, (unfinished, taken, mistaken, came) in zip(case.table.passages, shares, strict=True):
        yield {
            **identity_row(case),
            "sensor": row.sensor,
            "axle": row.axle,
            "path_m": row.path_m,
            "unfinished": told(*unfinished, taken),
            "mistaken": told(*mistaken, came),
        }


def designs(cases: Sequence[SensorCase]) -> Iterator[Exhibit]:
    """How the searches for the switching speeds ended, and all doubts."""
    yield Table("designs", "How the tables were found", DESIGNS, [design_row(case) for case in cases])
    yield from doubts(cases)


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
    from synth.retarder.sensors.table_pictures import switching_speeds

    return switching_speeds(cases[0].cut_name, [case.table for case in cases], [case.traces for case in cases])


def sample_passes(case: SensorCase) -> Figure:
    """See `switching_speeds`."""
    from synth.retarder.sensors.table_pictures import passes_with_readings

    return passes_with_readings(case)


def exit_density(cases: Sequence[SensorCase]) -> Figure:
    """See `switching_speeds`."""
    from synth.retarder.pictures.exits import exit_density

    return exit_density(cases)
