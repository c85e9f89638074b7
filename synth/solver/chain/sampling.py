"""Decisions at the samples of a radar, at any place, or where axles pass point sensors: then time is no state."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from plant_models import DopplerSensor, Plant, PlantError, PointSensors
from plant_models.frozen_arrays import Floats, Ints
from plant_models.point_sensors import Passage, deciding_passages
from synth.problem.resolution import Resolution
from synth.solver.chain.decisions import Decisions
from synth.solver.chain.grid import Grid, make_grid
from synth.solver.chain.speed_measurement import (
    PassageMeasurement,
    SpeedMeasurement,
    quantised_measurement,
    smooth_measurement,
)


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


APART_M = 1e-3
"""Passages stand no nearer to each other than this."""

QUANTA_A_PASSAGE = 1.5
"""The grid has at least so many for each passage."""

LEAST_REACH = 3
"""Rows of an entry distribution that the recursions need."""


@dataclass(frozen=True)
class PlaceEpochs:
    """Decisions at places at which the sensors `clock` are passed; a command may go to any stage."""

    clock: PointSensors

    @property
    def heard(self) -> float:
        """What is not missed."""
        return 1.0 - self.clock.missed_share

    @property
    def hold_period_s(self) -> float:
        """0: the next decision is at a place."""
        return 0.0

    def substeps(self, resolution: Resolution) -> int:
        """One: the clock's steps are short."""
        return 1

    def entry(self, plant: Plant, grid: Grid) -> Floats:
        """Entry speed by its law, all at the first place; the mean energy is kept."""
        count = 2000 if plant.entry.high_m_s > plant.entry.low_m_s else 1
        at_entrance = plant.entry.speed_m_s((np.arange(count) + 0.5) / count)
        v = plant.start_speed_m_s(at_entrance, plant.resistance.mean_n_per_kn)
        position = 0.5 * v**2 / grid.energy_m2_s2[1]
        cell = np.minimum(position.astype(int), len(grid.energy_m2_s2) - 2)
        entry = np.zeros((LEAST_REACH, len(grid.energy_m2_s2)))
        np.add.at(entry[0], cell, (1.0 - (position - cell)) / count)
        np.add.at(entry[0], cell + 1, (position - cell) / count)
        return entry

    def reading_std_m_s(self, speed_m_s: float) -> float:
        """That of a sensor."""
        return float(self.clock.reading_std_m_s(speed_m_s))

    def measurement(self, plant: Plant, grid: Grid) -> SpeedMeasurement:
        """Timing, tolerance of the base and quantisation as one error."""
        return PassageMeasurement(self.clock, grid.speed_m_s)

    def predicted_measurement(self, plant: Plant, grid: Grid) -> SpeedMeasurement:
        """The same: the timer's steps are much finer than its noise and the grid."""
        return self.measurement(plant, grid)


@dataclass(frozen=True)
class SensorPassages(PlaceEpochs):
    """The regulator decides at the passages over the sensors `clock`.

    Every passage, the middle of the sensor's base, is a path node: the speed read is that at the node, a transient has
    ended in time if it ended before the node, and the command leaves half a base behind it, after the second pulse.
    """

    def passages(self, plant: Plant) -> tuple[Passage, ...]:
        """Those that decide, in the order of the path; `PlantError` if the first is not where the plant begins."""
        found = deciding_passages(self.clock, plant.cut, plant.exit_m)
        if not found or abs(found[0].path_m - plant.start_m) > 1e-6:
            raise PlantError(
                f"sensors: path_m begins at {self.clock.path_m[0]:g}; the regulator acts from {plant.start_m:g} m on: "
                "make the approach as long as the first sensor is ahead of the entrance"
            )
        return found

    def grid(self, plant: Plant, resolution: Resolution) -> Grid:
        """Nodes at the passages, and between them evenly."""
        place_m, length_m = self._places_m(plant), plant.exit_m - plant.start_m
        step_m = min(resolution.path_step_m, length_m / math.ceil(QUANTA_A_PASSAGE * len(place_m)))
        even = make_grid(plant, replace(resolution, path_step_m=step_m))
        quanta = len(even.path_m) - 1
        node = nodes_of(place_m, even.path_step_m, quanta)
        path = np.interp(np.arange(quanta + 1), [*node, quanta], [*place_m, length_m])
        return replace(even, path_m=plant.start_m + path)

    def decisions(self, plant: Plant, grid: Grid) -> Decisions:
        """At the nodes of the passages."""
        place_m = self._places_m(plant)
        node = nodes_of(place_m, grid.path_step_m, len(grid.path_m) - 1)
        return Decisions(node, place_m, np.full(len(node), 0.5 * self.clock.base_m), plant.top_stage, plant.top_stage)

    def _places_m(self, plant: Plant) -> Floats:
        """Path of the passages from the first on."""
        place_m = np.array([each.path_m for each in self.passages(plant)]) - plant.start_m
        rank = np.arange(len(place_m)) * APART_M
        apart = np.maximum.accumulate(place_m - rank) + rank
        places: Floats = np.minimum(apart, plant.exit_m - plant.start_m - APART_M - rank[::-1])
        return places


def nodes_of(place_m: Floats, step_m: float, steps: int) -> Ints:
    """Nodes, `step_m` apart from 0 on, next to rising places; where two would share one, the later takes the next.

    None is the last of the path, node `steps`: there the cut has left. Those that would come there stay before it.
    """
    node = np.rint(place_m / step_m).astype(np.int64)
    rank = np.arange(len(node))
    return np.minimum(np.maximum.accumulate(node - rank), steps - len(node)) + rank


def with_point_sensors(plant: Plant, sensors: PointSensors) -> Plant:
    """`plant` whose regulator acts from the first sensor on."""
    first = deciding_passages(sensors, plant.cut, plant.exit_m)
    ahead_m = -first[0].path_m if first else 0.0
    if not first or ahead_m < 0.0:
        raise PlantError(
            f"sensors: path_m begins at {sensors.path_m[0]:g}; the first sensor must stand at the entrance or ahead of "
            "it, at 0 or less"
        )
    return replace(plant, approach=replace(plant.approach, length_m=ahead_m))
