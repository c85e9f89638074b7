"""A book of two classes on a coarse grid, and cuts that come to its position."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np

from plant_models.frozen_arrays import Floats
from synth.hump.rolling.hump_position import Arrivals
from synth.retarder.class_setup import class_setup, origin_of, validation_passes
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.estimation.estimator_design import estimator_of
from synth.retarder.table_class import TableClass, table_classes
from synth.retarder.tuned_table import solutions, tuned_table
from synth.simulation.controllers import TableController
from tuning_tables import ControllerTable, from_json, to_json

CREATED = "2026-11-20T22:46:00Z"
PARK = """\
[position]
name = "rnz-2m-park"
[entry]
low_m_s = 3.0
high_m_s = 4.5
[targets]
exit_speeds_m_s = [1.5, 2.0, 3.0]
[grid]
path_step_m = 1.0
speed_step_m_s = 0.05
friction_scenarios = 3
resistance_scenarios = 1
[fit]
degree = 2
[validation]
passes = 1000
[[cut]]
label = "one"
car = "gondola-4"
mass_t = 25
[[cut]]
label = "two"
car = "gondola-4"
cars = 2
mass_t = 50
"""


def coarse_classes() -> tuple[TableClass, ...]:
    """One and two light gondolas at a park position, with tables that were written and read back."""
    return table_classes(coarse_tables(), parse_config(PARK, "coarse.toml"), "coarse.toml")


@cache
def coarse_tables() -> tuple[ControllerTable, ...]:
    """The tables alone."""
    config = parse_config(PARK, "coarse.toml")
    made: list[ControllerTable] = []
    for label, plant in config.plants():
        setup = class_setup(config, label, plant, validation_passes(config), origin_of(config.sha256, CREATED))
        aims = config.aims_of(label)
        made += [from_json(to_json(tuned_table(setup, found).table)) for found in solutions(setup.design, aims)]
    return tuple(made)


def estimating(of_class: TableClass) -> TableClass:
    """The class whose tables are asked with the speed that an estimator makes."""
    estimator, controllers = estimator_of(of_class.plant), []
    for controller in of_class.controllers:
        assert isinstance(controller, TableController)
        assert isinstance(controller.table, ControllerTable)
        controllers.append(TableController(replace(controller.table, estimator=estimator)))
    return replace(of_class, controllers=tuple(controllers))


def coming(
    of_class: TableClass,
    entry_m_s: Floats,
    resistance_n_kn: Floats,
    commanded_m_s: Floats,
    mass_t: Floats | None = None,
) -> Arrivals:
    """Cuts of the class itself that roll with this resistance, at every speed, on the track of the class."""
    plant, path, n = of_class.plant, of_class.loops[0].path, len(entry_m_s)
    braked = slice(path.approach_cells, None)
    fall = float(path.gravity_m_s2[braked] @ np.diff(path.edges_m)[braked])
    gained = fall - path.drag_m_s2_per_n_kn * resistance_n_kn * plant.exit_m
    return Arrivals(
        rows=np.arange(n),
        retarder=np.full(n, 401),
        entry_m_s=entry_m_s,
        unbraked_exit_m_s=np.sqrt(np.maximum(entry_m_s**2 + 2.0 * gained, 0.0)),
        path_m=np.full(n, plant.exit_m),
        commanded_m_s=commanded_m_s,
        mass_t=np.full(n, plant.cut.mass_t) if mass_t is None else mass_t,
        axles=np.full(n, plant.cut.axles),
        category=np.zeros(n, dtype=np.int64),
        resistance_n_per_kn=resistance_n_kn,
        unbraked_resistance_n_per_kn=resistance_n_kn,
        train=np.arange(n),
        cut=np.full(n, 3),
        seed=11,
        position=2,
    )
