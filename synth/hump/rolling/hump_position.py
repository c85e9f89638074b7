"""A retarder position of the hump: what it makes of cuts that arrive with an order for their exit speed. Where its
exactness alone is known, cuts leave with the commanded speed and a normal error.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

import numpy as np
from scipy.special import ndtri

from plant_models.cut import GRAVITY_M_S2, ROTATING_MASS_PER_AXLE_T, Car
from plant_models.frozen_arrays import Bools, Floats, Ints, frozen_arrays
from plant_models.library.weight_category import WeightCategories
from plant_models.retarder import RetarderPosition
from plant_models.rolling.random_numbers import Purpose, keyed_uniform
from plant_models.stage_regulator import FullBrake

OF_ALL = ("seed", "position")
"""What all arrivals share."""


@frozen_arrays
class Arrivals:
    """m cuts, one entry each, that come to a position, the first of their way being `position` 0.

    The pass begins when the first axle is at the entrance, with `entry_m_s`, and ends `path_m` later, when the last
    axle is at the exit; there a cut that nothing brakes has `unbraked_exit_m_s`, 0 if it stops before. `commanded_m_s`:
    the exit speed ordered. `retarder`: number of the element. `category`: place among the weight categories.
    `resistance_n_per_kn`: basic resistance and air at the mean speed between entry and order;
    `unbraked_resistance_n_per_kn`: at that of the unbraked pass. `seed`, `train`, `cut`: whose random numbers they
    have; `rows` is the caller's.
    """

    rows: Ints
    retarder: Ints
    entry_m_s: Floats
    unbraked_exit_m_s: Floats
    path_m: Floats
    commanded_m_s: Floats
    mass_t: Floats
    axles: Ints
    category: Ints
    resistance_n_per_kn: Floats
    unbraked_resistance_n_per_kn: Floats
    train: Ints
    cut: Ints
    seed: int
    position: int

    def __post_init__(self) -> None:
        for name, values in vars(self).items():
            if isinstance(values, np.ndarray) and values.shape != self.rows.shape:
                raise ValueError(f"arrivals: {name} has the shape {values.shape}; the rows have {self.rows.shape}")

    def __len__(self) -> int:
        return len(self.rows)

    @property
    def reduced_gravity_m_s2(self) -> Floats:
        """g' of each cut, (m,)."""
        return np.asarray(GRAVITY_M_S2 * self.mass_t / (self.mass_t + ROTATING_MASS_PER_AXLE_T * self.axles))

    @property
    def keys(self) -> tuple[Ints, Ints, Ints]:
        """What tells the random numbers of the passes apart: train, cut, position."""
        return self.train, self.cut, np.full_like(self.cut, self.position)

    def chosen(self, which: Bools | Ints | slice) -> Arrivals:
        """Some of them."""
        arrays: dict[str, Any] = {name: values[which] for name, values in vars(self).items() if name not in OF_ALL}
        return Arrivals(**arrays, seed=self.seed, position=self.position)


@frozen_arrays
class Passed:
    """How m cuts passed: `exit_m_s` when the last axle is at the exit, `time_s` after the first was at the entrance.

    A cut that stops has speed 0 and infinite time. `switchings`: commands to the valves, 0 where no valve is modelled.
    """

    exit_m_s: Floats
    time_s: Floats
    switchings: Ints


class HumpPosition(Protocol):
    """A position under its controller. What a cut does there does not depend on the others of `arrivals`."""

    def passed(self, arrivals: Arrivals) -> Passed:
        """How they pass."""


def evenly_braked_s(arrivals: Arrivals, exit_m_s: Floats) -> Floats:
    """Time of passes whose v² changes evenly along the path: 2·path/(entry + exit); infinite where the cut stops."""
    moves = (exit_m_s > 0.0) & (arrivals.entry_m_s > 0.0)
    return np.where(moves, 2.0 * arrivals.path_m / np.where(moves, arrivals.entry_m_s + exit_m_s, 1.0), np.inf)


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
