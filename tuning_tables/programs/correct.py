"""On-line correction of the commanded speed from the last exits: a few operations a pass, bounded whatever comes in.

A table is tuned for a plant that ages. What its exits are off by on average drifts slowly; each single exit is off by
far more. The correction c is added to the speed that the rule compares with its lines, which is the same as a commanded
speed lower by c. After each pass that tells something (`usable_exit`), with e = exit speed - target:

    learn    b' = b + K clip(e + c - b)       the mean error of the table alone; e + c is what it would have been
    shrink   w  = b - t²/b if b² > t² else 0  what the filter's own standard deviation explains is not believed
    follow   c' = w, within ±limit, by no more than ±step from c

It is the steady state of a Kalman filter for a mean that walks at random: gain K = 1 / memory, and the standard
deviation of b is spread √K, of which t is the double. The shrinkage is the non-negative garrote (Breiman 1995): it is
continuous, does nothing below t, and leaves t²/b above it, where a soft threshold would leave t for ever.

All arithmetic is float32, one rounding an operation, in the order written; docs/explanation/correction.md states it,
and proves
|c| <= limit and |c' - c| <= step.
"""

from __future__ import annotations

from typing import Annotated, Any, Final, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from tuning_tables.language.records import Record, flag, reading, real, record_of, whole
from tuning_tables.programs.held import NOUGHT, ONE, Answer, ObservedSpeed, f32

LARGEST_ERROR_M_S: Final = np.float32(1.0)
LEAST_ERROR_M_S: Final = np.float32(-1.0)
"""An exit farther off was not regulated."""

LARGEST_EXCESS_M_S: Final = np.float32(0.1)
"""An exit faster than the target by more, at full brake, was brake saturated."""

FEWEST_SAMPLES: Final = 10
MOST_MISSING: Final = 3
MOST_LEARNT: Final = np.float32(2.0**24)
"""Beyond it float32 does not count."""

LARGEST_SPEED_M_S: Final = np.float32(40.0)

MEAN_M_S, CORRECTION_M_S, LEARNT = range(3)


class CorrectionSetting(NamedTuple):
    """How far and how fast the correction of a position may go. Closed."""

    gain: Annotated[np.float32, real("K: by which an innovation moves the mean error")]
    threshold_squared: Annotated[np.float32, real("t2: a mean error up to t changes nothing, m2/s2")]
    limit_m_s: Annotated[np.float32, real("the correction never leaves +-limit, m/s")]
    reach_m_s: Annotated[np.float32, real("the mean error never leaves +-reach: beyond it the limit is wanted, m/s")]
    clip_m_s: Annotated[np.float32, real("an innovation is clipped at +-clip, m/s")]
    step_m_s: Annotated[np.float32, real("most that one pass changes the correction by, m/s")]


SETTING: Final = record_of(CorrectionSetting)

CORRECTION: Final = Record(
    "correction",
    "What was learnt of one position: kept from pass to pass. Closed: all 0 before its first pass.",
    {
        "mean_m_s": real("mean error of the table alone, m/s"),
        "correction_m_s": real("added to the speed that the rule is asked with, m/s"),
        "learnt": real("passes learnt from; stays at 16777216"),
    },
    is_state=True,
)

CorrectionState: TypeAlias = Annotated[npt.NDArray[np.float32], CORRECTION]
"""float32 (3,)."""

ExitError: TypeAlias = Annotated[
    Any, reading("exit speed as measured, less the target; beyond 1 m/s where it was not measured")
]


def begin_correction(correction: CorrectionState) -> None:
    """Forget everything: to be called once for a position, and after every new table."""
    correction[MEAN_M_S] = NOUGHT
    correction[CORRECTION_M_S] = NOUGHT
    correction[LEARNT] = NOUGHT


def usable_exit(
    samples: Annotated[int, whole("at which the regulator looked at the speed")],
    missing: Annotated[int, whole("of them, without a speed that can be true")],
    at_top: Annotated[int, whole("of them, with the top stage commanded")],
    ends_at_top: Annotated[bool, flag("that stage was commanded at the last of them")],
    by_hand: Annotated[bool, flag("a person took part, or a fault is known")],
    stalled: Annotated[bool, flag("the cut came to a stand")],
    error_m_s: ExitError,
) -> Answer:
    """Once for a pass that has ended, whether it tells what the table is off by: nobody took part and nothing stalled;
    of 10 samples or more at most 3 are missing; the top stage was commanded at half of them at most; the error lies
    between -1 and +1 m/s, and is not above 0.1 m/s if the pass ended at the top stage.

    With the top stage for longer, or at the end of too fast a pass, it was short of brake power.
    """
    usable = False
    if samples >= FEWEST_SAMPLES and 0 <= missing <= MOST_MISSING and 0 <= at_top <= samples:
        others = samples - at_top
        # No comparison with a NaN is true.
        usable = (
            not by_hand
            and not stalled
            and at_top <= others
            and LEAST_ERROR_M_S <= error_m_s <= LARGEST_ERROR_M_S
            and (not ends_at_top or error_m_s <= LARGEST_EXCESS_M_S)
        )
    return usable


def learn_exit(
    setting: CorrectionSetting,
    correction: CorrectionState,
    error_m_s: ExitError,
    credible: Annotated[bool, flag("what `usable_exit` says of the pass")],
) -> None:
    """Then: take the exit of a pass, run under this correction, into it.

    Nothing is learnt from a pass that is not credible, or from an error that cannot be true. A state that cannot be, as
    of a memory that lost its content, is begun anew.
    """
    least_mean = NOUGHT - setting.reach_m_s
    least = NOUGHT - setting.limit_m_s
    # No comparison with a NaN is true.
    sound = (
        least_mean <= correction[MEAN_M_S] <= setting.reach_m_s
        and least <= correction[CORRECTION_M_S] <= setting.limit_m_s
        and NOUGHT <= correction[LEARNT] <= MOST_LEARNT
    )
    if not sound:
        begin_correction(correction)
    if credible and LEAST_ERROR_M_S <= error_m_s <= LARGEST_ERROR_M_S:
        innovation = f32(error_m_s) + correction[CORRECTION_M_S] - correction[MEAN_M_S]
        innovation = min(max(innovation, NOUGHT - setting.clip_m_s), setting.clip_m_s)
        mean = correction[MEAN_M_S] + setting.gain * innovation
        mean = min(max(mean, least_mean), setting.reach_m_s)
        # What the standard deviation of the mean explains is not believed.
        wanted = NOUGHT
        if mean * mean > setting.threshold_squared:
            wanted = mean - setting.threshold_squared / mean
        wanted = min(max(wanted, least), setting.limit_m_s)
        slowest = correction[CORRECTION_M_S] - setting.step_m_s
        fastest = correction[CORRECTION_M_S] + setting.step_m_s
        correction[MEAN_M_S] = mean
        correction[CORRECTION_M_S] = min(max(wanted, slowest), fastest)
        correction[LEARNT] = correction[LEARNT] + ONE


def corrected_speed(setting: CorrectionSetting, correction: CorrectionState, v_m_s: ObservedSpeed) -> Answer:
    """At every sample, the speed to ask `decide` with: what was observed and the correction, added, not below 0.

    A speed that cannot be true comes back as it is, so that the rule holds as before; a state that cannot be corrects
    nothing.
    """
    corrected = v_m_s
    least = NOUGHT - setting.limit_m_s
    is_credible = NOUGHT <= v_m_s <= LARGEST_SPEED_M_S
    if is_credible and least <= correction[CORRECTION_M_S] <= setting.limit_m_s:
        corrected = max(f32(v_m_s) + correction[CORRECTION_M_S], NOUGHT)
    return corrected
