"""The fixed part of the Structured Text self-test, as templates of `string.Template` for `st_self_test`."""

from __future__ import annotations

from typing import Final

TABLE_HEAD: Final = """\
FUNCTION_BLOCK RETARDER_TEST_$NUMBER
(* Table $NUMBER, $NAME: $CONSTANTS constants and $READINGS readings. *)
VAR_IN_OUT
    Table : RETARDER_TABLE; (* as RETARDER_LOAD gives it for TableNo $NUMBER *)
END_VAR
VAR_OUTPUT
    Failed : INT; (* constants and readings that are wrong *)
    FirstFailed : INT; (* the first of them, -1: none *)
END_VAR
VAR
    Decider : RETARDER_DECIDE;
    Index : INT;
END_VAR
"""

RESET: Final = """\
Failed := 0;
FirstFailed := -1;
"""

TABLE_CONSTANTS: Final = """\
IF Table.Target_m_s <> Expected[0] THEN
    Failed := Failed + 1;
    FirstFailed := 0;
END_IF;
IF (Table.PathMin_m <> Expected[1]) OR (Table.PathMax_m <> Expected[2]) THEN
    IF Failed = 0 THEN
        FirstFailed := 1;
    END_IF;
    Failed := Failed + 1;
END_IF;
FOR Index := 0 TO $LAST DO
    IF Table.Coefficient[Index] <> Expected[Index + 3] THEN
        IF Failed = 0 THEN
            FirstFailed := Index + 3;
        END_IF;
        Failed := Failed + 1;
    END_IF;
END_FOR;
"""

TABLE_LOOP: Final = """\
FOR Index := 0 TO $LAST DO
    Decider(Stage := Stage_$PART[Index], Path_m := Path_$PART[Index], Speed_m_s := Speed_$PART[Index],\
$PRESSURE_ASKED Table := Table);
    IF Decider.Wanted <> Answer_$PART[Index] THEN
        IF Failed = 0 THEN
            FirstFailed := Index + $FIRST;
        END_IF;
        Failed := Failed + 1;
    END_IF;
END_FOR;
"""

FOOT: Final = "END_FUNCTION_BLOCK\n"

CHOICE_HEAD: Final = """\
FUNCTION_BLOCK RETARDER_TEST_CHOICES
(* $CHOICES choices by status and target speed, $LINES between two tables by every coefficient. *)
VAR_OUTPUT
    Failed : INT; (* choices that are wrong *)
    FirstFailed : INT; (* the first of them, -1: none *)
END_VAR
VAR
    Selector : RETARDER_SELECT;
    Table : RETARDER_TABLE;
    Index : INT;
    Target : REAL;
    Agrees : BOOL;
END_VAR
"""

CHOICE_LOOP: Final = """\
FOR Index := 0 TO $LAST DO
    Selector(Layout := Layout_$PART[Index], Category := Category_$PART[Index], Axles := Axles_$PART[Index],
        Commanded_m_s := Commanded_$PART[Index], Table := Table);
    Target := 0.0;
    IF Selector.Status >= 0 THEN
        Target := Table.Target_m_s;
    END_IF;
    IF (Selector.Status <> Status_$PART[Index]) OR (Target <> Target_$PART[Index]) THEN
        IF Failed = 0 THEN
            FirstFailed := Index + $FIRST;
        END_IF;
        Failed := Failed + 1;
    END_IF;
END_FOR;
"""

CHOICE_LINES: Final = """\
Selector(Layout := $LAYOUT, Category := $CATEGORY, Axles := $AXLES, Commanded_m_s := $COMMANDED, Table := Table);
Agrees := Selector.Status = 1;
FOR Index := 0 TO $LAST DO
    IF Table.Coefficient[Index] <> Expected_$NUMBER[Index] THEN
        Agrees := FALSE;
    END_IF;
END_FOR;
${SLOPES_AGREE}IF NOT Agrees THEN
    IF Failed = 0 THEN
        FirstFailed := $FAULT;
    END_IF;
    Failed := Failed + 1;
END_IF;
"""

ESTIMATOR_CHECK: Final = """\
IF (Table.Estimator <> $ESTIMATOR) OR (Table.Touch_kpa <> $TOUCH) THEN
    IF Failed = 0 THEN
        FirstFailed := 0;
    END_IF;
    Failed := Failed + 1;
END_IF;
"""

ESTIMATOR_HEAD: Final = """\
FUNCTION_BLOCK RETARDER_TEST_ESTIMATOR_$PLACE
(* $NAME: $CONSTANTS constants and $SAMPLES samples. *)
VAR_IN_OUT
    Table : RETARDER_TABLE; (* as RETARDER_LOAD gives it for TableNo $NUMBER *)
END_VAR
VAR_OUTPUT
    Failed : INT; (* constants and samples that are wrong *)
    FirstFailed : INT; (* the first of them, -1: none *)
END_VAR
VAR
    Beginner : RETARDER_BEGIN;
    Observer : RETARDER_OBSERVE;
    Estimate : RETARDER_ESTIMATE;
    Index : INT;
END_VAR
"""

ESTIMATOR_CONSTANTS: Final = """\
IF (Table.Breaks <> $BREAKS)$DIFFERS THEN
    Failed := Failed + 1;
    FirstFailed := 0;
END_IF;
FOR Index := 0 TO $LAST_BREAK DO
    IF (Table.BreakPath_m[Index] <> Expected[Index + $PATH]) OR (Table.Drive[Index] <> Expected[Index + $DRIVE])
        OR (Table.Brake[Index] <> Expected[Index + $BRAKE]) THEN
        IF Failed = 0 THEN
            FirstFailed := Index + $PATH;
        END_IF;
        Failed := Failed + 1;
    END_IF;
END_FOR;
"""

TRACK_LOOP: Final = """\
FOR Index := 0 TO $LAST DO
    IF Begins[Index] THEN
        Beginner(Estimate := Estimate);
    END_IF;
    Observer(Path_m := Path[Index], Speed_m_s := Speed[Index], Overpressure_kpa := Pressure[Index], Table := Table,
        Estimate := Estimate);
    IF (Observer.Observed_m_s <> Observed[Index]) OR (Observer.Unseen <> Unseen[Index])
        OR (Observer.Alarms <> Alarms[Index]) THEN
        IF Failed = 0 THEN
            FirstFailed := Index + $FIRST;
        END_IF;
        Failed := Failed + 1;
    END_IF;
END_FOR;
"""
