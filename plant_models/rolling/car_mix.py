"""Which cars come over the hump, and what they weigh."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from plant_models.cut import Car
from plant_models.errors import require, require_between
from plant_models.frozen_arrays import Floats, Ints
from plant_models.library.weight_category import WeightCategories, WeightCategory

AXLES_OF_A_CATEGORY = 4
"""The limits of weight categories are masses of 4-axle cars; others are compared by axle load."""


@dataclass(frozen=True)
class MixedCar:
    """A type of car, its share of the cars of a category that it can be loaded to, and its area C_x·S in the wind."""

    car: Car
    share: float
    drag_area_m2: float

    def __post_init__(self) -> None:
        require_between(f"car mix: share of {self.car.name}", self.share, 0.0, 1e6)
        require_between(f"car mix: drag_area_m2 of {self.car.name}", self.drag_area_m2, 0.0, 100.0)


@dataclass(frozen=True)
class CarMix:
    """Types of cars with their shares.

    `following_share`: the part of its C_x·S that a car has behind another one. `underload_mean_t`: mean of the
    exponential under-load of cars of the heaviest category ([kozachenko-aimed] has the law and no figure).
    """

    cars: tuple[MixedCar, ...]
    following_share: float = 0.25
    underload_mean_t: float = 4.0

    def __post_init__(self) -> None:
        require(len(self.cars) > 0, "car mix: it holds no car")
        require(sum(car.share for car in self.cars) > 0.0, "car mix: all shares are 0; one at least must be positive")
        require_between("car mix: following_share", self.following_share, 0.0, 1.0)
        require_between("car mix: underload_mean_t", self.underload_mean_t, 0.01, 100.0)

    @property
    def axles(self) -> Ints:
        """Axles of each type."""
        return np.array([len(c.car.axle_offsets_m) for c in self.cars])

    def of(self, categories: WeightCategories, category: WeightCategory) -> CarMix:
        """The cars among these that can be in `category`; `PlantError` where there is none."""
        able = tuple(
            c for c in self.cars if c.share > 0.0 and not np.isnan(mass_limits_t(categories, category, c.car)[0])
        )
        require(len(able) > 0, f"car mix: no car of it can be in the weight category {category.label}")
        return CarMix(able, self.following_share, self.underload_mean_t)

    def types(self, u: Floats) -> Ints:
        """The type of cars for uniform `u`."""
        shares = np.array([car.share for car in self.cars])
        bounds = np.cumsum(shares) / shares.sum()
        return np.minimum(np.searchsorted(bounds, u, side="right"), len(shares) - 1)

    def masses_t(self, categories: WeightCategories, category: WeightCategory, types: Ints, u: Floats) -> Floats:
        """Masses for uniform `u`: uniform within the category; in the heaviest, gross mass less an exponential
        under-load, cut off where the category ends ([kozachenko-aimed])."""
        limits = np.array([mass_limits_t(categories, category, c.car) for c in self.cars])
        low, high = limits[types, 0], limits[types, 1]
        if category != categories.members[-1]:
            return np.asarray(low + (high - low) * u)
        scale = self.underload_mean_t
        return np.asarray(high + scale * np.log1p(u * np.expm1(-(high - low) / scale)))


def mass_limits_t(categories: WeightCategories, category: WeightCategory, car: Car) -> tuple[float, float]:
    """Lightest and heaviest `car` of `category`, tonnes; NaN twice where it cannot be in it."""
    place = categories.members.index(category)
    of_axles = len(car.axle_offsets_m) / AXLES_OF_A_CATEGORY
    above = category.mass_above_t * of_axles
    to = categories.members[place + 1].mass_above_t * of_axles if place + 1 < len(categories.members) else np.inf
    low, high = max(above, car.tare_t), min(to, car.gross_t)
    return (low, high) if low < high else (np.nan, np.nan)
