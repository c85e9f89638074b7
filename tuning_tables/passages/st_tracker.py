"""The tracker of point sensors in Structured Text, as templates of `string.Template`."""

from __future__ import annotations

from typing import Final

NEXT: Final = """\
FUNCTION_BLOCK RETARDER_NEXT_PASSAGE
(* The first passage of a sensor behind the last one that the cut can have reached since, with the speed there and the
   speed now as far off as allowed; else the last one before it, as the pairs of two passages near to each other may
   come in the other order. The cut rolls farthest if it gains speed first and loses it last, least far if it loses
   first and gains last. *)
VAR_INPUT
    Last : INT; (* the last passage heard; -1: none, and there is no next one *)
    Speed_m_s : REAL; (* there *)
    Time_s : REAL; (* since *)
    Sensor : INT;
    Now_m_s : REAL; (* the speed now *)
END_VAR
VAR_IN_OUT
    Table : RETARDER_PASSAGE_TABLE; (* only read; it is not copied *)
END_VAR
VAR_OUTPUT
    Passage : INT; (* -1: none *)
END_VAR
VAR
    More : REAL;
    Less : REAL;
    Both : REAL;
    HalfGain : REAL;
    HalfLoss : REAL;
    Fast : REAL;
    Slow : REAL;
    FastNow : REAL;
    SlowNow : REAL;
    Gained : REAL;
    Lost : REAL;
    Most : REAL;
    Least : REAL;
    Turn : REAL;
    Rest : REAL;
    Part : REAL;
    Farthest : REAL;
    Nearest : REAL;
    Way : REAL;
    Better : BOOL;
    Index : INT;
END_VAR

Passage := -1;
(* Indices are used only inside this IF: AND may evaluate both of its sides. *)
IF (Last >= 0) AND (Last < Table.Heard) AND (Table.Heard <= $HEARD) THEN
    More := 1.0 + Table.SpeedTolerance;
    Less := 1.0 - Table.SpeedTolerance;
    Both := Table.Acceleration_m_s2 + Table.Deceleration_m_s2;
    HalfGain := 0.5 * Table.Acceleration_m_s2;
    HalfLoss := 0.5 * Table.Deceleration_m_s2;
    Fast := Speed_m_s * More;
    Slow := Speed_m_s * Less;
    FastNow := Now_m_s * More;
    SlowNow := Now_m_s * Less;
    Gained := Table.Acceleration_m_s2 * Time_s;
    Lost := Table.Deceleration_m_s2 * Time_s;
    Most := Fast + Gained;
    Least := Slow - Lost;
    IF (SlowNow <= Most) AND (FastNow >= Least) THEN
        Turn := FastNow - Fast;
        Turn := Turn + Lost;
        Turn := Turn / Both;
        IF Turn < 0.0 THEN
            Turn := 0.0;
        END_IF;
        IF Turn > Time_s THEN
            Turn := Time_s;
        END_IF;
        Rest := Time_s - Turn;
        Part := HalfGain * Turn;
        Part := Fast + Part;
        Part := Turn * Part;
        Farthest := HalfLoss * Rest;
        Farthest := FastNow + Farthest;
        Farthest := Rest * Farthest;
        Farthest := Part + Farthest;
        Farthest := Farthest + Table.PathTolerance_m;
        Turn := Slow - SlowNow;
        Turn := Turn + Gained;
        Turn := Turn / Both;
        IF Turn < 0.0 THEN
            Turn := 0.0;
        END_IF;
        IF Turn > Time_s THEN
            Turn := Time_s;
        END_IF;
        Rest := Time_s - Turn;
        Part := Table.Deceleration_m_s2 * Turn;
        IF Part > Slow THEN (* it may have stood in between *)
            Turn := Slow / Table.Deceleration_m_s2;
            Rest := SlowNow / Table.Acceleration_m_s2;
        END_IF;
        Part := HalfLoss * Turn;
        Part := Slow - Part;
        Part := Turn * Part;
        Nearest := HalfGain * Rest;
        Nearest := SlowNow - Nearest;
        Nearest := Rest * Nearest;
        Nearest := Part + Nearest;
        Nearest := Nearest - Table.PathTolerance_m;
        Index := Table.Heard - 1;
        WHILE Index >= 0 DO
            Better := (Index > Last) OR ((Index < Last) AND (Passage < 0));
            IF Better AND (Table.Sensor[Index] = Sensor) THEN
                Way := Table.Path_m[Index] - Table.Path_m[Last];
                IF (Nearest <= Way) AND (Way <= Farthest) THEN
                    Passage := Index;
                END_IF;
            END_IF;
            Index := Index - 1;
        END_WHILE;
    END_IF;
END_IF;
END_FUNCTION_BLOCK
"""

BELIEVED: Final = """\
FUNCTION_BLOCK RETARDER_BELIEVED_PASSAGE
(* The passage heard that a pulse pair is taken for. A Tracker that cannot be is begun anew. *)
VAR_INPUT
    Sensor : INT;
    Since_s : REAL; (* from the second pulse of the pair before, of whatever sensor, or from RETARDER_BEGIN_CUT *)
    Speed_m_s : REAL; (* base over time *)
END_VAR
VAR_IN_OUT
    Table : RETARDER_PASSAGE_TABLE; (* only read; it is not copied *)
    Tracker : RETARDER_TRACKER;
END_VAR
VAR_OUTPUT
    Passage : INT; (* -1: the pair is not believed *)
END_VAR
VAR
    Beginner : RETARDER_BEGIN_CUT;
    Finder : RETARDER_NEXT_PASSAGE;
    Sound : BOOL;
    First : INT;
    Last : INT;
    Index : INT;
END_VAR
VAR CONSTANT
$LONGEST_WAIT
END_VAR

Passage := -1;
(* Indices are used only inside this IF: AND may evaluate both of its sides. *)
IF (Table.Heard >= 1) AND (Table.Heard <= $HEARD) THEN
    (* No comparison with a NaN is true. *)
    Sound := (Tracker.Passage >= -1) AND (Tracker.Passage < Table.Heard)
        AND (Tracker.Speed_m_s >= 0.0) AND (Tracker.Speed_m_s <= Table.Greatest_m_s)
        AND (Tracker.Time_s >= 0.0) AND (Tracker.Time_s <= LongestWait_s)
        AND (Tracker.Rival >= -1) AND (Tracker.Rival < Table.Heard)
        AND (Tracker.RivalSpeed_m_s >= 0.0) AND (Tracker.RivalSpeed_m_s <= Table.Greatest_m_s)
        AND (Tracker.RivalTime_s >= 0.0) AND (Tracker.RivalTime_s <= LongestWait_s);
    IF NOT Sound THEN
        Beginner(Tracker := Tracker);
    END_IF;
    First := -1;
    IF (Since_s >= 0.0) AND (Since_s <= LongestWait_s) THEN
        Tracker.Time_s := Tracker.Time_s + Since_s;
        IF Tracker.Time_s > LongestWait_s THEN
            Tracker.Time_s := LongestWait_s;
        END_IF;
        Tracker.RivalTime_s := Tracker.RivalTime_s + Since_s;
        IF Tracker.RivalTime_s > LongestWait_s THEN
            Tracker.RivalTime_s := LongestWait_s;
        END_IF;
        IF (Speed_m_s >= Table.Least_m_s) AND (Speed_m_s <= Table.Greatest_m_s) THEN
            Index := Table.Heard - 1;
            WHILE Index >= 0 DO
                IF Table.Sensor[Index] = Sensor THEN
                    First := Index;
                END_IF;
                Index := Index - 1;
            END_WHILE;
        END_IF;
    END_IF;
    IF First >= 0 THEN
        Last := Tracker.Passage;
        IF (Tracker.Passage < 0) AND (Tracker.Rival < 0) THEN
            Passage := First;
        ELSE
            Finder(Last := Tracker.Passage, Speed_m_s := Tracker.Speed_m_s, Time_s := Tracker.Time_s,
                Sensor := Sensor, Now_m_s := Speed_m_s, Table := Table);
            Passage := Finder.Passage;
            IF Passage < 0 THEN
                Last := Tracker.Rival;
                Finder(Last := Tracker.Rival, Speed_m_s := Tracker.RivalSpeed_m_s, Time_s := Tracker.RivalTime_s,
                    Sensor := Sensor, Now_m_s := Speed_m_s, Table := Table);
                Passage := Finder.Passage;
            END_IF;
        END_IF;
        IF Passage >= 0 THEN
            Tracker.Passage := Passage;
            IF Last > Passage THEN
                Tracker.Passage := Last;
            END_IF;
            Tracker.Speed_m_s := Speed_m_s;
            Tracker.Time_s := 0.0;
            Tracker.Rival := -1;
        ELSE
            Tracker.Rival := First;
            Tracker.RivalSpeed_m_s := Speed_m_s;
            Tracker.RivalTime_s := 0.0;
        END_IF;
    END_IF;
END_IF;
END_FUNCTION_BLOCK
"""
