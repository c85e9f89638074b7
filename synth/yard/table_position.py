"""A position that runs exported tables: each cut through the closed loop, once for every target of its class."""

from __future__ import annotations

import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

from plant_models import Plant, PlantError, PressingForce
from plant_models.cut import ROTATING_MASS_PER_AXLE_T
from plant_models.errors import require
from synth.book.validate_table import plant_for
from synth.configuration.resolved_config import ResolvedConfig
from synth.kernels.loop import closed_loop as kernel
from synth.simulation.closed_loop import ClosedLoop, close_loop
from synth.simulation.controllers import Controller, TableController, fixed
from synth.simulation.random_passes import RandomPasses, random_passes
from synth.yard.position_models import SampledExits
from synth.yard.scene import SceneCuts
from tuning_tables import ControllerTable

Floats = NDArray[np.float64]

CHUNK = 2000
"""Cuts whose random numbers are in memory at a time, for each thread."""


@dataclass(frozen=True)
class TableClass:
    """A cut class with its regulators: `targets_m_s` increase, one controller each."""

    plant: Plant
    targets_m_s: tuple[float, ...]
    controllers: tuple[Controller, ...]

    def __post_init__(self) -> None:
        require(
            len(self.targets_m_s) == len(self.controllers) >= 2,
            f"tables for {self.plant.cut.category}, {self.plant.cut.mass_t:g} t: {len(self.targets_m_s)} targets; an "
            "aim needs two or more to choose between",
        )


@dataclass(frozen=True)
class TablePosition:
    """Exported tables as a position model. A cut gets the class of its category and axles that is nearest by mass.

    What the class does not have comes from the cut: mass (in the work of the brake), resistance with wind, entry speed.
    Its axles stand where those of the class do. Between two targets exit speeds are linear: the controller that chooses
    its lines between tables is taken to do so. Friction, path and sensor noise of cut i are the same for all targets.
    """

    classes: tuple[TableClass, ...]

    def exits(self, cuts: SceneCuts) -> SampledExits:
        """The exits of these cuts at every target; `PlantError` where a cut has no class."""
        able = self.able(cuts)
        targets = able[0].targets_m_s
        mass = cuts.rolling.cuts.cut_mass_t
        nearest = np.abs(mass[:, None] - np.array([c.plant.cut.mass_t for c in able])).argmin(axis=1)
        entry = entry_speeds_m_s(cuts)
        exits = np.empty((len(cuts), len(targets)))

        def run(start: int) -> None:
            passes = random_passes(cuts.seed, cuts.first + start, min(CHUNK, len(cuts) - start))
            for place, of_class in enumerate(able):
                chosen = np.flatnonzero(nearest[start : start + CHUNK] == place)
                if len(chosen):
                    rows = start + chosen
                    exits[rows] = class_exits(of_class, taken(passes, chosen), cuts, rows, entry[rows])

        with ThreadPoolExecutor(max_workers=cuts.scene.threads or os.cpu_count() or 1) as pool:
            list(pool.map(run, range(0, len(cuts), CHUNK)))
        return SampledExits(np.array(targets), exits)

    def able(self, cuts: SceneCuts) -> list[TableClass]:
        """The classes that these cuts can be given: of their category and number of axles."""
        drawn = cuts.rolling.cuts
        axles = {len(car.car.axle_offsets_m) * drawn.cars for car in drawn.mix.cars}
        able = [c for c in self.classes if c.plant.cut.category == cuts.category.name and c.plant.cut.axles in axles]
        if not able or len({c.targets_m_s for c in able}) > 1:
            held = sorted({f"{c.plant.cut.category} with {c.plant.cut.axles} axles" for c in self.classes})
            raise PlantError(
                f"tables: none for {drawn.cars} cars of category {cuts.category.name}, all of its classes with the "
                f"same targets; there are {', '.join(held)}"
            )
        return able


def table_position(tables: Sequence[ControllerTable], config: ResolvedConfig, source: str) -> TablePosition:
    """The position that runs `tables`, made from `config`; `source` is what a message calls it.

    Raises `InputError` where no cut class of the configuration fits a table, `PlantError` where a class has one target.
    """
    placed = [(*plant_for(table, config, source), table) for table in tables]
    placed.sort(key=lambda p: (p[0], p[2].target_speed_m_s))
    classes = []
    for _, group in groupby(placed, key=lambda p: p[0]):
        of_class = list(group)
        targets = tuple(table.target_speed_m_s for _, _, table in of_class)
        classes.append(TableClass(of_class[0][1], targets, tuple(TableController(t) for _, _, t in of_class)))
    return TablePosition(tuple(classes))


def entry_speeds_m_s(cuts: SceneCuts) -> Floats:
    """Speed of each cut when its first axle is at the entrance of the position; 0 if it stops before."""
    entrance = (cuts.scene.entrance_m + cuts.rolling.cuts.first_axle_m)[:, None]
    return cuts.rolling.roll_on(cuts.begin_m, cuts.stretch_speed_m_s, entrance).speed_m_s[:, 0]


def class_exits(
    of_class: TableClass, passes: RandomPasses, cuts: SceneCuts, rows: NDArray[np.int64], entry_m_s: Floats
) -> Floats:
    """Exits (rows, targets) of the cuts `rows`, all of one class."""
    columns = []
    for target, controller in zip(of_class.targets_m_s, of_class.controllers, strict=True):
        loop = close_loop(of_class.plant, controller.stages)
        resistance = cuts.resistance_at(0.5 * (entry_m_s + target), rows)
        columns.append(loop.run(controller, draws(loop, passes, cuts, rows, entry_m_s, resistance)).exit_speed_m_s)
    return np.stack(columns, axis=1)


def draws(
    loop: ClosedLoop,
    passes: RandomPasses,
    cuts: SceneCuts,
    rows: NDArray[np.int64],
    entry_m_s: Floats,
    resistance_n_kn: Floats,
) -> kernel.Draws:
    """`passes` with mass, entry speed and resistance of the cuts `rows`."""
    plant, drawn = loop.plant, cuts.rolling.cuts
    factor = plant.friction.cut_factor(passes.cut_z, plant.friction_cv)
    if isinstance(plant.position.force, PressingForce):  # the force does not follow the mass, so the work a tonne does
        inertia = drawn.cut_mass_t[rows] + ROTATING_MASS_PER_AXLE_T * plant.cut.axles
        factor = factor * (plant.cut.inertia_t / inertia)
    made = loop.draws(passes)
    brakes = np.empty((len(passes), len(loop.path.gravity_m_s2)))
    kernel.brake_rows(loop.path, fixed(factor, np.float64), made.path_z, brakes)
    start = plant.start_speed_m_s(np.maximum(entry_m_s, 0.05), resistance_n_kn)
    return made._replace(
        cut_factor=fixed(factor, np.float64),
        resistance_n_kn=fixed(resistance_n_kn, np.float64),
        entry_m_s=fixed(start, np.float64),
        brake_m_s2_per_kpa=fixed(brakes, np.float64),
    )


def taken(passes: RandomPasses, rows: NDArray[np.int64]) -> RandomPasses:
    """Some of `passes`."""
    return RandomPasses(**{name: values[rows] for name, values in vars(passes).items()})
