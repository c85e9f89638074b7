"""A book of tables with lines: a row for each case, and what these rows come to; all controllers side by side, on the
same passes; which criterion the tables were made by, and what keeping its requirement took; how far their predictions
can be trusted, and what commands at any time gain.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from statistics import median
from typing import Final

from synth.frame.exhibits import Column, Exhibit, Row, Sentence, Table
from synth.frame.interval import Interval
from synth.frame.printed_numbers import counted, decimals, per_cent, span, speed
from synth.retarder.acceptance import CaseVerdict, FoundBook
from synth.retarder.case_result import CaseResult, fronts_of
from synth.retarder.case_result import told as nearly_free
from synth.retarder.comparison.measured import Measured
from synth.retarder.exit_figures import CASE, DETAILS, EFFORT, LOOP, PREDICTED, TOLD, loop_row, told
from synth.retarder.permissions.permission import tellable
from synth.retarder.shown.cases import (
    KEYS,
    PROMISE,
    UNAVOIDABLE,
    VERDICT,
    case_row,
    cases_table,
    identity_row,
    passes_told,
    tiles,
    to_do,
)
from synth.retarder.shown.checks import worst_of
from synth.retarder.shown.pictures import accuracy_charts

ENTRY: Final = (
    Column("entry_m_s", "entry speeds", "m/s", detail=True),
    Column("served_entry_m_s", "of them served", "m/s", decimals(2), detail=True),
)
CASES: Final = (
    *CASE, VERDICT, *TOLD,
    Column("at_rest_ratio", "rms / at rest", form=decimals(2), spare=7),
    Column("regret", "regret", form=decimals(2), spare=5),
    Column("best_baseline_m_s", "best baseline", "m/s", decimals(4), spare=6),
    Column("best_baseline", "which", words=True, spare=6),
    UNAVOIDABLE, *EFFORT, *DETAILS, *KEYS, *ENTRY, *PROMISE,
)  # fmt: skip

HOW_TO_READ: Final = (
    "Regret: rms of the table over that of a controller of its kind that knows the friction of each cut, with lines "
    "polished for it: a reference, no lower bound. Best baseline: the classical law of least rms, tuned for the case. "
    "Unavoidable: rms of what cuts leave too fast by under the hardest braking, and too slow by without any; where it "
    "is above the limit, no regulator of the position keeps that limit, and the case is infeasible. All controllers "
    "see the same passes, and may act from the same place."
)
PERMISSIONS: Final = (
    "'retarder-synth hardware' tells what commands at any time and other permissions of the hardware would give."
)


NO_REGRET: Final = (
    "No regret is stated where the regulator that knows the friction is beaten by one that does not: it is no "
    "reference there."
)


def results(found: FoundBook[CaseResult]) -> Iterator[Exhibit]:
    """The table of cases, what is to be known of it, and the pictures of all cases."""
    yield tiles(found)
    yield from cases_table(found, CASES, result_row)
    yield Sentence(passes_told(found.book.cases), overall(found), brief=True)
    yield Sentence(HOW_TO_READ)
    for sentence in (*remarks(found), *(infeasible(case, each) for case, each in found.judged if not each.feasible)):
        yield Sentence(sentence, brief=True)
    yield from to_do(found)
    yield from accuracy_charts(found.book.cases, found.book.config.acceptance.rms_m_s)


def result_row(case: CaseResult, verdict: CaseVerdict) -> Row:
    """Everything about one case in figures."""
    found, entry, best = case.comparison, case.plant.entry, case.comparison.best_baseline
    n, at_rest = case.statistics.passes, found.at_rest
    return {
        **case_row(case, verdict),
        "regret": told(found.regret, found.regret_ci95, n),
        "at_rest_ratio": None if at_rest is None else table_ratio(at_rest),
        "best_baseline": best and best.name,
        "best_baseline_m_s": best and told(best.statistics.rms_m_s, best.statistics.rms_ci95_m_s, n),
        "entry_m_s": (entry.low_m_s, entry.high_m_s),
        "served_entry_m_s": case.feasibility.served_m_s,
    }


def table_ratio(found: Measured) -> Interval | None:
    """The rms of the table over that of another controller."""
    return told(found.table_ratio, found.table_ratio_ci95, found.statistics.passes)


def overall(found: FoundBook[CaseResult]) -> Row:
    """Figures over the feasible cases; infeasible ones are only counted."""
    regrets = [case.comparison.regret for case in found.feasible if case.comparison.has_reference]
    honest = [case.measured.prediction_ratio for case in found.feasible]
    return {
        "criterion": found.book.config.criterion.sentence,
        "cases": len(found.book.cases),
        "feasible": len(found.feasible),
        "highest_rms_m_s": max((case.statistics.rms_m_s for case in found.feasible), default=None),
        "median_regret": median(regrets) if regrets else None,
        "lowest_prediction_ratio": min(honest, default=None),
        "highest_prediction_ratio": max(honest, default=None),
    }


def remarks(found: FoundBook[CaseResult]) -> Iterator[str]:
    """What is to be done or known besides the verdict."""
    if not all(case.comparison.has_reference for case in found.book.cases):
        yield NO_REGRET
    worst = worst_of(found.feasible)
    if worst is not None:
        yield worst.told
    if fronts := fronts_of(found.book.cases):
        yield nearly_free(fronts)
    if tellable(found.book.config):
        yield PERMISSIONS


def infeasible(case: CaseResult, verdict: CaseVerdict) -> str:
    """What of an infeasible case can be served."""
    served, entry, least = case.feasibility.served_m_s, case.plant.entry, case.unavoidable
    part = f"entry speeds from {served[0]:.2f} to {served[1]:.2f} m/s" if served else "no entry speed"
    low, high = map(speed, least.rms_ci95_m_s)
    return (
        f"Infeasible and outside the verdict: {verdict.name}, {verdict.obstacle}: {part} can be served of the "
        f"{entry.low_m_s:g} to {entry.high_m_s:g} m/s asked for, where the rms that no regulator avoids is "
        f"{speed(least.rms_m_s)} [{low}, {high}] m/s."
    )


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


HONEST: Final = (0.9, 1.1)
"""Predicted / simulated rms inside this is called honest."""

EXACT: Final = (
    "Prediction (the exit-speed density of the exported table, nothing sampled) and simulation (passes in time with "
    "valves, sensor and sampling) are two independent computations of one quantity. "
)
ESTIMATED: Final = (
    "With an estimator the prediction is itself simulated, on stratified passes that neither design nor validation "
    "use: it tests the sample, not the model. "
)


def predictions(found: FoundBook[CaseResult]) -> Iterator[Exhibit]:
    """Over the feasible cases (over all, where none is feasible)."""
    cases = found.feasible or found.book.cases
    exact = [case for case in cases if case.table.estimator is None]
    estimated = [case for case in cases if case.table.estimator is not None]
    if exact:
        yield Sentence(EXACT + ratios_of(exact))
    if estimated:
        yield Sentence(ESTIMATED + ratios_of(estimated))
    ratios = [case.comparison.at_rest.table_ratio for case in cases if case.comparison.at_rest is not None]
    if ratios:
        yield Sentence(
            "The regulator commands at any time, also while the pressure is on its way. On the same passes its rms is "
            f"{span(ratios)} times that of the lines that the same tune makes for commands at rest "
            f"({median(ratios):.2f} in the median)."
        )


def ratios_of(cases: Sequence[CaseResult]) -> str:
    """Predicted over simulated rms, in a sentence."""
    ratios = [case.measured.prediction_ratio for case in cases]
    inside = sum(HONEST[0] <= ratio <= HONEST[1] for ratio in ratios)
    return (
        f"Predicted / simulated rms is {span(ratios)} over {counted(len(cases), 'case')}; {inside} of them within "
        f"{HONEST[0]:g} to {HONEST[1]:g}."
    )
