"""The numbers of an estimator that a controller holds, in C and in Structured Text: stated once, in their order."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from tuning_tables.estimator import Estimator, Floats


@dataclass(frozen=True)
class HeldNumber:
    """A binary32 number: its names in C and in Structured Text, what it means, and where `Estimator.parameters` has it.

    `place` None: the touch pressure, which is no parameter of `observe`.
    """

    c: str
    st: str
    meaning: str
    place: int | None


HELD_NUMBERS: Final = (
    HeldNumber("speed_variance", "SpeedVariance", "variance of a measured speed, m2/s2", 0),
    HeldNumber("factor_variance", "FactorVariance", "variance of the friction factor of cuts", 1),
    HeldNumber("path_variance", "PathVariance", "variance of the friction along the path, times its length, m", 2),
    HeldNumber("touch_kpa", "Touch_kpa", "touch pressure, at which the beams touch the wheels, kPa", None),
    HeldNumber("excess_variance", "ExcessVariance", "variance of the excess resistance of cuts, m2/s4", 13),
    HeldNumber("leap_m_s", "Leap", "between two readings, what noise cannot explain, m/s", 16),
    HeldNumber("frozen", "Frozen", "repetitions of a reading of a frozen sensor", 18),
    HeldNumber("doubted", "Doubted", "doubted readings after which the estimate begins anew", 19),
    HeldNumber("lost_variance", "LostVariance", "variance of the speed beyond which the cut is lost, m2/s2", 20),
    HeldNumber("caution", "Caution", "of the answer for a lost cut, s/m", 21),
    HeldNumber("unlikely", "Unlikely", "deviation of the friction factor that no cut of the category has", 22),
)

TOUCH_PLACE: Final = next(place for place, each in enumerate(HELD_NUMBERS) if each.place is None)


def held_numbers(estimator: Estimator) -> Floats:
    """The numbers of `estimator` in the order of `HELD_NUMBERS`, float32."""
    places = (each.place for each in HELD_NUMBERS)
    touch_kpa = np.float32(estimator.touch_pressure_kpa)
    return np.array([touch_kpa if place is None else estimator.parameters[place] for place in places], dtype=np.float32)
