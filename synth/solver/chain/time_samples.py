"""Decisions at the samples of a radar: at any place, a sampling period apart."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from plant_models import DopplerSensor, Plant
from plant_models.frozen_arrays import Floats
from synth.problem.resolution import Resolution
from synth.solver.chain.decisions import Decisions
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

    def entry(self, plant: Plant, grid: Grid) -> Floats:
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


def entry_distribution(plant: Plant, grid: Grid) -> Floats:
    """Entry speed by its law, sampling phase uniform: the first sample lies within v·T_c of where the regulator acts.

    With an approach, the speed there is that of a cut of mean resistance; the spread of the resistance moves it by less
    than a centimetre a second on 4 m, and what it does from there on is in the scenarios.
    The mass is spread so that the mean energy is kept; along the path by integrating the hat functions.
    """
    count = 2000 if plant.entry.high_m_s > plant.entry.low_m_s else 1
    at_entrance = plant.entry.speed_m_s((np.arange(count) + 0.5) / count)
    v = plant.start_speed_m_s(at_entrance, plant.resistance.mean_n_per_kn)
    period, step = plant.sensor.sample_period_s, grid.path_step_m
    most_quanta = 1.01 * grid.speed_m_s[-1] * period / step  # a hundredth: downhill it runs a little faster
    reach = math.floor(most_quanta) + 2
    position = 0.5 * v**2 / grid.energy_m2_s2[1]
    cell = np.minimum(position.astype(int), len(grid.energy_m2_s2) - 2)
    share = position - cell
    entry = np.zeros((reach, len(grid.energy_m2_s2)))
    far = v * period / step
    for r in range(reach):
        weight = (hat_integral(far - r) - hat_integral(-r * np.ones_like(far))) / far
        np.add.at(entry[r], cell, weight * (1.0 - share) / count)
        np.add.at(entry[r], cell + 1, weight * share / count)
    return entry


def hat_integral(x: Floats) -> Floats:
    """∫ from −1 to x of the hat function max(0, 1 − |t|)."""
    x = np.clip(x, -1.0, 1.0)
    return np.where(x < 0, 0.5 * (1 + x) ** 2, 1.0 - 0.5 * (1 - x) ** 2)
