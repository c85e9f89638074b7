"""When a regulator decides, at which nodes of the path, and how far a command may go.

At samples in time, or where an axle passes a sensor: one programme takes either.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import numpy as np

from plant_models import Plant
from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from plant_models.stage_regulator import RegulatorClock
from synth.problem.resolution import Resolution

if TYPE_CHECKING:
    from synth.solver.chain.grid import Grid
    from synth.solver.chain.speed_measurement import SpeedMeasurement


@frozen_arrays
class Decisions:
    """R decisions on a path of N quanta, in the order of the path.

    `node` (R,): path node of each, rising; `place_m` (R,): its path from where the regulator acts; `lead_m` (R,): path
    from there to where the command leaves. `farthest`: by how many stages a command may go; `swept`: by how many those
    go whose gains a sweep compares. Commands are numbered: 2·d − 2 goes down, 2·d − 1 up by d stages.
    """

    node: Ints
    place_m: Floats
    lead_m: Floats
    farthest: int
    swept: int

    @property
    def commands(self) -> int:
        """How many commands there are, C."""
        return 2 * self.farthest

    def __len__(self) -> int:
        return len(self.node)

    def at_nodes(self, nodes: int) -> Ints:
        """Number of the decision at each of the first `nodes` path nodes, R where there is none."""
        numbers = np.full(nodes, len(self.node))
        numbers[self.node] = np.arange(len(self.node))
        return numbers

    def behind(self, node: int) -> Decisions:
        """Those at path node `node` and behind it, whose nodes are counted from there."""
        kept = self.node >= node
        return Decisions(self.node[kept] - node, self.place_m[kept], self.lead_m[kept], self.farthest, self.swept)


def steps_of(command: int) -> int:
    """By how many stages a command changes the stage: down negative."""
    return (command // 2 + 1) * (2 * (command % 2) - 1)


class Policy(Protocol):
    """What a regulator compares measured speeds with."""

    def at_decisions(self, decisions: Decisions) -> Floats:
        """Its lines (C, R, K + 1), m/s, by command, decision and stage."""
        ...

    def slopes(self, decisions: Decisions, by_command: Floats) -> Floats:
        """Derivatives by what the policy consists of, from those by `at_decisions`, (I, C, R, K + 1)."""
        ...


class DecisionEpochs(Protocol):
    """What the chain of a plant must know of its regulator's decisions."""

    @property
    def clock(self) -> RegulatorClock:
        """Counts the durations of changes of stage."""
        ...

    @property
    def heard(self) -> float:
        """Probability that a decision is taken where one may be; else the stage is held."""
        ...

    @property
    def hold_period_s(self) -> float:
        """Time until the next decision while a stage is held; 0: it is at a place, not a time away."""
        ...

    def substeps(self, resolution: Resolution) -> int:
        """Parts of a step of the clock in which transients are integrated."""
        ...

    def grid(self, plant: Plant, resolution: Resolution) -> Grid:
        """The quantised state space."""
        ...

    def decisions(self, plant: Plant, grid: Grid) -> Decisions:
        """Where decisions are taken."""
        ...

    def entry(self, plant: Plant, grid: Grid) -> Floats:
        """Probability (M + 1, E) that the first decision is at path node r with energy j."""
        ...

    def reading_std_m_s(self, speed_m_s: float) -> float:
        """Std of a measured speed."""
        ...

    def measurement(self, plant: Plant, grid: Grid) -> SpeedMeasurement:
        """What is measured, as lines are designed on it: with smooth errors."""
        ...

    def predicted_measurement(self, plant: Plant, grid: Grid) -> SpeedMeasurement:
        """The same as a finished table is predicted with."""
        ...
