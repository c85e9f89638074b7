"""Decisions at the samples of a radar: at any place, a sampling period apart."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models import DopplerSensor, Plant
from synth.problem.resolution import Resolution
from synth.solver.chain.decisions import Decisions
from synth.solver.chain.entry import entry_distribution
from synth.solver.chain.grid import Grid, make_grid
from synth.solver.chain.speed_measurement import SpeedMeasurement, quantised_measurement, smooth_measurement


@dataclass(frozen=True)
class TimeSamples:
    """The radar `clock` is sampled from where the regulator acts on, its phase uniform; a command may go to any stage.

    A sweep compares commands that go one stage far: with decisions so dense its lines are the better ones to begin a
    polish with, in less time.
    """

    clock: DopplerSensor

    @property
    def heard(self) -> float:
        """1: every sample is taken."""
        return 1.0

    @property
    def hold_period_s(self) -> float:
        """The sampling period."""
        return self.clock.sample_period_s

    def substeps(self, resolution: Resolution) -> int:
        """As the resolution asks."""
        return resolution.transient_substeps

    def grid(self, plant: Plant, resolution: Resolution) -> Grid:
        """Uniform in path and energy."""
        return make_grid(plant, resolution)

    def decisions(self, plant: Plant, grid: Grid) -> Decisions:
        """At every path node, where samples are gathered."""
        node = np.arange(len(grid.path_m) - 1)
        return Decisions(node, node.astype(np.float64) * grid.path_step_m, np.zeros(len(node)), plant.top_stage, 1)

    def entry(self, plant: Plant, grid: Grid) -> NDArray[np.float64]:
        """The first sample lies within a period of where the regulator acts."""
        return entry_distribution(plant, grid)

    def reading_std_m_s(self, speed_m_s: float) -> float:
        """That of the radar, at any speed."""
        return self.clock.reading_std_m_s

    def measurement(self, plant: Plant, grid: Grid) -> SpeedMeasurement:
        """Noise alone."""
        return smooth_measurement(self.clock)

    def predicted_measurement(self, plant: Plant, grid: Grid) -> SpeedMeasurement:
        """With the staircase of the quantisation."""
        return quantised_measurement(self.clock)
