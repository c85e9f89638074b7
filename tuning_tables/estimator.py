"""What the estimator of speed, friction and resistance must know of a cut; how it works is `programs.observe`."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Annotated, Final

import numpy as np
import numpy.typing as npt

from tuning_tables.declared.members import require_declared
from tuning_tables.declared.numbers import Count, Number, Row
from tuning_tables.errors import InvalidTable, require_tuple
from tuning_tables.programs.held import ESTIMATE, UNSEEN
from tuning_tables.programs.motion_filter import LEAST_STEP_M
from tuning_tables.programs.observe import GATE, LARGEST_OVERPRESSURE_KPA

Floats = npt.NDArray[np.float32]

STATE_SIZE: Final = len(ESTIMATE.members)

CAUTION: Final = 0.5
"""The answer is lower than the speed by so many limits, times (variance / limit² - 1)."""

MOST_READINGS: Final = 10_000

MOST_BREAKS: Final = 256
FARTHEST_M: Final = 1e4
LARGEST_WORK: Final = 1e6


def at_breaks(meaning: str, largest: float) -> Row:
    """A number at each path break."""
    return Row(Number(meaning, -largest, largest), "break", 2, MOST_BREAKS)


@dataclass(frozen=True)
class Estimator:
    """What the estimator must know of a cut in a position; the lines are then for the speed that it estimates.

    Energies are those per inertia from the first path break on, linear between breaks. Breaks are a millimetre apart at
    least, as float32. The work of the brake never falls along the path.

    Derived (read-only): `numbers`, those that a controller holds, by their names in `LineTable`; `work`, float32
    (3, B).
    Raises `InvalidTable`.

    Examples
    --------
    >>> from tuning_tables import Estimator
    >>> estimator = Estimator(
    ...     speed_noise_m_s=0.05,
    ...     friction_cv=0.15,
    ...     resistance_std_m_s2=0.006,
    ...     path_std=0.1,
    ...     correlation_length_m=2.0,
    ...     frozen_readings=7,
    ...     doubted_readings=20,
    ...     lost_speed_std_m_s=0.2,
    ...     unlikely_deviation=0.5,
    ...     touch_pressure_kpa=50.0,
    ...     s_m=(0.0, 22.5),
    ...     drive_m2_s2=(0.0, 1.0),
    ...     brake_m2_s2_per_kpa=(0.0, 0.03),
    ... )
    >>> estimator
    Estimator(2 path breaks from 0 to 22.5 m)
    >>> estimator.work.shape
    (3, 2)
    """

    speed_noise_m_s: Annotated[
        float, Number("standard deviation of a measured speed, its rounding included", 1e-4, 10.0)
    ]
    friction_cv: Annotated[float, Number("standard deviation of the friction factor of cuts around 1", 0.0, 1.0)]
    resistance_std_m_s2: Annotated[
        float, Number("standard deviation of the deceleration by running resistance around its mean", 0.0, 1.0)
    ]
    path_std: Annotated[float, Number("standard deviation of the friction along the path", 0.0, 1.0)]
    correlation_length_m: Annotated[float, Number("correlation length of the friction along the path", 1e-3, 1e4)]
    frozen_readings: Annotated[
        int,
        Count(
            f"after so many repetitions of a reading the sensor is frozen; from a third of them on it is not believed; "
            f"{MOST_READINGS}: more than a pass has",
            1,
            MOST_READINGS,
        ),
    ]
    doubted_readings: Annotated[
        int,
        Count("after so many doubted readings in a row that move as a cut does it begins anew", 1, MOST_READINGS),
    ]
    lost_speed_std_m_s: Annotated[
        float, Number("standard deviation of the estimated speed beyond which the cut is lost", 1e-3, 10.0)
    ]
    unlikely_deviation: Annotated[
        float, Number("of the friction factor from 1, beyond which the cut is not of the category", 0.0, 10.0)
    ]
    touch_pressure_kpa: Annotated[
        float, Number("P0: the overpressure is max(0, P - P0)", 0.0, float(LARGEST_OVERPRESSURE_KPA))
    ]
    s_m: Annotated[tuple[float, ...], at_breaks("path breaks", FARTHEST_M)]
    drive_m2_s2: Annotated[tuple[float, ...], at_breaks("D: energy gained from grade and resistance", LARGEST_WORK)]
    brake_m2_s2_per_kpa: Annotated[
        tuple[float, ...], at_breaks("W: energy lost in the brake at the friction factor 1", LARGEST_WORK)
    ]
    work: Floats = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        require_declared(self, "estimator")
        self._require_work()
        work = np.array((self.s_m, self.drive_m2_s2, self.brake_m2_s2_per_kpa), dtype=np.float32)
        work.setflags(write=False)
        object.__setattr__(self, "work", work)

    def __repr__(self) -> str:
        return f"Estimator({len(self.s_m)} path breaks from {self.s_m[0]:g} to {self.s_m[-1]:g} m)"

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
        for key in ("drive_m2_s2", "brake_m2_s2_per_kpa"):
            require_tuple(getattr(self, key), f"estimator.{key}", len(self.s_m))
        # In float32, as they are divided by.
        if not (np.diff(np.array(self.s_m, dtype=np.float32)) >= LEAST_STEP_M).all():
            raise InvalidTable(f"estimator.s_m must rise by {LEAST_STEP_M:g} m at least from break to break.")
        if any(later < earlier for earlier, later in pairwise(self.brake_m2_s2_per_kpa)):
            raise InvalidTable("estimator.brake_m2_s2_per_kpa falls, but a brake only takes energy away.")


def begin() -> Floats:
    """The state of an estimate before the first sample of a cut.

    Returns
    -------
    ndarray
        float32 (16,), all 0.

    Examples
    --------
    >>> from tuning_tables import begin
    >>> begin().shape
    (16,)
    """
    return np.zeros(STATE_SIZE, dtype=np.float32)


def unseen_samples(state: Floats) -> int:
    """For how many samples no reading was believed: so long has the model alone stood in for the sensor.

    Parameters
    ----------
    state
        The state of the cut, float32 (16,).

    Returns
    -------
    int
        0 after a reading that was believed; before the first one, the samples since `begin`. It stays at 2**24, beyond
        which float32 does not count.

    Examples
    --------
    With `table` from the example of `ControllerTable`:

    >>> from tuning_tables import begin, speed_for, unseen_samples
    >>> state = begin()
    >>> _ = speed_for(table, state, s_m=0.4, v_m_s=float("nan"), overpressure_kpa=0.0)
    >>> unseen_samples(state)
    1
    """
    return int(state[UNSEEN])
