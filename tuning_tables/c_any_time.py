"""Deciding at any time in the C99 export: words and code about the times of decision, the pressure gauge and slopes.

Where all tables of a book decide at rest, every blank is filled with what the text said before there were others.
"""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np
import numpy.typing as npt

from tuning_tables.c_literals import hex_float
from tuning_tables.c_template import part
from tuning_tables.decisions import Decisions
from tuning_tables.golden_vectors import GoldenVectors
from tuning_tables.table_block import BlockSize, TableBlock
from tuning_tables.table_book import TableBook

DECIDE: Final = "int retarder_decide(const retarder_table *table, int stage, float s_m, float v_m_s)"

AT_REST: Final[Mapping[str, str]] = {
    **dict.fromkeys(
        ("TIMES_HEAD", "TIMES_MACROS", "TIMES_MEMBERS", "TIMES_DECLARATION", "TIMES_WORDS", "MORE_WORDS", "AT_ANY_TIME",
         "SAME_TIMES", "SAME_GAUGE", "SLOPE_BETWEEN", "WRONG_TIMES", "GAUGE_DECLARATION", "DECIDE_AT_PRESSURE",
         "VECTOR_PRESSURE", "SURFACE_SPEED", "PRESSURE_PARAMETER", "PRESSURE_ARGUMENT"),
        "",
    ),
    "TIMES_ASKED": " * To be asked at each sample at which no change of stage is under way, "
    "from retarder_approach before the entrance on.",
    "FARTHEST_MEANT": "any stage",
    "SAME_NAMES": "estimator and approach",
    "DECIDE": DECIDE,
    "FARTHEST": "table->stages - 1u",
    "LOWER_SPEED": "line_speed(table->coefficients[stage][0], table->powers, s_m)",
    "UPPER_SPEED": "line_speed(table->coefficients[stage][1], table->powers, s_m)",
    "DECIDED_RIGHT": """\
    return retarder_decide(table, (int)golden->stage, float_of(golden->s_bits), float_of(golden->v_bits))
        == golden->answer;""",
}  # fmt: skip

HEAD: Final = """
 *
 * Deciding at any time. A table decides either at rest or at any time: retarder_at_any_time() tells which. A table that
 * decides at rest is asked only when the pressure of the stage is reached. A table that decides at any time is asked at
 * every sample, also while the pressure still changes: so a new command may come before the last one is carried out.
 * `stage` is always the stage that was commanded last, whatever the pressure is."""

ANY_TIME: Final[Mapping[str, str]] = {
    "TIMES_HEAD": HEAD,
    "TIMES_MACROS": """
#define RETARDER_AT_ANY_TIME 1u /* a table decides at any time; not defined where none does */""",
    "TIMES_MEMBERS": """
    uint32_t at_any_time; /* 1: the table decides at any time; 0: at rest */""",
    "TIMES_DECLARATION": """

/* 1 if the table decides at any time: ask at every sample, with the stage commanded last. 0 if it decides at rest, and
 * without table: ask only when the pressure of the stage is reached. */
int retarder_at_any_time(const retarder_table *table);""",
    "TIMES_ASKED": """\
 * To be asked at every sample if retarder_at_any_time is 1, else at each sample at which no change of stage is under
 * way, from retarder_approach before the entrance on. `stage` is the stage commanded last.""",
    "FARTHEST_MEANT": "any stage at rest, and one stage at any time",
    "FARTHEST": "retarder_at_any_time(table) ? 1u : table->stages - 1u",
    "TIMES_WORDS": "#define TIMES_WORDS 1u\n",
    "MORE_WORDS": " \\\n     + TIMES_WORDS",
    "SAME_NAMES": "estimator, approach,\n * times of decision, and pressures if there are slopes",
    "SAME_TIMES": "\n        && slower->at_any_time == faster->at_any_time",
    "WRONG_TIMES": "\n            || retarder_at_any_time(&retarder_tables[number]) != golden_times[number]",
}

GAUGE: Final[Mapping[str, str]] = {
    "TIMES_HEAD": f"""{HEAD}
 *
 * The gauge. Lines may depend on the pressure, because a cut is braked by the pressure that is there, and not by the
 * stage that was commanded: V(s, P) = line(s) + slope (P - pressure of the stage). So measure the pressure in the
 * cylinders and ask retarder_decide_at_pressure(). Where the gauge fails, hand over what is no number (NaN), or ask
 * retarder_decide(): then the lines at the pressure of the stage count.""",
    "TIMES_MACROS": f"""{ANY_TIME["TIMES_MACROS"]}
#define RETARDER_GAUGE 1u /* a table has slopes over the pressure; not defined where none has */""",
    "TIMES_MEMBERS": f"""{ANY_TIME["TIMES_MEMBERS"]}
    float highest_kpa; /* of the highest stage that the table raises to: a higher pressure counts as this one */
    float pressures[RETARDER_STAGES]; /* of the stages, kPa; a pressure below the first counts as the first */
    float slopes[RETARDER_STAGES][2]; /* of lower and upper, m/s per kPa */""",
    "TIMES_ASKED": f"""{ANY_TIME["TIMES_ASKED"]}
 *
 * If the table has slopes, this is the answer at the pressure of the stage.""",
    "GAUGE_DECLARATION": """

/* retarder_decide at the pressure that the gauge shows, kPa above that of the air; the same for a table without slopes.
 * A pressure below that of stage 0 counts as that, one above that of the highest stage that the table raises to as
 * that. A pressure that is not finite counts as that of the stage. */
int retarder_decide_at_pressure(const retarder_table *table, int stage, float s_m, float v_m_s, float pressure_kpa);""",
    "TIMES_WORDS": "#define TIMES_WORDS (2u + 3u * RETARDER_STAGES)\n",
    "LOWER_SPEED": "surface_speed(table, stage, 0u, s_m, pressure_kpa)",
    "UPPER_SPEED": "surface_speed(table, stage, 1u, s_m, pressure_kpa)",
    "PRESSURE_PARAMETER": ", const float *pressure_kpa",
    "PRESSURE_ARGUMENT": ", pressure_kpa",
    "DECIDE": """/* The rule, for both of its functions. */
static int decide(const retarder_table *table, int stage, float s_m, float v_m_s, const float *pressure_kpa)""",
    "SAME_TIMES": f"{ANY_TIME['SAME_TIMES']} && is_same_gauge(slower, faster)",
    "SLOPE_BETWEEN": """
            chosen->slopes[stage][line] = rounded(slower->slopes[stage][line]
                + rounded(weight * rounded(faster->slopes[stage][line] - slower->slopes[stage][line])));""",
    "VECTOR_PRESSURE": "\n    uint32_t p_bits;",
    "DECIDED_RIGHT": """\
    const float s_m = float_of(golden->s_bits);
    const float v_m_s = float_of(golden->v_bits);
    const int stage = (int)golden->stage;
    const int plain = retarder_decide(table, stage, s_m, v_m_s);
    return retarder_decide_at_pressure(table, stage, s_m, v_m_s, float_of(golden->p_bits)) == golden->answer
        /* NaN and both infinities: the gauge is silent. */
        && retarder_decide_at_pressure(table, stage, s_m, v_m_s, float_of(0x7FC00000u)) == plain
        && retarder_decide_at_pressure(table, stage, s_m, v_m_s, float_of(0x7F800000u)) == plain
        && retarder_decide_at_pressure(table, stage, s_m, v_m_s, float_of(0xFF800000u)) == plain;""",
}


def any_time_blanks(book: TableBook, size: BlockSize) -> Mapping[str, str]:
    """What the templates ask for about the times of decision and about slopes."""
    if not size.any_time:
        return {**AT_REST, "GOLDEN_TIMES": ""}
    times = ", ".join(f"{table.decisions is Decisions.AT_ANY_TIME:d}" for table in book.tables)
    rows = textwrap.fill(times, 100, initial_indent="    ", subsequent_indent="    ")
    found = {
        **AT_REST,
        **ANY_TIME,
        "AT_ANY_TIME": f"{part('at_any_time.c')}\n",
        "GOLDEN_TIMES": f"/* Which tables decide at any time. */\n"
        f"static const int golden_times[{len(book.tables)}] = {{\n{rows}\n}};\n\n",
    }
    if not size.gauge:
        return found
    return {
        **found,
        **GAUGE,
        "SURFACE_SPEED": f"{part('surface_speed.c')}\n",
        "DECIDE_AT_PRESSURE": f"\n{part('decide_at_pressure.c')}",
        "SAME_GAUGE": f"{part('same_gauge.c')}\n",
    }


def any_time_text(block: TableBlock, size: BlockSize) -> list[str]:
    """The lines of a table's initialiser about its times of decision, pressures and slopes; none if all are at rest."""
    if not size.any_time:
        return []
    at_any_time = int(block.words[size.at_any_time][0])
    found = [f"        {at_any_time}u, /* decides {'at any time' if at_any_time else 'at rest'} */"]
    if not size.gauge:
        return found
    numbers = block.words[size.pressures].view(np.float32)
    highest, pressures, slopes = numbers[0], numbers[1 : 1 + size.stages], numbers[1 + size.stages :].reshape(-1, 2)
    return [
        *found,
        f"        {hex_float(highest)}, /* highest pressure, {highest:g} kPa */",
        "        {",
        *(f"            {hex_float(kpa)}, /* of stage {k}, {kpa:g} kPa */" for k, kpa in enumerate(pressures)),
        "        },",
        "        {",
        *(
            f"            {{{hex_float(low)}, {hex_float(high)}}}, /* slopes at stage {k}: {low:.6g} {high:.6g} */"
            for k, (low, high) in enumerate(slopes)
        ),
        "        },",
    ]


def reading_columns(vectors: GoldenVectors, size: BlockSize) -> Sequence[npt.NDArray[np.float32]]:
    """Path and speed, and the pressure if a table of the book has a gauge."""
    return (vectors.s_m, vectors.v_m_s, *((vectors.pressure_kpa,) if size.gauge else ()))
