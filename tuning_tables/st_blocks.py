"""The fixed part of the Structured Text export: the head comment, the type of a table, the choice.

The texts are templates of `string.Template`; `st_source` and `st_tables` fill the capitals behind a dollar sign. They
keep to a small subset of the language: no methods, no pointers, no RETURN or EXIT, no typed literals, no initial value
inside a STRUCT, no index that only the other side of an AND keeps in range, one operation on REAL a statement.
"""

from __future__ import annotations

from string import Template
from typing import Final

HEAD: Final = Template(
    """\
(* Controller tables of a car retarder, and the rule by which they decide: IEC 61131-3 Structured Text.
   Generated: do not edit, export again. This text may be used, changed and passed on without any condition.

$ORIGIN
   layout     $LAYOUT (in layout 1 the numbers of the categories followed the order of the tables)
   categories, whose numbers are the same in every export of this layout:
$CATEGORIES

   Blocks
   RETARDER_SELECT  once for a cut, when its class and exit speed are known: fills a RETARDER_TABLE
   RETARDER_BEGIN   once for a cut, before its first sample: nothing is known of it
   RETARDER_OBSERVE at every sample: the speed to decide with, estimated if the table has an estimator, else as measured
   RETARDER_DECIDE  $WHEN
   RETARDER_LOAD    a table by its number in the book, unchanged
   RETARDER_CATEGORIES  names for the numbers of the weight categories; it need not be called

   The rule
   1. A path or speed that is not finite, a negative speed, or a stage that the table has not: hold.
   2. The path is clamped into the range of the table.$GAUGE_RULE
   3. If the stage has a lower line and the speed is below it: lower, to the next stage down.
   4. If the stage has an upper line and the speed is above it: raise, to the next stage up.$GATE_RULE
   5. Otherwise hold; a speed equal to a line holds.
   6. After lower or raise, 3 to 5 again at the stage reached, with the same path and speed, until that stage holds or
      answers the opposite. The stage where this ends is the one to command.$FARTHEST_RULE
$INTERLOCK$TIMES_HEAD
   Arithmetic. Every operation on REAL stands in a statement of its own, so that its result is rounded to REAL
   (binary32) before the next. A controller that calculates in double precision and rounds when it assigns gives the
   same results: rounding + - * / of binary32 numbers to 53 bits first and to 24 afterwards never differs from rounding
   once, as 53 >= 2 * 24 + 2 (Figueroa 1995). One that fuses multiplication and addition across statements does not:
   switch that off. RETARDER_SELF_TEST shows which is the case.

   Not done: no compiler of a vendor has seen this text. It was parsed, and its parse tree evaluated in binary32
   against the reference implementation; see docs/structured-text.md. *)
"""
)

TABLE_TYPE: Final = """\
TYPE
    RETARDER_TABLE : STRUCT
        Target_m_s : REAL; (* exit speed aimed at *)
        PathMin_m : REAL; (* the path is clamped into this range *)
        PathMax_m : REAL;
        Touch_kpa : REAL; (* pressure above which cylinders brake, for RETARDER_OBSERVE; 0 without estimator *)
        Stages : INT; (* stages 0 to Stages - 1; 0: no table *)
        Powers : INT; (* coefficients of a line: its degree + 1 *)$APPROACH_MEMBERS$TIMES_MEMBERS
        HasLower : ARRAY[0..$LAST_STAGE] OF BOOL; (* by stage *)
        HasUpper : ARRAY[0..$LAST_STAGE] OF BOOL;
        (* at (stage * 2 + line) * $POWERS + power, line 0 lower, 1 upper; m/s per m^power *)
        Coefficient : ARRAY[0..$LAST_COEFFICIENT] OF REAL;$ESTIMATOR_MEMBERS
    END_STRUCT;
END_TYPE
"""

SELECT_DECLARATIONS: Final = """\
FUNCTION_BLOCK RETARDER_SELECT
(* The table for a cut. Candidates are the tables of its category and number of axles; of several masses the largest.
   The command equal to a target: that table. Between two targets: the lines between them, if the two tables have the
   same stages, degree, lines, path range$SAME_NAMES. Otherwise the table of the next target below the command: the
   cut never leaves faster than commanded. Below all targets, or no number: no table. *)
VAR_INPUT
    Layout : INT; (* of whoever numbers the categories: write $LAYOUT, the layout of this file, as a number *)
    Category : INT; (* number as in the head of this file, or a name of RETARDER_CATEGORIES *)
    Axles : INT;
    Commanded_m_s : REAL; (* exit speed wanted *)
END_VAR
VAR_IN_OUT
    Table : RETARDER_TABLE; (* filled; without a table its Stages become 0, and RETARDER_DECIDE holds *)
END_VAR
VAR_OUTPUT
    Status : INT; (* 0 tuned, 1 between two tables, 2 slower; no table: -1 no such class, -2 none slow enough,
                     -3 the caller is of another layout, whose numbers may mean other categories *)
END_VAR
VAR
    Loader : RETARDER_LOAD;
    Faster : RETARDER_TABLE;
    Number : INT;
    SlowerNo : INT;
    FasterNo : INT;
    Index : INT;
    Fits : BOOL;
    Heaviest_t : REAL;
    Target : REAL;
    SlowerTarget : REAL;
    FasterTarget : REAL;
    Span : REAL;
    Weight : REAL;
    Low : REAL;
    Rise : REAL;
END_VAR
"""

SELECT_BODY: Final = """\
Table.Stages := 0;
Status := -1;
SlowerNo := -1;
FasterNo := -1;
Heaviest_t := -1.0;
SlowerTarget := 0.0;
FasterTarget := 0.0;
FOR Number := 0 TO $LAST_TABLE DO
    IF (CategoryOf[Number] = Category) AND (AxlesOf[Number] = Axles) THEN
        Status := -2;
        IF MassOf[Number] > Heaviest_t THEN
            Heaviest_t := MassOf[Number];
            SlowerNo := -1;
            FasterNo := -1;
        END_IF;
        IF MassOf[Number] >= Heaviest_t THEN
            (* A later table of equal target does not replace an earlier one. *)
            Target := TargetOf[Number];
            IF Target <= Commanded_m_s THEN
                IF (SlowerNo < 0) OR (Target > SlowerTarget) THEN
                    SlowerNo := Number;
                    SlowerTarget := Target;
                END_IF;
            ELSIF (FasterNo < 0) OR (Target < FasterTarget) THEN
                FasterNo := Number;
                FasterTarget := Target;
            END_IF;
        END_IF;
    END_IF;
END_FOR;
IF Layout <> $LAYOUT THEN
    Status := -3;
    SlowerNo := -1;
END_IF;
IF (SlowerNo >= 0) AND (Commanded_m_s > 0.0) AND (Commanded_m_s <= 3.4028235E+38) THEN
    Loader(TableNo := SlowerNo, Table := Table);
    IF SlowerTarget >= Commanded_m_s THEN
        Status := 0;
    ELSE
        Status := 2;
        IF FasterNo >= 0 THEN
            Loader(TableNo := FasterNo, Table := Faster);
            Fits := (Table.Stages = Faster.Stages) AND (Table.Powers = Faster.Powers)$SAME_APPROACH$SAME_TIMES
                AND (Table.PathMin_m = Faster.PathMin_m) AND (Table.PathMax_m = Faster.PathMax_m)$SAME_ESTIMATOR;
            FOR Index := 0 TO $LAST_STAGE DO
                IF (Table.HasLower[Index] XOR Faster.HasLower[Index])
                    OR (Table.HasUpper[Index] XOR Faster.HasUpper[Index]) THEN
                    Fits := FALSE;
                END_IF;$SAME_PRESSURES
            END_FOR;
            Span := FasterTarget - SlowerTarget;
            IF Fits AND (Span > 0.0) THEN
                Weight := Commanded_m_s - SlowerTarget;
                Weight := Weight / Span;
                FOR Index := 0 TO $LAST_COEFFICIENT DO
                    Low := Table.Coefficient[Index];
                    Rise := Faster.Coefficient[Index] - Low;
                    Rise := Weight * Rise;
                    Table.Coefficient[Index] := Low + Rise;
                END_FOR;$SLOPES_BETWEEN
                Table.Target_m_s := Commanded_m_s;
                Status := 1;
            END_IF;
        END_IF;
    END_IF;
END_IF;
END_FUNCTION_BLOCK
"""

CATEGORIES: Final = """\
FUNCTION_BLOCK RETARDER_CATEGORIES
(* Names for the numbers of the weight categories, the same in every export of layout $LAYOUT. One instance does, and
   it need not be called. *)
VAR_OUTPUT
$DECLARED
END_VAR

$ASSIGNED
END_FUNCTION_BLOCK
"""

LOAD_DECLARATIONS: Final = """\
FUNCTION_BLOCK RETARDER_LOAD
(* A table of the book as it stands. *)
VAR_INPUT
    TableNo : INT; (* 0 to $LAST_TABLE *)
END_VAR
VAR_IN_OUT
    Table : RETARDER_TABLE; (* filled; where there is no such table its Stages become 0, and RETARDER_DECIDE holds *)
END_VAR
VAR_OUTPUT
    Found : BOOL; (* there is such a table *)
END_VAR
VAR
    Index : INT;$LOAD_VARIABLES
END_VAR
"""

LOAD_BODY: Final = """\
Found := (TableNo >= 0) AND (TableNo <= $LAST_TABLE);
Table.Stages := 0;
IF Found THEN
    Table.Target_m_s := TargetOf[TableNo];
    Table.PathMin_m := PathMinOf[TableNo];
    Table.PathMax_m := PathMaxOf[TableNo];
    Table.Stages := StagesOf[TableNo];
    Table.Powers := PowersOf[TableNo];$LOAD_APPROACH$LOAD_TIMES
    CASE TableNo OF
$CASES
    END_CASE;
$LOAD_ESTIMATOR
END_IF;
END_FUNCTION_BLOCK
"""
