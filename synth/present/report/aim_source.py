"""Which exported aim tables commanded the last positions of humped trains, as a table."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from synth.frame.page.markup import Cell, Markup, element, head_row, joined, table
from synth.yard.hump.number_ranges import ranges
from synth.yard.humping.aim_choice import KNOWN, AimChoice

COLUMNS = ("tracks", "table", "position", "weight category", "by", "p", "coupling speed, m/s", "made")
LEAD = (
    "Exit speeds of the last position of these tracks are the answers of these tables, by the rule of controllers. "
    "Where a table has no answer its lowest speed is commanded. On other tracks they were chosen for this trial."
)


def aim_section(aims: Sequence[AimChoice], tracks: Sequence[int]) -> Markup:
    """A sentence, and a row for each table; `tracks` (routes,) of the routes that `aims` name."""
    rows = [(row, "") for choice in aims for row in table_rows(choice, tracks)]
    return joined((element("p", LEAD), table("Aim tables", (head_row(*COLUMNS),), rows, kind="parameters")))


def table_rows(choice: AimChoice, tracks: Sequence[int]) -> Iterator[list[str | Cell]]:
    """The cells of each table of one choice."""
    for each in choice.tables.tables:
        yield [
            ranges(sorted(int(tracks[row]) for row in choice.rows)),
            Cell(each.id, kind="code"),
            each.position.name,
            each.category.name,
            KNOWN[each.is_measured],
            f"{each.required.p_overspeed:g}",
            f"{each.required.coupling_speed_m_s:g}",
            each.created,
        ]
