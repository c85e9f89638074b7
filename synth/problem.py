"""What is to be solved: one cut class at one retarder position, and the speed it must leave with."""

from __future__ import annotations

from dataclasses import dataclass, replace

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
from synth.criterion.requirement import FrictionRange, Requirement
from synth.criterion.terminal_cost import SquaredError, TerminalCost


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

    def require_modelled(self, friction: FrictionRange) -> None:
        """Raise `PlantError` unless the range lies within four standard deviations of ξ_cut, which grids cover."""
        low, high = max(self.friction.floor, 1.0 - 4.0 * self.friction_cv), 1.0 + 4.0 * self.friction_cv
        for name, value in (("low", friction.low), ("high", friction.high)):
            require(
                low <= value <= high,
                f"criterion: worst_friction_{name} is {value:g}; the friction of this cut is modelled from {low:.3g} "
                f"to {high:.3g}: keep within, or raise friction.common_cv",
            )


SQUARED_ERROR = SquaredError()


@dataclass(frozen=True)
class Criterion:
    """Cost of one pass: `terminal` of its exit speed, plus `stall_cost_m2_s2` for a stall in the position.

    `switching_tolerance_m2_s2`: a change of stage must gain more than this, else hold wins: commands whose
    costs differ by less count as equal, and of these the one with the fewest switchings is taken.
    `requirement`: what the exported lines must keep besides; only with the squared error.
    """

    stall_cost_m2_s2: float = 1.0
    switching_tolerance_m2_s2: float = 3e-5
    terminal: TerminalCost = SQUARED_ERROR
    requirement: Requirement | None = None

    def __post_init__(self) -> None:
        require_between("criterion: stall_cost_m2_s2", self.stall_cost_m2_s2, 0.0, 1e4)
        require_between("criterion: switching_tolerance_m2_s2", self.switching_tolerance_m2_s2, 0.0, 1.0)
        require(
            self.requirement is None or self.terminal == SQUARED_ERROR,
            "criterion: a chance constraint or a worst case goes with the squared error only; leave out one of the two",
        )

    def exit_costs(self, speed_m_s: NDArray[np.float64], target_speed_m_s: float) -> tuple[NDArray[np.float64], float]:
        """(cost of leaving with every grid speed (E,), cost of a stall: that of exit speed 0 and the stall cost)."""
        terminal = self.terminal.at_exit(speed_m_s, target_speed_m_s)
        return terminal, float(terminal[0]) + self.stall_cost_m2_s2

    def squared(self) -> Criterion:
        """The same prices with the squared error and no requirement: what references are measured by."""
        return replace(self, terminal=SQUARED_ERROR, requirement=None)

    @property
    def sentence(self) -> str:
        """What is minimised, in words."""
        return self.terminal.sentence if self.requirement is None else self.requirement.sentence


SQUARED_ERROR_CRITERION = Criterion()
"""The default."""


@dataclass(frozen=True)
class Problem:
    """A plant, the commanded exit speed and the cost."""

    plant: Plant
    target_speed_m_s: float
    criterion: Criterion = SQUARED_ERROR_CRITERION

    def __post_init__(self) -> None:
        require_between("targets: target_speed_m_s", self.target_speed_m_s, 0.3, 20.0)
        require(
            self.target_speed_m_s < self.plant.entry.high_m_s,
            f"targets: {self.target_speed_m_s:g} m/s is not below the highest entry speed "
            f"{self.plant.entry.high_m_s:g} m/s: there is nothing to brake; lower the target",
        )
        if isinstance(self.criterion.requirement, FrictionRange):
            self.plant.require_modelled(self.criterion.requirement)
