"""The verdict: accepted or not, the worst case, and what is infeasible and why."""

from __future__ import annotations

from synth.book.case_names import case_name
from synth.book.case_result import CaseResult
from synth.frame.page.markup import Markup, element
from synth.frame.printed_numbers import counted, in_ten_thousand, interval, speed
from synth.present.report.book_report import BookReport


def verdict(book: BookReport) -> Markup:
    """The box at the head of the page."""
    word = "Accepted" if book.accepted else "Not accepted"
    parts = [element("p", element("strong", word), " — ", book.verdict)]
    if book.feasible:
        parts.append(element("p", worst_case(book)))
    if book.infeasible:
        lead = (
            f"{counted(len(book.infeasible), 'case')} of {every(book)} infeasible: whatever regulator is there, the "
            f"cuts that leave too fast under the hardest braking, or too slow without any, keep its rms above "
            f"{speed(book.acceptance_rms_m_s)} m/s. "
            "They take no part in the verdict and are shown everywhere."
        )
        parts.append(element("p", lead))
        parts.append(element("ul", *(element("li", infeasible_case(case)) for case in book.infeasible)))
    else:
        parts.append(element("p", f"Every case{' with a table' * bool(book.failed)} is feasible."))
    return element("section", *parts, class_="verdict accepted" if book.accepted else "verdict refused", id="verdict")


def every(book: BookReport) -> str:
    """How many cases there are to judge."""
    return f"{len(book.cases)} with a table" if book.failed else str(len(book.cases))


def worst_case(book: BookReport) -> str:
    """The feasible case of highest simulated rms."""
    worst = max(book.feasible, key=lambda case: case.comparison.table.statistics.rms_m_s)
    found = worst.comparison.table.statistics
    return (
        f"Worst of the {counted(len(book.feasible), 'feasible case')}: {case_name(worst)}, simulated rms "
        f"{speed(found.rms_m_s)} m/s, 95 % interval {interval(found.rms_ci95_m_s)}, over {found.passes} passes; "
        f"the limit is {speed(book.acceptance_rms_m_s)} m/s. {in_cuts(worst)}"
    )


def in_cuts(case: CaseResult) -> str:
    """The same in cuts, as a yard counts them."""
    found, power = case.comparison.table.statistics, case.brake_power
    out = in_ten_thousand(power.out_of_brake, power.out_of_brake_ci95)
    return (
        f"95 of 100 of its cuts leave within ±{speed(found.p95_m_s)} m/s of the target, 99 within "
        f"±{speed(found.p99_m_s)}; out of brake power are {out} in 10 000."
    )


def infeasible_case(case: CaseResult) -> str:
    """Why one case cannot be served, and what of it can."""
    found, entry, served = case.feasibility, case.plant.entry, case.feasibility.served_m_s
    part = (
        f"entry speeds from {served[0]:.2f} to {served[1]:.2f} m/s can be served"
        if served
        else "no entry speed can be served"
    )
    return (
        f"{case_name(case)}: {found.obstacle}; rms that no regulator avoids {speed(found.unavoidable.rms_m_s)} m/s "
        f"{interval(found.unavoidable.rms_ci95_m_s)} at entry speeds of {entry.low_m_s:g} to {entry.high_m_s:g} m/s; "
        f"{part}."
    )
