"""Which class of a book stands for a cut: of its category, nearest by axles, then by axle load."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np

from plant_models import PlantError
from plant_models.frozen_arrays import Ints
from plant_models.library.weight_category import WeightCategories
from synth.hump.trains.hump_position import Arrivals
from synth.retarder.table_class import TableClass

MOST_LONGER, MOST_SHORTER = 10.0 / 3.0, 1.5
"""A class stands for cuts of up to so many times its axles, and of as few as its axles over the other number."""


@dataclass(frozen=True)
class ClassChoice:
    """The classes of a book, and the categories that arrivals name by their places.

    Nearest by axles is the class with the least difference in number, of two the one with fewer; among those with equal
    axles the one with the nearest axle load. A book of single cars thus serves cuts of three, one with cuts of three
    serves cuts of ten.
    """

    classes: tuple[TableClass, ...]
    categories: WeightCategories

    def of(self, arrivals: Arrivals) -> Ints:
        """Place of the class of each cut, (m,); `PlantError` for the first kind of cut that none stands for."""
        found = np.empty(len(arrivals), dtype=np.int64)
        kinds, of_kind = np.unique(np.stack((arrivals.category, arrivals.axles)), axis=1, return_inverse=True)
        loads = np.array([c.plant.cut.axle_load_t for c in self.classes])
        for kind, (category, axles) in enumerate(kinds.T):
            rows = np.flatnonzero(of_kind.reshape(-1) == kind)
            able = self.able(int(category), int(axles))
            apart = np.abs((arrivals.mass_t[rows] / axles)[:, None] - loads[able])
            found[rows] = able[apart.argmin(axis=1)]
        return found

    def able(self, category: int, axles: int) -> Ints:
        """The classes, by place, among which the axle load decides for cuts of this category with so many axles."""
        member = self.categories.members[category]
        counts = {
            place: c.plant.cut.axles for place, c in enumerate(self.classes) if c.plant.cut.category == member.name
        }
        nearest = nearest_axles(counts.values(), axles)
        if nearest is None:
            raise PlantError(f"tables: none for cuts of category {member.label} with {axles} axles")
        return np.array([place for place, count in counts.items() if count == nearest])


def nearest_axles(held: Collection[int], axles: int) -> int | None:
    """Which of the axle numbers `held` of the classes of a category stands for cuts with so many `axles`; None where
    none does."""
    nearest = min(held, key=lambda count: (abs(count - axles), count), default=0)
    return nearest if nearest and nearest / MOST_SHORTER <= axles <= nearest * MOST_LONGER else None
