"""Decisions where axles pass point sensors: known places, so that time is no part of the state."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from plant_models import (
    Approach,
    Passage,
    Plant,
    PlantError,
    PointSensors,
    deciding_passages,
    path_coefficients,
)
from synth.problem.resolution import Resolution
from synth.solver.chain.decisions import Decisions
from synth.solver.chain.grid import Grid, make_grid
from synth.solver.chain.passage_measurement import PassageMeasurement
from synth.solver.chain.speed_measurement import SpeedMeasurement

FINER_AT_MOST = 1.3
"""The path step is made finer, by no more than this, until the passages lie near to nodes."""

STEPS_TRIED = 60

LEAST_REACH = 3
"""Rows of an entry distribution that the recursions need."""


@dataclass(frozen=True)
class SensorPassages:
    """The regulator decides at the passages over the sensors `clock`; a command may go to any stage.

    A passage lies at the path node next to the middle of the sensor's base: what is read there is the speed at that
    place, and the command leaves half a base behind it, after the second pulse. Both are taken at their true places;
    only whether a transient has ended in time is told at the node.
    """

    clock: PointSensors

    @property
    def hold_period_s(self) -> float:
        """0: the next decision is at a place."""
        return 0.0

    def substeps(self, resolution: Resolution) -> int:
        """One: the clock's steps are short."""
        return 1

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
        """Of the path steps that are a little finer, the one whose nodes lie nearest to the passages."""
        length_m = plant.exit_m - plant.start_m
        place_m = np.array([each.path_m for each in self.passages(plant)]) - plant.start_m
        least = max(4, round(length_m / resolution.path_step_m), math.ceil(1.5 * len(place_m)))
        tried = np.unique(np.linspace(least, FINER_AT_MOST * least, STEPS_TRIED).astype(int))
        off = [np.abs(place_m - nodes_of(place_m, length_m / n, int(n)) * (length_m / n)).max() for n in tried]
        best = int(tried[int(np.argmin(np.round(off, 9)))])
        return make_grid(plant, replace(resolution, path_step_m=length_m / best))

    def decisions(self, plant: Plant, grid: Grid) -> Decisions:
        """At the node next to the middle of each base, and no two at one."""
        place_m = np.array([each.path_m for each in self.passages(plant)]) - plant.start_m
        node = nodes_of(place_m, grid.path_step_m, len(grid.path_m) - 1)
        return Decisions(node, place_m + 0.5 * self.clock.base_m - node * grid.path_step_m, plant.top_stage)

    def entry(self, plant: Plant, grid: Grid) -> NDArray[np.float64]:
        """Entry speed by its law, all at the first passage."""
        return entry_at_start(plant, grid)

    def reading_std_m_s(self, speed_m_s: float) -> float:
        """That of a sensor."""
        return float(self.clock.reading_std_m_s(speed_m_s))

    def measurement(self, plant: Plant, grid: Grid) -> SpeedMeasurement:
        """Timing, tolerance of the base and quantisation as one error, read at the true place of the passage."""
        decisions = self.decisions(plant, grid)
        off_m = decisions.lead_m - 0.5 * self.clock.base_m
        return PassageMeasurement(self.clock, grid.speed_m_s, 2.0 * off_m[:, None] * held_m_s2(plant, grid, decisions))

    def predicted_measurement(self, plant: Plant, grid: Grid) -> SpeedMeasurement:
        """The same: the timer's steps are much finer than its noise and the grid."""
        return self.measurement(plant, grid)


def entry_at_start(plant: Plant, grid: Grid) -> NDArray[np.float64]:
    """Entry speed by its law, all where the regulator begins to act, (3, E); the mean energy is kept."""
    count = 2000 if plant.entry.high_m_s > plant.entry.low_m_s else 1
    at_entrance = plant.entry.speed_m_s((np.arange(count) + 0.5) / count)
    v = plant.start_speed_m_s(at_entrance, plant.resistance.mean_n_per_kn)
    position = 0.5 * v**2 / grid.energy_m2_s2[1]
    cell = np.minimum(position.astype(int), len(grid.energy_m2_s2) - 2)
    entry = np.zeros((LEAST_REACH, len(grid.energy_m2_s2)))
    np.add.at(entry[0], cell, (1.0 - (position - cell)) / count)
    np.add.at(entry[0], cell + 1, (position - cell) / count)
    return entry


def held_m_s2(plant: Plant, grid: Grid, decisions: Decisions) -> NDArray[np.float64]:
    """Acceleration at every decision while a stage is held, mean friction and resistance, (R, K + 1)."""
    cells = path_coefficients(plant.position, plant.cut, plant.profile, grid.path_m)
    free = cells.free_m_s2(plant.resistance.mean_n_per_kn)[decisions.node]
    pressures = np.array(plant.position.stage_pressures_kpa[: plant.top_stage + 1])
    over = np.maximum(0.0, pressures - plant.position.force.touch_pressure_kpa)
    held: NDArray[np.float64] = free[:, None] - cells.brake_m_s2_per_kpa[decisions.node, None] * over
    return held


def nodes_of(place_m: NDArray[np.float64], step_m: float, steps: int) -> NDArray[np.int64]:
    """Nodes, `step_m` apart from 0 on, next to rising places; where two would share one, the later takes the next.

    None is the last of the path, node `steps`: there the cut has left. Those that would come there stay before it.
    """
    node = np.rint(place_m / step_m).astype(np.int64)
    rank = np.arange(len(node))
    return np.minimum(np.maximum.accumulate(node - rank), steps - len(node)) + rank


def with_point_sensors(plant: Plant, sensors: PointSensors, entrance_stage: int | None = None) -> Plant:
    """`plant` whose regulator acts from the first sensor on; `entrance_stage`: highest stage before the entrance."""
    first = deciding_passages(sensors, plant.cut, plant.exit_m)
    ahead_m = -first[0].path_m if first else 0.0
    if not first or ahead_m < 0.0:
        raise PlantError(
            f"sensors: path_m begins at {sensors.path_m[0]:g}; the first sensor must stand at the entrance or ahead of "
            "it, at 0 or less"
        )
    stage = plant.approach.entrance_stage if entrance_stage is None else entrance_stage
    return replace(plant, approach=Approach(ahead_m, stage, plant.approach.initial_stage))
