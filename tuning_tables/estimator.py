"""What the estimator of speed, friction and resistance must know of a cut; how it works is `programs.observe`."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Final

import numpy as np
import numpy.typing as npt

from tuning_tables.errors import InvalidTable
from tuning_tables.programs.estimate import ESTIMATE, UNSEEN
from tuning_tables.programs.motion_filter import LEAST_STEP_M
from tuning_tables.programs.observe import GATE, LARGEST_OVERPRESSURE_KPA
from tuning_tables.requirement import require_between, require_tuple

Floats = npt.NDArray[np.float32]

STATE_SIZE: Final = len(ESTIMATE.members)

CAUTION: Final = 0.5
"""The answer is lower than the speed by so many limits, times (variance / limit² - 1)."""

MOST_READINGS: Final = 10_000

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

    Derived (read-only): `numbers`, those that a controller holds, by their names in `LineTable`; work float32 (3, B).
    Raises `InvalidTable`.
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
        require_between(self.touch_pressure_kpa, "estimator.touch_pressure_kpa", 0.0, float(LARGEST_OVERPRESSURE_KPA))
        self._require_work()
        work = np.array((self.s_m, self.drive_m2_s2, self.brake_m2_s2_per_kpa), dtype=np.float32)
        work.setflags(write=False)
        object.__setattr__(self, "work", work)

    @property
    def numbers(self) -> Mapping[str, float]:
        """The numbers that a controller holds, in the order of `LineTable`."""
        return {
            "speed_variance": self.speed_noise_m_s**2,
            "factor_variance": self.friction_cv**2,
            "path_variance": 2.0 * self.path_std**2 * self.correlation_length_m,
            "excess_variance": self.resistance_std_m_s2**2,
            "leap_m_s": GATE * math.sqrt(2.0) * self.speed_noise_m_s,
            "frozen": self.frozen_readings,
            "doubted": self.doubted_readings,
            "lost_variance": self.lost_speed_std_m_s**2,
            "caution": CAUTION / self.lost_speed_std_m_s,
            "unlikely": self.unlikely_deviation,
        }

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
