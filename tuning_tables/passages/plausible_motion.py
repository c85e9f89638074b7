"""What a cut can do between two passages: the limits by which the tracker believes a pulse pair or not."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from tuning_tables.errors import InvalidTable
from tuning_tables.requirement import require_between, require_tuple

FASTEST_M_S: Final = 40.0
SPEED_RANGE_M_S: Final = (0.01, FASTEST_M_S)
ACCELERATION_RANGE_M_S2: Final = (0.001, 10.0)
SPEED_TOLERANCE_RANGE: Final = (0.0, 0.9)
PATH_TOLERANCE_RANGE_M: Final = (0.0, 10.0)


@dataclass(frozen=True)
class PlausibleMotion:
    """Limits for `tracker.believed_passage`, all inclusive.

    speed_m_s             (least, greatest) speed that a reading may tell, within [0.01, 40]
    acceleration_m_s2     greatest acceleration of a cut, 0.001 to 10
    deceleration_m_s2     greatest deceleration, 0.001 to 10
    speed_tolerance       relative error allowed of a speed, 0 to 0.9
    path_tolerance_m      error allowed of a path, 0 to 10

    Raises `InvalidTable`.
    """

    speed_m_s: tuple[float, float]
    acceleration_m_s2: float
    deceleration_m_s2: float
    speed_tolerance: float
    path_tolerance_m: float

    def __post_init__(self) -> None:
        require_tuple(self.speed_m_s, "plausible.speed_m_s", 2)
        for index, speed in enumerate(self.speed_m_s):
            require_between(speed, f"plausible.speed_m_s[{index}]", *SPEED_RANGE_M_S)
        if not self.speed_m_s[0] < self.speed_m_s[1]:
            raise InvalidTable(f"plausible.speed_m_s is {self.speed_m_s!r}, but the lesser speed must come first.")
        require_between(self.acceleration_m_s2, "plausible.acceleration_m_s2", *ACCELERATION_RANGE_M_S2)
        require_between(self.deceleration_m_s2, "plausible.deceleration_m_s2", *ACCELERATION_RANGE_M_S2)
        require_between(self.speed_tolerance, "plausible.speed_tolerance", *SPEED_TOLERANCE_RANGE)
        require_between(self.path_tolerance_m, "plausible.path_tolerance_m", *PATH_TOLERANCE_RANGE_M)

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
