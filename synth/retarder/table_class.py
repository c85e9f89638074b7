"""Tables of a position by cut class, and what the closed loop of a class needs of cuts that are not quite of it; the
classes of a book that a file of the user names: read, and of the position that the file means.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby
from pathlib import Path

import numpy as np

from plant_models import Plant, PlantError, PressingForce
from plant_models.cut import ROTATING_MASS_PER_AXLE_T
from plant_models.errors import require
from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from synth.frame.faults import InputError
from synth.frame.settings.settings_file import BUILT_IN
from synth.kernels.loop.motion import brake_rows
from synth.kernels.loop.passes import Draws
from synth.retarder.configuration.config_file import load_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.forms.tables_at import tables_at
from synth.retarder.served_class import plant_for
from synth.simulation.closed_loop import ClosedLoop, close_loop
from synth.simulation.controllers import Controller, TableController, fixed
from synth.simulation.random_passes import RandomPasses, readings_z
from tuning_tables import ControllerTable

SLOWEST_ENTRY_M_S = 0.05
"""Entry speed of cuts that come slower, or not at all: the kernel divides by it."""


@dataclass(frozen=True)
class TableClass:
    """A cut class with its regulators: `targets_m_s` increase, one controller each."""

    plant: Plant
    targets_m_s: tuple[float, ...]
    controllers: tuple[Controller, ...]

    def __post_init__(self) -> None:
        require(
            len(self.targets_m_s) == len(self.controllers) >= 2,
            f"tables for {self.plant.cut.category}, {self.plant.cut.mass_t:g} t: {len(self.targets_m_s)} targets; a "
            "position that is commanded needs two or more to choose between",
        )

    @cached_property
    def loops(self) -> tuple[ClosedLoop, ...]:
        """The closed loop of each controller; those of as many stages share theirs."""
        made = {stages: close_loop(self.plant, stages) for stages in {c.stages for c in self.controllers}}
        return tuple(made[controller.stages] for controller in self.controllers)

    def brakes(self, passes: RandomPasses, mass_t: Floats, axles: Ints) -> Brakes:
        """How cuts (n,) of this mass and so many axles are braked in `passes`.

        They stand where the axles of the class do. Where the force does not follow the mass, the work of the brake is
        that on their axles, and its share of their mass; where it does, that is the same for all.
        """
        plant = self.plant
        factor = plant.friction.cut_factor(passes.cut_z, plant.friction_cv)
        if isinstance(plant.position.force, PressingForce):
            inertia = mass_t + ROTATING_MASS_PER_AXLE_T * axles
            factor = factor * (plant.cut.inertia_t / inertia * (axles / plant.cut.axles))
        path = self.loops[0].path
        factor, path_z = fixed(factor, np.float64), fixed(passes.path_z, np.float32)
        rows = np.empty((len(passes), len(path.gravity_m_s2)))
        brake_rows(path, factor, path_z, rows)
        return Brakes(factor, rows)


@frozen_arrays
class Brakes:
    """Friction factor of n cuts (n,), and deceleration by one kPa in each path cell of each of them (n, cells)."""

    factor: Floats
    rows_m_s2_per_kpa: Floats


def draws(loop: ClosedLoop, passes: RandomPasses, brakes: Brakes, entry_m_s: Floats, resistance_n_kn: Floats) -> Draws:
    """`passes` with entry speed, resistance and brake of cuts (n,)."""
    start = loop.plant.start_speed_m_s(np.maximum(entry_m_s, SLOWEST_ENTRY_M_S), resistance_n_kn)
    return Draws(
        fixed(brakes.factor, np.float64),
        fixed(resistance_n_kn, np.float64),
        fixed(start, np.float64),
        fixed(passes.phase_u * loop.plant.sensor.sample_period_s, np.float64),
        fixed(passes.path_z, np.float32),
        fixed(readings_z(passes, loop.plant.sensor), np.float32),
        fixed(brakes.rows_m_s2_per_kpa, np.float64),
        fixed(passes.weight, np.float64),
    )


def table_classes(tables: Sequence[ControllerTable], config: ResolvedConfig, source: str) -> tuple[TableClass, ...]:
    """The classes of `tables`, made from `config`; `source` is what a message calls it.

    Raises `InputError` where no cut class of the configuration fits a table, `PlantError` where a class has one target.
    """
    placed = [(*plant_for(table, config, source), table) for table in tables]
    placed.sort(key=lambda p: (p[0], p[2].target_speed_m_s))
    classes = []
    for _, group in groupby(placed, key=lambda p: p[0]):
        of_class = list(group)
        targets = tuple(table.target_speed_m_s for _, _, table in of_class)
        classes.append(TableClass(of_class[0][1], targets, tuple(TableController(t) for _, _, t in of_class)))
    return tuple(classes)


def taken(passes: RandomPasses, rows: Ints) -> RandomPasses:
    """Some of `passes`."""
    return RandomPasses(**{name: values[rows] for name, values in vars(passes).items()})


def book_classes(
    named: str, book: Path, tuned_with: Path | None, position: str, position_key: str = "position.name"
) -> tuple[TableClass, ...]:
    """The classes of the tables in `book`, in the closed loops of the configuration `tuned_with`, None: built in.

    `named` is what names the book, 'my.toml: aim.tables'; `position_key` names there the `position` that it must be of.
    Raises `InputError` for a book of another position or one that does not fit its configuration, `TableError` for a
    damaged one.
    """
    tables = tables_at(book).only_lines(named)
    for table in tables:
        if table.retarder.name != position:
            raise InputError(
                f"{named} names {book}, whose table {table.id} is for the position {table.retarder.name}, but "
                f"{position_key} is {position}; give a book of that position"
            )
    config = load_config(tuned_with)
    try:
        return table_classes(tables, config, str(tuned_with or BUILT_IN))
    except PlantError as fault:
        raise InputError(unfitting(named, book, fault)) from None


def unfitting(named: str, book: Path, fault: PlantError) -> str:
    """The sentence for a book that does not fit what it is named for."""
    return f"{named} names {book}, which does not fit: {fault}"
