"""What a control expects of cuts: when they come to each element and leave it, for every choice of exit speeds."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays
from synth.yard.humping.hump_routes import HumpRoutes, Mark
from synth.yard.humping.motion import Cars, Moving, braked_evenly, even_duration_s, rolled_free

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

BOTH_MARKS = np.array([Mark.FIRST_IN, Mark.LAST_OUT])
"""Intervals need no other times."""


@frozen_arrays
@dataclass(frozen=True, eq=False)
class Expected:
    """Cuts as a control knows them, (n,): `cars` roll as it expects; first and last axles behind the head."""

    cars: Cars
    first_axle_m: Floats
    last_axle_m: Floats

    def chosen(self, which: Bools | Ints) -> Expected:
        """Some of them."""
        return Expected(self.cars.chosen(which), self.first_axle_m[which], self.last_axle_m[which])


class Choices(Protocol):
    """Exit speeds of a position that are compared."""

    @property
    def most_entry_m_s(self) -> Floats | float:
        """Fastest that a cut may come to the position."""

    def speeds(self, most_m_s: Floats) -> Floats:
        """(n, choices); a cut cannot be faster than `most_m_s` (n,)."""


@frozen_arrays
@dataclass(frozen=True, eq=False)
class Given:
    """One exit speed for each cut, `speed_m_s` (n,)."""

    speed_m_s: Floats
    most_entry_m_s: Floats | float = np.inf

    def speeds(self, most_m_s: Floats) -> Floats:
        """(n, 1)."""
        return np.minimum(self.speed_m_s, most_m_s)[:, None]


@dataclass(frozen=True)
class SpeedRange:
    """Exit speeds that a position may be commanded, and how many of them a control compares; `most_entry_m_s`:
    fastest that a cut may come to it."""

    low_m_s: float
    high_m_s: float
    choices: int = 7
    most_entry_m_s: float = np.inf

    def speeds(self, most_m_s: Floats) -> Floats:
        """(n, choices) evenly between both ends; where a cut is slower, up to its speed `most_m_s` (n,)."""
        high = np.minimum(self.high_m_s, most_m_s)
        low = np.minimum(self.low_m_s, high)
        return np.asarray(low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, self.choices))


@frozen_arrays
@dataclass(frozen=True, eq=False)
class Forecast:
    """n cuts with c choices each, from where they are until their last axles are out of the last position.

    `first_in_s`, `last_out_s` (n, c, elements): NaN for what lies behind the cut or beyond the forecast, infinite
    behind a stop. `speeds_m_s` (n, c, q): exit speeds of the next q positions; `able` (n, c): whether the cut can
    have them. `arrival_s`, `arrival_m_s` (n, c): there.
    """

    first_in_s: Floats
    last_out_s: Floats
    speeds_m_s: Floats
    able: Bools
    arrival_s: Floats
    arrival_m_s: Floats

    def choice(self, column: Ints) -> Forecast:
        """One choice for each cut, (n,); arrays keep an axis of one choice."""
        at = np.arange(len(column)), column
        return Forecast(
            self.first_in_s[at][:, None],
            self.last_out_s[at][:, None],
            self.speeds_m_s[at][:, None],
            self.able[at][:, None],
            self.arrival_s[at][:, None],
            self.arrival_m_s[at][:, None],
        )


def from_crest(routes: HumpRoutes, expected: Expected, start: Moving, choices: tuple[Choices, ...]) -> Forecast:
    """From the crest on, where the heads are at `start`; `choices` of the first positions."""
    heads = heads_m(routes, expected)
    end, times = rolled_free(expected.cars, start, entrance_m(routes, expected, 0), heads)
    known = start.time_s[:, None] - (start.head_m[:, None] - heads) / start.speed_m_s[:, None]
    times = np.where(heads <= start.head_m[:, None], known, times)
    speeds = np.empty((len(heads), 1, 0))
    able = np.ones((len(heads), 1), dtype=bool)
    return through(
        routes, expected, 0, Reached(end.speed_m_s[:, None], end.time_s[:, None], times[:, None], speeds, able), choices
    )


def from_entrance(
    routes: HumpRoutes, expected: Expected, start: Moving, position: int, choices: tuple[Choices, ...]
) -> Forecast:
    """From the entrance of `position` on; `choices` of it and of those behind it."""
    none = np.full((len(start.head_m), 1, 2 * routes.elements), np.nan)
    speeds, able = np.empty((len(none), 1, 0)), np.ones((len(none), 1), dtype=bool)
    reached = Reached(start.speed_m_s[:, None], start.time_s[:, None], none, speeds, able)
    return through(routes, expected, position, reached, choices)


@frozen_arrays
@dataclass(frozen=True, eq=False)
class Reached:
    """Cuts at the entrance of a position, (n, c): speed, time, and times of marks on the way there (n, c, marks)."""

    speed_m_s: Floats
    time_s: Floats
    times_s: Floats
    speeds_m_s: Floats
    able: Bools


def through(
    routes: HumpRoutes, expected: Expected, position: int, reached: Reached, choices: tuple[Choices, ...]
) -> Forecast:
    """Through as many positions as there are `choices`, all choices of the one with all of the next."""
    for place, of_one in enumerate(choices):
        reached = through_one(routes, expected, position + place, reached, of_one)
    marks = reached.times_s.reshape(*reached.times_s.shape[:2], routes.elements, 2)
    first_in, last_out = marks[..., 0], marks[..., 1]
    unknown = np.isnan(last_out) & ~np.isnan(first_in)
    last_out = np.where(unknown, reached.time_s[:, :, None], last_out)
    return Forecast(first_in, last_out, reached.speeds_m_s, reached.able, reached.time_s, reached.speed_m_s)


def through_one(routes: HumpRoutes, expected: Expected, position: int, reached: Reached, choices: Choices) -> Reached:
    """Through `position` with each of the choices, and free to the next position."""
    count, before = reached.speed_m_s.shape
    heads = heads_m(routes, expected)
    entrance = entrance_m(routes, expected, position)
    leaves = routes.exit_m[expected.cars.routes, position] + expected.last_axle_m
    fastest = reached.speed_m_s.max(axis=1)
    unbraked, _ = rolled_free(expected.cars, Moving(entrance, fastest, np.zeros(count)), leaves, np.empty((count, 0)))
    won = unbraked.speed_m_s**2 - fastest**2
    speeds = choices.speeds(np.maximum(unbraked.speed_m_s, 0.1))
    chosen = speeds.shape[1]
    # the roll behind the position is the same whatever the speed at its entrance was
    each = np.repeat(np.arange(count), chosen)
    begins = Moving(leaves[each], speeds.reshape(-1), np.zeros(len(each)))
    ends, roll = rolled_free(
        expected.cars.chosen(each), begins, entrance_m(routes, expected, position + 1)[each], heads[each]
    )
    # the pass: every speed at the entrance with every choice
    pair = np.repeat(np.arange(count), before * chosen)
    enters = Moving(
        entrance[pair], np.repeat(reached.speed_m_s.reshape(-1), chosen), np.repeat(reached.time_s.reshape(-1), chosen)
    )
    exits = np.broadcast_to(speeds[:, None], (count, before, chosen)).reshape(-1)
    takes = even_duration_s(enters, leaves[pair], exits)
    left, brake = braked_evenly(enters, leaves[pair], exits, takes, heads[pair])
    limit = np.broadcast_to(choices.most_entry_m_s, count)[pair]
    able = (exits**2 <= enters.speed_m_s**2 + won[pair] + 1e-6) & (enters.speed_m_s <= limit)
    wide = (count, before, chosen, -1)
    out = left.time_s.reshape(wide)
    times = np.where(
        np.isnan(roll).reshape(count, 1, chosen, -1),
        brake.reshape(wide),
        out + roll.reshape(count, 1, chosen, -1),
    )
    times = np.where(np.isnan(reached.times_s)[:, :, None], times, reached.times_s[:, :, None])
    arrival = out[..., 0] + ends.time_s.reshape(count, 1, chosen)
    shown = np.broadcast_to(reached.speeds_m_s[:, :, None], (*arrival.shape, reached.speeds_m_s.shape[2]))
    new = np.broadcast_to(speeds[:, None, :, None], (*arrival.shape, 1))
    columns = before * chosen
    return Reached(
        np.broadcast_to(ends.speed_m_s.reshape(count, 1, chosen), arrival.shape).reshape(count, columns).copy(),
        arrival.reshape(count, columns),
        times.reshape(count, columns, -1),
        np.concatenate((shown, new), axis=3).reshape(count, columns, -1),
        (able.reshape(arrival.shape) & reached.able[:, :, None]).reshape(count, columns),
    )


def heads_m(routes: HumpRoutes, expected: Expected) -> Floats:
    """Where the heads are when first axles come in and last axles go out, (n, elements · 2)."""
    places = routes.place_m[expected.cars.routes][:, :, BOTH_MARKS]
    axles = np.stack((expected.first_axle_m, expected.last_axle_m), axis=1)
    return np.asarray((places + axles[:, None, :]).reshape(len(places), -1))


def entrance_m(routes: HumpRoutes, expected: Expected, position: int) -> Floats:
    """Where the heads are at the entrance of `position`, or, behind the last one, when the last axles are out of it."""
    rows = expected.cars.routes
    if position == routes.positions:
        return np.asarray(routes.exit_m[rows, position - 1] + expected.last_axle_m)
    return np.asarray(routes.entrance_m[rows, position] + expected.first_axle_m)
