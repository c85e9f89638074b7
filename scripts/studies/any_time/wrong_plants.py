"""What surfaces lose beside lines for commands at rest, where plant, gauge or sensor are not as they should be."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from plant_models import Plant
from scripts.studies.any_time.findings import Ratio, SilentGauge
from scripts.studies.estimator.wrong import Wrong, braking_otherwise, simulated
from scripts.studies.plant_changes import aged_valves
from scripts.studies.sensor_fault import DropOut, LostReadings, at_random
from synth.simulation.closed_loop import Controller, LineController, TableController, simulate
from synth.simulation.common_passes import CommonPasses
from synth.simulation.exit_statistics import rms_ratio
from synth.simulation.random_passes import RandomPasses
from synth.solver.tabulate import lines_of
from tuning_tables import ControllerTable, Decisions

LINE_NODES = 301


def otherwise(plant: Plant, seed: int) -> Iterator[Wrong]:
    """Plants and sensors to try; `seed` draws what readings are lost."""
    rough = replace(plant.friction, path_std=2.0 * plant.friction.path_std)
    yield from braking_otherwise(plant)
    yield Wrong("path noise × 2", replace(plant, friction=rough))
    yield Wrong("valves: delays × 2, constants × 1.5", aged_valves(plant))
    yield Wrong("one reading in ten lost", plant, fault=LostReadings(0.1, seed))
    yield Wrong("no reading for 1 s, any moment", plant, fault=DropOut(1.0, at_random(seed)))


def ratios_to_rest(
    plant: Plant, target_m_s: float, table: TableController, at_rest: Controller, passes: RandomPasses, seed: int
) -> dict[str, Ratio]:
    """rms of `table` over that of `at_rest` on the same `passes`, for each thing that is wrong."""
    rest, found = simulate(plant, at_rest, passes), {}
    for wrong in otherwise(plant, seed):
        ours, theirs = (simulated(wrong, each, passes, rest.transit_time_s) for each in (table, at_rest))
        found[wrong.name] = Ratio(*rms_ratio(ours, theirs, target_m_s))
    return found


def with_a_silent_gauge(
    target_m_s: float, table: ControllerTable, at_rest: Controller, passes: CommonPasses
) -> SilentGauge:
    """`table`, one stage a command, beside a gauge that shows nothing: asked at every sample, or at rest."""
    lines = lines_of(waiting_table(table), np.linspace(*table.valid.s_m, LINE_NODES))
    rest, waiting = passes.run(at_rest), passes.run(LineController(lines, farthest=table.farthest))
    going_on = passes.run(TableController(table, math.nan))
    pairs = (going_on, rest), (waiting, rest), (waiting, going_on)
    return SilentGauge(*(Ratio(*rms_ratio(*pair, target_m_s)) for pair in pairs))


def waiting_table(table: ControllerTable) -> ControllerTable:
    """The lines of `table` as they stand at the pressure of their stage, for commands at rest."""
    stages = (replace(each, lower_slope_m_s_per_kpa=None, upper_slope_m_s_per_kpa=None) for each in table.stages)
    return replace(table, decisions=Decisions.AT_REST, stages=tuple(stages))
