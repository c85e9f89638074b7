"""Positions that run a tuned book of the park position, or the tuned energy rule, in the closed loop."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from plant_models.library import load_car
from plant_models.rolling.car_mix import mass_limits_t
from scripts.studies.aiming.trial import Cuts
from scripts.studies.cases import CREATED, side_by_side
from synth.aim.table_position import TablePosition, entry_speeds_m_s
from synth.retarder.class_setup import TUNING_PASSES, ClassSetup, class_setup, origin_of, validation_passes
from synth.retarder.comparison.baselines import FAMILIES, tune
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.table_class import TableClass, table_classes
from synth.retarder.tuned_table import read_back, solutions, tuned_table
from synth.simulation.random_passes import random_passes
from tuning_tables import ControllerTable

POSITION = "rnz-2m-park"

ENTRY_TAILS = 0.005
"""Share of entry speeds beyond each end of those that the book is tuned for."""

CLASS_SHARES = (0.25, 0.75)
"""The masses of the two classes are these quantiles of the cuts' masses, or the tare of gondolas if that is more."""

ENERGY_RULE = next(family for family in FAMILIES if family.name == "energy rule")

COARSE = "[grid]\npath_step_m = 1.0\nspeed_step_m_s = 0.06\nfriction_scenarios = 2\nresistance_scenarios = 1\n"


@dataclass(frozen=True)
class ParkBook:
    """What one number of cars of one category needs: classes of gondolas at `masses_t` (of the cut), tuned for each of
    `targets_m_s` and entry speeds between `entry_m_s`, on the grid of a tune or on a `coarse` one."""

    cars: int
    entry_m_s: tuple[float, float]
    masses_t: tuple[float, ...]
    targets_m_s: tuple[float, ...]
    coarse: bool = False

    def config(self, estimator: bool) -> ResolvedConfig:
        """The configuration that a user would write."""
        low, high = self.entry_m_s
        text = f"""
title = "park position for aimed braking"
[position]
name = "{POSITION}"
[entry]
low_m_s = {low}
high_m_s = {high}
[targets]
exit_speeds_m_s = [{", ".join(str(t) for t in self.targets_m_s)}]
[regulator]
estimator = {str(estimator).lower()}
{COARSE if self.coarse else ""}""" + "".join(
            f'[[cut]]\nlabel = "class-{i}"\ncar = "gondola-4"\ncars = {self.cars}\nmass_t = {mass}\n'
            for i, mass in enumerate(self.masses_t)
        )
        return parse_config(text, "park book")

    def tables(self, estimator: bool) -> TablePosition:
        """The position under the tables that a tune makes, as they are read back."""
        config = self.config(estimator)
        made = side_by_side(lambda setup: tables_of(config, setup), self.setups(config))
        tables = [table for of_class in made for table in of_class]
        return TablePosition(table_classes(tables, config, "park book"))

    def energy_rule(self) -> TablePosition:
        """The position under the energy rule, tuned for each class and target as a comparison tunes it."""
        config = self.config(estimator=False)
        return TablePosition(side_by_side(lambda setup: energy_class(config, setup), self.setups(config)))

    @staticmethod
    def setups(config: ResolvedConfig) -> list[ClassSetup]:
        """What the targets of each class share."""
        origin, passes = origin_of(config.sha256, CREATED), validation_passes(config)
        return [class_setup(config, label, plant, passes, origin) for label, plant in config.plants()]


def park_book(cuts: Cuts, targets_m_s: tuple[float, ...], classes: int, coarse: bool) -> ParkBook:
    """The book for such cuts."""
    few = cuts.scene.draw(cuts.category, cuts.cars, 0, 0, 2000)
    entry = np.quantile(entry_speeds_m_s(few), (ENTRY_TAILS, 1.0 - ENTRY_TAILS))
    lightest, _ = mass_limits_t(cuts.scene.population.categories, cuts.category, load_car("gondola-4").car)
    masses = np.maximum(np.quantile(few.rolling.cuts.cut_mass_t, CLASS_SHARES[:classes]), cuts.cars * lightest)
    return ParkBook(
        cuts.cars, (round(float(entry[0]), 2), round(float(entry[1]), 2)),
        tuple(round(float(mass), 1) for mass in masses), targets_m_s, coarse,
    )  # fmt: skip


def tables_of(config: ResolvedConfig, setup: ClassSetup) -> list[ControllerTable]:
    """The tables of one class, read back."""
    aims = config.aims_of(setup.label)
    return [read_back(tuned_table(setup, found).table) for found in solutions(setup.design, aims)]


def energy_class(config: ResolvedConfig, setup: ClassSetup) -> TableClass:
    """The energy rule of one class, tuned on passes that nothing else uses."""
    passes = setup.passes.of_others(random_passes(config.validation.seed + 1, 0, TUNING_PASSES))
    targets = config.targets_of(setup.label)
    return TableClass(setup.plant, targets, tuple(tune(ENERGY_RULE, passes, t).controller for t in targets))
