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

All arithmetic is float32, one rounding an operation, in the order written; docs/correction.md states it, and proves
|c| <= limit and |c' - c| <= step.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import sqrt
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from tuning_tables.requirement import require_between

Floats = npt.NDArray[np.float32]

STATE_SIZE: Final = 3
"""Mean error b of the table alone, correction c, passes learnt from."""

CERTAINTY: Final = 2.0
"""Standard deviations of b that are not believed: t = 2 spread √K."""

CLIP: Final = 3.0
"""Spreads at which a surprise is clipped: 0.3 % of normal exits are."""

LARGEST_ERROR_M_S: Final = 1.0
"""An exit farther off was not regulated."""

LARGEST_EXCESS_M_S: Final = 0.1
"""An exit faster than the target by more, at full brake, was out of brake power."""

FEWEST_SAMPLES: Final = 10
MOST_MISSING: Final = 3
MOST_LEARNT: Final = 16777216.0
"""2**24, beyond which float32 does not count."""

LARGEST_SPEED_M_S: Final = 40.0
LEAST_LIMIT_M_S, LARGEST_LIMIT_M_S = 0.01, 0.5


@dataclass(frozen=True)
class Correction:
    """How far and how fast the correction may go.

    limit_m_s       c never leaves ±limit, 0.01 to 0.5 m/s
    spread_m_s      standard deviation of a usable exit around its mean, with that of its measurement, 0.005 to 0.5 m/s
    memory_passes   1/K: how many passes the mean is taken over, 10 to 10 000
    step_m_s        most that one pass may change c by, 0.0001 to 0.1 m/s

    Derived, for the functions below (read-only): parameters float32 (14,). Raises `InvalidTable`.
    """

    limit_m_s: float = 0.15
    spread_m_s: float = 0.06
    memory_passes: float = 100.0
    step_m_s: float = 0.005
    parameters: Floats = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        require_between(self.limit_m_s, "correction.limit_m_s", LEAST_LIMIT_M_S, LARGEST_LIMIT_M_S)
        require_between(self.spread_m_s, "correction.spread_m_s", 0.005, 0.5)
        require_between(self.memory_passes, "correction.memory_passes", 10.0, 1e4)
        require_between(self.step_m_s, "correction.step_m_s", 1e-4, 0.1)
        limit, t = self.limit_m_s, self.threshold_m_s
        numbers = (
            self.gain, t * t, limit, 0.5 * (limit + sqrt(limit * limit + 4.0 * t * t)), CLIP * self.spread_m_s,
            self.step_m_s, LARGEST_ERROR_M_S, LARGEST_EXCESS_M_S, LARGEST_SPEED_M_S, 0.0, 1.0, MOST_LEARNT,
            FEWEST_SAMPLES, MOST_MISSING,
        )  # fmt: skip
        array = np.array(numbers, dtype=np.float32)
        array.setflags(write=False)
        object.__setattr__(self, "parameters", array)

    @property
    def gain(self) -> float:
        """K of the filter."""
        return 1.0 / self.memory_passes

    @property
    def threshold_m_s(self) -> float:
        """t: a mean error up to it changes nothing."""
        return CERTAINTY * self.spread_m_s * sqrt(self.gain)


def begin_correction() -> Floats:
    """The state of a position before its first pass, float32 (3,): no correction."""
    return np.zeros(STATE_SIZE, dtype=np.float32)


def usable_exit(
    parameters: Floats,
    samples: int,
    missing: int,
    at_top: int,
    ends_at_top: bool,
    by_hand: bool,
    stalled: bool,
    error_m_s: float,
) -> bool:
    """Whether a pass tells what the table is off by.

    `samples` at which the regulator looked at the speed, `missing` of them without a credible one, `at_top` of them
    with the top stage commanded; `ends_at_top`: that stage was commanded at the last of them; `by_hand`: a person took
    part, or a fault is known; `stalled`: the cut came to a stand; `error_m_s`: exit speed as measured - target, NaN
    where it was not measured. All of these must hold:

    1. nobody took part, and the cut did not stall;
    2. at least 10 samples, and at most 3 of them missing;
    3. the top stage at half of the samples at most: else the pass was short of brake power;
    4. an error between -1 and +1 m/s, and not above 0.1 m/s if the pass ended at the top stage.
    """
    if by_hand or stalled or samples < parameters[12] or missing < 0 or missing > parameters[13]:
        return False
    if at_top < 0 or at_top > samples or at_top > samples - at_top:
        return False
    # Written so that NaN fails.
    if not (-float(parameters[6]) <= error_m_s <= float(parameters[6])):
        return False
    return not (ends_at_top and error_m_s > float(parameters[7]))


def learn_exit(parameters: Floats, state: Floats, error_m_s: float, credible: bool) -> None:
    """Take the exit of one pass into `state`, float32 (3,), which is changed in place.

    `error_m_s`: exit speed as measured - target, of a pass under the correction in `state`; `credible`: `usable_exit`
    of it. Otherwise, or beyond ±1 m/s, or not finite, nothing is learnt. A state that cannot be (a memory lost its
    content) is begun anew. `numba.njit(learn_exit)` compiles this text, same numbers.
    """
    nought, limit, reach, most = parameters[9], parameters[2], parameters[3], parameters[5]
    # Comparisons so that NaN fails.
    sound = -reach <= state[0] <= reach and -limit <= state[1] <= limit and nought <= state[2] <= parameters[11]
    if not sound:
        state[0], state[1], state[2] = nought, nought, nought
    largest = float(parameters[6])
    if not credible or not (-largest <= error_m_s <= largest):
        return
    clip = parameters[4]
    surprise = np.float32(error_m_s) + state[1] - state[0]
    surprise = min(max(surprise, -clip), clip)
    mean = state[0] + parameters[0] * surprise
    mean = min(max(mean, -reach), reach)
    wanted = nought
    if mean * mean > parameters[1]:
        wanted = mean - parameters[1] / mean
    wanted = min(max(wanted, -limit), limit)
    state[0] = mean
    state[1] = min(max(wanted, state[1] - most), state[1] + most)
    state[2] = state[2] + parameters[10]  # float32 itself stays at 2**24


def corrected_speed(parameters: Floats, state: Floats, v_m_s: float) -> Any:
    """The speed to compare with the lines, m/s: `v_m_s` + c, not below 0.

    `v_m_s` is the measured speed, or that of `estimator.observe`. One that cannot be true (negative, above 40 m/s, not
    finite) comes back as it is, so that the rule holds as before; a state that cannot be corrects nothing.
    """
    # Before the conversion, so that no number overflows in it.
    if not (0.0 <= v_m_s <= float(parameters[8])):
        return v_m_s
    v, limit = np.float32(v_m_s), parameters[2]
    if not (-limit <= state[1] <= limit):
        return v
    return max(v + state[1], parameters[9])
