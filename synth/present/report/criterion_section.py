"""Which criterion the tables were made by, and what keeping its requirement took."""

from __future__ import annotations

from synth.book.case_names import case_name
from synth.frame.page.markup import Markup, element, joined
from synth.present.report.book_report import BookReport


def criterion_section(book: BookReport) -> Markup:
    """The criterion in a sentence; where it requires something, a sentence for each case."""
    criteria = dict.fromkeys(case.criterion for case in book.cases)
    parts = [
        element(
            "p",
            f"Minimised: {criterion.sentence}; a stop in the position costs {criterion.stall_cost_m2_s2:g} m2/s2 more, "
            f"a change of stage {criterion.switching_tolerance_m2_s2:g} m2/s2, a second in the position "
            f"{criterion.time_price_m2_s3:g} m2/s3.",
        )
        for criterion in criteria
    ]
    kept = [f"{case_name(case)}: {case.finding.sentence}." for case in book.cases if case.finding is not None]
    if kept:
        parts.append(element("ul", *(element("li", sentence) for sentence in kept)))
    return joined(parts)
