"""When a regulator decides: at samples in time, or where an axle passes a sensor. One programme takes either."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from plant_models import Plant
from plant_models.frozen_arrays import Floats
from plant_models.stage_regulator import RegulatorClock
from synth.problem.resolution import Resolution

if TYPE_CHECKING:
    from synth.solver.chain.decisions import Decisions
    from synth.solver.chain.grid import Grid
    from synth.solver.chain.speed_measurement import SpeedMeasurement


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
