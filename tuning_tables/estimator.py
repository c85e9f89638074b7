"""Estimator of speed and friction for a trackside controller: a few multiplications a sample, no root, no history.

A measured speed is noisy; but how much a cut slows down between two samples is known, save for its friction. The
estimator carries the speed v and the friction factor ξ of the cut, with their covariance, from sample to sample
(extended Kalman filter), and the lines of a table that was tuned for it are compared with its speed:

    predict   Δe = ΔD - ξ p ΔW      the work of grade and rolling resistance, and of the brake under the overpressure p
              v' = v + 2 Δe / (v + v + Δe/v)
    correct   v, ξ by the measured speed, weighted by the covariance

D(s) and W(s) are given as broken lines. The path's own friction noise (standard deviation σ_η, correlation length ℓ)
enters as white noise of the same work, variance 2 σ_η² ℓ / Δs.

All arithmetic is float32, one rounding an operation, in the order written; docs/table-format.md states it. A reading
that cannot be true, such as a radar drop-out, corrects nothing: the estimate goes on by the model alone, and the state
counts for how many samples it has done so.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from tuning_tables.errors import InvalidTable
from tuning_tables.requirement import require_between, require_tuple

Floats = npt.NDArray[np.float32]

STATE_SIZE: Final = 8
"""Begun (0 or 1), path of the last sample, speed, friction factor, variance of speed, covariance, variance of the
factor, samples since the last credible speed."""

UNSEEN: Final = 7
"""Place of the last of them in the state."""

LEAST_SPEED_M_S: Final = 0.2
LEAST_STEP_M: Final = 0.001
FACTOR_RANGE: Final = (0.3, 1.9)
"""Beyond the default floor of ξ_cut, and six standard deviations at a CV of 0.15."""

LARGEST_SPEED_M_S: Final = 40.0
LARGEST_OVERPRESSURE_KPA: Final = 2000.0
LARGEST_STEP_M: Final = 20.0
"""Readings beyond these cannot be true, and one of them would spoil the state for the rest of the pass."""

MOST_BREAKS: Final = 256
FARTHEST_M: Final = 1e4
LARGEST_WORK: Final = 1e6


@dataclass(frozen=True)
class Estimator:
    """What the estimator must know of a cut in a position.

    speed_noise_m_s        standard deviation of a measured speed, > 0
    friction_cv            standard deviation of the friction factor of cuts around 1
    path_std, correlation_length_m   σ_η and ℓ of the friction along the path, ℓ in m
    touch_pressure_kpa     P0, at which the beams touch the wheels: the overpressure is max(0, P - P0)
    s_m, drive_m2_s2, brake_m2_s2_per_kpa   D and W at path breaks, linear between: kinetic energy per mass gained from
                           the first break to s, and lost for each kPa of overpressure at ξ = 1; W never falls, breaks
                           are a millimetre apart at least

    Derived, for `observe` (read-only): parameters float32 (13,), work float32 (3, B). Raises `InvalidTable`.
    """

    speed_noise_m_s: float
    friction_cv: float
    path_std: float
    correlation_length_m: float
    touch_pressure_kpa: float
    s_m: tuple[float, ...]
    drive_m2_s2: tuple[float, ...]
    brake_m2_s2_per_kpa: tuple[float, ...]
    parameters: Floats = field(init=False, repr=False, compare=False)
    work: Floats = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        require_between(self.speed_noise_m_s, "estimator.speed_noise_m_s", 1e-4, 10.0)
        require_between(self.friction_cv, "estimator.friction_cv", 0.0, 1.0)
        require_between(self.path_std, "estimator.path_std", 0.0, 1.0)
        require_between(self.correlation_length_m, "estimator.correlation_length_m", 1e-3, 1e4)
        require_between(self.touch_pressure_kpa, "estimator.touch_pressure_kpa", 0.0, LARGEST_OVERPRESSURE_KPA)
        self._require_work()
        variance = 2.0 * self.path_std**2 * self.correlation_length_m
        numbers = (
            self.speed_noise_m_s**2, self.friction_cv**2, variance, *FACTOR_RANGE, LEAST_SPEED_M_S, LEAST_STEP_M,
            0.0, 1.0, 2.0, LARGEST_SPEED_M_S, LARGEST_OVERPRESSURE_KPA, LARGEST_STEP_M,
        )  # fmt: skip
        arrays = {"parameters": numbers, "work": (self.s_m, self.drive_m2_s2, self.brake_m2_s2_per_kpa)}
        for name, content in arrays.items():
            array = np.array(content, dtype=np.float32)
            array.setflags(write=False)
            object.__setattr__(self, name, array)

    def _require_work(self) -> None:
        require_tuple(self.s_m, "estimator.s_m")
        if not 2 <= len(self.s_m) <= MOST_BREAKS:
            raise InvalidTable(f"estimator.s_m has {len(self.s_m)} breaks, but 2 to {MOST_BREAKS} are allowed.")
        for key, values, largest in (
            ("s_m", self.s_m, FARTHEST_M),
            ("drive_m2_s2", self.drive_m2_s2, LARGEST_WORK),
            ("brake_m2_s2_per_kpa", self.brake_m2_s2_per_kpa, LARGEST_WORK),
        ):
            require_tuple(values, f"estimator.{key}", len(self.s_m))
            for index, value in enumerate(values):
                require_between(value, f"estimator.{key}[{index}]", -largest, largest)
        # In float32, as they are divided by.
        if not (np.diff(np.array(self.s_m, dtype=np.float32)) >= LEAST_STEP_M).all():
            raise InvalidTable(f"estimator.s_m must rise by {LEAST_STEP_M:g} m at least from break to break.")
        if any(later < earlier for earlier, later in pairwise(self.brake_m2_s2_per_kpa)):
            raise InvalidTable("estimator.brake_m2_s2_per_kpa falls, but a brake only takes energy away.")


def begin() -> Floats:
    """The state before the first sample of a cut, float32 (8,)."""
    return np.zeros(STATE_SIZE, dtype=np.float32)


def unseen_samples(state: Floats) -> int:
    """For how many samples there was no credible speed: 0 after a credible one; before the first, since `begin`.

    The model alone has stood in for the sensor that long. It stays at 2**24, beyond which float32 does not count.
    """
    return int(state[UNSEEN])


def hand_on(state: Floats, v_m_s: float) -> float:
    """`v_m_s` as it is, for a table without estimator; `state` counts samples without a credible speed all the same."""
    credible = 0.0 <= v_m_s <= LARGEST_SPEED_M_S
    state[UNSEEN] = np.float32(0.0) if credible else state[UNSEEN] + np.float32(1.0)
    return v_m_s


def observe(parameters: Floats, work: Floats, state: Floats, s_m: float, v_m_s: float, overpressure_kpa: float) -> Any:
    """Take one sample into `state` and return the estimated speed, m/s; −1 as long as no speed was measured.

    To be called at every sample, also while a change of stage is under way, with the path, the measured speed, and the
    mean of max(0, P - P0) since the sample before. What cannot be true changes little: a speed above 40 m/s, negative
    or not finite corrects nothing, such an overpressure counts as 0, a path that goes back, or on by more than 20 m, as
    no movement. `state`, float32 (8,), is changed in place. `numba.njit(observe)` compiles this text, same numbers.
    """
    nought, one, two = parameters[7], parameters[8], parameters[9]
    last = work.shape[1] - 1
    # Written so that NaN fails each of them, and before the conversion, so that no number overflows in it.
    credible = 0.0 <= v_m_s <= float(parameters[10])
    state[7] = nought if credible else state[7] + one
    v = np.float32(v_m_s) if credible else nought
    p = np.float32(overpressure_kpa) if 0.0 <= overpressure_kpa <= float(parameters[11]) else nought
    begun = state[0] != nought
    before = state[1] if begun else work[0, 0]
    farthest = before + parameters[12] if begun else work[0, last]
    s = np.float32(s_m) if float(before) <= s_m <= float(farthest) else before
    least_speed = parameters[5]
    if not begun:
        if not credible:
            return nought - one
        state[0], state[1], state[2], state[3] = one, s, max(v, least_speed), one
        state[4], state[5], state[6] = parameters[0], nought, parameters[1]
        return state[2]
    drive, brake = nought, nought
    for end in range(2):  # what was reached at s, less what was reached before
        place = s if end == 0 else before
        place = min(max(place, work[0, 0]), work[0, last])
        j = 0
        while j < last - 1 and place > work[0, j + 1]:
            j += 1
        part = (place - work[0, j]) / (work[0, j + 1] - work[0, j])
        d = work[1, j] + part * (work[1, j + 1] - work[1, j])
        w = work[2, j] + part * (work[2, j + 1] - work[2, j])
        drive = d if end == 0 else drive - d
        brake = w if end == 0 else brake - w
    work_at_one = p * brake
    gained = drive - state[3] * work_at_one
    mean = max((state[2] + state[2] + gained / state[2]) / two, least_speed)
    predicted = max(state[2] + gained / mean, least_speed)
    slope = state[2] / predicted
    effect = work_at_one / mean
    path_variance = parameters[2] / max(s - before, parameters[6])
    p11 = slope * slope * state[4] - two * slope * effect * state[5] + effect * effect * (state[6] + path_variance)
    p12 = slope * state[5] - effect * state[6]
    state[1], state[2], state[4], state[5] = s, predicted, p11, p12
    if credible:
        total = p11 + parameters[0]
        gain, factor_gain = p11 / total, p12 / total
        surprise = v - predicted
        state[2] = max(predicted + gain * surprise, least_speed)
        state[3] = min(max(state[3] + factor_gain * surprise, parameters[3]), parameters[4])
        state[6] = max(state[6] - factor_gain * p12, nought)
        state[5] = p12 - gain * p12
        state[4] = p11 - gain * p11
    return state[2]
