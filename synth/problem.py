"""What is to be solved: one cut class at one retarder position, and the speed it must leave with."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models import (
    Cut,
    DopplerSensor,
    Friction,
    RetarderPosition,
    RollingResistance,
    TrackProfile,
    mean_braked_axles,
)
from plant_models.errors import require, require_between


@dataclass(frozen=True)
class EntrySpeed:
    """Speed of the first axle at the entrance, uniform in [low, high], m/s."""

    low_m_s: float
    high_m_s: float

    def __post_init__(self) -> None:
        require_between("entry: low_m_s", self.low_m_s, 0.3, 20.0)
        require(
            self.low_m_s <= self.high_m_s <= 20.0,
            f"entry: high_m_s is {self.high_m_s!r}; it must be from low_m_s = {self.low_m_s:g} to 20",
        )

    def speed_m_s(self, u: NDArray[np.float64]) -> NDArray[np.float64]:
        """Entry speed for uniform `u` in [0, 1)."""
        return self.low_m_s + (self.high_m_s - self.low_m_s) * u


@dataclass(frozen=True)
class Plant:
    """Everything about a pass but the commanded speed."""

    position: RetarderPosition
    cut: Cut
    profile: TrackProfile
    friction: Friction
    resistance: RollingResistance
    sensor: DopplerSensor
    entry: EntrySpeed

    def __post_init__(self) -> None:
        require(
            self.entry.high_m_s <= self.position.max_entry_speed_m_s,
            f"entry: high_m_s is {self.entry.high_m_s:g}; {self.position.name} takes at most "
            f"{self.position.max_entry_speed_m_s:g} m/s: lower it or choose another retarder",
        )

    @property
    def exit_m(self) -> float:
        """S_exit, metres."""
        return self.position.exit_m(self.cut)

    @property
    def top_stage(self) -> int:
        """Highest stage that position and weight category both allow."""
        return min(self.position.top_stage, self.cut.allowed_stage)

    @property
    def friction_cv(self) -> float:
        """CV of ξ_cut for this cut at this position."""
        return self.friction.cut_cv(mean_braked_axles(self.position, self.cut))


@dataclass(frozen=True)
class Criterion:
    """Cost of one pass: (V_exit − V_target)², plus `stall_cost_m2_s2` for a stall in the position.

    `switching_tolerance_m2_s2`: a change of stage must gain more than this, else hold wins: commands whose
    costs differ by less count as equal, and of these the one with the fewest switchings is taken (R5).
    """

    stall_cost_m2_s2: float = 1.0
    switching_tolerance_m2_s2: float = 3e-5

    def __post_init__(self) -> None:
        require_between("criterion: stall_cost_m2_s2", self.stall_cost_m2_s2, 0.0, 1e4)
        require_between("criterion: switching_tolerance_m2_s2", self.switching_tolerance_m2_s2, 0.0, 1.0)


@dataclass(frozen=True)
class Problem:
    """A plant, the commanded exit speed and the cost."""

    plant: Plant
    target_speed_m_s: float
    criterion: Criterion = Criterion()

    def __post_init__(self) -> None:
        require_between("targets: target_speed_m_s", self.target_speed_m_s, 0.3, 20.0)
        require(
            self.target_speed_m_s < self.plant.entry.high_m_s,
            f"targets: {self.target_speed_m_s:g} m/s is not below the highest entry speed "
            f"{self.plant.entry.high_m_s:g} m/s: there is nothing to brake; lower the target",
        )
