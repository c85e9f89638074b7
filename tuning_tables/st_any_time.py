"""Deciding at any time in the Structured Text export: words, members and statements about times, gauge and slopes.

Where all tables of a book decide at rest, every blank is filled with what the text said before there were others.
"""

from __future__ import annotations

from collections.abc import Mapping
from string import Template
from typing import Final

import numpy as np
import numpy.typing as npt

from tuning_tables.st_literals import bool_array, boolean, real, real_array
from tuning_tables.table_block import BlockSize, TableBlock

AT_REST: Final[Mapping[str, str]] = {
    **dict.fromkeys(
        ("TIMES_HEAD", "GAUGE_RULE", "TIMES_MEMBERS", "PRESSURE_INPUT", "PRESSURE_VARIABLES", "ABOVE", "LOWER_RISE",
         "UPPER_RISE", "FARTHEST_RULE", "FARTHEST", "LOAD_TIMES", "CASE_PRESSURES", "SAME_TIMES", "SAME_PRESSURES",
         "SLOPES_BETWEEN"),
        "",
    ),
    "WHEN": "at every sample at which no change of stage is under way: the stage to command",
    "ASKED": "To be asked at each sample at which no change of stage is under way.",
    "STAGE_MEANT": "pressure stage in force",
}  # fmt: skip

HEAD: Final = """
   Deciding at any time
   A table decides either at rest or at any time: its member AtAnyTime tells which. A table that decides at rest
   (FALSE) is asked only when the pressure of the stage is reached. A table that decides at any time (TRUE) is asked at
   every sample, also while the pressure still changes: so a new command may come before the last one is carried out.
   The input Stage is always the stage that was commanded last, whatever the pressure is.
"""

ANY_TIME: Final[Mapping[str, str]] = {
    "TIMES_HEAD": HEAD,
    "WHEN": """at every sample if AtAnyTime of the table is TRUE, else at every sample at which no change of stage
                    is under way: the stage to command""",
    "ASKED": """To be asked at each sample if Table.AtAnyTime is TRUE, else at each sample at which no change of stage
   is under way.""",
    "STAGE_MEANT": "pressure stage commanded last",
    "TIMES_MEMBERS": """
        AtAnyTime : BOOL; (* TRUE: the table decides at any time; FALSE: at rest *)""",
    "FARTHEST_RULE": """
      A table that decides at any time ends after one step: the next sample asks again.""",
    "FARTHEST": """
    IF Table.AtAnyTime THEN
        Farthest := 1;
    END_IF;""",
    "LOAD_TIMES": """
    Table.AtAnyTime := AtAnyTimeOf[TableNo];""",
    "SAME_TIMES": """
                AND NOT (Table.AtAnyTime XOR Faster.AtAnyTime)""",
}

GAUGE: Final[Mapping[str, str]] = {
    "TIMES_HEAD": f"""{HEAD}
   The gauge
   Lines may depend on the pressure, because a cut is braked by the pressure that is there, and not by the stage that
   was commanded. So measure the pressure in the cylinders, kPa above that of the air, and hand it over as Pressure_kpa
   at every call of RETARDER_DECIDE; an input that is left out is 0.0, the pressure of a released retarder. Where the
   gauge fails, hand over Table.Pressure_kpa of the stage. For a table without slopes any pressure does.
""",
    "GAUGE_RULE": """
      With slopes each line of the stage is line(path) + slope * (pressure - pressure of the stage). The pressure is
      clamped into the range from that of stage 0 to HighestPressure_kpa; one that is not finite counts as that of the
      stage.""",
    "TIMES_MEMBERS": f"""{ANY_TIME["TIMES_MEMBERS"]}
        HighestPressure_kpa : REAL; (* of the highest stage raised to: a higher pressure counts as this one *)
        Pressure_kpa : ARRAY[0..$LAST_STAGE] OF REAL; (* of the stages; all 0 in a table without slopes *)
        Slope : ARRAY[0..$LAST_SLOPE] OF REAL; (* at stage * 2 + line, line 0 lower, 1 upper; m/s per kPa *)""",
    "PRESSURE_INPUT": """
    Pressure_kpa : REAL; (* that of the gauge *)""",
    "PRESSURE_VARIABLES": """
    Above : REAL;
    Rise : REAL;""",
    "ABOVE": """
    Above := 0.0;
    IF (Pressure_kpa >= -3.4028235E+38) AND (Pressure_kpa <= 3.4028235E+38) THEN
        Above := Pressure_kpa;
        IF Above < Table.Pressure_kpa[0] THEN
            Above := Table.Pressure_kpa[0];
        END_IF;
        IF Above > Table.HighestPressure_kpa THEN
            Above := Table.HighestPressure_kpa;
        END_IF;
        Above := Above - Table.Pressure_kpa[Stage];
    END_IF;""",
    "LOWER_RISE": """
                Rise := Table.Slope[Wanted * 2] * Above;
                Line := Line + Rise;""",
    "UPPER_RISE": """
                Rise := Table.Slope[Wanted * 2 + 1] * Above;
                Line := Line + Rise;""",
    "LOAD_TIMES": f"""{ANY_TIME["LOAD_TIMES"]}
    Table.HighestPressure_kpa := HighestPressureOf[TableNo];""",
    "CASE_PRESSURES": """
    FOR Index := 0 TO $LAST_STAGE DO
        Table.Pressure_kpa[Index] := Pressure_$NUMBER[Index];
    END_FOR;
    FOR Index := 0 TO $LAST_SLOPE DO
        Table.Slope[Index] := Slope_$NUMBER[Index];
    END_FOR;""",
    "SAME_PRESSURES": """
                IF Table.Pressure_kpa[Index] <> Faster.Pressure_kpa[Index] THEN
                    Fits := FALSE;
                END_IF;""",
    "SLOPES_BETWEEN": """
                FOR Index := 0 TO $LAST_SLOPE DO
                    Low := Table.Slope[Index];
                    Rise := Faster.Slope[Index] - Low;
                    Rise := Weight * Rise;
                    Table.Slope[Index] := Low + Rise;
                END_FOR;""",
}

SAME_NAMES: Final[Mapping[tuple[bool, bool], str]] = {
    (False, False): " and estimator",
    (True, False): ",\n   estimator and approach",
    (False, True): ", estimator,\n   times of decision and pressures",
    (True, True): ", estimator,\n   approach, times of decision and pressures",
}
"""What two tables must have alike beside their shape: with approaches, with times of decision in the book."""

TIMES_CHECK: Final = """\
IF Table.AtAnyTime XOR $AT_ANY_TIME THEN
    IF Failed = 0 THEN
        FirstFailed := 0;
    END_IF;
    Failed := Failed + 1;
END_IF;
"""

GAUGE_CHECK: Final = """\
IF Table.HighestPressure_kpa <> $HIGHEST THEN
    IF Failed = 0 THEN
        FirstFailed := 0;
    END_IF;
    Failed := Failed + 1;
END_IF;
FOR Index := 0 TO $LAST_STAGE DO
    IF (Table.Pressure_kpa[Index] <> ExpectedPressure[Index])
        OR (Table.Slope[Index * 2] <> ExpectedSlope[Index * 2])
        OR (Table.Slope[Index * 2 + 1] <> ExpectedSlope[Index * 2 + 1]) THEN
        IF Failed = 0 THEN
            FirstFailed := 0;
        END_IF;
        Failed := Failed + 1;
    END_IF;
END_FOR;
"""

SLOPES_AGREE: Final = """\
FOR Index := 0 TO $LAST_SLOPE DO
    IF Table.Slope[Index] <> ExpectedSlope_$NUMBER[Index] THEN
        Agrees := FALSE;
    END_IF;
END_FOR;
"""


def any_time_blanks(size: BlockSize) -> Mapping[str, str]:
    """What the templates ask for about times of decision and slopes; nothing much if all tables decide at rest."""
    blanks = {**AT_REST, **(ANY_TIME if size.any_time else {}), **(GAUGE if size.gauge else {})}
    lengths = {"LAST_STAGE": str(size.stages - 1), "LAST_SLOPE": str(2 * size.stages - 1)}
    filled = {name: Template(text).safe_substitute(lengths) for name, text in blanks.items()}
    return {**filled, "SAME_NAMES": SAME_NAMES[size.approach, size.any_time]}


def times_constants(blocks: list[TableBlock], size: BlockSize) -> list[str]:
    """Declarations: times of decision and highest pressure by table; none if all tables decide at rest."""
    found = []
    if size.any_time:
        found.append(bool_array("AtAnyTimeOf", [decides_at_any_time(block, size) for block in blocks]))
    if size.gauge:
        found.append(real_array("HighestPressureOf", [highest_kpa(block, size) for block in blocks]))
    return found


def gauge_constants(number: int, block: TableBlock, size: BlockSize) -> list[str]:
    """Declarations: pressures and slopes of one table; none if no table has slopes."""
    if not size.gauge:
        return []
    return [
        real_array(f"Pressure_{number}", pressures_of(block, size)),
        real_array(f"Slope_{number}", slopes_of(block, size)),
    ]


def times_check(block: TableBlock, size: BlockSize) -> tuple[list[str], list[str]]:
    """Declarations and statements of the test whether a table has the times, pressures and slopes it should have."""
    if not size.any_time:
        return [], []
    statements = [Template(TIMES_CHECK).substitute(AT_ANY_TIME=boolean(decides_at_any_time(block, size)))]
    if not size.gauge:
        return [], statements
    check = Template(GAUGE_CHECK).substitute(HIGHEST=real(highest_kpa(block, size)), LAST_STAGE=size.stages - 1)
    expected = [
        real_array("ExpectedPressure", pressures_of(block, size)),
        real_array("ExpectedSlope", slopes_of(block, size)),
    ]
    return expected, [*statements, check]


def slopes_agree(number: int, block: TableBlock, size: BlockSize) -> tuple[list[str], str]:
    """Declarations and statements of the test whether slopes between two tables are right; none without slopes."""
    if not size.gauge:
        return [], ""
    declaration = real_array(f"ExpectedSlope_{number}", slopes_of(block, size))
    return [declaration], Template(SLOPES_AGREE).substitute(NUMBER=number, LAST_SLOPE=2 * size.stages - 1)


def decides_at_any_time(block: TableBlock, size: BlockSize) -> bool:
    """Whether the block's table decides at any time, in a book where one does."""
    return bool(block.words[size.at_any_time][0])


def highest_kpa(block: TableBlock, size: BlockSize) -> np.float32:
    """The pressure of the highest stage raised to, 0 for a table without slopes."""
    return np.float32(block.words[size.pressures].view(np.float32)[0])


def pressures_of(block: TableBlock, size: BlockSize) -> npt.NDArray[np.float32]:
    """The pressures of the stages, (stages,) kPa, zeros for a table without slopes."""
    return block.words[size.pressures].view(np.float32)[1 : 1 + size.stages]


def slopes_of(block: TableBlock, size: BlockSize) -> npt.NDArray[np.float32]:
    """The slopes in the order of RETARDER_TABLE, (2 * stages,) m/s per kPa."""
    return block.words[size.pressures].view(np.float32)[1 + size.stages :]
