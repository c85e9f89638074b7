"""A switch of the hump: points, insulated section, machine, and its two branches."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from plant_models.errors import require_none
from plant_models.hump.edge import Edge
from plant_models.hump.element_number import SWITCHES
from plant_models.hump.ranges import ENTRY_JOINT_M, FOULING_M, RELAY_S, SWITCH_EXIT_JOINT_M, THROW_S, TURN_DEG

LEFT: Final = 0
RIGHT: Final = 1
"""Positions of a switch, s of the published model."""


@dataclass(frozen=True)
class Branch:
    """One branch of a switch: its `edge`, how many degrees it turns aside from the track ahead, and its fouling point.

    `fouling_m`: from the points; a car whose tail is not beyond it stands in the way of cars on the other branch.
    """

    edge: Edge
    turn_deg: float
    fouling_m: float

    def __post_init__(self) -> None:
        require_none((*TURN_DEG.faults("turn_deg", self.turn_deg), *FOULING_M.faults("fouling_m", self.fouling_m)))


@dataclass(frozen=True)
class Switch:
    """A switch, whose element is at the points (tips of the blades); its edges begin there.

    The insulated section reaches from `entry_joint_m` ahead of the points to `exit_joint_m` behind them on both
    branches. The machine throws the points in `throw_s`; `relay_s` passes before it starts. With `axle_counters` there
    is one at each of its three joints. `name`: what the yard calls it. Raises `PlantError`.
    """

    number: int
    left: Branch
    right: Branch
    entry_joint_m: float
    exit_joint_m: float
    throw_s: float
    relay_s: float
    axle_counters: bool = True
    name: str | None = None

    def __post_init__(self) -> None:
        SWITCHES.checked(self.number)
        require_none(
            (
                *ENTRY_JOINT_M.faults("entry_joint_m", self.entry_joint_m),
                *SWITCH_EXIT_JOINT_M.faults("exit_joint_m", self.exit_joint_m),
                *THROW_S.faults("throw_s", self.throw_s),
                *RELAY_S.faults("relay_s", self.relay_s),
            )
        )

    @property
    def branches(self) -> tuple[Branch, Branch]:
        """By position: left, right."""
        return self.left, self.right

    @property
    def edges(self) -> tuple[Edge, ...]:
        """Left, right."""
        return self.left.edge, self.right.edge

    @property
    def section_m(self) -> tuple[float, float]:
        """Metres of the insulated section (ahead of the element, behind it)."""
        return self.entry_joint_m, self.exit_joint_m
