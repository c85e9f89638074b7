"""What surfaces lose beside lines for commands at rest, where plant, gauge or sensor are not as they should be."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

from plant_models import Plant
from synth.simulation.closed_loop import Controller, TableController, simulate
from synth.simulation.exit_statistics import rms_ratio
from synth.simulation.random_passes import RandomPasses
from synth.studies.any_time.findings import Ratio
from synth.studies.estimator.wrong import Wrong, braking_otherwise, simulated
from synth.studies.robustness.condition import aged_valves
from synth.studies.robustness.sensor_fault import DropOut, LostReadings, at_random

SILENT = "gauge silent"


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
    silent = simulate(plant, replace(table, gauge_factor=math.nan), passes)
    found[SILENT] = Ratio(*rms_ratio(silent, rest, target_m_s))
    return found
