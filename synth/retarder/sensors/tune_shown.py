"""What is shown of a tune for point sensors: a row for each case, the passages that went wrong, and the doubts."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Final

from synth.frame.exhibits import Column, Exhibit, Row, Sentence, Table
from synth.frame.printed_numbers import per_cent
from synth.retarder.acceptance import CaseVerdict, advice_of
from synth.retarder.exit_figures import (
    CASE,
    DETAILS,
    EFFORT,
    LEGEND,
    TOLD,
    table_row,
    told,
)
from synth.retarder.sensors.found_passages import FoundPassages
from synth.retarder.sensors.sensor_case import SensorCase
from synth.retarder.sensors.sensor_tune import SensorBook
from synth.retarder.shown.cases import (
    KEYS,
    POLISH,
    PROMISE,
    UNAVOIDABLE,
    VERDICT,
    failed_cases,
    failed_rows,
    is_outside,
    key_row,
    polish_row,
    unavoidable,
)

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
    Column("escaped_probability", "left the grid", form="{:.1e}".format),
)


def results(found: FoundPassages) -> Iterator[Exhibit]:
    """The table of cases, and what is to be known of it."""
    book = found.book
    rows = [case_row(case, verdict) for case, verdict in zip(book.cases, found.verdicts, strict=True)]
    rows += failed_rows(book.failed)
    yield Table("cases", book.config.title, CASES, rows, True, is_outside)
    yield from failed_cases(book.failed)
    passes = book.cases[0].statistics.passes
    criterion = {"criterion": book.config.criterion.sentence}
    yield Sentence(f"{passes} stratified passes a case. {LEGEND} {HOW_TO_READ}", criterion, brief=True)
    advice = advice_of(found.verdicts)
    if advice:
        yield Sentence(advice, brief=True)
    if found.no_st:
        yield Sentence(f"No Structured Text is written: {found.no_st}.", brief=True)


def case_row(case: SensorCase, verdict: CaseVerdict) -> Row:
    """Everything about one case in figures."""
    found = case.statistics
    return {
        **key_row(case.label, case.plant, case.table, verdict),
        **table_row(found, case.brake_power, case.table.predicted),
        "unavoidable_rms_m_s": unavoidable(case.unavoidable, found.passes),
    }


def heard(book: SensorBook) -> Iterator[Exhibit]:
    """Where the sensors stand, whose passages decide, and what came of each."""
    places = ", ".join(f"{place:g}" for place in book.sensors.sensors.path_m)
    yield Sentence(
        f"{len(book.sensors.sensors.path_m)} sensors {book.sensors.type} stand at {places} m from the entrance. The "
        f"regulator decides on a cut when {DECIDES[book.sensors.decides_on]} one, if the change of stage before has "
        "ended."
    )
    yield Sentence(HEARD)
    yield Table("passages", "Passages", PASSAGES, [row for case in book.cases for row in passage_rows(case)])


def passage_rows(case: SensorCase) -> Iterator[Row]:
    """The passages of one case."""
    heard = case.heard
    shares = zip(heard.unfinished, heard.taken, heard.mistaken, heard.heard, strict=True)
    for row, (unfinished, taken, mistaken, came) in zip(case.table.passages, shares, strict=True):
        yield {
            **of(case),
            "sensor": row.sensor,
            "axle": row.axle,
            "path_m": row.path_m,
            "unfinished": told(*unfinished, taken),
            "mistaken": told(*mistaken, came),
        }


def designs(book: SensorBook) -> Iterator[Exhibit]:
    """How the searches for the switching speeds ended, and all doubts."""
    yield Table("designs", "How the tables were found", DESIGNS, [design_row(case) for case in book.cases])
    for case in book.cases:
        yield from (Sentence(f"Warning for {case.name}: {warning}.") for warning in case.warnings)


def design_row(case: SensorCase) -> Row:
    """One case."""
    return {
        **of(case),
        **polish_row(case.polish),
        "escaped_probability": case.predicted.escaped,
    }


def of(case: SensorCase) -> dict[str, Any]:
    """Which case it is."""
    return {"label": case.label, "target_speed_m_s": case.target_speed_m_s}
