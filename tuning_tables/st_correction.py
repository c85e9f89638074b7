"""The on-line correction as IEC 61131-3 Structured Text, with its self-test: a library text beside that of the tables.

In the subset that `st_blocks` keeps to. The self-test asks the golden exits that have a portable literal.
"""

from __future__ import annotations

from collections.abc import Mapping
from string import Template
from typing import Final

import numpy as np

from tuning_tables.c_correction import CONSTANTS, correction_words
from tuning_tables.correction import Correction
from tuning_tables.export_prefix import RETARDER, ExportPrefix
from tuning_tables.golden_exits import COUNTS, FLAGS, INPUT_FIELDS, OUTPUT_FIELDS, golden_exits, golden_passes
from tuning_tables.st_correction_test import EXITS_TEST, SELF_TEST_HEAD
from tuning_tables.st_literals import bool_array, constants, int_array, is_portable, real_array, real_constant
from tuning_tables.st_units import unit_files

CORRECTION_FILE: Final = "retarder_correction.st"
SELF_TEST_FILE: Final = "retarder_correction_self_test.st"

HEAD: Final = """\
(* On-line correction of the commanded speed of a car retarder from its last exits: IEC 61131-3 Structured Text.
   Generated: do not edit, export again. This text may be used, changed and passed on without any condition.

   limit      $LIMIT m/s: the correction never leaves +-limit
   step       $STEP m/s: most that one pass changes it by
   spread     $SPREAD m/s: standard deviation of a usable exit around its mean
   memory     $MEMORY passes

   Blocks
   RETARDER_BEGIN_CORRECTION  once for a position, and after every new table: forgets everything
   RETARDER_CORRECTED_SPEED   at every sample: the speed to ask RETARDER_DECIDE with
   RETARDER_USABLE_EXIT       once for a pass that has ended: whether it tells what the table is off by
   RETARDER_LEARN_EXIT        then: takes its exit into the correction

   Arithmetic. Every operation on REAL stands in a statement of its own, so that its result is rounded to REAL
   (binary32) before the next; see docs/structured-text.md.

   Not done: no compiler of a vendor has seen this text. It was parsed, and its parse tree evaluated in binary32
   against the reference implementation. *)
"""

STATE_TYPE: Final = """\
TYPE
    (* What was learnt of one position: closed, kept from pass to pass. *)
    RETARDER_CORRECTION : STRUCT
        Mean_m_s : REAL; (* mean error of the table alone *)
        Correction_m_s : REAL; (* added to the speed that the rule is asked with *)
        Learnt : REAL; (* passes learnt from; stays at 16777216 *)
    END_STRUCT;
END_TYPE
"""

BEGIN: Final = """\
FUNCTION_BLOCK RETARDER_BEGIN_CORRECTION
VAR_IN_OUT
    State : RETARDER_CORRECTION;
END_VAR

State.Mean_m_s := 0.0;
State.Correction_m_s := 0.0;
State.Learnt := 0.0;
END_FUNCTION_BLOCK
"""

USABLE: Final = """\
FUNCTION_BLOCK RETARDER_USABLE_EXIT
(* Nobody took part and nothing stalled; $FEWEST_SAMPLES samples or more, at most $MOST_MISSING of them missing; the top
   stage at half of them at most; an error between -$LARGEST_ERROR and +$LARGEST_ERROR m/s, and not above
   $LARGEST_EXCESS m/s if the pass ended at the top stage. *)
VAR_INPUT
    Samples : INT; (* at which the regulator looked at the speed *)
    Missing : INT; (* of them, without a speed that can be true *)
    AtTop : INT; (* of them, with the top stage commanded *)
    EndsAtTop : BOOL; (* that stage was commanded at the last of them *)
    ByHand : BOOL; (* a person took part, or a fault is known *)
    Stalled : BOOL; (* the cut came to a stand *)
    Error_m_s : REAL; (* exit speed as measured, less the target; 9.0 where it was not measured *)
END_VAR
VAR_OUTPUT
    Usable : BOOL;
END_VAR
VAR
    Others : INT;
END_VAR
VAR CONSTANT
$LARGEST_ERRORS
$LARGEST_EXCESS_CONSTANT
END_VAR

Usable := FALSE;
IF (Samples >= $FEWEST_SAMPLES) AND (Missing >= 0) AND (Missing <= $MOST_MISSING) AND (AtTop >= 0)
    AND (AtTop <= Samples) THEN
    Others := Samples - AtTop;
    (* No comparison with a NaN is true. *)
    Usable := (AtTop <= Others) AND NOT ByHand AND NOT Stalled
        AND (Error_m_s >= MinusLargestError_m_s) AND (Error_m_s <= LargestError_m_s)
        AND ((NOT EndsAtTop) OR (Error_m_s <= LargestExcess_m_s));
END_IF;
END_FUNCTION_BLOCK
"""

LEARN: Final = """\
FUNCTION_BLOCK RETARDER_LEARN_EXIT
(* Nothing is learnt from a pass that is not credible, or from an error that cannot be true. A state that cannot be is
   begun anew. *)
VAR_INPUT
    Error_m_s : REAL; (* of a pass under the correction in State *)
    Credible : BOOL; (* RETARDER_USABLE_EXIT of the pass *)
END_VAR
VAR_IN_OUT
    State : RETARDER_CORRECTION;
END_VAR
VAR
    Beginner : RETARDER_BEGIN_CORRECTION;
    Sound : BOOL;
    Surprise : REAL;
    Change : REAL;
    Mean : REAL;
    Square : REAL;
    Doubt : REAL;
    Wanted : REAL;
    Least : REAL;
    Largest : REAL;
END_VAR
VAR CONSTANT
$LEARN_CONSTANTS
$LIMITS
$LARGEST_ERRORS
END_VAR

(* No comparison with a NaN is true. *)
Sound := (State.Mean_m_s >= MinusReach_m_s) AND (State.Mean_m_s <= Reach_m_s)
    AND (State.Correction_m_s >= MinusLimit_m_s) AND (State.Correction_m_s <= Limit_m_s)
    AND (State.Learnt >= 0.0) AND (State.Learnt <= MostLearnt);
IF NOT Sound THEN
    Beginner(State := State);
END_IF;
IF Credible AND (Error_m_s >= MinusLargestError_m_s) AND (Error_m_s <= LargestError_m_s) THEN
    Surprise := Error_m_s + State.Correction_m_s;
    Surprise := Surprise - State.Mean_m_s;
    IF Surprise < MinusClip_m_s THEN
        Surprise := MinusClip_m_s;
    END_IF;
    IF Surprise > Clip_m_s THEN
        Surprise := Clip_m_s;
    END_IF;
    Change := Gain * Surprise;
    Mean := State.Mean_m_s + Change;
    IF Mean < MinusReach_m_s THEN
        Mean := MinusReach_m_s;
    END_IF;
    IF Mean > Reach_m_s THEN
        Mean := Reach_m_s;
    END_IF;
    Wanted := 0.0;
    Square := Mean * Mean;
    IF Square > ThresholdSquared THEN
        Doubt := ThresholdSquared / Mean;
        Wanted := Mean - Doubt;
    END_IF;
    IF Wanted < MinusLimit_m_s THEN
        Wanted := MinusLimit_m_s;
    END_IF;
    IF Wanted > Limit_m_s THEN
        Wanted := Limit_m_s;
    END_IF;
    Least := State.Correction_m_s - Step_m_s;
    Largest := State.Correction_m_s + Step_m_s;
    IF Wanted < Least THEN
        Wanted := Least;
    END_IF;
    IF Wanted > Largest THEN
        Wanted := Largest;
    END_IF;
    State.Mean_m_s := Mean;
    State.Correction_m_s := Wanted;
    State.Learnt := State.Learnt + 1.0; (* REAL itself stays at 16777216 *)
END_IF;
END_FUNCTION_BLOCK
"""

SPEED: Final = """\
FUNCTION_BLOCK RETARDER_CORRECTED_SPEED
(* Observed + correction, not below 0. A speed that cannot be true comes back as it is; a state that cannot be corrects
   nothing. *)
VAR_INPUT
    Observed_m_s : REAL; (* of RETARDER_OBSERVE *)
END_VAR
VAR_IN_OUT
    State : RETARDER_CORRECTION; (* only read *)
END_VAR
VAR_OUTPUT
    Corrected_m_s : REAL; (* to ask RETARDER_DECIDE with *)
END_VAR
VAR CONSTANT
$LIMITS
$LARGEST_SPEED_CONSTANT
END_VAR

Corrected_m_s := Observed_m_s;
(* No comparison with a NaN is true. *)
IF (Observed_m_s >= 0.0) AND (Observed_m_s <= LargestSpeed_m_s)
    AND (State.Correction_m_s >= MinusLimit_m_s) AND (State.Correction_m_s <= Limit_m_s) THEN
    Corrected_m_s := Observed_m_s + State.Correction_m_s;
    IF Corrected_m_s < 0.0 THEN
        Corrected_m_s := 0.0;
    END_IF;
END_IF;
END_FUNCTION_BLOCK
"""


def correction_st_files(correction: Correction, prefix: ExportPrefix = RETARDER) -> Mapping[str, bytes]:
    """The files by name, ASCII with LF: the blocks, and the self-test. Equal corrections give equal bytes."""
    head, units = _head(correction), _units(correction)
    files = {
        CORRECTION_FILE: "\n".join([head, *units]),
        SELF_TEST_FILE: "\n".join([SELF_TEST_HEAD, _test_block(correction)]),
    }
    return {prefix.renamed(name): prefix.renamed(text).encode("ascii") for name, text in files.items()}


def correction_st_unit_files(correction: Correction, prefix: ExportPrefix = RETARDER) -> Mapping[str, bytes]:
    """The same units, a file each; by their names in the order in which they need each other."""
    first, *others = _units(correction)
    texts = ["\n".join([_head(correction), first]), *others, _test_block(correction)]
    named = unit_files([prefix.renamed(text) for text in texts])
    # Behind the name, so that they sort beside, not among, the numbered units of the tables.
    return {f"correction_{name}": text for name, text in named.items()}


def _head(correction: Correction) -> str:
    return Template(HEAD).substitute(correction_words(correction))


def _units(correction: Correction) -> list[str]:
    blanks = {**correction_words(correction), **_declarations(correction)}
    return [STATE_TYPE, BEGIN, *(Template(text).substitute(blanks) for text in (USABLE, LEARN, SPEED))]


def _declarations(correction: Correction) -> Mapping[str, str]:
    """Declarations of constants, by the blanks that ask for them."""
    number = dict(zip(CONSTANTS, correction.parameters[:12], strict=True))
    names = {"Gain": "GAIN", "ThresholdSquared": "THRESHOLD_SQUARED", "Step_m_s": "STEP", "MostLearnt": "MOST_LEARNT"}
    learn = [real_constant(name, number[key]) for name, key in names.items()]
    for name, key in (("Reach_m_s", "REACH"), ("Clip_m_s", "CLIP")):
        learn.append(_both(name, number[key]))
    return {
        "LEARN_CONSTANTS": "\n".join(learn),
        "LIMITS": _both("Limit_m_s", number["LIMIT"]),
        "LARGEST_ERRORS": _both("LargestError_m_s", number["LARGEST_ERROR"]),
        "LARGEST_EXCESS_CONSTANT": real_constant("LargestExcess_m_s", number["LARGEST_EXCESS"]),
        "LARGEST_SPEED_CONSTANT": real_constant("LargestSpeed_m_s", number["LARGEST_SPEED"]),
    }


def _both(name: str, value: np.float32) -> str:
    """Declarations of a limit and of its negative."""
    return f"{real_constant(name, value)}\n{real_constant(f'Minus{name}', -value)}"


def _test_block(correction: Correction) -> str:
    """The self-test, with the rows that have a literal in every language."""
    exits, passes = golden_exits(correction), golden_passes(correction)
    exits = exits[np.logical_and.reduce([is_portable(exits[name]) for name in (*INPUT_FIELDS, *OUTPUT_FIELDS)])]
    passes = passes[is_portable(passes["error_m_s"])]
    arrays = [real_array(f"Exit_{name}", exits[name]) for name in (*INPUT_FIELDS, *OUTPUT_FIELDS)]
    arrays += [bool_array("Exit_credible", exits["credible"])]
    arrays += [int_array(f"Pass_{name}", passes[name]) for name in COUNTS]
    arrays += [bool_array(f"Pass_{name}", passes[name]) for name in (*FLAGS, "usable")]
    arrays += [real_array("Pass_error_m_s", passes["error_m_s"])]
    declarations, body = EXITS_TEST.split("$CONSTANTS\n")
    blanks = {"EXITS": len(exits), "PASSES": len(passes), "LAST_EXIT": len(exits) - 1, "LAST_PASS": len(passes) - 1}
    return Template(declarations).substitute(blanks) + constants(arrays) + Template(body).substitute(blanks)
