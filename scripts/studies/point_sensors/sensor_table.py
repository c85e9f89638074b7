"""The table of one layout of point sensors, and what the closed loop makes of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from plant_models import Cut, Plant, PointSensors, every_axle, first_axle
from scripts.studies.point_sensors.sites import Site
from scripts.studies.tuned_table import CREATED
from synth.problem.resolution import Resolution
from synth.retarder.sensors.passage_table import passage_table
from synth.retarder.sensors.tuned_passages import TunedPassages, passage_chains, tuned_passages
from synth.simulation.passage_controller import of_table
from synth.simulation.passage_loop import PassageLoop, close_passage_loop
from synth.simulation.passage_sample import DECIDED, UNFINISHED, PassageSample
from synth.simulation.random_passes import RandomPasses
from synth.simulation.replicates import Interval, half_width
from synth.solver.chain.sensor_passages import with_point_sensors
from tuning_tables import Generator
from tuning_tables.passages.passage_table import PassageTable

AXLES: dict[str, Callable[[Cut], tuple[int, ...]]] = {"first": first_axle, "every": every_axle}
"""The axles that are decided on, by the word of the tables."""


@dataclass(frozen=True)
class SensorTable:
    """A table with what it was made of and the loop that it runs in."""

    tuned: TunedPassages
    table: PassageTable
    loop: PassageLoop

    @property
    def plant(self) -> Plant:
        """The plant, which begins at the first sensor."""
        return self.tuned.plant

    def run(self, passes: RandomPasses) -> PassageSample:
        """The passes by a regulator that is told each passage."""
        return self.loop.run(of_table(self.table, tracking=False), self.loop.draws(passes))


def tabulated(site: Site, tuned: TunedPassages) -> SensorTable:
    """The exported table of tuned switching speeds."""
    maker = Generator("retarder-synth study", "0", site.config.sha256)
    table = passage_table(tuned, maker, f"{site.name}-{len(tuned.sensors.path_m)}", CREATED)
    loop = close_passage_loop(tuned.plant, tuned.sensors, table.switching_m_s.shape[1])
    return SensorTable(tuned, table, loop)


def sensor_table(site: Site, sensors: PointSensors, resolution: Resolution) -> SensorTable:
    """Tuned, predicted and rounded on `resolution`."""
    plant = with_point_sensors(site.plant, sensors)
    return tabulated(site, tuned_passages(passage_chains(plant, sensors, resolution), site.aim))


def unfinished_share(sample: PassageSample) -> tuple[float, Interval]:
    """Share of all passages heard that found a transient unfinished, and its 95 % interval."""
    late = (sample.outcome == UNFINISHED).sum(axis=1).astype(np.float64)
    heard = late + (sample.outcome == DECIDED).sum(axis=1)
    weight = sample.weight * heard
    value = float(sample.weight @ late / weight.sum())
    half = half_width(sample.weight * (late - value * heard), weight)
    return value, (max(value - half, 0.0), value + half)
