"""What is to be solved: one cut class at one retarder position, and the aim, the speed it must leave with."""

from __future__ import annotations

from dataclasses import dataclass, replace

from plant_models import Plant
from plant_models.errors import require, require_between
from synth.problem.criterion import SQUARED_ERROR_CRITERION, Criterion
from synth.problem.requirement import FrictionRange

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


@dataclass(frozen=True)
class Problem:
    """What is to be solved: a plant, and what its lines are for.

    Parameters
    ----------
    plant
        One cut class at one retarder position.
    aim
        The exit speed, and the criterion.

    Raises
    ------
    PlantError
        The two do not fit.

    Examples
    --------
    >>> import synth
    >>> plant = dict(synth.load_config().plants())["gondola-4-52t"]
    >>> synth.Problem(plant, synth.Aim(3.0))
    Problem(knp-5-bunch, 52 t on 4 axles, entry 5 to 6.5 m/s, to 3 m/s)
    >>> synth.Problem(plant, synth.Aim(9.0))
    Traceback (most recent call last):
    ...
    plant_models.errors.PlantError: targets: 9 m/s is not below the highest entry speed 6.5 m/s: there is nothing to ...
    """

    plant: Plant
    aim: Aim

    def __post_init__(self) -> None:
        require(
            self.target_speed_m_s < self.plant.entry.high_m_s,
            f"targets: {self.target_speed_m_s:g} m/s is not below the highest entry speed "
            f"{self.plant.entry.high_m_s:g} m/s: there is nothing to brake; lower the target",
        )
        if isinstance(self.criterion.requirement, FrictionRange):
            require_modelled(self.plant, self.criterion.requirement)

    def __repr__(self) -> str:
        return f"Problem({repr(self.plant)[len('Plant(') : -1]}, to {self.target_speed_m_s:g} m/s)"

    @property
    def target_speed_m_s(self) -> float:
        """The commanded exit speed."""
        return self.aim.target_speed_m_s

    @property
    def criterion(self) -> Criterion:
        """What a pass costs."""
        return self.aim.criterion


def require_modelled(plant: Plant, friction: FrictionRange) -> None:
    """Raise `PlantError` unless the range lies within four standard deviations of ξ_cut, which grids cover."""
    low, high = max(plant.friction.floor, 1.0 - 4.0 * plant.friction_cv), 1.0 + 4.0 * plant.friction_cv
    for name, value in (("low", friction.low), ("high", friction.high)):
        require(
            low <= value <= high,
            f"criterion: worst_friction_{name} is {value:g}; the friction of this cut is modelled from {low:.3g} "
            f"to {high:.3g}: keep within, or raise friction.common_cv",
        )
