"""What a layout of point sensors gives: its tables, made in less time than by a tune, and their exits on drawn passes.

A plan compares dozens of layouts. So its tables are made on a grid twice as coarse in speed and polished less far than
those of `tune`, and what they give is simulated, on the same passes for all layouts.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from plant_models import Plant, PointSensors
from plant_models.frozen_arrays import Floats, frozen_arrays
from synth.frame.interval import Interval
from synth.problem.problem import Aim
from synth.problem.resolution import Resolution
from synth.retarder.sensors.layout import LayoutCase
from synth.retarder.sensors.passage_table import LEAST_FRICTIONS, RESISTANCES, rounded
from synth.simulation.closed_loop import close_loop
from synth.simulation.controllers import LineController
from synth.simulation.passage_controller import of_speeds
from synth.simulation.passage_loop import close_passage_loop
from synth.simulation.random_passes import RandomPasses
from synth.simulation.replicates import rms_of, rms_quotient
from synth.solver.backward_induction import Solution, solve_all
from synth.solver.chain.chain import persistent_chain
from synth.solver.chain.sampling import SensorPassages, with_point_sensors
from synth.solver.passage_speeds import PassageSpeeds, passage_speeds, polish_passages
from synth.solver.tuned_lines import tuned_lines

COARSER = 2.0
"""Times the speed step of a tune: with the polish of a tune it changes the rms of 15 cases by at most 1 %."""

POLISH_TOLERANCE = 2e-2
"""A polish ends when a step gains less than this part of the cost; that of a tune ends at a tenth of it. Against a
quarter of it the rms of 15 cases is 2 % higher with 8 sensors, and the tables take 0.6 times as long."""

RADAR_FRICTIONS = 4
"""Scenarios of the friction for the lines of the radar; of the running resistance they take the mean. The speed step is
that of a tune: on a coarser one the polish takes longer, and ends at 1.5 times the rms where brake is short."""

RADAR_DEGREE = 3
"""Of the polynomial lines of the radar's tables."""

RADAR_TOLERANCE = 2e-2
"""Of their polish, as `POLISH_TOLERANCE`; that of a tune ends at a quarter of it."""


@dataclass(frozen=True)
class LayoutTable:
    """The switching speeds of one cut class and aim with these sensors; `plant` begins at the first of them."""

    plant: Plant
    sensors: PointSensors
    aim: Aim
    speeds: PassageSpeeds


@frozen_arrays
class ExitErrors:
    """Exit-speed errors (T, n), m/s, of T tables on the same n passes, and `weight` (n,): the cuts of each pass."""

    error_m_s: Floats
    weight: Floats

    @property
    def rms(self) -> Interval:
        """Root of the mean square over all tables, m/s."""
        return interval_of(*rms_of(self._pooled_m_s, self.weight), len(self.weight))

    @property
    def by_table(self) -> tuple[Interval, ...]:
        """The rms of each table, m/s."""
        return tuple(interval_of(*rms_of(each, self.weight), len(each)) for each in self.error_m_s)

    def over(self, other: ExitErrors) -> Interval:
        """This rms in parts of that of `other`, told pass by pass; `ValueError` for other passes."""
        if not np.array_equal(self.weight, other.weight):
            raise ValueError("exit errors: the passes are not the same")
        return interval_of(*rms_quotient(self._pooled_m_s, other._pooled_m_s, self.weight), len(self.weight))

    @property
    def _pooled_m_s(self) -> Floats:
        pooled: Floats = np.sqrt(np.square(self.error_m_s).mean(axis=0))
        return pooled


def interval_of(value: float, ends: tuple[float, float], n: int) -> Interval:
    """A figure with its ends."""
    return Interval(value, *ends, n)


def solutions(
    case: LayoutCase, sensors: PointSensors, resolution: Resolution
) -> tuple[tuple[LayoutTable, Solution], ...]:
    """The tables of a case before any polish, and the solutions that they are read from."""
    plant = with_point_sensors(case.plant, sensors)
    frictions = max(resolution.friction_nodes, LEAST_FRICTIONS)
    design = replace(coarser(resolution), friction_nodes=frictions, resistance_nodes=RESISTANCES)
    solved = solve_all(persistent_chain(plant, design, SensorPassages(sensors)), case.aims)
    return tuple(
        (LayoutTable(plant, sensors, each.aim, rounded(passage_speeds(each.lines_m_s))), each) for each in solved
    )


def polished(table: LayoutTable, solution: Solution) -> LayoutTable:
    """The table after the polish of its solution."""
    return replace(table, speeds=rounded(polish_passages(solution, tolerance=POLISH_TOLERANCE).best))


def errors_of(tables: Sequence[LayoutTable], passes: RandomPasses) -> ExitErrors:
    """Exits of `passes` under each of the tables, every regulator told its passages, no sensor failing.

    Tables of one class stand side by side.
    """
    return ExitErrors(np.stack(list(table_errors(tables, passes))), passes.weight)


def table_errors(tables: Sequence[LayoutTable], passes: RandomPasses) -> Iterator[Floats]:
    """The errors (n,) of one table after the other."""
    plant: Plant | None = None
    for each in tables:
        if each.plant is not plant:
            plant = each.plant
            loop = close_passage_loop(plant, each.sensors, plant.top_stage + 1)
            draws = loop.draws(passes)
        controller = of_speeds(plant, each.sensors, each.speeds.switching_m_s.astype(np.float32))
        yield loop.run(controller, draws).exit_speed_m_s - each.aim.target_speed_m_s


def radar_errors(case: LayoutCase, resolution: Resolution, passes: Sequence[RandomPasses]) -> tuple[Floats, ...]:
    """Errors (T, n), m/s, of the radar's lines for each aim of a case, of each of the `passes`.

    Its regulator is as the plant has it.
    """
    design = replace(resolution, friction_nodes=RADAR_FRICTIONS, resistance_nodes=RESISTANCES)
    chain, loop = persistent_chain(case.plant, design), close_loop(case.plant, case.plant.top_stage + 1)
    descents = [tuned_lines(chain, aim, RADAR_DEGREE, RADAR_TOLERANCE) for aim in case.aims]
    controllers = [LineController(each.best.at(chain.grid.path_m)) for each in descents]
    targets_m_s = np.array([[aim.target_speed_m_s] for aim in case.aims])
    return tuple(
        np.stack([loop.run(each, draws).exit_speed_m_s for each in controllers]) - targets_m_s
        for draws in map(loop.draws, passes)
    )


def coarser(resolution: Resolution) -> Resolution:
    """The grid of a plan for the grid of a tune."""
    return replace(resolution, speed_step_m_s=COARSER * resolution.speed_step_m_s)
