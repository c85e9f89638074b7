"""What positions that aim are commanded: aim tables by group of routes and weight category."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from synth.kernels.aim_speeds import aim_exit_speeds
from tuning_tables.aim import AimAxes
from tuning_tables.aim.held_aim import aim_grid
from tuning_tables.programs.aim_table import AimGrid


@dataclass(frozen=True)
class CategoryAim:
    """Exit speeds for one weight category, of a table or made for a simulation alone: `by_category`, and `measured`,
    where a cut's resistance was read.

    `mean_n_per_kn`: the mean reading of such cuts.
    """

    by_category: AimGrid
    measured: AimGrid | None = None
    mean_n_per_kn: float = np.nan


@frozen_arrays
class HumpAim:
    """Exit speeds of the last position: `tables`, by group of routes and by place of the weight category in its set.

    `group` (routes,): the group of each route. `lowest_m_s`, of all or (groups, categories), is commanded where no
    speed is known to be safe. `stretch_m` (routes, 2): from where to where the tables have the resistance measured, NaN
    for routes on which it is that of the free stretch ahead of the last position; None: for all.
    """

    group: Ints
    tables: tuple[tuple[CategoryAim, ...], ...]
    lowest_m_s: float | Floats
    stretch_m: Floats | None = None

    @property
    def lowest_by_table_m_s(self) -> Floats:
        """(groups, categories)."""
        return np.broadcast_to(self.lowest_m_s, (len(self.tables), len(self.tables[0])))

    def command_m_s(
        self, routes: Ints, category: Ints, cars: Ints, free_distance_m: Floats, reading_n_per_kn: Floats | None = None
    ) -> Floats:
        """Exit speeds for cuts on `routes`, (n,) all of them; a reading that is NaN was not made.

        The rule is that of aim tables (`tuning_tables.aim`), with one difference: longer cuts than the longest listed
        are commanded as those. Exported tables are used only where none are longer.
        """
        speeds = np.full(len(routes), np.nan)
        together = self.group[routes] * len(self.tables[0]) + category
        for key in np.unique(together):
            rows = np.flatnonzero(together == key)
            table = self.tables[key // len(self.tables[0])][key % len(self.tables[0])]
            if reading_n_per_kn is not None and table.measured is not None:
                told = ~np.isnan(reading_n_per_kn[rows])
                read, rows = rows[told], rows[~told]
                speeds[read] = answer(table.measured, cars[read], free_distance_m[read], reading_n_per_kn[read])
            if len(rows):
                speeds[rows] = answer(table.by_category, cars[rows], free_distance_m[rows])
        return np.where(np.isnan(speeds), self.lowest_by_table_m_s[self.group[routes], category], speeds)

    def expected_m_s(self, routes: Ints, category: Ints, cars: Ints, free_distance_m: Floats, measured: bool) -> Floats:
        """What is expected before the train: for the mean reading where cuts will be `measured`, else by category."""
        reading = None
        if measured:
            means = np.array([[table.mean_n_per_kn for table in group] for group in self.tables])
            reading = means[self.group[routes], category]
        return self.command_m_s(routes, category, cars, free_distance_m, reading)


def answer(table: AimGrid, cars: Ints, free_distance_m: Floats, reading_n_per_kn: Floats | None = None) -> Floats:
    """What the rule answers, NaN for nothing; more cars than listed count as the most that are."""
    reading = np.full(len(cars), np.nan) if reading_n_per_kn is None else reading_n_per_kn
    listed = np.minimum(cars, table.cars[table.listed - 1])
    return aim_exit_speeds(table, listed, free_distance_m, reading).astype(np.float64)


def no_speeds() -> AimGrid:
    """Nodes without any speed, for cuts that no train has."""
    return aim_grid(AimAxes(np.array([1]), np.zeros(1)), np.full((1, 1), np.nan))


def no_aim(routes: int, categories: int, lowest_m_s: float) -> HumpAim:
    """Where no position aims: nobody asks for these speeds."""
    tables = (tuple(CategoryAim(no_speeds()) for _ in range(categories)),)
    return HumpAim(np.zeros(routes, dtype=np.int64), tables, lowest_m_s)


def joined_aims(parts: Sequence[tuple[Ints, HumpAim]], routes: int) -> HumpAim:
    """One aim for all `routes`, of (rows, aim of these rows) that are no two for one route. Routes on which
    no position aims are in none, and nobody asks for them."""
    group, stretch = np.zeros(routes, dtype=np.int64), np.full((routes, 2), np.nan)
    tables: list[tuple[CategoryAim, ...]] = []
    for rows, aim in parts:
        group[rows] = len(tables) + aim.group
        if aim.stretch_m is not None:
            stretch[rows] = aim.stretch_m
        tables += aim.tables
    lowest = np.concatenate([aim.lowest_by_table_m_s for _, aim in parts])
    return HumpAim(group, tuple(tables), lowest, stretch)
