"""How far the predictions of the tables can be trusted."""

from __future__ import annotations

from collections.abc import Sequence
from statistics import median

from synth.book.case_result import CaseResult
from synth.frame.page.markup import Markup, element
from synth.frame.printed_numbers import counted, span
from synth.present.report.book_report import BookReport
from synth.present.report.case_table import HONEST


def honesty_section(book: BookReport) -> Markup:
    """Computed over the feasible cases (over all, where none is feasible)."""
    cases = book.feasible or book.cases
    return element("div", element("p", own_prediction(cases)), at_any_time(cases))


def own_prediction(cases: Sequence[CaseResult]) -> str:
    """What became of the prediction of the exported tables: exact ones, and simulated ones of tables with estimator."""
    exact = [case for case in cases if case.table.estimator is None]
    estimated = [case for case in cases if case.table.estimator is not None]
    sentences = []
    if exact:
        sentences.append(
            "Prediction (the exit-speed density of the exported table, nothing sampled) and simulation (passes in time "
            "with valves, sensor and sampling) are two independent computations of one quantity. " + ratios_of(exact)
        )
    if estimated:
        sentences.append(
            "With an estimator the prediction is itself simulated, on stratified passes that neither "
            f"design nor validation use: it tests the sample, not the model. {ratios_of(estimated)}"
        )
    return " ".join(sentences)


def at_any_time(cases: Sequence[CaseResult]) -> Markup:
    """What commands at any time gain; nothing where commands wait for the last one."""
    ratios = [case.comparison.at_rest.table_ratio for case in cases if case.comparison.at_rest is not None]
    if not ratios:
        return Markup("")
    return element(
        "p",
        "The regulator commands at any time, also while the pressure is on its way. On the same passes its rms is "
        f"{span(ratios)} times that of the lines that the same tune makes for commands at rest "
        f"({median(ratios):.2f} in the median).",
    )


def ratios_of(cases: Sequence[CaseResult]) -> str:
    """Predicted over simulated rms, in a sentence."""
    ratios = [case.comparison.table.honesty for case in cases]
    inside = sum(HONEST[0] <= ratio <= HONEST[1] for ratio in ratios)
    return (
        f"Predicted / simulated rms is {span(ratios)} over {counted(len(cases), 'case')}; {inside} of them within "
        f"{HONEST[0]:g} to {HONEST[1]:g}."
    )
