"""The choice of a table in C99, and the names of tables that it needs."""

from __future__ import annotations

from typing import Final

from tuning_tables.controller_code.code import ControllerCode

STATUSES: Final = """\
/* How a choice ended; below 0 no table was chosen. */
#define RETARDER_TUNED (0)      /* a table for this very speed */
#define RETARDER_BETWEEN (1)    /* what lies between two tables */
#define RETARDER_SLOWER (2)     /* the nearest table that aims at less than was commanded */
#define RETARDER_NO_CLASS (-1)  /* no table for this category and number of axles */
#define RETARDER_NO_TARGET (-2) /* no number, or below the lowest target: every table would let the cut out too fast */
"""

SELECT_NOTE: Final = """\
Fill chosen with the table for a cut of this category and number of axles that shall leave with commanded_m_s.
Candidates are the tables of the category and number of axles; of several masses the largest. {between} the
table of the next target below the command: the cut never leaves faster than commanded. Returns how it ended. Where that
is below 0, no table here is known to be safe: the stages of chosen become 0, so that nothing is commanded, and whoever
commands must decide."""

BLENDED_NOTE: Final = (
    "Between two targets it is what lies between the two tables, where they are of one family; else, and above the "
    "highest target,"
)
SLOWER_NOTE: Final = "Between two targets, and above the highest, it is"

SELECT: Final = """\
int32_t {select}(int32_t category, int32_t axles, float commanded_m_s, {type} *chosen)
{{
    int32_t slower;
    int32_t faster;
    int32_t status;
    choose(category, axles, commanded_m_s, &status, &slower, &faster);
    if (chosen == 0) {{
        return RETARDER_NO_CLASS;
    }}
    chosen->stages = 0;
    if (status >= 0) {{
        *chosen = {tables}[slower];
    }}
    if (status == RETARDER_BETWEEN) {{
{between}
    }}
    return status;
}}
"""

BLENDED: Final = """\
        const {type} *const other = &{tables}[faster];
        /* Not 0 where either is damaged: then what lies between them is told as damaged, too. */
        const uint32_t damage = (table_crc32(chosen) ^ chosen->crc32) | (table_crc32(other) ^ other->crc32);
        if (blend(chosen, other, commanded_m_s)) {{
            chosen->target_m_s = commanded_m_s;
            chosen->crc32 = table_crc32(chosen) ^ damage;
        }} else {{
            status = RETARDER_SLOWER;
        }}"""
SLOWER: Final = """\
        status = RETARDER_SLOWER;"""


def tables_of(code: ControllerCode) -> str:
    """The array of all tables."""
    return f"retarder_{code.table_name}s"


def table_type(code: ControllerCode) -> str:
    """The type of a table."""
    return f"retarder_{code.table_name}"


def select_of(code: ControllerCode) -> str:
    """The name of the choice."""
    return f"retarder_select{code.ending}"


def select_note(code: ControllerCode) -> str:
    """What the choice does."""
    return SELECT_NOTE.format(between=BLENDED_NOTE if code.blends else SLOWER_NOTE).replace("\n", " ")


def select(code: ControllerCode) -> str:
    """The function that chooses a table."""
    between = BLENDED.format(type=table_type(code), tables=tables_of(code)) if code.blends else SLOWER
    return SELECT.format(select=select_of(code), type=table_type(code), tables=tables_of(code), between=between)
