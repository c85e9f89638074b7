"""The body of RETARDER_OBSERVE in the Structured Text export: the recursion, in the subset that `st_blocks` keeps to.

One statement an operation, so that each is rounded once. Books without estimator have `st_estimate.HAND_ON` instead.
"""

from __future__ import annotations

from typing import Final

OBSERVE: Final = """\
VAR
    Worker : RETARDER_WORK;
    Sensible : BOOL;
    Fresh : BOOL;
    Moves : BOOL;
    Leaps : BOOL;
    Strange : BOOL;
    Heard : BOOL;
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
    Heard := (Estimate.Unseen = 0.0) OR (Estimate.Repeated > 0.0);
    IF Sensible AND (Speed_m_s = Reading) THEN
        Estimate.Repeated := Estimate.Repeated + 1.0;
    ELSE
        Estimate.Repeated := 0.0;
    END_IF;
    IF Sensible THEN
        Estimate.Reading_m_s := Speed_m_s;
    END_IF;
    Fresh := Sensible AND (Estimate.Repeated + Estimate.Repeated + Estimate.Repeated < Table.Frozen);
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
            IF Heard THEN
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
        IF Change > Table.Unlikely THEN
            Alarms := Alarms + $LIGHTER_ALARM;
        END_IF;
        Change := 0.0 - Change;
        IF Change > Table.Unlikely THEN
            Alarms := Alarms + $HEAVIER_ALARM;
        END_IF;
    END_IF;
END_IF;
IF Seen THEN
    Unseen := 0.0;
END_IF;
Estimate.Unseen := Unseen;
END_FUNCTION_BLOCK
"""
