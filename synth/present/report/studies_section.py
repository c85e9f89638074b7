"""Two findings beside the tables: which degree suffices, and what the indifferent region saves (R5)."""

from __future__ import annotations

from collections.abc import Sequence
from statistics import median

from synth.book.case_result import CaseResult, DegreeStudy
from synth.book.printed_numbers import ABSENT, span, speed
from synth.present.report.book_report import BookReport
from synth.present.report.markup import Cell, Markup, element, head_row, joined, table


def studies_section(book: BookReport) -> Markup:
    """The table of the degree study, where there is one, and a sentence on the indifferent region."""
    parts = [element("p", indifference(book.feasible or book.cases))]
    if book.degree_studies:
        lead = (
            "Rms in m/s of rounded tables of polished lines by degree, in brackets before the polish, predicted as the "
            "rms of an exported table is; the last column predicts the solver's lines on the same grid. The study "
            "takes no limit on over-speed, no guard against the worst friction and no estimator."
        )
        parts += [element("p", lead), degree_table(book.degree_studies)]
    return joined(parts)


def degree_table(studies: Sequence[DegreeStudy]) -> Markup:
    """One row a study, one column a degree, the unsmoothed lines last."""
    degrees = sorted({degree for study in studies for degree in study.degrees})
    rows = [(degree_row(study, degrees), "") for study in studies]
    head = head_row("case", *(f"degree {degree}" for degree in degrees), "solver's lines")
    return table("Exit-speed error by degree of the lines", (head,), rows)


def degree_row(study: DegreeStudy, degrees: Sequence[int]) -> list[str | Cell]:
    """The cells of one study."""
    pairs = zip(study.polished_rms_m_s, study.fitted_rms_m_s, strict=True)
    by_degree = {
        degree: f"{speed(float(polished))} ({speed(float(fitted))})"
        for degree, (polished, fitted) in zip(study.degrees, pairs, strict=True)
    }
    return [study.label, *(by_degree.get(degree, ABSENT) for degree in degrees), speed(study.lines_rms_m_s)]


def indifference(cases: Sequence[CaseResult]) -> str:
    """Switchings saved and error paid by holding within the tolerance, over `cases`."""
    found = [case.study.indifference for case in cases]
    saved = [each.switchings_without - each.switchings_with for each in found]
    paid = [each.rms_with_m_s / each.rms_without_m_s for each in found if each.rms_without_m_s]
    text = (
        "Where several commands cost the same within the tolerance, hold is taken. In the solver's lines this saves "
        f"{span(saved)} switchings a pass ({median(saved):.2f} in the median)"
    )
    return f"{text} and multiplies the rms by {span(paid, '.3f')}." if paid else f"{text}."
