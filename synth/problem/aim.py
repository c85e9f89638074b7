"""What the lines of one table are for."""

from __future__ import annotations

from dataclasses import dataclass, replace

from plant_models.errors import require_between
from synth.problem.criterion import SQUARED_ERROR_CRITERION, Criterion

OVERSPEED_M_S = 0.3
"""An exit that is faster than the target by more than this is an over-speed."""


@dataclass(frozen=True)
class Aim:
    """The commanded exit speed, and what a pass costs that misses it.

    Parameters
    ----------
    target_speed_m_s
        The commanded exit speed, m/s.
    criterion
        What a pass costs; by default the squared error.

    Raises
    ------
    PlantError
        A speed out of range.

    Examples
    --------
    >>> import synth
    >>> aim = synth.Aim(3.0, synth.Criterion(time_price_m2_s3=1e-4))
    >>> aim.prices_time, aim.timeless == synth.Aim(3.0)
    (True, True)
    """

    target_speed_m_s: float
    criterion: Criterion = SQUARED_ERROR_CRITERION

    def __post_init__(self) -> None:
        require_between("targets: target_speed_m_s", self.target_speed_m_s, 0.3, 20.0)

    @property
    def timeless(self) -> Aim:
        """The same where a second costs nothing."""
        return replace(self, criterion=replace(self.criterion, time_price_m2_s3=0.0))

    @property
    def prices_time(self) -> bool:
        """Whether a second costs something."""
        return self.criterion.time_price_m2_s3 > 0.0
