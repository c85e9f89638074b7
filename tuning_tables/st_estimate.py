"""The fixed part of the Structured Text export about an estimate: type, beginning, work along the path, interface.

In the subset that `st_blocks` keeps to. Books without estimator have the same blocks with the same interface;
RETARDER_OBSERVE then hands the speed on.
"""

from __future__ import annotations

from typing import Final

ESTIMATE_TYPE: Final = """\
TYPE
    (* What is known of the cut in the retarder: closed, to be begun by RETARDER_BEGIN, one for each cut. *)
    RETARDER_ESTIMATE : STRUCT
        Begun : BOOL; (* a speed was measured *)
        Path_m : REAL;
        Speed_m_s : REAL;
        Factor : REAL; (* of the friction of this cut *)
        Excess : REAL; (* of its running resistance over the mean, m/s2 *)
        SpeedVariance : REAL;
        FactorCovariance : REAL; (* of speed and factor *)
        ExcessCovariance : REAL; (* of speed and excess *)
        FactorVariance : REAL;
        CrossCovariance : REAL; (* of factor and excess *)
        ExcessVariance : REAL;
        Unseen : REAL; (* samples since the last reading that was believed *)
        Reading_m_s : REAL; (* the last that can be true *)
        Repeated : REAL; (* how often it was the same again *)
        Believed : REAL; (* readings since the estimate began *)
        Doubted : REAL; (* readings in a row *)
    END_STRUCT;
END_TYPE
"""

TABLE_MEMBERS: Final = """
        Estimator : INT; (* its number in the book, -1: none, the lines are for the measured speed *)
        Breaks : INT; (* of the estimator, 0: none *)
$NUMBER_MEMBERS
        BreakPath_m : ARRAY[0..$LAST_BREAK] OF REAL;
        Drive : ARRAY[0..$LAST_BREAK] OF REAL; (* work of grade and resistance up to a break, m2/s2 *)
        Brake : ARRAY[0..$LAST_BREAK] OF REAL; (* work of the brake for each kPa, m2/s2 *)"""

BEGIN: Final = """\
FUNCTION_BLOCK RETARDER_BEGIN
(* To be called once for each cut before its first sample: forgets the last cut. *)
VAR_IN_OUT
    Estimate : RETARDER_ESTIMATE;
END_VAR

Estimate.Begun := FALSE;
Estimate.Path_m := 0.0;
Estimate.Speed_m_s := 0.0;
Estimate.Factor := 0.0;
Estimate.Excess := 0.0;
Estimate.SpeedVariance := 0.0;
Estimate.FactorCovariance := 0.0;
Estimate.ExcessCovariance := 0.0;
Estimate.FactorVariance := 0.0;
Estimate.CrossCovariance := 0.0;
Estimate.ExcessVariance := 0.0;
Estimate.Unseen := 0.0;
Estimate.Reading_m_s := 0.0;
Estimate.Repeated := 0.0;
Estimate.Believed := 0.0;
Estimate.Doubted := 0.0;
END_FUNCTION_BLOCK
"""

WORK: Final = """\
FUNCTION_BLOCK RETARDER_WORK
(* What grade and brake have done from the entrance to a path, from broken lines; part of RETARDER_OBSERVE. *)
VAR_INPUT
    Path_m : REAL; (* a number *)
END_VAR
VAR_IN_OUT
    Table : RETARDER_TABLE; (* only read; it is not copied *)
END_VAR
VAR_OUTPUT
    Drive : REAL; (* m2/s2 *)
    Brake : REAL; (* m2/s2 for each kPa *)
END_VAR
VAR
    Place : REAL;
    Span : REAL;
    Share : REAL;
    Rise : REAL;
    First : INT;
    Index : INT;
END_VAR

Drive := 0.0;
Brake := 0.0;
IF (Table.Breaks >= 2) AND (Table.Breaks <= $BREAKS) THEN
    Place := Path_m;
    IF Place < Table.BreakPath_m[0] THEN
        Place := Table.BreakPath_m[0];
    END_IF;
    IF Place > Table.BreakPath_m[Table.Breaks - 1] THEN
        Place := Table.BreakPath_m[Table.Breaks - 1];
    END_IF;
    First := 0;
    FOR Index := 1 TO Table.Breaks - 2 DO
        IF Place > Table.BreakPath_m[Index] THEN
            First := Index;
        END_IF;
    END_FOR;
    Span := Table.BreakPath_m[First + 1] - Table.BreakPath_m[First];
    Share := Place - Table.BreakPath_m[First];
    Share := Share / Span;
    Rise := Table.Drive[First + 1] - Table.Drive[First];
    Rise := Share * Rise;
    Drive := Table.Drive[First] + Rise;
    Rise := Table.Brake[First + 1] - Table.Brake[First];
    Rise := Share * Rise;
    Brake := Table.Brake[First] + Rise;
END_IF;
END_FUNCTION_BLOCK
"""

OBSERVE_INTERFACE: Final = """\
FUNCTION_BLOCK RETARDER_OBSERVE
(* To be called once at every sample, also while a change of stage is under way. What cannot be true is not believed: a
   speed above $LARGEST_SPEED m/s, negative or not finite (a missing reading: hand over -1.0) corrects nothing; such an
   overpressure (above $LARGEST_OVERPRESSURE kPa) counts as 0; a path that goes back, or on by more than
   $LARGEST_STEP m, as no movement. With an estimator a reading that leapt away from the estimate, one that repeats
   itself and a 0.0 where the cut moves are doubted, and correct nothing; without one a reading of 0.0 is believed: the
   cut stands, so the brake is released. If the radar shows 0.0 where it has lost its target, hand over -1.0 then. *)
VAR_INPUT
    Path_m : REAL; (* first axle, from the entrance of the first retarder *)
    Speed_m_s : REAL; (* measured *)
    Overpressure_kpa : REAL; (* mean of the pressure above Table.Touch_kpa, not below 0, since the sample before *)
END_VAR
VAR_IN_OUT
    Table : RETARDER_TABLE; (* only read; it is not copied *)
    Estimate : RETARDER_ESTIMATE;
END_VAR
VAR_OUTPUT
    Observed_m_s : REAL; (* to ask RETARDER_DECIDE with; -1.0, at which it holds, before a speed was measured *)
    Unseen : REAL; (* for how many samples no reading was believed; without estimator every speed that can be true is:
        0 after one that was; before the first, since RETARDER_BEGIN; stays at 16777216. The estimate goes on by the
        model alone: the supervision compares Unseen with a limit of its own, and acts. *)
    Alarms : INT; (* 0: none, or no estimator; else a sum of
        $LOST_ALARM: the speed is known too badly, so that Observed_m_s is lower than the estimate;
        $SENSOR_ALARM: readings of the radar are doubted, or one repeats itself;
        $LIGHTER_ALARM: the brake works more on this cut than on any of its category;
        $HEAVIER_ALARM: it works less. *)
END_VAR
"""

HAND_ON: Final = """
(* No table of this book has an estimator: their lines are for the measured speed. *)
Observed_m_s := Speed_m_s;
Unseen := Estimate.Unseen + 1.0;
(* No comparison with a NaN is true. *)
IF (Speed_m_s >= 0.0) AND (Speed_m_s <= $LARGEST_SPEED_REAL) THEN
    Unseen := 0.0;
END_IF;
Estimate.Unseen := Unseen;
Alarms := 0;
END_FUNCTION_BLOCK
"""
