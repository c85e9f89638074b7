"""Which types of cars a cut of a sorting list can have: drawn among those that fit its cars, axles and length."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from plant_models.frozen_arrays import Floats, Ints
from plant_models.rolling.car_mix import CarMix

FITS_M = 0.5
"""Lengths that differ by no more fit the list; where none fits, the nearest do. Assumed: lists round."""

FINEST_M, LARGEST_TABLE = 0.01, 4e6
"""Lengths are added up in steps of this, or as many times longer ones as keep the table smaller."""


@dataclass(frozen=True)
class ListedCars:
    """Cuts of `cars` cars of `mix`, each drawn by its share: how probable each sum of axles and of lengths is."""

    mix: CarMix
    cars: int

    @property
    def axles(self) -> Ints:
        """Axles that a car of the mix can have, rising."""
        return np.unique(self.mix.axles)

    @cached_property
    def step_m(self) -> float:
        """Step of the lengths."""
        step, kinds = FINEST_M, float(np.ptp(self._axles) * self.cars + 1)
        while kinds * (np.ptp(self._lengths_m) / step * self.cars + 1) * self.cars > LARGEST_TABLE:
            step *= 2.0
        return step

    @cached_property
    def _axles(self) -> Ints:
        """Axles of each type beyond those of the type with the fewest, in the steps by which types differ."""
        return np.asarray((self.mix.axles - self.axles[0]) // self._axle_step)

    @property
    def _axle_step(self) -> int:
        return max(int(np.gcd.reduce(np.diff(self.axles))), 1)

    @property
    def _lengths_m(self) -> Floats:
        return np.array([each.car.length_m for each in self.mix.cars])

    @cached_property
    def _steps(self) -> Ints:
        """Length of each type beyond that of the shortest, in steps."""
        return np.asarray(np.rint((self._lengths_m - self._lengths_m.min()) / self.step_m), dtype=np.int64)

    @property
    def _shares(self) -> Floats:
        shares = np.array([each.share for each in self.mix.cars])
        return np.asarray(shares / shares.sum())

    @cached_property
    def _levels(self) -> tuple[Floats, ...]:
        """Probability of (axles, length) of 0, 1, … `cars` cars."""
        axles, steps, shares = self._axles, self._steps, self._shares
        levels = [np.ones((1, 1))]
        for _ in range(self.cars):
            before = levels[-1]
            level = np.zeros((before.shape[0] + axles.max(), before.shape[1] + steps.max()))
            for a, b, share in zip(axles, steps, shares, strict=True):
                level[a : a + before.shape[0], b : b + before.shape[1]] += share * before
            levels.append(level)
        return tuple(levels)

    def types(self, axles: int, length_m: float, u: Floats, u_cars: Floats) -> Ints | None:
        """Types of cuts with so many axles, for uniform `u` (n,) and `u_cars` (n, cars): the cuts of the mix under the
        condition that axles and length fit. None if no cars of the mix have so many axles."""
        last = self._levels[-1]
        place, rest = divmod(axles - self.cars * int(self.axles[0]), self._axle_step)
        if rest or not 0 <= place < len(last) or not last[place].any():
            return None
        at_axles = last[place]
        apart = np.abs(self.cars * self._lengths_m.min() + self.step_m * np.arange(len(at_axles)) - length_m)
        nearest = float(apart[at_axles > 0.0].min())
        fit = np.where(apart <= max(nearest, FITS_M) + 0.5 * self.cars * self.step_m, at_axles, 0.0)
        fitting = np.flatnonzero(fit)
        b = fitting[drawn(fit[None, fitting], u)]
        a, types = np.full(len(u), place), np.empty(u_cars.shape, dtype=np.int64)
        for car in reversed(range(self.cars)):
            types[:, car] = drawn(self._weights(self._levels[car], a, b), u_cars[:, car])
            a, b = a - self._axles[types[:, car]], b - self._steps[types[:, car]]
        return types

    def _weights(self, level: Floats, a: Ints, b: Ints) -> Floats:
        """Weight of each type as the last car of cuts with the sums `a`, `b`; `level`: of one car fewer."""
        rest_a, rest_b = a[:, None] - self._axles, b[:, None] - self._steps
        inside = (rest_a >= 0) & (rest_a < level.shape[0]) & (rest_b >= 0) & (rest_b < level.shape[1])
        return np.where(inside, self._shares * level[np.where(inside, rest_a, 0), np.where(inside, rest_b, 0)], 0.0)


def drawn(weights: Floats, u: Floats) -> Ints:
    """The column of each row of `weights`, (n, columns) or (1, columns), that uniform `u` (n,) falls on; none of
    weight 0."""
    bounds = np.cumsum(weights, axis=1)
    place = (bounds <= (u * bounds[:, -1])[:, None]).sum(axis=1)
    last = weights.shape[1] - 1 - np.argmax(weights[:, ::-1] > 0.0, axis=1)
    return np.asarray(np.minimum(place, last))
