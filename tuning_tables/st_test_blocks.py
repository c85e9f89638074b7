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
    Decider(Stage := Stage_$PART[Index], Path_m := Path_$PART[Index], Speed_m_s := Speed_$PART[Index], Table := Table);
    IF Decider.Command <> Answer_$PART[Index] THEN
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
    Selector(Category := Category_$PART[Index], Axles := Axles_$PART[Index], Commanded_m_s := Commanded_$PART[Index],
        Table := Table);
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
Selector(Category := $CATEGORY, Axles := $AXLES, Commanded_m_s := $COMMANDED, Table := Table);
Agrees := Selector.Status = 1;
FOR Index := 0 TO $LAST DO
    IF Table.Coefficient[Index] <> Expected_$NUMBER[Index] THEN
        Agrees := FALSE;
    END_IF;
END_FOR;
IF NOT Agrees THEN
    IF Failed = 0 THEN
        FirstFailed := $FAULT;
    END_IF;
    Failed := Failed + 1;
END_IF;
"""

RUN_ALL: Final = """\
FUNCTION_BLOCK RETARDER_SELF_TEST
(* Call it once a cycle until Done: each call tests one table, the last one the choice. *)
VAR_INPUT
    Restart : BOOL; (* begin again *)
END_VAR
VAR_OUTPUT
    Done : BOOL;
    Failed : INT; (* blocks in which something is wrong; 0 when Done: all is as exported *)
    FirstFailed : INT; (* the first of them: number of the table, $TABLES for the choice; -1: none *)
    FirstFault : INT; (* FirstFailed of that block *)
END_VAR
VAR
    Loader : RETARDER_LOAD;
    Choices : RETARDER_TEST_CHOICES;
$INSTANCES
    Table : RETARDER_TABLE;
    Number : INT;
    Begun : BOOL;
    Faults : INT;
    Fault : INT;
END_VAR

IF Restart OR NOT Begun THEN
    Begun := TRUE;
    Done := FALSE;
    Number := 0;
    Failed := 0;
    FirstFailed := -1;
    FirstFault := -1;
END_IF;
IF NOT Done THEN
    Faults := 0;
    Fault := -1;
    Loader(TableNo := Number, Table := Table);
    CASE Number OF
$CASES
        $TABLES:
            Choices();
            Faults := Choices.Failed;
            Fault := Choices.FirstFailed;
    END_CASE;
    IF Faults > 0 THEN
        IF Failed = 0 THEN
            FirstFailed := Number;
            FirstFault := Fault;
        END_IF;
        Failed := Failed + 1;
    END_IF;
    Done := Number >= $TABLES;
    Number := Number + 1;
END_IF;
END_FUNCTION_BLOCK
"""

RUN_ONE: Final = """\
        $NUMBER:
            Test_$NUMBER(Table := Table);
            Faults := Test_$NUMBER.Failed;
            Fault := Test_$NUMBER.FirstFailed;"""
