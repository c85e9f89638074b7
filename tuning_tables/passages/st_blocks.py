"""The fixed part of the Structured Text for point sensors: the head comment, the types, the rule and the step.

The texts are templates of `string.Template` in the subset that `tuning_tables.st_blocks` keeps to, with WHILE for loops
over as much as a table has (`tuning_tables.st_loops`); the tracker's stand in `st_tracker`.
"""

from __future__ import annotations

from string import Template
from typing import Final

HEAD: Final = Template(
    """\
(* Controller tables of a car retarder with point sensors, and what a regulator does at a pulse pair: IEC 61131-3
   Structured Text. Generated: do not edit, export again. This text may be used, changed and passed on without any
   condition.

$ORIGIN
   categories, whose numbers are the same in every export:
$CATEGORIES

   Blocks
   RETARDER_SELECT_PASSAGES   once for a cut, when its class and exit speed are known: fills a RETARDER_PASSAGE_TABLE
   RETARDER_LOAD_PASSAGES     used by it: a table by its number
   RETARDER_BEGIN_CUT         once for a cut, before its first pulse: nothing is known of it
   RETARDER_AT_PULSE          at the second pulse of every pair, of whatever sensor and axle: the stage to command
   RETARDER_BELIEVED_PASSAGE  used by it: which axle over which sensor the pair was, if it can be believed
   RETARDER_NEXT_PASSAGE      used by that
   RETARDER_WANTED_STAGE      used by RETARDER_AT_PULSE: the stage that the table wants at a passage

   The rule
   1. A speed that is not finite, a negative speed, or a passage or stage that the table has not: the stage stays.
   2. From the stage in force the stage goes up while the speed is above the switching speed there, else down while it
      is below. A speed equal to a switching speed changes nothing.
   3. At the passages before the entrance no stage above EntranceStage is entered.
   4. Nothing is commanded at a pair that is not believed, and while a change of stage was not over by the middle
      between the two pulses.

   The interlock is the program's: the regulator may take over a cut only when the cut ahead has left the position, its
   last axle out of the last retarder, and then only when the stage commanded is at most EntranceStage.

   Arithmetic. Every operation on REAL stands in a statement of its own, so that its result is rounded to REAL
   (binary32) before the next; see docs/structured-text.md.

   Not done: no compiler of a vendor has seen this text. It was parsed, and its parse tree evaluated in binary32
   against the reference implementation. *)
"""
)

TABLE_TYPE: Final = """\
TYPE
    RETARDER_PASSAGE_TABLE : STRUCT
        Target_m_s : REAL; (* exit speed aimed at *)
        Base_m : REAL; (* distance of the two coils of a sensor *)
        Least_m_s : REAL; (* limits of the tracker: credible speeds *)
        Greatest_m_s : REAL;
        Acceleration_m_s2 : REAL; (* the greatest of a cut *)
        Deceleration_m_s2 : REAL;
        SpeedTolerance : REAL; (* relative *)
        PathTolerance_m : REAL;
        Stages : INT; (* stages 0 to Stages - 1; 0: no table *)
        Heard : INT; (* passages of axles over sensors, in the order of the path: each gives a pulse pair *)
        Passages : INT; (* of them, those at which is decided, numbered from 0 *)
        BeforeEntrance : INT; (* of these: the first ones *)
        EntranceStage : INT; (* no stage above it is entered at these *)
        InitialStage : INT; (* at rest when the regulator takes over a cut *)
        Path_m : ARRAY[0..$LAST_HEARD] OF REAL; (* of the first axle, at each passage heard *)
        Sensor : ARRAY[0..$LAST_HEARD] OF INT; (* its number, from 0 *)
        Deciding : ARRAY[0..$LAST_HEARD] OF INT; (* the passage at which is decided; -1: none *)
        (* at (passage * $STAGES + stage in force) * $SPEEDS + j: it parts stage j from stage j + 1 *)
        Switching_m_s : ARRAY[0..$LAST_SPEED] OF REAL;
    END_STRUCT;
END_TYPE
"""

TRACKER_TYPE: Final = """\
TYPE
    (* What is known of the cut in the retarder: closed, one for each cut. *)
    RETARDER_TRACKER : STRUCT
        Passage : INT; (* the last passage heard that was believed; -1: none *)
        Speed_m_s : REAL; (* there *)
        Time_s : REAL; (* since *)
        Rival : INT; (* the same of the last pair that was not believed *)
        RivalSpeed_m_s : REAL;
        RivalTime_s : REAL;
    END_STRUCT;
END_TYPE
"""

BEGIN: Final = """\
FUNCTION_BLOCK RETARDER_BEGIN_CUT
VAR_IN_OUT
    Tracker : RETARDER_TRACKER;
END_VAR

Tracker.Passage := -1;
Tracker.Speed_m_s := 0.0;
Tracker.Time_s := 0.0;
Tracker.Rival := -1;
Tracker.RivalSpeed_m_s := 0.0;
Tracker.RivalTime_s := 0.0;
END_FUNCTION_BLOCK
"""

WANTED: Final = """\
FUNCTION_BLOCK RETARDER_WANTED_STAGE
VAR_INPUT
    Passage : INT; (* at which is decided, from 0 *)
    Stage : INT; (* in force *)
    Speed_m_s : REAL; (* read there *)
END_VAR
VAR_IN_OUT
    Table : RETARDER_PASSAGE_TABLE; (* only read; it is not copied *)
END_VAR
VAR_OUTPUT
    Wanted : INT; (* the stage wanted; Stage: hold *)
END_VAR
VAR
    Credible : BOOL;
    First : INT;
    Highest : INT;
    Index : INT;
END_VAR
VAR CONSTANT
$GREATEST_REAL
END_VAR

Wanted := Stage;
(* No comparison with a NaN is true. *)
Credible := (Speed_m_s >= 0.0) AND (Speed_m_s <= GreatestReal)
    AND (Passage >= 0) AND (Passage < Table.Passages) AND (Stage >= 0) AND (Stage < Table.Stages)
    AND (Table.Passages <= $PASSAGES) AND (Table.Stages <= $STAGES);
(* Indices are used only inside this IF: AND may evaluate both of its sides. *)
IF Credible THEN
    First := (Passage * $STAGES + Stage) * $SPEEDS;
    Highest := Table.Stages - 1;
    IF (Passage < Table.BeforeEntrance) AND (Table.EntranceStage < Highest) THEN
        Highest := Table.EntranceStage;
    END_IF;
    Index := Stage;
    WHILE Index < Highest DO
        IF (Wanted = Index) AND (Speed_m_s > Table.Switching_m_s[First + Index]) THEN
            Wanted := Index + 1;
        END_IF;
        Index := Index + 1;
    END_WHILE;
    IF Wanted = Stage THEN
        Index := Stage - 1;
        WHILE Index >= 0 DO
            IF (Wanted = Index + 1) AND (Speed_m_s < Table.Switching_m_s[First + Index]) THEN
                Wanted := Index;
            END_IF;
            Index := Index - 1;
        END_WHILE;
    END_IF;
END_IF;
END_FUNCTION_BLOCK
"""

AT_PULSE: Final = """\
FUNCTION_BLOCK RETARDER_AT_PULSE
(* To be called at the second pulse of every pair, of whatever sensor and axle, also while a change of stage is under
   way. *)
VAR_INPUT
    Sensor : INT; (* its number, from 0 in the order of the path *)
    Since_s : REAL; (* from the second pulse of the pair before, of whatever sensor, or from RETARDER_BEGIN_CUT *)
    OverBase_s : REAL; (* from the first pulse of the pair to the second *)
    Stage : INT; (* the one commanded last *)
    TransientEnded : BOOL; (* the change to it had ended by the middle between the pulses *)
END_VAR
VAR_IN_OUT
    Table : RETARDER_PASSAGE_TABLE; (* only read; it is not copied *)
    Tracker : RETARDER_TRACKER;
END_VAR
VAR_OUTPUT
    Command : INT; (* the stage to command; Stage: command nothing *)
END_VAR
VAR
    Believer : RETARDER_BELIEVED_PASSAGE;
    Wanter : RETARDER_WANTED_STAGE;
    Speed : REAL;
END_VAR
VAR CONSTANT
$SHORTEST_READING
$LONGEST_WAIT
END_VAR

Speed := -1.0;
IF (OverBase_s >= ShortestReading_s) AND (OverBase_s <= LongestWait_s) THEN
    Speed := Table.Base_m / OverBase_s;
END_IF;
Believer(Sensor := Sensor, Since_s := Since_s, Speed_m_s := Speed, Table := Table, Tracker := Tracker);
Command := Stage;
IF TransientEnded AND (Believer.Passage >= 0) THEN
    Wanter(Passage := Table.Deciding[Believer.Passage], Stage := Stage, Speed_m_s := Speed, Table := Table);
    Command := Wanter.Wanted;
END_IF;
END_FUNCTION_BLOCK
"""

LOAD_DECLARATIONS: Final = """\
FUNCTION_BLOCK RETARDER_LOAD_PASSAGES
(* A table of the export as it stands. *)
VAR_INPUT
    TableNo : INT; (* 0 to $LAST_TABLE *)
END_VAR
VAR_IN_OUT
    Table : RETARDER_PASSAGE_TABLE; (* filled; where there is no such table its Stages become 0: nothing is commanded *)
END_VAR
VAR_OUTPUT
    Found : BOOL; (* there is such a table *)
END_VAR
VAR
    Index : INT;
END_VAR
"""

LOAD_BODY: Final = """\
Found := (TableNo >= 0) AND (TableNo <= $LAST_TABLE);
Table.Stages := 0;
Table.Heard := 0;
Table.Passages := 0;
IF Found THEN
$MEMBERS
    CASE TableNo OF
$CASES
    END_CASE;
END_IF;
END_FUNCTION_BLOCK
"""
