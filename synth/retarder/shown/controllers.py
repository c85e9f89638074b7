"""All controllers of every case side by side, on the same passes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from synth.frame.exhibits import Column, Exhibit, Row, Table
from synth.frame.printed_numbers import decimals
from synth.retarder.case_result import CaseResult
from synth.retarder.comparison.measured import Measured
from synth.retarder.exit_figures import CASE, LOOP, PREDICTED, loop_row
from synth.retarder.found_book import FoundBook
from synth.retarder.shown.cases import identity_row
from synth.retarder.shown.results import table_ratio

CONTROLLER: Final = (
    Column("controller", "controller", words=True),
    *LOOP,
    PREDICTED,
    Column("table_ratio", "rms of the table / its rms", form=decimals(3)),
)
CONTROLLERS: Final = (*CASE, *CONTROLLER)


def controllers(found: FoundBook[CaseResult]) -> Iterator[Exhibit]:
    """A row for each controller of each case: the table, the reference, and the classical laws."""
    cases = found.book.cases
    rows = [{**identity_row(case), **controller_row(each)} for case in cases for each in case.controllers]
    yield Table("controllers", "Every controller, on the same passes; ratios are paired", CONTROLLERS, rows)


def controller_row(found: Measured) -> Row:
    """The figures of `CONTROLLER`."""
    return {
        "controller": found.name,
        **loop_row(found.statistics),
        "predicted_rms_m_s": found.predicted_rms_m_s,
        "table_ratio": table_ratio(found),
    }
