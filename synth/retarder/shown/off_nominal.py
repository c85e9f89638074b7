"""What the tables do where plant or sensor are not what they were made for."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

from synth.frame.exhibits import Column, Exhibit, Row, Sentence, Table
from synth.frame.printed_numbers import decimals, per_cent
from synth.retarder.case_result import CaseResult
from synth.retarder.exit_figures import CASE, RMS, told
from synth.retarder.found_book import FoundBook
from synth.retarder.judgement import interval_text
from synth.retarder.off_nominal.outcome import OffNominal, Outcome

OFF_NOMINAL: Final = (
    *CASE,
    Column("condition", "condition", words=True),
    Column("change", "what differs", words=True),
    RMS,
    Column("ratio", "rms / nominal", form=decimals(2)),
    Column("overspeed", "over-speed", form=per_cent),
    Column("stalled", "stopped inside", form=per_cent),
    Column("impossible", "not possible, as", words=True),
    Column("key", "key", words=True, detail=True),
)
CHANGED: Final = (
    "The same tables where plant or sensor are not what the tables were made for. The ratio is to the rms of the same "
    "passes on the table's own plant, paired. Of weight ± 10 % the worse is shown. The sizes of the changes are "
    "assumed. No limit follows from them: they show what a table lives on. Where readings are lost, a few cuts make "
    "most of the rms of a table with estimator, so that its interval there is too narrow."
)


def off_nominal(found: FoundBook[CaseResult]) -> Iterator[Exhibit]:
    """A row for each condition of each case."""
    yield Sentence(CHANGED)
    rows = [row_of(case, each) for case in found.book.cases for each in case.off_nominal]
    yield Table("off_nominal", "The same tables on other plants", OFF_NOMINAL, rows)


def row_of(case: CaseResult, found: OffNominal) -> Row:
    """One condition of one case."""
    head = {
        "label": case.label,
        "target_speed_m_s": case.target_speed_m_s,
        "condition": found.name,
        "key": found.key,
    }
    became = found.outcome
    if became is None:
        return {**head, "impossible": found.impossible}
    return {
        **head,
        "change": became.change,
        "rms_m_s": told(became.rms_m_s, became.rms_ci95_m_s, became.passes),
        "ratio": told(became.ratio, became.ratio_ci95, became.passes),
        "overspeed": told(became.overspeed, became.overspeed_ci95, became.passes),
        "stalled": told(became.stalled, became.stalled_ci95, became.passes),
    }


@dataclass(frozen=True)
class Worst:
    """The largest `ratio` to the rms of the same passes on the plant of the table: `case`, and what became of it."""

    case: CaseResult
    key: str
    outcome: Outcome
    ratio: float

    @property
    def told(self) -> str:
        """In a sentence."""
        found = self.outcome
        return (
            f"Off nominal, for which there is no limit, the worst is {self.case.name} with {found.change}: rms "
            f"{found.rms_m_s:.4f} {interval_text(found.rms_ci95_m_s)} m/s, {self.ratio:.1f} times the nominal."
        )


def worst_of(cases: Sequence[CaseResult]) -> Worst | None:
    """The worst of all conditions of `cases`, None where there is no ratio."""
    return max(ratios_of(cases), key=lambda each: each.ratio, default=None)


def ratios_of(cases: Sequence[CaseResult]) -> Iterator[Worst]:
    """Every ratio that there is."""
    for case in cases:
        for each in case.off_nominal:
            if each.outcome is not None and each.outcome.ratio is not None:
                yield Worst(case, each.key, each.outcome, each.outcome.ratio)
