"""The fixed part of the Structured Text export about the estimator, in the subset that `st_blocks` keeps to.

Books without estimator have the same blocks with the same interface; RETARDER_OBSERVE then hands the speed on.
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
        SpeedVariance : REAL;
        Covariance : REAL;
        FactorVariance : REAL;
        Unseen : REAL; (* samples since the last speed that can be true *)
    END_STRUCT;
END_TYPE
"""

TABLE_MEMBERS: Final = """
        Estimator : INT; (* its number in the book, -1: none, the lines are for the measured speed *)
        Breaks : INT; (* of the estimator, 0: none *)
        SpeedVariance : REAL; (* of a measured speed, m2/s2 *)
        FactorVariance : REAL; (* of the friction factor of cuts *)
        PathVariance : REAL; (* of the friction along the path, times its correlation length, m *)
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
Estimate.SpeedVariance := 0.0;
Estimate.Covariance := 0.0;
Estimate.FactorVariance := 0.0;
Estimate.Unseen := 0.0;
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
   $LARGEST_STEP m, as no movement. A reading of 0.0 is believed: the cut stands, so the brake is released, and Unseen
   stays 0. If the radar shows 0.0 where it has lost its target, hand over -1.0 in place of that. *)
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
    Unseen : REAL; (* for how many samples no speed that can be true was handed over, with an estimator or without: 0
        after one that was; before the first, since RETARDER_BEGIN; stays at 16777216. The estimate goes on by the model
        alone, without limit: the supervision compares Unseen with a limit of its own, and acts. *)
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
END_FUNCTION_BLOCK
"""

OBSERVE: Final = """\
VAR
    Worker : RETARDER_WORK;
    Credible : BOOL;
    Path : REAL;
    Before : REAL;
    Farthest : REAL;
    Pressure : REAL;
    DriveGain : REAL;
    BrakeGain : REAL;
    WorkAtOne : REAL;
    Gained : REAL;
    Speed : REAL;
    Mean : REAL;
    Predicted : REAL;
    Slope : REAL;
    Effect : REAL;
    Way : REAL;
    PathPart : REAL;
    SpeedPart : REAL;
    CrossPart : REAL;
    FactorPart : REAL;
    Total : REAL;
    Gain : REAL;
    FactorGain : REAL;
    Surprise : REAL;
    Change : REAL;
END_VAR
VAR CONSTANT
    LeastSpeed_m_s : REAL := $LEAST_SPEED_REAL;
    LeastWay_m : REAL := $LEAST_STEP_REAL;
    LeastFactor : REAL := $LEAST_FACTOR_REAL;
    LargestFactor : REAL := $LARGEST_FACTOR_REAL;
    LargestSpeed_m_s : REAL := $LARGEST_SPEED_REAL;
    LargestPressure_kpa : REAL := $LARGEST_OVERPRESSURE_REAL;
    LargestWay_m : REAL := $LARGEST_STEP_REAL;
END_VAR

(* No comparison with a NaN is true. *)
Credible := (Speed_m_s >= 0.0) AND (Speed_m_s <= LargestSpeed_m_s);
Unseen := Estimate.Unseen + 1.0;
IF Table.Breaks = 0 THEN
    Observed_m_s := Speed_m_s;
ELSIF (Table.Breaks < 2) OR (Table.Breaks > $BREAKS) THEN
    Observed_m_s := -1.0;
    Credible := FALSE;
ELSIF NOT Estimate.Begun THEN
    Observed_m_s := -1.0;
    IF Credible THEN
        Path := Table.BreakPath_m[0];
        IF (Path_m >= Path) AND (Path_m <= Table.BreakPath_m[Table.Breaks - 1]) THEN
            Path := Path_m;
        END_IF;
        Estimate.Begun := TRUE;
        Estimate.Path_m := Path;
        Estimate.Speed_m_s := Speed_m_s;
        IF Estimate.Speed_m_s < LeastSpeed_m_s THEN
            Estimate.Speed_m_s := LeastSpeed_m_s;
        END_IF;
        Estimate.Factor := 1.0;
        Estimate.SpeedVariance := Table.SpeedVariance;
        Estimate.Covariance := 0.0;
        Estimate.FactorVariance := Table.FactorVariance;
        Observed_m_s := Estimate.Speed_m_s;
    END_IF;
ELSE
    Before := Estimate.Path_m;
    Farthest := Before + LargestWay_m;
    Path := Before;
    IF (Path_m >= Before) AND (Path_m <= Farthest) THEN
        Path := Path_m;
    END_IF;
    Pressure := 0.0;
    IF (Overpressure_kpa >= 0.0) AND (Overpressure_kpa <= LargestPressure_kpa) THEN
        Pressure := Overpressure_kpa;
    END_IF;
    (* Speed and covariance are carried on by the work done on the way. *)
    Worker(Path_m := Path, Table := Table);
    DriveGain := Worker.Drive;
    BrakeGain := Worker.Brake;
    Worker(Path_m := Before, Table := Table);
    DriveGain := DriveGain - Worker.Drive;
    BrakeGain := BrakeGain - Worker.Brake;
    WorkAtOne := Pressure * BrakeGain;
    Gained := Estimate.Factor * WorkAtOne;
    Gained := DriveGain - Gained;
    Speed := Estimate.Speed_m_s;
    Change := Gained / Speed;
    Mean := Speed + Speed;
    Mean := Mean + Change;
    Mean := Mean / 2.0;
    IF Mean < LeastSpeed_m_s THEN
        Mean := LeastSpeed_m_s;
    END_IF;
    Change := Gained / Mean;
    Predicted := Speed + Change;
    IF Predicted < LeastSpeed_m_s THEN
        Predicted := LeastSpeed_m_s;
    END_IF;
    Slope := Speed / Predicted;
    Effect := WorkAtOne / Mean;
    Way := Path - Before;
    IF Way < LeastWay_m THEN
        Way := LeastWay_m;
    END_IF;
    PathPart := Table.PathVariance / Way;
    SpeedPart := Slope * Slope;
    SpeedPart := SpeedPart * Estimate.SpeedVariance;
    CrossPart := 2.0 * Slope;
    CrossPart := CrossPart * Effect;
    CrossPart := CrossPart * Estimate.Covariance;
    PathPart := Estimate.FactorVariance + PathPart;
    FactorPart := Effect * Effect;
    FactorPart := FactorPart * PathPart;
    SpeedPart := SpeedPart - CrossPart;
    SpeedPart := SpeedPart + FactorPart;
    CrossPart := Slope * Estimate.Covariance;
    FactorPart := Effect * Estimate.FactorVariance;
    CrossPart := CrossPart - FactorPart;
    Estimate.Path_m := Path;
    Estimate.Speed_m_s := Predicted;
    Estimate.SpeedVariance := SpeedPart;
    Estimate.Covariance := CrossPart;
    IF Credible THEN
        (* The measured speed is weighed by the covariance. *)
        Total := SpeedPart + Table.SpeedVariance;
        Gain := SpeedPart / Total;
        FactorGain := CrossPart / Total;
        Surprise := Speed_m_s - Predicted;
        Change := Gain * Surprise;
        Estimate.Speed_m_s := Predicted + Change;
        IF Estimate.Speed_m_s < LeastSpeed_m_s THEN
            Estimate.Speed_m_s := LeastSpeed_m_s;
        END_IF;
        Change := FactorGain * Surprise;
        Estimate.Factor := Estimate.Factor + Change;
        IF Estimate.Factor < LeastFactor THEN
            Estimate.Factor := LeastFactor;
        END_IF;
        IF Estimate.Factor > LargestFactor THEN
            Estimate.Factor := LargestFactor;
        END_IF;
        Change := FactorGain * CrossPart;
        Estimate.FactorVariance := Estimate.FactorVariance - Change;
        IF Estimate.FactorVariance < 0.0 THEN
            Estimate.FactorVariance := 0.0;
        END_IF;
        Change := Gain * CrossPart;
        Estimate.Covariance := CrossPart - Change;
        Change := Gain * SpeedPart;
        Estimate.SpeedVariance := SpeedPart - Change;
    END_IF;
    Observed_m_s := Estimate.Speed_m_s;
END_IF;
IF Credible THEN
    Unseen := 0.0;
END_IF;
Estimate.Unseen := Unseen;
END_FUNCTION_BLOCK
"""
