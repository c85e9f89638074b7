"""What is shown of a tune for point sensors: a row for each case, the passages that went wrong, and the doubts."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Final

from synth.frame.exhibits import Column, Exhibit, Row, Sentence, Table
from synth.frame.printed_numbers import per_cent
from synth.retarder.configuration.point_sensors.resolved_sensors import ResolvedSensors
from synth.retarder.exit_figures import CASE, DETAILS, EFFORT, TOLD, told
from synth.retarder.found_book import FoundBook
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
)
from synth.retarder.shown.first_screen import tiles, to_do

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
