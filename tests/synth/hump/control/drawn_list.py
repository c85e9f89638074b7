"""Sorting lists that nobody wrote."""

from __future__ import annotations

import numpy as np

from synth.hump.control.cut_record import CutRecord
from synth.hump.control.sorting_list import SortingList
from synth.hump.control.train_population import TrainPopulation


def drawn_list(population: TrainPopulation, seed: int, cuts: int) -> SortingList:
    """Train 0 of the row `seed` as a list."""
    drawn = population.drawn(seed, 0, 1, cuts)
    real = drawn.mass_t > 0.0
    axles = np.where(real, population.mix.axles[drawn.types], 0).sum(axis=1)
    lengths = np.where(real, np.array([each.car.length_m for each in population.mix.cars])[drawn.types], 0.0)
    return SortingList(
        tuple(
            CutRecord(
                serial=row + 1,
                cars=int(drawn.cars[row]),
                axles=int(axles[row]),
                mass_t=round(float(drawn.mass_t[row].sum()), 3),
                category=population.categories.members[drawn.category[row]].number,
                track=int(drawn.track[row]),
                length_m=round(float(lengths[row].sum()), 3),
            )
            for row in range(cuts)
        )
    )
