"""Which criterion the tables were made by, and what keeping its requirement took."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from synth.frame.exhibits import Column, Exhibit, Row, Sentence, Table
from synth.frame.printed_numbers import decimals, per_cent
from synth.retarder.case_result import CaseResult
from synth.retarder.exit_figures import CASE
from synth.retarder.found_book import FoundBook
from synth.retarder.shown.cases import identity_row

REQUIREMENT: Final = (
    *CASE,
    Column("multiplier_m2_s2", "price of an over-speed", "m²/s²"),
    Column("probability", "predicted over-speed", form=per_cent),
    Column("probability_without", "without the limit", form=per_cent),
    Column("worst_factor", "worst friction factor"),
    Column("worst_rms_m_s", "rms there", "m/s", decimals(4)),
    Column("worst_rms_without_m_s", "without the guard", "m/s", decimals(4)),
    Column("rms_m_s", "predicted rms", "m/s", decimals(4)),
    Column("rms_without_m_s", "of the least mean square", "m/s", decimals(4)),
    Column("gap", "duality gap", form=per_cent),
    Column("factors", "friction factors optimised over"),
    Column("weights", "their weights"),
    Column("rounds", "rounds"),
    Column("met", "limit kept"),
)
"""Of `OverspeedLimitFound` and `WorstCaseFound`; a table has the columns of one."""


def criterion(found: FoundBook[CaseResult]) -> Iterator[Exhibit]:
    """The criterion in a sentence; where it requires something, a sentence for each case."""
    of = found.book.config.criterion
    yield Sentence(
        f"Minimised: {of.sentence}; a stop in the position costs {of.stall_cost_m2_s2:g} m2/s2 more, a change of stage "
        f"{of.switching_tolerance_m2_s2:g} m2/s2, a second in the position {of.time_price_m2_s3:g} m2/s3."
    )
    for case in found.book.cases:
        if case.finding is not None:
            yield Sentence(f"{case.name}: {case.finding.sentence}.")
    rows: list[Row] = [
        {**identity_row(case), **vars(case.finding)} for case in found.book.cases if case.finding is not None
    ]
    if rows:
        yield Table("requirement", "What the requirement took", REQUIREMENT, rows)
