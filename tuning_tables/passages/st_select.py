"""The choice among tables for point sensors in Structured Text, and its self-test, as templates."""

from __future__ import annotations

from typing import Final

SELECT_DECLARATIONS: Final = """\
FUNCTION_BLOCK RETARDER_SELECT_PASSAGES
(* The table for a cut. Candidates are the tables of its category and number of axles; of several masses the largest.
   The command equal to a target: that table. Otherwise the table of the next target below the command: the cut never
   leaves faster than commanded. Below all targets, or no number: no table. *)
VAR_INPUT
    Category : INT; (* number as in the head of this file *)
    Axles : INT;
    Commanded_m_s : REAL; (* exit speed wanted *)
END_VAR
VAR_IN_OUT
    Table : RETARDER_PASSAGE_TABLE; (* filled; without a table its Stages become 0: nothing is commanded *)
END_VAR
VAR_OUTPUT
    Status : INT; (* 0 tuned, 2 slower; no table: -1 no such class, -2 none slow enough *)
END_VAR
VAR
    Loader : RETARDER_LOAD_PASSAGES;
    Number : INT;
    SlowerNo : INT;
    Heaviest_t : REAL;
    Slower_m_s : REAL;
END_VAR
"""

SELECT_BODY: Final = """\
Status := -1;
SlowerNo := -1;
Heaviest_t := -1.0;
Slower_m_s := 0.0;
FOR Number := 0 TO $LAST_TABLE DO
    IF (CategoryOf[Number] = Category) AND (AxlesOf[Number] = Axles) THEN
        Status := -2;
        IF MassOf[Number] > Heaviest_t THEN
            Heaviest_t := MassOf[Number];
            SlowerNo := -1;
        END_IF;
        (* A later table of equal target does not replace an earlier one. A NaN is not above a target. *)
        IF (MassOf[Number] >= Heaviest_t) AND (TargetOf[Number] <= Commanded_m_s) AND (Commanded_m_s <= GreatestReal)
            AND ((SlowerNo < 0) OR (TargetOf[Number] > Slower_m_s)) THEN
            SlowerNo := Number;
            Slower_m_s := TargetOf[Number];
        END_IF;
    END_IF;
END_FOR;
Loader(TableNo := SlowerNo, Table := Table);
IF SlowerNo >= 0 THEN
    Status := 2;
    IF Slower_m_s >= Commanded_m_s THEN
        Status := 0;
    END_IF;
END_IF;
END_FUNCTION_BLOCK
"""

CHOICE_HEAD: Final = """\
FUNCTION_BLOCK RETARDER_PASSAGES_CHOICES
(* $CHOICES choices by status and target speed. *)
VAR_OUTPUT
    Failed : INT; (* choices that are wrong *)
    FirstFailed : INT; (* the first of them, -1: none *)
END_VAR
VAR
    Selector : RETARDER_SELECT_PASSAGES;
    Table : RETARDER_PASSAGE_TABLE;
    Target : REAL;
    Index : INT;
    Number : INT;
    Agrees : BOOL;
END_VAR
"""

CHOICE_ASKED: Final = """\
    Selector(Category := Category_$PART[Index], Axles := Axles_$PART[Index],
        Commanded_m_s := Commanded_$PART[Index], Table := Table);
    Target := 0.0;
    IF Table.Stages > 0 THEN
        Target := Table.Target_m_s;
    END_IF;
    Agrees := (Selector.Status = Status_$PART[Index]) AND (Target = Target_$PART[Index]);
"""
