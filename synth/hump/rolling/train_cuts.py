"""The cuts of whole trains: what they are, where they go, and what is drawn for their way."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.special import ndtri

from plant_models.errors import PlantError
from plant_models.frozen_arrays import Floats, Ints, frozen_arrays, read_only
from plant_models.hump import Route
from plant_models.rolling.car_mix import AXLES_OF_A_CATEGORY
from plant_models.rolling.random_cuts import CutPopulation, DrawnCuts, air_n_per_kn, bend_draws
from plant_models.rolling.random_numbers import Purpose, uniform_numbers
from synth.hump.control.train_population import DrawnTrains, TrainPopulation


@frozen_arrays
class TrainCuts:
    """Trains of the row `seed`, of `cuts` cuts each, with the `numbers` first, first + apart, …: cut i of train k of
    them is the row k·cuts + i. From `trains` or `list_trains`.

    `population`: mix, weight categories, law and weather of the cuts; `drawn`: their bends are draws
    (`DrawnCuts.on_bends`). Arrays of shape (rows,): `route`, place among the routes; `track`; `category`, place among
    the weight categories; `mass_t` as a sorting list tells it. Lengths and axles are those of the drawn cars.
    """

    population: CutPopulation
    seed: int
    first: int
    trains: int
    cuts: int
    drawn: DrawnCuts
    route: Ints
    track: Ints
    category: Ints
    mass_t: Floats
    apart: int = 1

    def __len__(self) -> int:
        return len(self.drawn)

    @cached_property
    def numbers(self) -> Ints:
        """Of the trains, (trains,)."""
        return read_only(self.first + self.apart * np.arange(self.trains))

    def every(self, apart: int, place: int = 0) -> TrainCuts:
        """The trains `place`, `place + apart`, … of these."""
        if apart == 1:
            return self
        lanes = np.arange(place, self.trains, apart)
        rows = (lanes[:, None] * self.cuts + np.arange(self.cuts)).reshape(-1)
        return replace(
            self,
            first=self.first + self.apart * place,
            apart=self.apart * apart,
            trains=len(lanes),
            drawn=self.drawn.chosen(rows),
            route=self.route[rows],
            track=self.track[rows],
            category=self.category[rows],
            mass_t=self.mass_t[rows],
        )

    @cached_property
    def cars(self) -> Ints:
        """Cars of each cut."""
        return read_only(self.drawn.cars_of_cut)

    @cached_property
    def axles(self) -> Ints:
        """Axles of each cut."""
        return read_only(self.car_axles.sum(axis=1))

    @property
    def car_axles(self) -> Ints:
        """Axles of each car, (rows, cars); 0 where there is none."""
        return np.where(self.drawn.mass_t > 0.0, self.drawn.mix.axles[self.drawn.types], 0)

    @cached_property
    def length_m(self) -> Floats:
        """Length over couplers."""
        return read_only(self.drawn.car_lengths_m.sum(axis=1))

    @cached_property
    def first_axle_m(self) -> Floats:
        """How far the first axle is behind the head."""
        return read_only(self.drawn.first_axle_m)

    @cached_property
    def last_axle_m(self) -> Floats:
        """How far the last axle is behind the head."""
        return read_only(self.drawn.last_axle_m)

    def resistance_at(self, rows: Ints, speed_m_s: Floats) -> Floats:
        """Resistance of the cuts `rows` on straight track of the hump slope at `speed_m_s`, air and wind included,
        N/kN."""
        return self.drawn.resistance_at(self.population.law, rows, speed_m_s)


def trains(
    population: TrainPopulation,
    people: CutPopulation,
    routes: tuple[Route, ...],
    seed: int,
    first: int,
    count: int,
    cuts: int,
    one_wind_a_train: bool = False,
) -> TrainCuts:
    """Trains `first` … `first + count − 1` of the row `seed`, of `cuts` cuts each, over the lead of the first of
    `routes`; law and weather of `people`. Each train is the same whatever `first` and `count`.

    `one_wind_a_train`: one draw of the wind a train instead of one a cut. `PlantError` for a track without route.
    """
    drawn = population.drawn(seed, first, count, cuts)
    own = replace(people, mix=population.mix, categories=population.categories)
    route = routes_to(routes, np.zeros_like(drawn.track), drawn.track)
    draw = Draw(seed, first, one_wind_a_train)
    return cuts_on_routes(own, routes, drawn, route, np.round(drawn.mass_t.sum(axis=1), 3), draw)


@dataclass(frozen=True)
class Draw:
    """Which numbers are drawn: trains from `first` on of the row `seed`."""

    seed: int
    first: int
    one_wind_a_train: bool


def cuts_on_routes(
    people: CutPopulation, routes: tuple[Route, ...], trains: DrawnTrains, route: Ints, mass_t: Floats, draw: Draw
) -> TrainCuts:
    """`trains` with what is drawn for their way: resistance of each car, wind, bends."""
    rows, begins, most_bends = len(trains.cars), draw.first * trains.cuts, max(len(r.roll_track.bends) for r in routes)
    count = rows // trains.cuts
    bends = bend_draws(people.law, most_bends, draw.seed, begins, rows)
    u_cars = uniform_numbers(draw.seed, Purpose.TRAIN_RESISTANCE, begins, rows, trains.types.shape[1])
    drawn = DrawnCuts(
        mix=trains.mix,
        types=trains.types,
        mass_t=trains.mass_t,
        basic_n_per_kn=basic_n_per_kn(people, trains, u_cars),
        head_wind_m_s=people.weather.head_winds_m_s(ndtri(wind_numbers(draw, count, trains.cuts))),
        bend_v2_m_s2=bends,
        bend_head_m=bends,
        air_n_per_kn=air_n_per_kn(trains.mix, people.weather, trains.types, trains.mass_t),
    )
    return TrainCuts(
        people, draw.seed, draw.first, count, trains.cuts, drawn, route, trains.track, trains.category, mass_t
    )


def wind_numbers(draw: Draw, count: int, cuts: int) -> Floats:
    """Uniform numbers of the wind of each cut, (rows,)."""
    if draw.one_wind_a_train:
        return uniform_numbers(draw.seed, Purpose.TRAIN_WIND, draw.first, count, 1)[:, 0].repeat(cuts)
    return uniform_numbers(draw.seed, Purpose.WIND, draw.first * cuts, count * cuts, 1)[:, 0]


def basic_n_per_kn(people: CutPopulation, trains: DrawnTrains, u: Floats | None = None) -> Floats:
    """Resistance of each car for uniform `u` (rows, cars), else the mean of its law; 0 where there is no car."""
    basic = np.zeros(trains.mass_t.shape)
    on_four_axles = trains.mass_t * (AXLES_OF_A_CATEGORY / trains.mix.axles[trains.types])
    temperature = people.weather.temperature_c
    for place, category in enumerate(people.categories.members):
        cars = (trains.mass_t > 0.0) & (trains.category == place)[:, None]
        of, mass = category.resistance, on_four_axles[cars]
        basic[cars] = (
            people.law.mean_basic_n_per_kn(of, mass, temperature)
            if u is None
            else people.law.basic_n_per_kn(of, mass, temperature, u[cars])
        )
    return basic


def expected(cuts: TrainCuts) -> DrawnCuts:
    """`cuts` as a control knows them: the mass of the list, spread evenly over the axles, mean resistance of the
    category, mean bends and mean wind; the types as drawn, because a list tells cars and axles."""
    people, drawn = cuts.population, cuts.drawn
    mass = cuts.mass_t[:, None] * (cuts.car_axles / cuts.axles[:, None])
    known = DrawnTrains(drawn.mix, cuts.cuts, cuts.cars, cuts.category, cuts.track, drawn.types, mass)
    bends = np.full(drawn.bend_v2_m_s2.shape, people.law.mean_bend_draw)
    return replace(
        drawn,
        mass_t=mass,
        basic_n_per_kn=basic_n_per_kn(people, known),
        head_wind_m_s=people.weather.head_winds_m_s(np.zeros(len(cuts))),
        bend_v2_m_s2=bends,
        bend_head_m=bends,
        air_n_per_kn=air_n_per_kn(drawn.mix, people.weather, drawn.types, mass),
    )


def routes_to(routes: tuple[Route, ...], lead: Ints, track: Ints) -> Ints:
    """Place of the route over lead 0 or 1 (in the order of `routes`) to each `track`; `PlantError` if there is none."""
    leads = tuple(dict.fromkeys(route.lead for route in routes))
    tracks = 1 + max(int(track.max(initial=0)), *(route.track for route in routes))
    places = np.full((max(2, len(leads)), tracks), -1)
    for place, route in enumerate(routes):
        places[leads.index(route.lead), route.track] = place
    found = np.asarray(places[lead, track])
    if (found < 0).any():
        row = int(np.argmax(found < 0))
        raise PlantError(f"train: a cut goes to track {track[row]} over lead {lead[row]}; the hump has no such route")
    return found
