"""Estimator of speed, friction and resistance for a trackside controller: a few multiplications a sample, no root.

A measured speed is noisy, and some readings are missing or false. But how much a cut slows down between two samples is
known, save for its friction and its running resistance. The estimator carries the speed v, the friction factor ξ and
the excess resistance a of the cut, with their covariance, from sample to sample (extended Kalman filter), and the lines
of a table that was tuned for it are compared with its speed:

    predict   Δe = ΔD - a Δs - ξ p ΔW      the work of grade and mean resistance, excess, and brake under p
              v' = v + 2 Δe / (v + v + Δe/v)
    doubt     a reading far from v' that leapt there; one that repeats itself a third as often as a frozen sensor
    correct   v, ξ, a by the measured speed, weighted by the covariance

D(s) and W(s) are given as broken lines. The path's own friction noise (standard deviation σ_η, correlation length ℓ)
enters as white noise of the same work, variance 2 σ_η² ℓ / Δs.

All arithmetic is float32, one rounding an operation, in the order written; docs/table-format.md states it. A reading
that is missing or doubted corrects nothing: the estimate goes on by the model alone, and the state counts for how many
samples it has done so. Once the standard deviation of the speed is beyond a limit, the answer is cautious: lower than
the estimate, the more the less is known, so that a cut that nobody sees does not stop in the retarder. `alarms` tells.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from tuning_tables.errors import InvalidTable
from tuning_tables.requirement import require_between, require_tuple

Floats = npt.NDArray[np.float32]

STATE_SIZE: Final = 16
"""0 begun (0 or 1); 1 path of the last sample; 2 speed v, 3 friction factor ξ, 4 excess resistance a; covariance 5 vv,
6 vξ, 7 va, 8 ξξ, 9 ξa, 10 aa; 11 samples since the last reading that was believed; 12 the last sensible reading, 13 how
often it was repeated; 14 readings believed since the estimate began; 15 readings doubted in a row."""

UNSEEN: Final = 11
REPEATED: Final = 13
DOUBTED: Final = 15
"""Places in the state."""

LOST_ALARM: Final = 1
SENSOR_ALARM: Final = 2
LIGHTER_ALARM: Final = 4
HEAVIER_ALARM: Final = 8
"""Bits of the alarm word. Lost: the standard deviation of the speed is beyond its limit, answers are cautious. Sensor:
readings are doubted, or one repeats itself. Lighter, heavier: the brake works more, or less, on this cut than on any
of the table's category; its weight may be wrong."""

GATE: Final = 5.0
"""Standard deviations of a surprise, beyond which a reading that leapt is doubted."""

FEW_READINGS: Final = 3
"""As long as fewer were believed, a doubted one begins the estimate anew: the first ones may have been the false."""

LARGEST_EXCESS_M_S2: Final = 0.5
CAUTION: Final = 0.5
"""The answer is lower than the speed by so many limits, times (variance / limit² - 1)."""

MOST_READINGS: Final = 10_000

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
    resistance_std_m_s2    standard deviation of the deceleration by running resistance around the mean of cuts
    path_std, correlation_length_m   σ_η and ℓ of the friction along the path, ℓ in m
    frozen_readings        after so many repetitions of one reading the sensor is frozen; from a third of them on the
                           reading is not believed; `MOST_READINGS`: more than a pass has
    doubted_readings       after so many doubted readings in a row that move as a cut does, the estimate begins anew
    lost_speed_std_m_s     limit of the standard deviation of the speed, beyond which answers are cautious
    unlikely_deviation     of the friction factor from 1, beyond which the cut is not of the table's category
    touch_pressure_kpa     P0, at which the beams touch the wheels: the overpressure is max(0, P - P0)
    s_m, drive_m2_s2, brake_m2_s2_per_kpa   D and W at path breaks, linear between: kinetic energy per mass gained from
                           the first break to s, and lost for each kPa of overpressure at ξ = 1; W never falls, breaks
                           are a millimetre apart at least

    Derived, for `observe` (read-only): parameters float32 (23,), work float32 (3, B). Raises `InvalidTable`.
    """

    speed_noise_m_s: float
    friction_cv: float
    resistance_std_m_s2: float
    path_std: float
    correlation_length_m: float
    frozen_readings: int
    doubted_readings: int
    lost_speed_std_m_s: float
    unlikely_deviation: float
    touch_pressure_kpa: float
    s_m: tuple[float, ...]
    drive_m2_s2: tuple[float, ...]
    brake_m2_s2_per_kpa: tuple[float, ...]
    parameters: Floats = field(init=False, repr=False, compare=False)
    work: Floats = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        require_between(self.speed_noise_m_s, "estimator.speed_noise_m_s", 1e-4, 10.0)
        require_between(self.friction_cv, "estimator.friction_cv", 0.0, 1.0)
        require_between(self.resistance_std_m_s2, "estimator.resistance_std_m_s2", 0.0, 1.0)
        require_between(self.path_std, "estimator.path_std", 0.0, 1.0)
        require_between(self.correlation_length_m, "estimator.correlation_length_m", 1e-3, 1e4)
        require_between(self.frozen_readings, "estimator.frozen_readings", 1, MOST_READINGS)
        require_between(self.doubted_readings, "estimator.doubted_readings", 1, MOST_READINGS)
        require_between(self.lost_speed_std_m_s, "estimator.lost_speed_std_m_s", 1e-3, 10.0)
        require_between(self.unlikely_deviation, "estimator.unlikely_deviation", 0.0, 10.0)
        require_between(self.touch_pressure_kpa, "estimator.touch_pressure_kpa", 0.0, LARGEST_OVERPRESSURE_KPA)
        self._require_work()
        variance = 2.0 * self.path_std**2 * self.correlation_length_m
        numbers = (
            self.speed_noise_m_s**2, self.friction_cv**2, variance, *FACTOR_RANGE, LEAST_SPEED_M_S, LEAST_STEP_M,
            0.0, 1.0, 2.0, LARGEST_SPEED_M_S, LARGEST_OVERPRESSURE_KPA, LARGEST_STEP_M,
            self.resistance_std_m_s2**2, LARGEST_EXCESS_M_S2, GATE**2, GATE * math.sqrt(2.0) * self.speed_noise_m_s,
            FEW_READINGS, self.frozen_readings, self.doubted_readings,
            self.lost_speed_std_m_s**2, CAUTION / self.lost_speed_std_m_s, self.unlikely_deviation,
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
    """The state before the first sample of a cut, float32 (16,)."""
    return np.zeros(STATE_SIZE, dtype=np.float32)


def unseen_samples(state: Floats) -> int:
    """For how many samples no reading was believed: 0 after one that was; before the first, since `begin`.

    The model alone has stood in for the sensor that long. It stays at 2**24, beyond which float32 does not count.
    """
    return int(state[UNSEEN])


def hand_on(state: Floats, v_m_s: float) -> float:
    """`v_m_s` as it is, for a table without estimator; `state` counts samples without a credible speed all the same."""
    credible = 0.0 <= v_m_s <= LARGEST_SPEED_M_S
    state[UNSEEN] = np.float32(0.0) if credible else state[UNSEEN] + np.float32(1.0)
    return v_m_s


def alarms(parameters: Floats, state: Floats) -> int:
    """The alarm word of a cut's state: a sum of the bits `LOST_ALARM` to `HEAVIER_ALARM`, 0 for none."""
    if state[0] == parameters[7]:
        return 0
    lost = state[5] > parameters[20]
    sensor = state[DOUBTED] > parameters[7] or state[REPEATED] >= parameters[18]
    off = state[3] - parameters[8]
    lighter, heavier = off > parameters[22], off < parameters[7] - parameters[22]
    word = LOST_ALARM * int(lost) + SENSOR_ALARM * int(sensor)
    return word + LIGHTER_ALARM * int(lighter) + HEAVIER_ALARM * int(heavier)


def table_after(word: int, present: int, last: int) -> int:
    """Which of the tables 0 … `last`, from the lightest category to the heaviest, brakes a cut from now on.

    `word`: what `alarms` says of the cut by table `present`, which brakes it. Each table's own estimator observes every
    sample. A neighbour takes over where the weight alone is in doubt: a radar that is doubted may be what is wrong.
    `numba.njit(table_after)` compiles this text.
    """
    if word == LIGHTER_ALARM and present > 0:
        return present - 1
    if word == HEAVIER_ALARM and present < last:
        return present + 1
    return present


def observe(parameters: Floats, work: Floats, state: Floats, s_m: float, v_m_s: float, overpressure_kpa: float) -> Any:
    """Take one sample into `state` and return the speed to compare, m/s; −1 as long as no speed was measured.

    To be called at every sample, also while a change of stage is under way, with the path, the measured speed, and the
    mean of max(0, P - P0) since the sample before. What cannot be true changes little: a speed above 40 m/s, negative
    or not finite corrects nothing, such an overpressure counts as 0, a path that goes back, or on by more than 20 m, as
    no movement. A cut begins with a reading of the least speed or more. A reading is doubted, and corrects nothing, if
    it is far from the estimate and leapt there: more than the noise of two readings and all that the brake does are off
    between it and the last; after a missing one, if it is below the least speed. Doubt ends with a reading near the
    estimate. `state`, float32 (16,), is changed in place. `numba.njit(observe)` compiles this text, same numbers.
    """
    nought, one, two, least_speed = parameters[7], parameters[8], parameters[9], parameters[5]
    last = work.shape[1] - 1
    # Written so that NaN fails each of them, and before the conversion, so that no number overflows in it.
    sensible = 0.0 <= v_m_s <= float(parameters[10])
    v = np.float32(v_m_s) if sensible else nought
    p = np.float32(overpressure_kpa) if 0.0 <= overpressure_kpa <= float(parameters[11]) else nought
    begun = state[0] != nought
    before = state[1] if begun else work[0, 0]
    farthest = before + parameters[12] if begun else work[0, last]
    s = np.float32(s_m) if float(before) <= s_m <= float(farthest) else before
    reading, heard = state[12], state[11] == nought or state[13] > nought
    state[13] = state[13] + one if sensible and v == reading else nought
    state[12] = v if sensible else reading
    believed = sensible and state[13] + state[13] + state[13] < parameters[18]
    anew = not begun
    if anew:
        believed = believed and v >= least_speed
    else:
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
        step, speed, work_at_one = s - before, state[2], p * brake
        gained = drive - state[4] * step - state[3] * work_at_one
        mean = max((speed + speed + gained / speed) / two, least_speed)
        predicted = max(speed + gained / mean, least_speed)
        slope, effect, drag = speed / predicted, work_at_one / mean, step / mean
        path_variance = parameters[2] / max(step, parameters[6])
        p12 = slope * state[6] - effect * state[8] - drag * state[9]
        p13 = slope * state[7] - effect * state[9] - drag * state[10]
        p11 = slope * (slope * state[5] - effect * state[6] - drag * state[7])
        p11 = max(p11 - effect * (p12 - effect * path_variance) - drag * p13, nought)
        state[1], state[2], state[5], state[6], state[7] = s, predicted, p11, p12, p13
        if believed:
            total, surprise = p11 + parameters[0], v - predicted
            leap, most = (v - reading) - (predicted - speed), parameters[16] + effect
            leaps = leap > most or leap < nought - most
            strange = leaps if heard else v < least_speed
            if surprise * surprise > parameters[15] * total and (strange or state[15] > nought):
                moves = v >= least_speed and not leaps
                state[15] = state[15] + one if moves else one
                anew = v >= least_speed and (state[14] < parameters[17] or state[15] >= parameters[19])
                believed = anew
            else:
                gain, factor_gain, excess_gain = p11 / total, p12 / total, p13 / total
                factor, excess = state[3] + factor_gain * surprise, state[4] + excess_gain * surprise
                state[2] = max(predicted + gain * surprise, least_speed)
                state[3] = min(max(factor, parameters[3]), parameters[4])
                state[4] = min(max(excess, nought - parameters[14]), parameters[14])
                state[5], state[6], state[7] = p11 - gain * p11, p12 - gain * p12, p13 - gain * p13
                state[8] = max(state[8] - factor_gain * p12, nought)
                state[9] = state[9] - factor_gain * p13
                state[10] = max(state[10] - excess_gain * p13, nought)
                state[14], state[15] = state[14] + one, nought
    state[11] = nought if believed else state[11] + one
    if anew and believed:
        state[0], state[1], state[2], state[3], state[4] = one, s, v, one, nought
        state[5], state[6], state[7] = parameters[0], nought, nought
        state[8], state[9], state[10] = parameters[1], nought, parameters[13]
        state[14], state[15] = one, nought
    if state[0] == nought:
        return nought - one
    beyond = max(state[5] - parameters[20], nought)
    return max(state[2] - parameters[21] * beyond, nought)
