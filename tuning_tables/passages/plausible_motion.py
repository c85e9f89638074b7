"""What a cut can do between two passages: the limits by which the tracker believes a pulse pair or not."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Final

from tuning_tables.declared.members import require_declared
from tuning_tables.declared.numbers import Number, Row
from tuning_tables.errors import InvalidTable

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
