"""Checks of the tables beside the figures: where the loop hunts, and what throws doubt on the numbers."""

from __future__ import annotations

import math
from collections.abc import Iterator

from synth.book.case_names import case_name
from synth.book.case_result import CaseResult
from synth.book.comparison.limit_cycle import Hunting, hunting_report
from synth.book.comparison.pressure_cycle import pressure_hunting
from synth.frame.page.markup import Cell, Markup, element, head_row, joined, table
from synth.frame.printed_numbers import ABSENT, counted, percent
from synth.present.report.book_report import BookReport

HUNTING = (
    "Limit cycles predicted for the exported lines without noise: the regulator of the position steps between two "
    "neighbouring stages around a line wherever a whole period fits into the path. The amplitude shows how tightly two "
    "stages can hold a speed with this sampling and these valves; in brackets the estimate by the describing function "
    "of the relay with hysteresis and delay."
)


def checks_section(book: BookReport) -> Markup:
    """Hunting by case, the stage pressure regulator, and escaped probability."""
    rows = [
        (hunting_row(case, each), "")
        for case in book.cases
        for each in hunting_report(case.plant, case.study.table_lines)
    ]
    head = head_row("case", "stages", "from, m", "to, m", "periods", "amplitude, m/s", "period, s")
    cycles = (
        table("Predicted limit cycles", (head,), rows) if rows else element("p", "No limit cycle fits into the path.")
    )
    return joined(
        (element("p", HUNTING), cycles, element("p", pressure(book)), element("p", escaped(book)), *doubts(book))
    )


def hunting_row(case: CaseResult, hunting: Hunting) -> list[str | Cell]:
    """The cells of one stretch of path."""
    cycle = hunting.cycle
    return [
        case_name(case),
        f"{cycle.lower_stage} and {cycle.lower_stage + 1}",
        f"{hunting.from_m:.1f}",
        f"{hunting.to_m:.1f}",
        f"{hunting.periods:.1f}",
        f"{cycle.sampled_amplitude_m_s:.3f} ({known(cycle.harmonic_amplitude_m_s, '.3f')})",
        f"{cycle.sampled_period_s:.2f} ({known(cycle.harmonic_period_s, '.2f')})",
    ]


def known(value: float, form: str) -> str:
    """The number, or a dash where the describing function has no answer."""
    return ABSENT if math.isnan(value) else format(value, form)


def pressure(book: BookReport) -> str:
    """Whether the regulator of the stage pressure hunts."""
    stages = sorted({stage for case in book.cases for stage, _ in pressure_hunting(case.plant)})
    if not stages:
        return "The regulator of the stage pressure does not hunt: no overshoot crosses its dead band."
    return f"The regulator of the stage pressure hunts at stage {', '.join(str(stage) for stage in stages)}."


def doubts(book: BookReport) -> Iterator[Markup]:
    """How the polishes ended, how often hold won a tie, and the warnings of single cases."""
    converged = sum(case.polish.converged for case in book.cases)
    ties = max((case.study.policy_map.ties for case in book.cases), default=0.0)
    yield element(
        "p",
        f"{converged} of {counted(len(book.cases), 'polish', 'polishes')} converged. In at most {percent(ties)} % of "
        "the states of the solver no change of stage gains anything, so that hold wins the tie.",
    )
    for case in book.cases:
        yield from (element("p", f"Warning for {case_name(case)}: {warning}.") for warning in case.warnings)


def escaped(book: BookReport) -> str:
    """The largest probability that ran off the top of the grid in a prediction."""
    most = max((case.predicted.escaped for case in book.cases), default=0.0)
    return f"Probability that left the top of the speed grid in a prediction: at most {most:.1e} (it should be zero)."
