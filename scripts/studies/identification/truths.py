"""Plants of which the truth is known, and logs of them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

from plant_models.pressure_gauge import PressureGauge
from scripts.studies.side_by_side import side_by_side
from scripts.studies.tuned_table import tuned_table
from synth.logs import unknowns as asked
from synth.logs.fitting_passes import FittingPasses, fitting_passes
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.simulation.controllers import TableController
from synth.simulation.logged_passes import LoggedClass, mixed_log

CLASSES = (("light", 22.0, 1, 3.0), ("middle", 52.0, 1, 3.0), ("heavy", 85.0, 1, 4.0), ("three", 156.0, 3, 4.0))
"""Label, mass in t, cars and exit speed of the cuts that come, as many of each."""

POSITION = "knp-5-bunch"

OUTSIDE = """
[retarder.force]
slope_kn_per_kpa = 0.0225
touch_pressure_kpa = 15.0
[retarder.pneumatics]
fill_time_constant_s = 0.6
exhaust_time_constant_s = 0.8
brake_delay_s = 0.25
release_delay_s = 0.3
dead_band_kpa = 35.0
[friction]
common_cv = 0.3
path_std = 0.2
correlation_length_m = 4.0
[sensor]
noise_m_s = 0.1
"""
"""Nearly every number beyond the sensible range of the library."""


@dataclass(frozen=True)
class Truth:
    """A plant: its name, what is otherwise than assumed, and its gauge, None for a drive without one."""

    name: str
    otherwise: str
    gauge: PressureGauge | None

    @cached_property
    def config(self) -> ResolvedConfig:
        """The configuration of the true plant."""
        return parse_config(self.otherwise + text_of_classes(), f"study identification, {self.name}")

    def values(self, asked_keys: tuple[str, ...]) -> dict[str, float]:
        """The true numbers."""
        known = {value.key: value.value for value in self.config.parameters}
        made: dict[str, float] = {asked.SLOPE_BY_AXLES: 0.0, asked.BIAS: 0.0, asked.RESISTANCE_SPREAD: 1.0}
        if self.gauge is not None:
            made[asked.GAUGE_NOISE] = math.hypot(self.gauge.noise_kpa, self.gauge.resolution_kpa / math.sqrt(12.0))
        for _, plant in self.config.plants():
            made[asked.RESISTANCE + plant.cut.category] = plant.resistance.mean_n_per_kn
        found = {key: known.get(key, made.get(key)) for key in asked_keys}
        return {key: value for key, value in found.items() if isinstance(value, float)}


GAUGE = PressureGauge(2.0, 1.0)

TRUTHS = (
    Truth("as assumed", "", GAUGE),
    Truth("as assumed, no gauge", "", None),
    Truth("outside the ranges", OUTSIDE, GAUGE),
)


def text_of_classes() -> str:
    """The part of a configuration that all share."""
    classes = "".join(
        f'[[cut]]\nlabel = "{label}"\ncar = "gondola-4"\ncars = {cars}\nmass_t = {mass_t}\ntargets_m_s = [{target}]\n'
        for label, mass_t, cars, target in CLASSES
    )
    return f'[position]\nname = "{POSITION}"\n{classes}'


@dataclass(frozen=True)
class Yard:
    """What is taken of the position before anything was measured, and the tables that were tuned for that."""

    config: ResolvedConfig
    controllers: dict[str, TableController]

    def passes(self, truth: Truth, count: int, seed: int) -> FittingPasses:
        """A log of `count` passes of the true plant under these tables, fitted to the assumed classes."""
        classes = [
            LoggedClass(plant, self.controllers[label], self.config.targets_of(label)[0])
            for label, plant in truth.config.plants()
        ]
        log = mixed_log(classes, [count // len(classes)] * len(classes), seed, truth.gauge)
        return fitting_passes(log, self.config.plants(), "study identification")


def assumed_yard() -> Yard:
    """Tuned for the numbers of the library."""
    config = parse_config(text_of_classes(), "study identification")
    plants = config.plants()
    tables = side_by_side(lambda one: tuned_table(config, one[1], config.targets_of(one[0])[0]), plants)
    return Yard(config, {label: TableController(table) for (label, _), table in zip(plants, tables, strict=True)})
