"""Cuts as they come over the hump: types, masses, resistance, wind and bends, one draw each for the whole way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property

import numpy as np
from scipy.special import ndtri

from plant_models.cut import GRAVITY_M_S2, ROTATING_MASS_PER_AXLE_T
from plant_models.errors import require
from plant_models.frozen_arrays import Bools, Floats, Ints, frozen_arrays
from plant_models.library.weight_category import WeightCategories, WeightCategory
from plant_models.rolling.car_mix import AXLES_OF_A_CATEGORY, CarMix
from plant_models.rolling.random_numbers import Purpose, uniform_numbers
from plant_models.rolling.resistance_law import ResistanceLaw
from plant_models.rolling.roll_track import Bend, Weather

MOST_CARS = 60


@frozen_arrays
class DrawnCuts:
    """n cuts of up to `cars` cars each; arrays of shape (n, cars), of cuts (n,), of bends (n, bends).

    `types`: places in the mix; `mass_t`: 0 where a cut has no more cars; `basic_n_per_kn`: resistance of each car in
    the yard at standstill; `head_wind_m_s`: against the cut; `bend_v2_m_s2`, `bend_head_m`: head that a bend takes, per
    (m/s)² and whatever the speed; of cuts that were drawn for no track, the draws themselves (`on_bends`);
    `air_n_per_kn`: resistance of the air of the whole cut per (m/s)² of relative speed.
    """

    mix: CarMix
    types: Ints
    mass_t: Floats
    basic_n_per_kn: Floats
    head_wind_m_s: Floats
    bend_v2_m_s2: Floats
    bend_head_m: Floats
    air_n_per_kn: Floats

    def __len__(self) -> int:
        return len(self.types)

    @property
    def cars(self) -> int:
        """Cars of the longest cut, or more."""
        return int(self.types.shape[1])

    @property
    def cars_of_cut(self) -> Ints:
        """Cars of each cut, (n,)."""
        return np.asarray(np.count_nonzero(self.mass_t, axis=1))

    @property
    def cut_mass_t(self) -> Floats:
        """Q, shape (n,)."""
        return np.asarray(self.mass_t.sum(axis=1))

    @property
    def shares(self) -> Floats:
        """Mass of each car over that of its cut, (n, cars)."""
        return self.mass_t / self.cut_mass_t[:, None]

    @cached_property
    def resistance_n_per_kn(self) -> Floats:
        """w0 of each cut: of its cars, weighted by mass, (n,)."""
        found = np.asarray((self.shares * self.basic_n_per_kn).sum(axis=1))
        found.setflags(write=False)
        return found

    def resistance_at(self, law: ResistanceLaw, rows: Ints, speed_m_s: Floats) -> Floats:
        """Resistance of the cuts `rows` on straight track of the hump slope at `speed_m_s`, air and wind included,
        N/kN."""
        against = speed_m_s + self.head_wind_m_s[rows]
        air = self.air_n_per_kn[rows] * against * np.abs(against)
        steady = self.resistance_n_per_kn[rows] + law.slope_extra_n_per_kn
        return np.asarray(steady + law.linear_n_per_kn * speed_m_s + air)

    @property
    def reduced_gravity_m_s2(self) -> Floats:
        """g' of each cut, (n,)."""
        axles = np.where(self.mass_t > 0.0, self.mix.axles[self.types], 0).sum(axis=1)
        return np.asarray(GRAVITY_M_S2 / (1.0 + ROTATING_MASS_PER_AXLE_T * axles / self.cut_mass_t))

    @property
    def car_lengths_m(self) -> Floats:
        """Length over couplers of each car, (n, cars); 0 where there is none."""
        return np.where(self.mass_t > 0.0, np.array([c.car.length_m for c in self.mix.cars])[self.types], 0.0)

    @property
    def car_fronts_m(self) -> Floats:
        """How far the front coupler of each car is behind the head of its cut, (n, cars)."""
        return np.cumsum(self.car_lengths_m, axis=1) - self.car_lengths_m

    @property
    def first_axle_m(self) -> Floats:
        """How far the first axle is behind the head, (n,)."""
        return self.overhangs_m[self.types[:, 0]]

    @property
    def last_axle_m(self) -> Floats:
        """How far the last axle is behind the head, (n,)."""
        last = self.types[np.arange(len(self)), self.cars_of_cut - 1]
        return np.asarray(self.car_lengths_m.sum(axis=1) - self.overhangs_m[last])

    @property
    def overhangs_m(self) -> Floats:
        """From the coupler to the nearest axle, for each type of the mix."""
        return np.array([(c.car.length_m - c.car.axle_offsets_m[-1]) / 2.0 for c in self.mix.cars])

    def chosen(self, which: Bools | Ints | slice) -> DrawnCuts:
        """Some of these cuts."""
        arrays = {f.name: getattr(self, f.name)[which] for f in fields(self) if f.name != "mix"}
        return DrawnCuts(mix=self.mix, **arrays)

    def first_cars(self, cars: int, weather: Weather) -> DrawnCuts:
        """These cuts without what comes behind their first `cars` cars."""
        types, mass_t = self.types[:, :cars], self.mass_t[:, :cars]
        return replace(
            self,
            types=types,
            mass_t=mass_t,
            basic_n_per_kn=self.basic_n_per_kn[:, :cars],
            air_n_per_kn=air_n_per_kn(self.mix, weather, types, mass_t),
        )

    def on_bends(self, law: ResistanceLaw, bends: Sequence[Bend]) -> DrawnCuts:
        """These cuts, whose bends are draws, with the heads that `bends` take from them by `law`."""
        v2, head = bend_scales_m(law, bends).T
        return replace(
            self,
            bend_v2_m_s2=self.bend_v2_m_s2[:, : len(bends)] * v2,
            bend_head_m=self.bend_head_m[:, : len(bends)] * head,
        )


@dataclass(frozen=True)
class CutPopulation:
    """Where cuts come from: mix of cars, weight categories, law of resistance, weather, and the bends of their way."""

    mix: CarMix
    categories: WeightCategories
    law: ResistanceLaw
    weather: Weather
    bends: tuple[Bend, ...] = ()

    def draw(self, category: WeightCategory, cars: int, seed: int, first: int, count: int) -> DrawnCuts:
        """Cuts `first` … `first + count − 1` of the row `seed`, each of `cars` cars of `category`.

        The first cars, the wind and the bends of cut i are the same whatever `cars`.
        """
        require(1 <= cars <= MOST_CARS, f"cut: {cars} cars; a cut has 1 to {MOST_CARS}")
        mix = self.mix.of(self.categories, category)
        u = uniform_numbers(seed, Purpose.CARS, first, count, 3 * cars).reshape(count, cars, 3)
        types = mix.types(u[..., 0])
        mass = mix.masses_t(self.categories, category, types, u[..., 1])
        on_four_axles = mass * (AXLES_OF_A_CATEGORY / mix.axles[types])
        basic = self.law.basic_n_per_kn(category.resistance, on_four_axles, self.weather.temperature_c, u[..., 2])
        wind = ndtri(uniform_numbers(seed, Purpose.WIND, first, count, 1)[:, 0])
        draws = bend_draws(self.law, len(self.bends), seed, first, count)
        return DrawnCuts(
            mix=mix,
            types=types,
            mass_t=mass,
            basic_n_per_kn=basic,
            head_wind_m_s=self.weather.head_winds_m_s(wind),
            bend_v2_m_s2=draws,
            bend_head_m=draws,
            air_n_per_kn=air_n_per_kn(mix, self.weather, types, mass),
        ).on_bends(self.law, self.bends)


def air_n_per_kn(mix: CarMix, weather: Weather, types: Ints, mass_t: Floats) -> Floats:
    """Resistance of the air of cuts per (m/s)², (n,), from C_x1·S_1 + Σ C_xj·S_j: cars behind the first count by their
    following share, those of mass 0 not at all."""
    areas = np.where(mass_t > 0.0, np.array([c.drag_area_m2 for c in mix.cars])[types], 0.0)
    felt = areas[:, 0] + mix.following_share * areas[:, 1:].sum(axis=1)
    return np.asarray(weather.air_n_per_kn(1.0) * felt / mass_t.sum(axis=1))


def bend_draws(law: ResistanceLaw, bends: int, seed: int, first: int, count: int) -> Floats:
    """Draws of cuts for that many bends along their way, (count, bends)."""
    u = uniform_numbers(seed, Purpose.BENDS, first, count, bends * law.bend_numbers)
    return law.bend_draws(u.reshape(count, bends, law.bend_numbers))


def bend_scales_m(law: ResistanceLaw, bends: Sequence[Bend]) -> Floats:
    """Heads that bends take from a draw of 1: (per (m/s)², whatever the speed), (bends, 2)."""
    return np.array([law.bend_scale_m(bend) for bend in bends]).reshape(-1, 2)
