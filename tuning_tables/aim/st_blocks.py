"""The fixed part of the Structured Text of aim tables, as templates of `string.Template` for `st_source`.

The subset of the language is that of controller tables (`tuning_tables.st_blocks`): one operation on REAL a statement,
no index that only the other side of an AND keeps in range, no RETURN, EXIT or typed literals. Loops over as much as a
table has are WHILE (`tuning_tables.st_loops`).
"""

from __future__ import annotations

from string import Template
from typing import Final

HEAD: Final = Template(
    """\
(* Aim tables of a park position, and the rule by which they are asked: IEC 61131-3 Structured Text.
   Generated: do not edit, export again. This text may be used, changed and passed on without any condition.

$ORIGIN
   categories, whose numbers are the same in every export:
$CATEGORIES

   Blocks
   AIM_SELECT      once for a cut: the number of the table for its category, by measured resistance or by category alone
   AIM_EXIT_SPEED  the exit speed to command; -1.0 where there is no answer: then brake to the lowest speed
   AIM_LOAD        the axes of a table, for AIM_EXIT_SPEED

   The rule
   1. A distance or a resistance that is not finite, or nearer than the first distance: no answer. The resistance is
      clamped; a table by category alone does not look at it.
   2. No speed at one of the neighbouring nodes (at a node: that node alone): no answer.
   3. Along the distance at the lower resistance and at the higher one, then between the two results. Beyond the last
      distance the speed of the last node, if there is one at the node before and it is not greater; else no answer.
   4. Between two listed numbers of cars the lesser of the answers for both, none if one has none. Fewer or more cars
      than are listed: no answer.

   Arithmetic. Every operation on REAL stands in a statement of its own, so that its result is rounded to REAL
   (binary32) before the next; see docs/structured-text.md.

   Not done: no compiler of a vendor has seen this text. It was parsed, and its parse tree evaluated in binary32
   against the reference implementation. *)
"""
)

AXES_TYPE: Final = """\
TYPE
    AIM_AXES : STRUCT
        Listed : INT; (* numbers of cars; 0: no table *)
        Distances : INT;
        Resistances : INT; (* 0: the table is by category alone *)
        FirstRow : INT; (* of the exit speeds for the first number of cars *)
        Cars : ARRAY[0..$LAST_CARS] OF INT;
        Distance_m : ARRAY[0..$LAST_DISTANCE] OF REAL;
        Resistance : ARRAY[0..$LAST_RESISTANCE] OF REAL; (* N/kN *)
    END_STRUCT;
END_TYPE
"""

LOAD_DECLARATIONS: Final = """\
FUNCTION_BLOCK AIM_LOAD
(* The axes of a table. *)
VAR_INPUT
    TableNo : INT; (* 0 to $LAST_TABLE *)
END_VAR
VAR_IN_OUT
    Axes : AIM_AXES; (* filled; where there is no such table its Listed becomes 0 *)
END_VAR
VAR
    Index : INT;
END_VAR
"""

LOAD_BODY: Final = """\
Axes.Listed := 0;
IF (TableNo >= 0) AND (TableNo <= $LAST_TABLE) THEN
    Axes.Listed := ListedOf[TableNo];
    Axes.Distances := DistancesOf[TableNo];
    Axes.Resistances := ResistancesOf[TableNo];
    Axes.FirstRow := FirstRowOf[TableNo];
    CASE TableNo OF
$CASES
    END_CASE;
END_IF;
END_FUNCTION_BLOCK
"""

LOAD_CASE: Final = """\
$NUMBER:
    FOR Index := 0 TO $LAST_CARS DO
        Axes.Cars[Index] := Cars_$NUMBER[Index];
    END_FOR;
    FOR Index := 0 TO $LAST_DISTANCE DO
        Axes.Distance_m[Index] := Distance_$NUMBER[Index];
    END_FOR;"""

LOAD_RESISTANCES: Final = """
    FOR Index := 0 TO $LAST_RESISTANCE DO
        Axes.Resistance[Index] := Resistance_$NUMBER[Index];
    END_FOR;"""

SELECT_DECLARATIONS: Final = """\
FUNCTION_BLOCK AIM_SELECT
(* The table for a cut. *)
VAR_INPUT
    Category : INT; (* number as in the head of this file *)
    Measured : BOOL; (* TRUE: the table by measured resistance; FALSE: by category alone *)
END_VAR
VAR_OUTPUT
    TableNo : INT; (* -1: there is none *)
END_VAR
VAR
    Index : INT;
END_VAR
"""

SELECT_BODY: Final = """\
TableNo := -1;
FOR Index := 0 TO $LAST_TABLE DO
    IF (CategoryOf[Index] = Category) AND NOT (MeasuredOf[Index] XOR Measured) THEN
        TableNo := Index;
    END_IF;
END_FOR;
END_FUNCTION_BLOCK
"""

SPEED_DECLARATIONS: Final = """\
FUNCTION_BLOCK AIM_EXIT_SPEED
(* The exit speed to command. One instance a position is enough. *)
VAR_INPUT
    TableNo : INT; (* that of AIM_SELECT *)
    Cars : INT; (* of the cut *)
    FreeDistance_m : REAL; (* what its head has still to roll when its last axle leaves the position *)
    Resistance : REAL; (* as measured, N/kN *)
END_VAR
VAR_OUTPUT
    ExitSpeed_m_s : REAL; (* -1.0: no answer *)
END_VAR
VAR
    Loader : AIM_LOAD;
    Axes : AIM_AXES;
    Credible : BOOL;
    Beyond : BOOL; (* the last distance *)
    Sound : BOOL;
    Index : INT;
    Row : INT;
    LastRow : INT;
    Side : INT;
    Place : INT;
    Below : INT;
    Above : INT;
    Lower : INT;
    Upper : INT;
    Stride : INT;
    Node : ARRAY[0..3] OF INT;
    Speed : ARRAY[0..3] OF REAL;
    Way : REAL;
    Share : REAL;
    Span : REAL;
    Rise : REAL;
    First : REAL;
    Second : REAL;
    Answer : REAL;
END_VAR
"""

SPEED_BODY: Final = """\
ExitSpeed_m_s := -1.0;
Loader(TableNo := TableNo, Axes := Axes);
Row := -1;
Index := 0;
WHILE Index < Axes.Listed DO
    IF Cars >= Axes.Cars[Index] THEN
        Row := Index;
    END_IF;
    Index := Index + 1;
END_WHILE;
LastRow := Row;
IF Row >= 0 THEN
    IF Cars > Axes.Cars[Row] THEN
        LastRow := Row + 1;
    END_IF;
END_IF;
(* No comparison with a NaN is true. *)
Credible := (Row >= 0) AND (LastRow < Axes.Listed)
    AND (FreeDistance_m >= Axes.Distance_m[0]) AND (FreeDistance_m <= GreatestReal);
IF Axes.Resistances > 0 THEN
    Credible := Credible AND (Resistance >= LeastReal) AND (Resistance <= GreatestReal);
END_IF;
IF Credible THEN
    Below := 0;
    Index := 1;
    WHILE Index < Axes.Distances DO
        IF FreeDistance_m >= Axes.Distance_m[Index] THEN
            Below := Index;
        END_IF;
        Index := Index + 1;
    END_WHILE;
    Above := Below;
    Way := 0.0;
    Beyond := FALSE;
    IF FreeDistance_m > Axes.Distance_m[Below] THEN
        IF Below < Axes.Distances - 1 THEN
            Above := Below + 1;
            Span := Axes.Distance_m[Above] - Axes.Distance_m[Below];
            Way := FreeDistance_m - Axes.Distance_m[Below];
            Way := Way / Span;
        ELSE
            Beyond := TRUE;
            Below := Below - 1;
        END_IF;
    END_IF;
    Credible := Below >= 0;
END_IF;
IF Credible THEN
    Lower := 0;
    Upper := 0;
    Share := 0.0;
    Stride := 1;
    IF Axes.Resistances > 0 THEN
        Stride := Axes.Resistances;
        Index := 1;
        WHILE Index < Axes.Resistances DO
            IF Resistance >= Axes.Resistance[Index] THEN
                Lower := Index;
            END_IF;
            Index := Index + 1;
        END_WHILE;
        Upper := Lower;
        IF (Resistance > Axes.Resistance[Lower]) AND (Lower < Axes.Resistances - 1) THEN
            Upper := Lower + 1;
            Span := Axes.Resistance[Upper] - Axes.Resistance[Lower];
            Share := Resistance - Axes.Resistance[Lower];
            Share := Share / Span;
        END_IF;
    END_IF;
    Node[0] := Below * Stride + Lower;
    Node[1] := Above * Stride + Lower;
    Node[2] := Below * Stride + Upper;
    Node[3] := Above * Stride + Upper;
    Side := Row;
    WHILE Side <= LastRow DO
        Place := Axes.FirstRow + Side;
        CASE Place OF
$CASES
        END_CASE;
        Answer := -1.0;
        Sound := (Speed[0] >= 0.0) AND (Speed[1] >= 0.0) AND (Speed[2] >= 0.0) AND (Speed[3] >= 0.0);
        IF Beyond THEN
            Sound := Sound AND (Speed[0] <= Speed[1]) AND (Speed[2] <= Speed[3]);
        END_IF;
        IF Sound THEN
            First := Speed[1];
            Second := Speed[3];
            IF NOT Beyond THEN
                Rise := Speed[1] - Speed[0];
                Rise := Way * Rise;
                First := Speed[0] + Rise;
                IF Speed[0] < Speed[1] THEN
                    IF First > Speed[1] THEN
                        First := Speed[1];
                    END_IF;
                ELSIF First < Speed[1] THEN
                    First := Speed[1];
                END_IF;
                Rise := Speed[3] - Speed[2];
                Rise := Way * Rise;
                Second := Speed[2] + Rise;
                IF Speed[2] < Speed[3] THEN
                    IF Second > Speed[3] THEN
                        Second := Speed[3];
                    END_IF;
                ELSIF Second < Speed[3] THEN
                    Second := Speed[3];
                END_IF;
            END_IF;
            Rise := Second - First;
            Rise := Share * Rise;
            Answer := First + Rise;
            IF First < Second THEN
                IF Answer > Second THEN
                    Answer := Second;
                END_IF;
            ELSIF Answer < Second THEN
                Answer := Second;
            END_IF;
        END_IF;
        IF (Side = Row) OR (Answer < ExitSpeed_m_s) THEN
            ExitSpeed_m_s := Answer;
        END_IF;
        Side := Side + 1;
    END_WHILE;
END_IF;
END_FUNCTION_BLOCK
"""

SPEED_CASE: Final = """\
$ROW:
    FOR Index := 0 TO 3 DO
        Speed[Index] := Speed_$ROW[Node[Index]];
    END_FOR;"""
