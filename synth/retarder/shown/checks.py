"""What the tables do where plant or sensor are not what they were made for; and checks of them beside the figures:
where the loop hunts, and what throws doubt on the numbers.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

from synth.frame.exhibits import Column, Exhibit, Row, Sentence, Table
from synth.frame.printed_numbers import decimals, per_cent
from synth.retarder.acceptance import FoundBook
from synth.retarder.case_result import CaseResult, OffNominal, Outcome
from synth.retarder.comparison.limit_cycle import Hunting, hunting_report
from synth.retarder.comparison.measured import interval_text
from synth.retarder.comparison.pressure_cycle import pressure_hunting
from synth.retarder.exit_figures import CASE, RMS, told
from synth.retarder.shown.cases import ESCAPED, POLISH, design_row, doubts, identity_row
from synth.retarder.tuned_table import AnyEstimate

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


LEAD: Final = (
    "Limit cycles predicted for the exported lines without noise: the regulator of the position steps between two "
    "neighbouring stages around a line wherever a whole period fits into the path. The amplitude shows how tightly two "
    "stages can hold a speed with this sampling and these valves; beside it the estimate by the describing function of "
    "the relay with hysteresis and delay."
)
HUNTING: Final = (
    *CASE,
    Column("lower_stage", "lower stage"),
    Column("from_m", "from", "m", decimals(1)),
    Column("to_m", "to", "m", decimals(1)),
    Column("periods", "periods", form=decimals(1)),
    Column("sampled_amplitude_m_s", "amplitude", "m/s", decimals(3)),
    Column("harmonic_amplitude_m_s", "describing function", "m/s", decimals(3)),
    Column("sampled_period_s", "period", "s", decimals(2)),
    Column("harmonic_period_s", "describing function", "s", decimals(2)),
    Column("gap_m_s", "between the lines", "m/s", decimals(3)),
    Column("top_m_s", "top", "m/s", decimals(3)),
    Column("bottom_m_s", "bottom", "m/s", decimals(3)),
    Column("period_s", "period in closed form", "s", decimals(2)),
    Column("rise_m_s2", "gains", "m/s²", decimals(3)),
    Column("fall_m_s2", "falls behind", "m/s²", decimals(3)),
    Column("brake_delay_s", "delay of braking", "s", decimals(2)),
    Column("release_delay_s", "delay of releasing", "s", decimals(2)),
)
PRESSURE: Final = (
    *CASE,
    Column("stage", "stage"),
    Column("bottom_kpa", "lowest", "kPa"),
    Column("top_kpa", "highest", "kPa"),
    Column("period_s", "period", "s", decimals(2)),
)
DESIGNS: Final = (
    *CASE,
    *POLISH,
    Column("design_rms_m_s", "rms on the grid", "m/s", decimals(4)),
    Column("independent_rms_m_s", "rms without it", "m/s", decimals(4)),
    Column("again", "designed again on finer speeds"),
    Column("most_off", "believed up to a factor of"),
    Column("ties", "hold wins ties", form=per_cent),
    ESCAPED,
    Column("error_m_s", "error of the estimate", "m/s", decimals(4)),
    Column("trim_m_s", "trim of the lines", "m/s", decimals(4)),
    Column("tuning_rms_before_trim_m_s", "rms before the trim", "m/s", decimals(4)),
    Column("tuning_rms_m_s", "rms after it", "m/s", decimals(4)),
)


def checks(cases: Sequence[CaseResult]) -> Iterator[Exhibit]:
    """Hunting by case, the regulator of the stage pressure, how the lines were found, and all doubts."""
    rows = [hunting_row(case, each) for case in cases for each in hunting_report(case.plant, case.table_lines)]
    yield Sentence(LEAD if rows else "No limit cycle fits into the path.")
    if rows:
        yield Table("hunting", "Predicted limit cycles", HUNTING, rows)
    yield from pressure(cases)
    designs = [lines_row(case) for case in cases]
    yield Table("designs", "How the lines were found", DESIGNS, designs)
    yield from doubts(cases)


def hunting_row(case: CaseResult, found: Hunting) -> Row:
    """One stretch of path."""
    stretch = {"from_m": found.from_m, "to_m": found.to_m, "periods": found.periods}
    return {**identity_row(case), **stretch, **vars(found.cycle)}


def pressure(cases: Sequence[CaseResult]) -> Iterator[Exhibit]:
    """Whether the regulator of the stage pressure hunts."""
    rows: list[Row] = [
        {**identity_row(case), "stage": stage, **vars(cycle)}
        for case in cases
        for stage, cycle in pressure_hunting(case.plant)
    ]
    if rows:
        yield Table("pressure_hunting", "The regulator of the stage pressure hunts", PRESSURE, rows)
    else:
        yield Sentence("The regulator of the stage pressure does not hunt: no overshoot crosses its dead band.")


def lines_row(case: CaseResult) -> Row:
    """How the lines of one case were found."""
    return {
        **design_row(case),
        **vars(case.grid),
        "ties": case.ties,
        **({} if case.estimate is None else estimate_row(case.estimate)),
    }


def estimate_row(made: AnyEstimate) -> Row:
    """How lines for the estimated speed were designed; the shifts of lower and upper lines, along the path if there
    are more."""
    return {
        "error_m_s": made.error_m_s,
        "trim_m_s": tuple(shift for pair in made.trim_m_s for shift in pair),
        "tuning_rms_before_trim_m_s": made.rms_before_m_s,
        "tuning_rms_m_s": made.rms_after_m_s,
    }
