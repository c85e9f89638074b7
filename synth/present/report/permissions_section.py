"""What permissions of the hardware would give: a column of the table of cases, and a table with every interval."""

from __future__ import annotations

from typing import Final

from synth.book.permissions.overview import SHORT, Overview, asked_of
from synth.book.permissions.permission import CasePermissions, Permission
from synth.frame.page.markup import Cell, Markup, element, head_row, joined, table
from synth.frame.printed_numbers import ABSENT, interval, quotient, quotient_interval, speed

GROUP: Final = "rms × if permitted"
"""What stands above the head of the column."""

NO_BREAK: Final = "\u00a0"

LEAD: Final = (
    "Each permission is designed, predicted and simulated as a table of its own. The ratio is paired, on the same "
    "passes as the exported table; brackets: 95 %. Below 1 the permission makes the error smaller."
)


def column_head(overview: Overview) -> str:
    """The head of the column, below the name of its group: names in the order of the figures."""
    return ", ".join(SHORT[each].replace(" ", NO_BREAK) for each in overview.in_column)


def column_cell(case: CasePermissions, overview: Overview) -> Cell:
    """The figures of a case in the order of the head; their intervals as a tool tip."""
    found = [case.of(each) for each in overview.in_column]
    notes = (f"{SHORT[each.permission]} {ratio_text(case, each.permission)}" for each in found if each is not None)
    return Cell(" ".join(ABSENT if each is None else quotient(each.ratio) for each in found), ", ".join(notes))


def permissions_section(overview: Overview) -> Markup:
    """Every permission of every case with its interval."""
    asked = asked_of(overview.cases)
    head = head_row("case", "target, m/s", "rms as configured, m/s", *(each.value for each in asked))
    rows = [(permissions_row(case, asked), "") for case in overview.cases]
    return joined((element("p", LEAD), table("Permissions of the hardware", (head,), rows, kind="cases")))


def permissions_row(case: CasePermissions, asked: list[Permission]) -> list[str | Cell]:
    """The cells of one case."""
    rms = f"{speed(case.table.rms_m_s)} {interval(case.table.rms_ci95_m_s)}"
    return [case.label, f"{case.target_speed_m_s:g}", rms, *(ratio_text(case, each) for each in asked)]


def ratio_text(case: CasePermissions, permission: Permission) -> str:
    """The ratio of a permission with its interval."""
    found = case.of(permission)
    return ABSENT if found is None else f"{quotient(found.ratio)} {quotient_interval(found.ratio_ci95)}"
