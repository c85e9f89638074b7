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
        $CATEGORY_ALARM: the brake works on this cut as on none of its category. *)
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

OBSERVE: Final = """\
VAR
    Worker : RETARDER_WORK;
    Sensible : BOOL;
    Fresh : BOOL;
    Moves : BOOL;
    Leaps : BOOL;
    Strange : BOOL;
    Anew : BOOL;
    Seen : BOOL; (* this reading is believed *)
    Path : REAL;
    Before : REAL;
    Farthest : REAL;
    Pressure : REAL;
    Reading : REAL;
    DriveGain : REAL;
    BrakeGain : REAL;
    WorkAtOne : REAL;
    Gained : REAL;
    Speed : REAL;
    Mean : REAL;
    Predicted : REAL;
    Slope : REAL;
    Effect : REAL;
    Drag : REAL;
    Way : REAL;
    PathPart : REAL;
    SpeedPart : REAL;
    CrossPart : REAL;
    ExcessPart : REAL;
    Total : REAL;
    Gain : REAL;
    FactorGain : REAL;
    ExcessGain : REAL;
    Surprise : REAL;
    Square : REAL;
    Bound : REAL;
    Leap : REAL;
    Most : REAL;
    Change : REAL;
END_VAR
VAR CONSTANT
    LeastSpeed_m_s : REAL := $LEAST_SPEED_REAL;
    LeastWay_m : REAL := $LEAST_STEP_REAL;
    LeastFactor : REAL := $LEAST_FACTOR_REAL;
    LargestFactor : REAL := $LARGEST_FACTOR_REAL;
    LargestExcess : REAL := $LARGEST_EXCESS_REAL;
    LargestSpeed_m_s : REAL := $LARGEST_SPEED_REAL;
    LargestPressure_kpa : REAL := $LARGEST_OVERPRESSURE_REAL;
    LargestWay_m : REAL := $LARGEST_STEP_REAL;
    GateSquared : REAL := $GATE_SQUARED_REAL;
    FewReadings : REAL := $FEW_READINGS_REAL;
END_VAR

(* No comparison with a NaN is true. *)
Sensible := (Speed_m_s >= 0.0) AND (Speed_m_s <= LargestSpeed_m_s);
Unseen := Estimate.Unseen + 1.0;
Alarms := 0;
Seen := FALSE;
Anew := FALSE;
IF Table.Breaks = 0 THEN
    Observed_m_s := Speed_m_s;
    Seen := Sensible;
ELSIF (Table.Breaks < 2) OR (Table.Breaks > $BREAKS) THEN
    Observed_m_s := -1.0;
ELSE
    Reading := Estimate.Reading_m_s;
    IF Sensible AND (Speed_m_s = Reading) THEN
        Estimate.Repeated := Estimate.Repeated + 1.0;
    ELSE
        Estimate.Repeated := 0.0;
    END_IF;
    IF Sensible THEN
        Estimate.Reading_m_s := Speed_m_s;
    END_IF;
    Fresh := Sensible AND (Estimate.Repeated < Table.Frozen);
    Moves := Speed_m_s >= LeastSpeed_m_s;
    IF NOT Estimate.Begun THEN
        Path := Table.BreakPath_m[0];
        IF (Path_m >= Path) AND (Path_m <= Table.BreakPath_m[Table.Breaks - 1]) THEN
            Path := Path_m;
        END_IF;
        Anew := Fresh AND Moves;
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
        (* Speed and covariances are carried on by the work done on the way. *)
        Worker(Path_m := Path, Table := Table);
        DriveGain := Worker.Drive;
        BrakeGain := Worker.Brake;
        Worker(Path_m := Before, Table := Table);
        DriveGain := DriveGain - Worker.Drive;
        BrakeGain := BrakeGain - Worker.Brake;
        Way := Path - Before;
        WorkAtOne := Pressure * BrakeGain;
        Change := Estimate.Excess * Way;
        Gained := DriveGain - Change;
        Change := Estimate.Factor * WorkAtOne;
        Gained := Gained - Change;
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
        Drag := Way / Mean;
        IF Way < LeastWay_m THEN
            Way := LeastWay_m;
        END_IF;
        PathPart := Table.PathVariance / Way;
        CrossPart := Slope * Estimate.FactorCovariance;
        Change := Effect * Estimate.FactorVariance;
        CrossPart := CrossPart - Change;
        Change := Drag * Estimate.CrossCovariance;
        CrossPart := CrossPart - Change;
        ExcessPart := Slope * Estimate.ExcessCovariance;
        Change := Effect * Estimate.CrossCovariance;
        ExcessPart := ExcessPart - Change;
        Change := Drag * Estimate.ExcessVariance;
        ExcessPart := ExcessPart - Change;
        SpeedPart := Slope * Estimate.SpeedVariance;
        Change := Effect * Estimate.FactorCovariance;
        SpeedPart := SpeedPart - Change;
        Change := Drag * Estimate.ExcessCovariance;
        SpeedPart := SpeedPart - Change;
        SpeedPart := Slope * SpeedPart;
        Change := Effect * PathPart;
        Change := CrossPart - Change;
        Change := Effect * Change;
        SpeedPart := SpeedPart - Change;
        Change := Drag * ExcessPart;
        SpeedPart := SpeedPart - Change;
        IF SpeedPart < 0.0 THEN
            SpeedPart := 0.0;
        END_IF;
        Estimate.Path_m := Path;
        Estimate.Speed_m_s := Predicted;
        Estimate.SpeedVariance := SpeedPart;
        Estimate.FactorCovariance := CrossPart;
        Estimate.ExcessCovariance := ExcessPart;
        IF Fresh THEN
            Total := SpeedPart + Table.SpeedVariance;
            Surprise := Speed_m_s - Predicted;
            Leap := Speed_m_s - Reading;
            Change := Predicted - Speed;
            Leap := Leap - Change;
            Most := Table.Leap + Effect;
            Change := 0.0 - Most;
            Leaps := (Leap > Most) OR (Leap < Change);
            Strange := NOT Moves;
            IF Estimate.Unseen = 0.0 THEN
                Strange := Leaps;
            END_IF;
            Square := Surprise * Surprise;
            Bound := GateSquared * Total;
            IF (Square > Bound) AND (Strange OR (Estimate.Doubted > 0.0)) THEN
                (* The reading is doubted. *)
                IF Moves AND (NOT Leaps) THEN
                    Estimate.Doubted := Estimate.Doubted + 1.0;
                ELSE
                    Estimate.Doubted := 1.0;
                END_IF;
                Anew := Moves AND ((Estimate.Believed < FewReadings) OR (Estimate.Doubted >= Table.Doubted));
            ELSE
                (* The reading is weighed by the covariances. *)
                Seen := TRUE;
                Gain := SpeedPart / Total;
                FactorGain := CrossPart / Total;
                ExcessGain := ExcessPart / Total;
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
                Change := ExcessGain * Surprise;
                Estimate.Excess := Estimate.Excess + Change;
                Change := 0.0 - LargestExcess;
                IF Estimate.Excess < Change THEN
                    Estimate.Excess := Change;
                END_IF;
                IF Estimate.Excess > LargestExcess THEN
                    Estimate.Excess := LargestExcess;
                END_IF;
                Change := Gain * SpeedPart;
                Estimate.SpeedVariance := SpeedPart - Change;
                Change := Gain * CrossPart;
                Estimate.FactorCovariance := CrossPart - Change;
                Change := Gain * ExcessPart;
                Estimate.ExcessCovariance := ExcessPart - Change;
                Change := FactorGain * CrossPart;
                Estimate.FactorVariance := Estimate.FactorVariance - Change;
                IF Estimate.FactorVariance < 0.0 THEN
                    Estimate.FactorVariance := 0.0;
                END_IF;
                Change := FactorGain * ExcessPart;
                Estimate.CrossCovariance := Estimate.CrossCovariance - Change;
                Change := ExcessGain * ExcessPart;
                Estimate.ExcessVariance := Estimate.ExcessVariance - Change;
                IF Estimate.ExcessVariance < 0.0 THEN
                    Estimate.ExcessVariance := 0.0;
                END_IF;
                Estimate.Believed := Estimate.Believed + 1.0;
                Estimate.Doubted := 0.0;
            END_IF;
        END_IF;
    END_IF;
    IF Anew THEN
        (* The estimate begins with this reading, taken as it is. *)
        Seen := TRUE;
        Estimate.Begun := TRUE;
        Estimate.Path_m := Path;
        Estimate.Speed_m_s := Speed_m_s;
        Estimate.Factor := 1.0;
        Estimate.Excess := 0.0;
        Estimate.SpeedVariance := Table.SpeedVariance;
        Estimate.FactorCovariance := 0.0;
        Estimate.ExcessCovariance := 0.0;
        Estimate.FactorVariance := Table.FactorVariance;
        Estimate.CrossCovariance := 0.0;
        Estimate.ExcessVariance := Table.ExcessVariance;
        Estimate.Believed := 1.0;
        Estimate.Doubted := 0.0;
    END_IF;
    Observed_m_s := -1.0;
    IF Estimate.Begun THEN
        (* A cut whose speed is known too badly is taken for slower than it seems. *)
        Change := Estimate.SpeedVariance - Table.LostVariance;
        IF Change < 0.0 THEN
            Change := 0.0;
        END_IF;
        Change := Table.Caution * Change;
        Observed_m_s := Estimate.Speed_m_s - Change;
        IF Observed_m_s < 0.0 THEN
            Observed_m_s := 0.0;
        END_IF;
        IF Estimate.SpeedVariance > Table.LostVariance THEN
            Alarms := Alarms + $LOST_ALARM;
        END_IF;
        IF (Estimate.Doubted > 0.0) OR (Estimate.Repeated >= Table.Frozen) THEN
            Alarms := Alarms + $SENSOR_ALARM;
        END_IF;
        Change := Estimate.Factor - 1.0;
        IF Change < 0.0 THEN
            Change := 0.0 - Change;
        END_IF;
        IF Change > Table.Unlikely THEN
            Alarms := Alarms + $CATEGORY_ALARM;
        END_IF;
    END_IF;
END_IF;
IF Seen THEN
    Unseen := 0.0;
END_IF;
Estimate.Unseen := Unseen;
END_FUNCTION_BLOCK
"""
