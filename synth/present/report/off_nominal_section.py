"""What the tables do off nominal: a column a condition, behind a fold."""

from __future__ import annotations

from synth.book.case_names import case_name
from synth.book.case_result import CaseResult
from synth.book.off_nominal.outcome import OffNominal
from synth.frame.page.markup import Cell, Markup, element, head_row, table
from synth.frame.printed_numbers import ABSENT, interval, percent, quotient, quotient_interval, speed
from synth.present.report.book_report import BookReport

LEAD = (
    "The same tables where plant or sensor are not what the tables were made for. In each cell: rms in m/s with its "
    "95 % interval and, after ×, over that of the same passes on the table's own plant; then the cuts that leave more "
    "than 0.3 m/s too fast, and those that stop inside, in per cent. Of weight ± 10 % the worse is shown. The sizes of "
    "the changes are assumed. No limit follows from them: they show what a table lives on. Where readings are lost, "
    "a few cuts make most of the rms of a table with estimator, so that its interval there is too narrow."
)


def off_nominal_section(book: BookReport) -> Markup:
    """The fold; nothing where no case was tried."""
    tried = [case for case in book.cases if case.off_nominal]
    if not tried:
        return Markup("")
    passes = max((each.outcome.passes for case in tried for each in case.off_nominal if each.outcome), default=0)
    head = head_row("case", "nominal rms, m/s", *(each.name for each in tried[0].off_nominal))
    rows = [(row_of(case), "" if case.feasibility.feasible else "infeasible") for case in tried]
    return element(
        "details",
        element("summary", f"Off nominal: the same tables on other plants ({passes} passes each)"),
        element("p", LEAD),
        table("Off nominal, by case", (head,), rows, kind="cases"),
    )


def row_of(case: CaseResult) -> list[str | Cell]:
    """The cells of one case."""
    return [
        case_name(case),
        speed(case.comparison.table.statistics.rms_m_s),
        *(cell_of(each) for each in case.off_nominal),
    ]


def cell_of(found: OffNominal) -> Cell:
    """What became of a table in one condition; the intervals of the shares on the tool tip."""
    outcome = found.outcome
    if outcome is None:
        return Cell(ABSENT, found.impossible)
    ratio = ""
    if outcome.ratio is not None and outcome.ratio_ci95 is not None:
        ratio = f" × {quotient(outcome.ratio)} {quotient_interval(outcome.ratio_ci95)}"
    rms = f"{speed(outcome.rms_m_s)} {interval(outcome.rms_ci95_m_s)}{ratio}"
    shares = f"too fast {percent(outcome.overspeed)} %, stopped {percent(outcome.stalled)} %"
    fast, stopped = (tuple(map(percent, ends)) for ends in (outcome.overspeed_ci95, outcome.stalled_ci95))
    note = f"{outcome.change}; too fast [{fast[0]}, {fast[1]}] %, stopped [{stopped[0]}, {stopped[1]}] %"
    return Cell(f"{rms}; {shares}", note, "words")
