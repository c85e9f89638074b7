"""The reference problem: a stochastic backward induction over stage, brake pressure and speed, and its batch of 16.

A yardstick that other software can be held against, with nothing in it of the tool's own problem but its kind: it is
small, published in full here and solved the same way by everybody. One path step changes pressure and speed; the
friction factor μ and the rolling resistance w are drawn anew at every step; the cost is the squared miss of the target
speed at the end. Interpolation is bilinear in (P, V).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class ReferenceProblem:
    """All numbers of one problem; the defaults are the published ones. `solve` gives its value and best commands."""

    target_speed_m_s: float = 4.0
    braking_m_s2_per_kpa: float = 4.0e-3
    mean_resistance: float = 0.0025
    stages: int = 120
    path_step_m: float = 0.25
    pressure_points: int = 33
    highest_pressure_kpa: float = 800.0
    speed_points: int = 301
    lowest_speed_m_s: float = 0.5
    highest_speed_m_s: float = 8.0
    commands: int = 5
    command_step_kpa: float = 200.0
    rise_time_s: float = 0.55
    fall_time_s: float = 0.35
    dead_pressure_kpa: float = 60.0
    grade: float = 0.010
    gravity_m_s2: float = 9.81
    resistance_std: float = 0.0008
    friction_std: float = 0.12
    friction_nodes: int = 7
    resistance_nodes: int = 3

    def __post_init__(self) -> None:
        counts = (self.stages, self.commands, self.friction_nodes, self.resistance_nodes)
        if min(counts) < 1 or min(self.pressure_points, self.speed_points) < 2:
            raise ValueError("a reference problem needs stages, commands, noise nodes and two points an axis")
        if self.commands > 256:
            raise ValueError("a best command is kept in one byte: at most 256 commands")
        if not 0.0 < self.lowest_speed_m_s < self.highest_speed_m_s:
            raise ValueError("the speed grid must begin above 0 and end above its beginning")
        if not 0.0 <= (self.commands - 1) * self.command_step_kpa <= self.highest_pressure_kpa:
            raise ValueError("every commanded pressure must lie on the pressure grid")
        if self.friction()[0][0] <= 0.0:
            raise ValueError("the friction factor must stay positive at every noise node")

    @property
    def pressures_kpa(self) -> Floats:
        """Pressure grid (P,)."""
        return np.linspace(0.0, self.highest_pressure_kpa, self.pressure_points)

    @property
    def speeds_m_s(self) -> Floats:
        """Speed grid (V,)."""
        return np.linspace(self.lowest_speed_m_s, self.highest_speed_m_s, self.speed_points)

    @property
    def commanded_kpa(self) -> Floats:
        """Commanded pressures (U,)."""
        return self.command_step_kpa * np.arange(self.commands, dtype=np.float64)

    @property
    def terminal_cost(self) -> Floats:
        """Squared miss of the target over the speed grid (V,), m²/s²."""
        return np.square(self.speeds_m_s - self.target_speed_m_s)

    @property
    def transitions(self) -> int:
        """State-control-outcome transitions of one solve, the unit in which implementations are compared."""
        outcomes = self.friction_nodes * self.resistance_nodes
        return self.stages * self.pressure_points * self.speed_points * self.commands * outcomes

    def friction(self) -> tuple[Floats, Floats]:
        """Nodes μ, ascending, and their probabilities: Gauss-Hermite for a normal variable of mean 1."""
        return _normal_nodes(self.friction_nodes, 1.0, self.friction_std)

    def drive_m_s2(self) -> tuple[Floats, Floats]:
        """Acceleration without brakes a0 = g·(grade − w), ascending, and its probabilities."""
        resistance, chance = _normal_nodes(self.resistance_nodes, self.mean_resistance, self.resistance_std)
        return self.gravity_m_s2 * (self.grade - resistance[::-1]), chance[::-1]

    @property
    def dynamics(self) -> ReferenceProblem:
        """The problem with a fixed target: equal for problems that differ in their target alone."""
        return replace(self, target_speed_m_s=0.0)


def batch_of_16() -> tuple[ReferenceProblem, ...]:
    """The published batch: four brakes by four targets, the mean resistance changing with every second target."""
    return tuple(
        ReferenceProblem(
            target_speed_m_s=3.0 + 0.5 * (k // 4),
            braking_m_s2_per_kpa=3.0e-3 + 2.0e-3 * (k % 4) / 3.0,
            mean_resistance=0.0015 + 0.002 * ((k // 4) % 2),
        )
        for k in range(16)
    )


def _normal_nodes(count: int, mean: float, std: float) -> tuple[Floats, Floats]:
    nodes, weights = np.polynomial.hermite_e.hermegauss(count)
    return mean + std * nodes, weights / weights.sum()
