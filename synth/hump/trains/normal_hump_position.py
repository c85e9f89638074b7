"""A position of which the exactness alone is known: cuts leave with the commanded speed and a normal error."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.special import ndtri

from plant_models.brake_power import FullBrake
from plant_models.cut import Car
from plant_models.frozen_arrays import Floats, Ints
from plant_models.library.weight_category import WeightCategories
from plant_models.retarder import RetarderPosition
from plant_models.rolling.keyed_numbers import keyed_uniform
from plant_models.rolling.random_numbers import Purpose
from synth.hump.trains.hump_position import Arrivals, Passed, evenly_braked_s

SLOWEST_M_S = 0.3
"""A regulator lets a cut go before it is slower than this, whatever its error."""


@dataclass(frozen=True)
class LibraryBrake:
    """Full brake of `position` for cuts as they arrive: each may be given the stages of its category.

    Axles stand as in cuts of whole cars of the type `car`. `share`: of the brake, 1 where it has all its supply.
    """

    position: RetarderPosition
    categories: WeightCategories
    car: Car
    share: float = 1.0

    def __call__(self, arrivals: Arrivals) -> Floats:
        """Energy head of the full brake, m."""
        return self.head_m(arrivals.mass_t, arrivals.axles, arrivals.category)

    def head_m(self, mass_t: Floats, axles: Ints, category: Ints) -> Floats:
        """The same of any cuts (n,)."""
        top = self.position.top_stage
        allowed = np.array([member.at(top).allowed_stage for member in self.categories.members])[category]
        return np.asarray(self.share * self.full.head_m(mass_t, axles, allowed))

    @cached_property
    def full(self) -> FullBrake:
        """The brake with all its supply, in whatever stage."""
        return FullBrake(self.position, self.car)


@dataclass(frozen=True)
class NormalHumpPosition:
    """Exit speed = command + normal error of `std_m_s`; 0 is the ideal position. The brake works evenly along the path.

    No cut leaves faster than it would unbraked, nor slower than the full brake leaves it: `full_brake_head_m` tells its
    energy head, in metres; mean friction is taken. A cut has another error in every position.
    """

    std_m_s: float
    full_brake_head_m: Callable[[Arrivals], Floats]

    def passed(self, arrivals: Arrivals) -> Passed:
        """See `HumpPosition`."""
        z = ndtri(error_uniform(arrivals))
        return passed_with(arrivals, self.std_m_s * z, self.full_brake_head_m(arrivals))


def error_uniform(arrivals: Arrivals) -> Floats:
    """What the exit errors of the cuts are drawn by, uniform in (0, 1): the same whatever law they have."""
    return np.asarray(keyed_uniform(arrivals.seed, Purpose.POSITION_ERROR, arrivals.keys, 1)[0])


def passed_with(arrivals: Arrivals, errors_m_s: Floats, full_brake_head_m: Floats) -> Passed:
    """Passes that end `errors_m_s` above the command, within what brake and track allow."""
    unbraked = arrivals.unbraked_exit_m_s
    taken = 2.0 * arrivals.reduced_gravity_m_s2 * full_brake_head_m
    least = np.sqrt(np.maximum(unbraked**2 - taken, SLOWEST_M_S**2))
    exit_m_s = np.minimum(np.maximum(arrivals.commanded_m_s + errors_m_s, least), unbraked)
    return Passed(exit_m_s, evenly_braked_s(arrivals, exit_m_s), np.zeros(len(arrivals), dtype=np.int64))
