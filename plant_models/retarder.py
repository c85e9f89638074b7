"""A retarder position: its braking zones, its stages and its force law."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Protocol

from plant_models.cut import Cut
from plant_models.errors import require, require_between
from plant_models.pneumatics import Pneumatics


class ForceLaw(Protocol):
    """Braking force of one wheel pair: slope · max(0, P − touch pressure)."""

    @property
    def touch_pressure_kpa(self) -> float:
        """Pressure P0 at which the pads touch the wheels."""
        ...

    def slope_kn_per_kpa(self, cut: Cut, axles_inside: int) -> float:
        """Mean slope K·c(N) of the force of one wheel pair.

        Parameters
        ----------
        cut
            The cut.
        axles_inside
            N: so many wheel pairs are braked.

        Returns
        -------
        float
            kN for each kPa above the touch pressure.
        """
        ...


@dataclass(frozen=True)
class PressingForce:
    """Pressing retarder: the force is set by the drive and does not depend on the car ([zhukovitsky-2012]).

    Parameters
    ----------
    slope_kn_per_kpa_per_pair
        Force of one wheel pair, kN for each kPa above the touch pressure.
    touch_pressure_kpa
        Pressure P0 at which the pads touch the wheels, kPa gauge.
    slope_factor_by_axles
        c(1), c(2), …: factors of the mean slope by the number of braked wheel pairs; beyond the end the last one holds.

    Raises
    ------
    PlantError
        A number out of range.

    Examples
    --------
    >>> from plant_models import Cut, PressingForce
    >>> cut = Cut("С", mass_t=52.0, axle_offsets_m=(0.0, 1.85, 8.65, 10.5), allowed_stage=3)
    >>> force = PressingForce(
    ...     slope_kn_per_kpa_per_pair=0.04,
    ...     touch_pressure_kpa=50.0,
    ...     slope_factor_by_axles=(1.0, 0.9),
    ... )
    >>> (
    ...     force.slope_kn_per_kpa(cut, axles_inside=1),
    ...     round(force.slope_kn_per_kpa(cut, axles_inside=3), 3),
    ... )
    (0.04, 0.036)
    """

    slope_kn_per_kpa_per_pair: float
    touch_pressure_kpa: float
    slope_factor_by_axles: tuple[float, ...] = (1.0,)

    def __post_init__(self) -> None:
        require_between("force: slope_kn_per_kpa", self.slope_kn_per_kpa_per_pair, 1e-4, 10.0)
        require_between("force: touch_pressure_kpa", self.touch_pressure_kpa, 0.0, 1000.0)
        require_factors(self.slope_factor_by_axles)

    def slope_kn_per_kpa(self, cut: Cut, axles_inside: int) -> float:
        """See `ForceLaw`."""
        return self.slope_kn_per_kpa_per_pair * factor_at(self.slope_factor_by_axles, axles_inside)


@dataclass(frozen=True)
class WeightForce:
    """Weight-proportional retarder (КВ type): the load of the wheel itself sets the force.

    Force of a wheel pair = slope · axle load · max(0, P − P0).

    Parameters
    ----------
    slope_kn_per_kpa_per_t
        kN for each kPa above the touch pressure and each tonne of axle load.
    touch_pressure_kpa
        Pressure P0 at which the pads touch the wheels, kPa gauge.
    slope_factor_by_axles
        As of `PressingForce`.

    Raises
    ------
    PlantError
        A number out of range.

    Examples
    --------
    >>> from plant_models import Cut, WeightForce
    >>> cut = Cut("С", mass_t=52.0, axle_offsets_m=(0.0, 1.85, 8.65, 10.5), allowed_stage=3)
    >>> WeightForce(slope_kn_per_kpa_per_t=0.25, touch_pressure_kpa=50.0).slope_kn_per_kpa(
    ...     cut, axles_inside=1
    ... )
    3.25
    """

    slope_kn_per_kpa_per_t: float
    touch_pressure_kpa: float
    slope_factor_by_axles: tuple[float, ...] = (1.0,)

    def __post_init__(self) -> None:
        require_between("force: slope_kn_per_kpa_per_t", self.slope_kn_per_kpa_per_t, 1e-6, 1.0)
        require_between("force: touch_pressure_kpa", self.touch_pressure_kpa, 0.0, 1000.0)
        require_factors(self.slope_factor_by_axles)

    def slope_kn_per_kpa(self, cut: Cut, axles_inside: int) -> float:
        """See `ForceLaw`."""
        return self.slope_kn_per_kpa_per_t * cut.axle_load_t * factor_at(self.slope_factor_by_axles, axles_inside)


@dataclass(frozen=True)
class RetarderPosition:
    """One or more retarders that are commanded together.

    Parameters
    ----------
    name
        Its name.
    zones_m
        Beginning and end of each retarder, m from the entrance of the first one, which begins at 0.
    stage_pressures_kpa
        P_0 < P_1 < … < P_K, kPa gauge.
    force
        The force law of its type, `PressingForce` or `WeightForce`.
    pneumatics
        The drive.
    max_entry_speed_m_s
        Limit of the type, m/s.

    Raises
    ------
    PlantError
        Zones that overlap, pressures that do not rise or cannot be reached, or a number out of range.

    Examples
    --------
    >>> from plant_models import PressingForce, RetarderPosition
    >>> from plant_models.library import load_position
    >>> position = RetarderPosition(
    ...     "my-retarder",
    ...     zones_m=((0.0, 12.0),),
    ...     stage_pressures_kpa=(0.0, 200.0, 400.0),
    ...     force=PressingForce(0.04, touch_pressure_kpa=50.0),
    ...     pneumatics=load_position("knp-5-bunch").position.pneumatics,
    ...     max_entry_speed_m_s=7.0,
    ... )
    >>> position.top_stage
    2
    """

    name: str
    zones_m: tuple[tuple[float, float], ...]
    stage_pressures_kpa: tuple[float, ...]
    force: ForceLaw
    pneumatics: Pneumatics
    max_entry_speed_m_s: float

    def __post_init__(self) -> None:
        require(
            len(self.zones_m) >= 1 and self.zones_m[0][0] == 0.0,
            f"retarder: zones_m is {self.zones_m}; the first zone must start at 0",
        )
        flat = [edge for zone in self.zones_m for edge in zone]
        require(
            all(b > a for a, b in pairwise(flat)) and flat[-1] <= 500.0,
            f"retarder: zones_m is {self.zones_m}; zones must be ordered, must not overlap and must end under 500 m",
        )
        pressures = self.stage_pressures_kpa
        require(
            len(pressures) >= 2 and all(b > a for a, b in pairwise(pressures)),
            f"retarder: stage_pressures_kpa is {pressures}; give at least two pressures, each above the one before",
        )
        require_between("retarder: stage_pressures_kpa", pressures[0], 0.0, 2000.0)
        self.pneumatics.require_reachable(pressures)
        require_between("retarder: max_entry_speed_m_s", self.max_entry_speed_m_s, 0.5, 20.0)

    @property
    def top_stage(self) -> int:
        """Highest stage K."""
        return len(self.stage_pressures_kpa) - 1

    def require_settling(self) -> None:
        """Raise unless the regulator comes to rest after every command between two stages: here, not in a solve."""
        for start in self.stage_pressures_kpa:
            for end in self.stage_pressures_kpa:
                self.pneumatics.respond(start, end, self.force.touch_pressure_kpa)

    def exit_m(self, cut: Cut) -> float:
        """Path of the first axle at which the last axle leaves the last retarder, S_exit."""
        return self.zones_m[-1][1] + cut.axle_offsets_m[-1]


def require_factors(factors: tuple[float, ...]) -> None:
    """Raise unless the mean-slope factors c(N) are positive and not absurd."""
    require(len(factors) >= 1, "force: slope_factor_by_axles is empty; give at least one factor")
    for factor in factors:
        require_between("force: slope_factor_by_axles", factor, 0.05, 5.0)


def factor_at(factors: tuple[float, ...], axles_inside: int) -> float:
    """c(N), the last factor holding beyond the end of the list."""
    return factors[min(axles_inside, len(factors)) - 1]
