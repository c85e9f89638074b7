"""The point sensors that a table is for: where they stand, how they measure, and at whose passages is decided; and
what a cut can do between two passages: the limits by which the tracker believes a pulse pair or not.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from itertools import pairwise
from typing import Annotated, Final

from tuning_tables.decisions import DELAY_RANGE_S, in_words
from tuning_tables.declared.members import require_declared
from tuning_tables.declared.numbers import Number, Row
from tuning_tables.declared.texts import Word
from tuning_tables.errors import InvalidTable, require_rising

MOST_SENSORS: Final = 32
SHORTEST_SECTION_M: Final = 0.3
ROUNDING_M: Final = 1e-9
"""By so much a difference of places may be off: 1.2 − 0.9 is less than 0.3."""
PLACE_RANGE_M: Final = (-100.0, 500.0)
BASE_RANGE_M: Final = (0.05, 1.0)
TOLERANCE_RANGE: Final = (0.0, 0.2)
TIMER_RANGE_S: Final = (0.0, 0.05)
SCAN_RANGE_S: Final = (0.001, 0.5)


Met = tuple[int, int, float]
"""Sensor and axle, both numbered from 0, and the path of the first axle when the axle is at the middle of the base."""


class DecidesOn(Enum):
    """Whose passages the regulator decides at; the value is the word in files."""

    FIRST_AXLE = "first_axle"
    EVERY_AXLE = "every_axle"

    def axles(self, count: int) -> range:
        """The numbers, from 0, of those axles of a cut with `count` axles."""
        return range(count if self is DecidesOn.EVERY_AXLE else 1)


@dataclass(frozen=True)
class SensorLayout:
    """The sensors of a retarder position and the clock of the regulator that listens to them.

    Sensors rise along the path, each at least 0.3 m behind the one before and no base over another; the first stands
    before the entrance. Speed is the base over the time between the pulses of the two coils.

    Raises `InvalidTable`.

    Examples
    --------
    >>> from tuning_tables import DecidesOn, SensorLayout
    >>> sensors = SensorLayout(
    ...     path_m=(-1.0, 6.0),
    ...     base_m=0.2,
    ...     base_tolerance=0.002,
    ...     timer_noise_s=1e-4,
    ...     timer_resolution_s=1e-4,
    ...     computing_delay_s=0.02,
    ...     scan_period_s=0.02,
    ...     decides_on=DecidesOn.FIRST_AXLE,
    ... )
    >>> sensors.heard(axle_offsets_m=(0.0, 10.5))
    ((0, 0, -1.0), (1, 0, 6.0), (0, 1, 9.5), (1, 1, 16.5))
    >>> sensors.passages(axle_offsets_m=(0.0, 10.5), exit_m=22.5)
    ((0, 0, -1.0), (1, 0, 6.0))
    """

    path_m: Annotated[
        tuple[float, ...],
        Row(Number("middle of the base of each, from the entrance", *PLACE_RANGE_M), "sensor", 1, MOST_SENSORS),
    ]
    base_m: Annotated[float, Number("distance of the two coils of a sensor", *BASE_RANGE_M)]
    base_tolerance: Annotated[
        float, Number("standard deviation of its relative error, lasting for each sensor", *TOLERANCE_RANGE)
    ]
    timer_noise_s: Annotated[float, Number("standard deviation of a measured time", *TIMER_RANGE_S)]
    timer_resolution_s: Annotated[
        float, Number("measured times are whole multiples of it; 0: not rounded", *TIMER_RANGE_S)
    ]
    computing_delay_s: Annotated[
        float, Number("from the second pulse to the command on the wires of the valves", *DELAY_RANGE_S)
    ]
    scan_period_s: Annotated[
        float, Number("step of the regulator's clock: a change of stage lasts a whole number of them", *SCAN_RANGE_S)
    ]
    decides_on: Annotated[DecidesOn, Word("whose passages are decided at", DecidesOn)]

    def __post_init__(self) -> None:
        require_declared(self, "sensors")
        require_rising(self.path_m, "sensors.path_m")
        for index, (before, after) in enumerate(pairwise(self.path_m), start=1):
            if not (after - before >= SHORTEST_SECTION_M - ROUNDING_M and after - before > self.base_m):
                raise InvalidTable(
                    f"sensors.path_m[{index}] is {after!r}, but it must be at least {SHORTEST_SECTION_M} m, and more "
                    f"than sensors.base_m, {self.base_m!r}, behind the sensor before, {before!r}."
                )

    @property
    def clock(self) -> str:
        """The clock of the regulator in words."""
        return in_words("a step", self.scan_period_s, self.computing_delay_s)

    def heard(self, axle_offsets_m: tuple[float, ...]) -> tuple[Met, ...]:
        """Every passage of an axle over a sensor, in the order of the path, then of the sensors: each gives pulses."""
        met = [
            (sensor, axle, place + offset)
            for sensor, place in enumerate(self.path_m)
            for axle, offset in enumerate(axle_offsets_m)
        ]
        return tuple(sorted(met, key=lambda each: (each[2], each[0])))

    def passages(self, axle_offsets_m: tuple[float, ...], exit_m: float) -> tuple[Met, ...]:
        """Those of the passages heard at which is decided: of the axles in question, before `exit_m`.

        At `exit_m`, or behind, nothing is decided any more: less than 1 nm before it counts as there.
        """
        axles = self.decides_on.axles(len(axle_offsets_m))
        return tuple(each for each in self.heard(axle_offsets_m) if each[1] in axles and each[2] < exit_m - 1e-9)


FASTEST_M_S: Final = 40.0
SPEED_RANGE_M_S: Final = (0.01, FASTEST_M_S)
ACCELERATION_RANGE_M_S2: Final = (0.001, 10.0)
SPEED_TOLERANCE_RANGE: Final = (0.0, 0.9)
PATH_TOLERANCE_RANGE_M: Final = (0.0, 10.0)


@dataclass(frozen=True)
class PlausibleMotion:
    """Limits for `tracker.believed_passage`, all inclusive.

    Raises `InvalidTable`.

    Examples
    --------
    >>> from tuning_tables import PlausibleMotion
    >>> PlausibleMotion(
    ...     speed_m_s=(0.5, 10.0),
    ...     acceleration_m_s2=0.5,
    ...     deceleration_m_s2=4.0,
    ...     speed_tolerance=0.05,
    ...     path_tolerance_m=0.5,
    ... ).numbers
    (0.5, 10.0, 0.5, 4.0, 0.05, 0.5)
    """

    speed_m_s: Annotated[
        tuple[float, float], Row(Number("least and greatest speed that is believed", *SPEED_RANGE_M_S), "end", 2, 2)
    ]
    acceleration_m_s2: Annotated[float, Number("greatest of a cut", *ACCELERATION_RANGE_M_S2)]
    deceleration_m_s2: Annotated[float, Number("greatest of a cut", *ACCELERATION_RANGE_M_S2)]
    speed_tolerance: Annotated[float, Number("relative error allowed of a speed", *SPEED_TOLERANCE_RANGE)]
    path_tolerance_m: Annotated[float, Number("error allowed of a path", *PATH_TOLERANCE_RANGE_M)]

    def __post_init__(self) -> None:
        require_declared(self, "plausible")
        if not self.speed_m_s[0] < self.speed_m_s[1]:
            raise InvalidTable(f"plausible.speed_m_s is {self.speed_m_s!r}, but the lesser speed must come first.")

    @property
    def numbers(self) -> tuple[float, float, float, float, float, float]:
        """All six in the order of `tracker.believed_passage`, in double precision."""
        return (
            *self.speed_m_s,
            self.acceleration_m_s2,
            self.deceleration_m_s2,
            self.speed_tolerance,
            self.path_tolerance_m,
        )
