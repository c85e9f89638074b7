"""The rule in the Structured Text export: a template in the subset of the language that `st_blocks` describes."""

from __future__ import annotations

from typing import Final

DECIDE: Final = """\
FUNCTION_BLOCK RETARDER_DECIDE
(* $ASKED *)
VAR_INPUT
    Stage : INT; (* $STAGE_MEANT, 0: released *)
    Path_m : REAL; (* first axle, from the entrance of the first retarder *)
    Speed_m_s : REAL; (* that of RETARDER_OBSERVE *)$PRESSURE_INPUT
END_VAR
VAR_IN_OUT
    Table : RETARDER_TABLE; (* only read; it is not copied *)
END_VAR
VAR_OUTPUT
    Wanted : INT; (* the stage to command; Stage itself: command nothing *)
END_VAR
VAR
    Credible : BOOL;
    Asking : BOOL;
    Path : REAL;
    Line : REAL;
    Farthest : INT; (* stages that one command may go *)
    Asked : INT;
    Answer : INT; (* of one stage: -1 lower, 0 hold, 1 raise *)
    Before : INT; (* that of the stage before; 0: there was none *)
    First : INT;
    Power : INT;$PRESSURE_VARIABLES
END_VAR

Wanted := Stage;
(* No comparison with a NaN is true. 3.4028235E+38 is the largest REAL, rounded up in its last digit. *)
Credible := (Path_m >= -3.4028235E+38) AND (Path_m <= 3.4028235E+38)
    AND (Speed_m_s >= 0.0) AND (Speed_m_s <= 3.4028235E+38)
    AND (Stage >= 0) AND (Stage < Table.Stages)
    AND (Table.Stages <= $STAGES) AND (Table.Powers >= 1) AND (Table.Powers <= $POWERS);
(* Indices are used only inside this IF: AND may evaluate both of its sides. *)
IF Credible THEN
    Path := Path_m;
    IF Path < Table.PathMin_m THEN
        Path := Table.PathMin_m;
    END_IF;
    IF Path > Table.PathMax_m THEN
        Path := Table.PathMax_m;
    END_IF;$ABOVE
    Farthest := Table.Stages - 1;$FARTHEST
    Before := 0;
    Asking := TRUE;
    FOR Asked := 1 TO Farthest DO
        IF Asking THEN
            Answer := 0;
            IF Table.HasLower[Wanted] THEN
                First := Wanted * $STRIDE;
                Line := Table.Coefficient[First + Table.Powers - 1];
                FOR Power := Table.Powers - 2 TO 0 BY -1 DO
                    Line := Line * Path;
                    Line := Line + Table.Coefficient[First + Power];
                END_FOR;$LOWER_RISE
                IF Speed_m_s < Line THEN
                    Answer := -1;
                END_IF;
            END_IF;
            IF (Answer = 0) AND Table.HasUpper[Wanted]$GATE THEN
                First := Wanted * $STRIDE + $POWERS;
                Line := Table.Coefficient[First + Table.Powers - 1];
                FOR Power := Table.Powers - 2 TO 0 BY -1 DO
                    Line := Line * Path;
                    Line := Line + Table.Coefficient[First + Power];
                END_FOR;$UPPER_RISE
                IF Speed_m_s > Line THEN
                    Answer := 1;
                END_IF;
            END_IF;
            (* A damaged table may ask for a stage that it has not. *)
            Asking := (Answer <> 0) AND (Answer + Before <> 0)
                AND (Wanted + Answer >= 0) AND (Wanted + Answer < Table.Stages);
            IF Asking THEN
                Wanted := Wanted + Answer;
                Before := Answer;
            END_IF;
        END_IF;
    END_FOR;
END_IF;
END_FUNCTION_BLOCK
"""
