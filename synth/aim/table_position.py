"""The park position of an aim configuration as it obeys commands: with a normal error, or as its own tables make it:
each cut through the closed loop, once for every target of its class.
"""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from plant_models import PlantError
from plant_models.frozen_arrays import Floats, Ints
from synth.aim.position_models import NormalPosition, PositionModel, SampledExits
from synth.aim.resolved_aim import ResolvedAim
from synth.aim.scene import SceneCuts
from synth.frame.faults import InputError
from synth.retarder.table_class import TableClass, draws, taken
from synth.simulation.random_passes import RandomPasses, random_passes


def position_of(config: ResolvedAim) -> PositionModel:
    """The model that the configuration asks for; `InputError` for a book that does not fit, `TableError` if damaged."""
    if config.book is None:
        assert config.exit_std_m_s is not None
        return NormalPosition(config.exit_std_m_s)
    return tabled(config, *config.book)


def tabled(config: ResolvedAim, book: Path, tuned_with: Path | None) -> PositionModel:
    """The closed loops of the tables in `book`, for every category and number of cars that is asked for."""
    from synth.retarder.table_class import book_classes, unfitting

    named = f"{config.place}: aim.tables"
    position = TablePosition(book_classes(named, book, tuned_with, config.position_name))
    try:
        for member in config.members:
            for cars in config.cars:
                position.able(config.scene.draw(member, cars, config.simulation.seed, 0, 1))
    except PlantError as fault:
        raise InputError(unfitting(named, book, fault)) from None
    return position


CHUNK = 2000
"""Cuts whose random numbers are in memory at a time, for each thread."""


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


def entry_speeds_m_s(cuts: SceneCuts) -> Floats:
    """Speed of each cut when its first axle is at the entrance of the position; 0 if it stops before."""
    entrance = (cuts.scene.entrance_m + cuts.rolling.cuts.first_axle_m)[:, None]
    return cuts.rolling.roll_on(cuts.begin_m, cuts.stretch_speed_m_s, entrance).speed_m_s[:, 0]


def class_exits(of_class: TableClass, passes: RandomPasses, cuts: SceneCuts, rows: Ints, entry_m_s: Floats) -> Floats:
    """Exits (rows, targets) of the cuts `rows`, all of one class."""
    mass_t = cuts.rolling.cuts.cut_mass_t[rows]
    brakes = of_class.brakes(passes, mass_t, np.full(len(rows), of_class.plant.cut.axles))
    columns = []
    for target, controller, loop in zip(of_class.targets_m_s, of_class.controllers, of_class.loops, strict=True):
        resistance = cuts.resistance_at(0.5 * (entry_m_s + target), rows)
        columns.append(loop.run(controller, draws(loop, passes, brakes, entry_m_s, resistance)).exit_speed_m_s)
    return np.stack(columns, axis=1)
