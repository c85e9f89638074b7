"""The fixed part of the Structured Text self-test of the on-line correction."""

from __future__ import annotations

from typing import Final

SELF_TEST_HEAD: Final = """\
(* Self-test of retarder_correction.st, for the controller that is to run it. Generated: do not edit, export again.

   Call one instance of RETARDER_CORRECTION_TEST once at start; Failed must be 0. It compares states, corrected speeds
   and usable passes with those of the reference implementation. Questions that are not finite or denormal are left
   out, because they have no portable literal. *)
"""

EXITS_TEST: Final = """\
FUNCTION_BLOCK RETARDER_CORRECTION_TEST
(* $EXITS exits and $PASSES passes. *)
VAR_OUTPUT
    Failed : INT; (* exits and passes that are wrong *)
    FirstFailed : INT; (* the first of them: exits, then passes from $EXITS on; -1: none *)
END_VAR
VAR
    Learner : RETARDER_LEARN_EXIT;
    Corrector : RETARDER_CORRECTED_SPEED;
    Judge : RETARDER_USABLE_EXIT;
    State : RETARDER_CORRECTION;
    Index : INT;
    Agrees : BOOL;
END_VAR
$CONSTANTS
Failed := 0;
FirstFailed := -1;
FOR Index := 0 TO $LAST_EXIT DO
    State.Mean_m_s := Exit_mean_m_s[Index];
    State.Correction_m_s := Exit_correction_m_s[Index];
    State.Learnt := Exit_learnt[Index];
    Learner(Error_m_s := Exit_error_m_s[Index], Credible := Exit_credible[Index], State := State);
    Corrector(Observed_m_s := Exit_speed_m_s[Index], State := State);
    Agrees := (State.Mean_m_s = Exit_new_mean_m_s[Index]) AND (State.Learnt = Exit_new_learnt[Index])
        AND (State.Correction_m_s = Exit_new_correction_m_s[Index])
        AND (Corrector.Corrected_m_s = Exit_corrected_m_s[Index]);
    IF NOT Agrees THEN
        IF Failed = 0 THEN
            FirstFailed := Index;
        END_IF;
        Failed := Failed + 1;
    END_IF;
END_FOR;
FOR Index := 0 TO $LAST_PASS DO
    Judge(Samples := Pass_samples[Index], Missing := Pass_missing[Index], AtTop := Pass_at_top[Index],
        EndsAtTop := Pass_ends_at_top[Index], ByHand := Pass_by_hand[Index], Stalled := Pass_stalled[Index],
        Error_m_s := Pass_error_m_s[Index]);
    IF Judge.Usable XOR Pass_usable[Index] THEN
        IF Failed = 0 THEN
            FirstFailed := Index + $EXITS;
        END_IF;
        Failed := Failed + 1;
    END_IF;
END_FOR;
END_FUNCTION_BLOCK
"""
