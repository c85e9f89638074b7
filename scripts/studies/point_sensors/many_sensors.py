"""Whether many point sensors become a radar: the same plant, the same noise of a reading, decisions ever denser.

So that nothing else differs, the brake has a single stage: a command of point sensors may pass over stages, that of a
radar may not. Both act from the same place.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from plant_models import DopplerSensor, Plant, PointSensors, every_axle
from scripts.studies.cases import rounded
from scripts.studies.point_sensors.rows import ManyRow
from scripts.studies.point_sensors.sites import Site, sensor_table, single_stage, site_of
from synth.problem.resolution import Resolution
from synth.retarder.sensors.layout import with_layout
from synth.simulation.closed_loop import TableController
from synth.simulation.common_passes import common_passes
from synth.simulation.exit_statistics import exit_statistics, rms_ratio
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses
from synth.solver.chain.chain import persistent_chain
from synth.solver.tuned_lines import tuned_lines

STAGE_KPA = 300.0
FIRST_M = -3.4
BASE_M = 0.05
"""A short base: less path between two sensors is needed, and a command leaves near to where the speed is read."""

DELAY_S, CLOCK_S = 0.02, 0.02

DEGREE = 6
"""Of the radar's lines: the cubics of a tune cost more where a sensor reads so exactly."""


@dataclass(frozen=True)
class Noise:
    """One error of a reading for both: std at the target speed, m/s. Where cuts are faster, sensors read less well."""

    std_m_s: float

    @property
    def name(self) -> str:
        """'0.05 m/s'."""
        return f"{self.std_m_s:g} m/s"

    def sensors(self, target_m_s: float) -> PointSensors:
        """Sensors whose timer has that error at the target speed."""
        timer_s = self.std_m_s * BASE_M / target_m_s**2
        return PointSensors((0.0,), BASE_M, 0.0, timer_s, 0.0, DELAY_S, CLOCK_S, 0.0, every_axle)

    def radar(self, period_s: float) -> DopplerSensor:
        """A radar with that error at every speed."""
        return DopplerSensor(self.std_m_s, 0.0, period_s, DELAY_S)


def many_rows(
    passes: RandomPasses, resolution: Resolution, deciding: Sequence[int], stds_m_s: Sequence[float]
) -> Iterator[ManyRow]:
    """For every noise a row for each number of deciding sensors, beside the radar that decides as often.

    As often: its period is the mean time between passages of a cut that slows down evenly from the mean entry speed.
    """
    site = single_stage(site_of("park-22"), STAGE_KPA)
    for std in stds_m_s:
        for count in deciding:
            yield row_of(site, Noise(std), count, passes, resolution)


def row_of(site: Site, noise: Noise, deciding: int, passes: RandomPasses, resolution: Resolution) -> ManyRow:
    """So many sensors in equal sections, every axle deciding, beside the radar."""
    places = np.linspace(FIRST_M, site.plant.exit_m, deciding, endpoint=False)
    sensors = with_layout(noise.sensors(site.target_m_s), tuple(places.tolist()), site.plant.exit_m)
    made = sensor_table(site, sensors, resolution)
    sample = made.run(passes)
    met = len(made.table.passages)
    way_m = site.plant.exit_m - FIRST_M
    mean_m_s = 0.5 * (0.5 * (site.plant.entry.low_m_s + site.plant.entry.high_m_s) + site.target_m_s)
    period_s = max(CLOCK_S, way_m / met / mean_m_s)
    plant = replace(made.plant, sensor=noise.radar(period_s))
    radar = radar_exits(site, plant, passes, resolution)
    found, of_radar = (exit_statistics(each, site.target_m_s) for each in (sample, radar))
    ratio, ci95 = rms_ratio(sample, radar, site.target_m_s)
    return ManyRow(
        noise.name, deciding, met, way_m / met, period_s, made.tuned.rms_m_s, found.rms_m_s, found.rms_ci95_m_s,
        of_radar.rms_m_s, of_radar.rms_ci95_m_s, ratio, ci95,
    )  # fmt: skip


def radar_exits(site: Site, plant: Plant, passes: RandomPasses, resolution: Resolution) -> ExitSample:
    """The passes under the table of a radar, made on the same grid."""
    design = persistent_chain(plant, replace(resolution, transient_substeps=1))
    lines = tuned_lines(design, site.aim, DEGREE).best
    table = rounded(site.config, plant, lines, site.target_m_s)
    return common_passes(plant, passes).run(TableController(table))
