"""How far the predictions of the tables can be trusted, and what commands at any time gain."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from statistics import median
from typing import Final

from synth.frame.exhibits import Exhibit, Sentence
from synth.frame.printed_numbers import counted, span
from synth.retarder.case_result import CaseResult
from synth.retarder.found_book import FoundBook

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
