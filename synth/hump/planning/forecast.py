"""What a control expects of cuts: when they come to each element and leave it, for every choice of exit speeds."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from plant_models.frozen_arrays import Bools, Floats, Ints, frozen_arrays
from synth.hump.rolling.hump_routes import HumpRoutes, Mark
from synth.hump.rolling.motion import Cars, KnownRolls, Leg, Legs, Moving, Push, rolled_free
from synth.kernels.roll import exit_choices as kernel

BOTH_MARKS = np.array([Mark.FIRST_IN, Mark.LAST_OUT])
"""Intervals need no other times."""

SLOWEST_M_S = 0.1
"""No choice is slower."""


@frozen_arrays
class Expected:
    """Cuts as a control knows them, (n,): `cars` roll as it expects; first and last axles behind the head;
    `braked_m2_s2` (n, positions): most loss of v² to the brake of each position; `rolled`: what was worked out of them
    before."""

    cars: Cars
    first_axle_m: Floats
    last_axle_m: Floats
    braked_m2_s2: Floats
    rolled: KnownRolls


class Choices(Protocol):
    """Exit speeds of a position that are compared."""

    @property
    def most_entry_m_s(self) -> Floats | float:
        """Fastest that a cut may come to the position."""

    @property
    def least_entry_m_s(self) -> Floats | float:
        """Slowest that it may come, so that worse runners than expected come, too."""

    def speeds(self, most_m_s: Floats) -> Floats:
        """(n, choices); a cut cannot be faster than `most_m_s` (n,)."""


@frozen_arrays
class Given:
    """One exit speed for each cut, `speed_m_s` (n,)."""

    speed_m_s: Floats
    most_entry_m_s: Floats | float = np.inf
    least_entry_m_s: Floats | float = 0.0

    def speeds(self, most_m_s: Floats) -> Floats:
        """(n, 1)."""
        return np.minimum(self.speed_m_s, most_m_s)[:, None]


@dataclass(frozen=True)
class SpeedRange:
    """Exit speeds that a position may be commanded, and how many of them a control compares; `most_entry_m_s`,
    `least_entry_m_s`: how fast a cut may come to it."""

    low_m_s: float
    high_m_s: float
    choices: int = 7
    most_entry_m_s: float = np.inf
    least_entry_m_s: float = 0.0

    def speeds(self, most_m_s: Floats) -> Floats:
        """(n, choices) evenly between both ends; where a cut is slower, up to its speed `most_m_s` (n,)."""
        high = np.minimum(self.high_m_s, most_m_s)
        low = np.minimum(self.low_m_s, high)
        return np.asarray(low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, self.choices))


@frozen_arrays
class Compared:
    """n cuts with c choices each, (n, c): least margins to the cuts ahead and behind; whether the cut can have these
    speeds; how far it comes beyond the limits of entry of some position, 0 if it does not; when its last axle is out of
    the last element; all exit speeds added up."""

    ahead_s: Floats
    behind_s: Floats
    able: Bools
    beyond_m_s: Floats
    arrival_s: Floats
    speeds_m_s: Floats


@frozen_arrays
class Forecast:
    """n cuts with one choice each: `first_in_s`, `last_out_s` (n, elements), NaN for what lies behind the cut, infinite
    behind a stop; (n, q) of the positions ahead: `exit_m_s`, and `ended_s`, when the passes end."""

    first_in_s: Floats
    last_out_s: Floats
    exit_m_s: Floats
    ended_s: Floats


class Ways:
    """All ways that n cuts can go from where they are until their last axles are out of the last element: free rolls
    and, for each position ahead, the choices of its exit speed. Build it with `from_crest` or `from_entrance`."""

    def __init__(self, routes: HumpRoutes, legs: kernel.Legs) -> None:
        self.routes, self.legs = routes, legs

    def compared(self, free_from_s: Floats, free_by_s: Floats) -> Compared:
        """Every combination of choices, beside neighbours who leave and need the elements at these times, (n,
        elements)."""
        legs = self.legs
        shape = len(legs.time_s), int(np.prod(legs.choices))
        ahead, behind, beyond, arrival = (np.empty(shape) for _ in range(4))
        able = np.empty(shape, dtype=np.bool_)
        work = kernel.work_for(legs)
        kernel.compare(legs, free_from_s, free_by_s, 0, shape[0], work, ahead, behind, able, beyond, arrival)
        total = np.zeros((shape[0], 1))
        for count, speeds in zip(legs.choices, legs.speeds_m_s, strict=True):
            total = (total[:, :, None] + speeds[:, None, :count]).reshape(shape[0], -1)
        return Compared(ahead, behind, able, beyond, arrival, total)

    def followed(self, column: Ints | None = None) -> Forecast:
        """The way with the combination `column` (n,) of the choices; None: the only one."""
        legs, count = self.legs, len(self.legs.time_s)
        at = np.zeros(count, dtype=np.int64) if column is None else column
        taken = np.stack(np.unravel_index(at, tuple(legs.choices)))
        times, ended = np.empty((count, 2 * self.routes.elements)), np.empty((count, len(taken)))
        kernel.follow(legs, taken, 0, count, times, ended)
        marks = times.reshape(count, -1, 2)
        exits = legs.speeds_m_s[np.arange(len(taken))[:, None], np.arange(count), taken]
        return Forecast(marks[:, :, 0].copy(), marks[:, :, 1].copy(), exits.T.copy(), ended)


def from_crest(routes: HumpRoutes, expected: Expected, start: Moving, push: Push, choices: tuple[Choices, ...]) -> Ways:
    """From the crest on, where the heads are at `start` after the `push`; `choices` of all positions."""
    heads = heads_m(routes, expected)
    to = np.maximum(entrance_m(routes, expected, 0), start.head_m)
    leg = rolled(expected, ("from the crest", 0, 1), start.head_m, start.speed_m_s[:, None], to, heads)
    known = push.times_s(start, heads)
    before = np.where(np.isnan(known), start.time_s[:, None] + leg.marks_s[:, 0], known)
    end = Moving(to, leg.ends_m_s[:, 0], start.time_s + leg.ends_s[:, 0])
    return through(routes, expected, end, before, 0, choices)


def rolled(expected: Expected, name: Leg, from_m: Floats, speeds_m_s: Floats, to_m: Floats, marks_m: Floats) -> Legs:
    """Free rolls of the cuts over a leg from the heads at `from_m` to `to_m` (n,), with each of `speeds_m_s` (n, c)."""

    def roll(some: Ints) -> Legs:
        shape = len(some), speeds_m_s.shape[1]
        each = np.repeat(some, shape[1])
        begins = Moving(from_m[each], speeds_m_s[some].reshape(-1), np.zeros(len(each)))
        ends, times = rolled_free(expected.cars.chosen(each), begins, to_m[each], marks_m[each])
        return Legs(times.reshape(*shape, -1), ends.time_s.reshape(shape), ends.speed_m_s.reshape(shape))

    return expected.rolled.found(name, expected.cars, np.column_stack((speeds_m_s, from_m)), roll)


def from_entrance(
    routes: HumpRoutes, expected: Expected, start: Moving, position: int, choices: tuple[Choices, ...]
) -> Ways:
    """From the entrance of `position` on; `choices` of it and of all behind it."""
    before = np.full((len(start.head_m), 2 * routes.elements), np.nan)
    return through(routes, expected, start, before, position, choices)


def through(
    routes: HumpRoutes, expected: Expected, start: Moving, before_s: Floats, position: int, choices: tuple[Choices, ...]
) -> Ways:
    """From `start` at the entrance of `position` through it and all positions behind it, which have the `choices`."""
    count, marks, most = len(before_s), before_s.shape[1], len(choices)
    heads, fastest, stretches = heads_m(routes, expected), start.speed_m_s, []
    begins = np.maximum(entrance_m(routes, expected, position), start.head_m)
    for place, of_one in enumerate(choices, position):
        stretches.append(stretch(routes, expected, place, heads, Moving(begins, fastest, np.zeros(count)), of_one))
        fastest, begins = stretches[-1].behind.ends_m_s.max(axis=1), entrance_m(routes, expected, place + 1)
    counts = np.array([each.speeds_m_s.shape[1] for each in stretches])
    wide = most, count, int(counts.max())
    speeds, ends, ends_speed = (np.zeros(wide) for _ in range(3))
    roll = np.full((*wide, marks), np.nan)
    for place, (chosen, each) in enumerate(zip(counts, stretches, strict=True)):
        speeds[place, :, :chosen], roll[place, :, :chosen] = each.speeds_m_s, each.behind.marks_s
        ends[place, :, :chosen], ends_speed[place, :, :chosen] = each.behind.ends_s, each.behind.ends_m_s
    legs = kernel.Legs(
        time_s=start.time_s.copy(),
        speed_m_s=start.speed_m_s.copy(),
        before_s=before_s,
        choices=counts,
        speeds_m_s=speeds,
        won_m2_s2=np.stack([each.won_m2_s2 for each in stretches]),
        path_m=np.stack([each.path_m for each in stretches]),
        share=np.stack([each.share for each in stretches]),
        roll_s=roll,
        ends_s=ends,
        ends_m_s=ends_speed,
        most_entry_m_s=np.stack([each.most_entry_m_s for each in stretches]),
        least_entry_m_s=np.stack([each.least_entry_m_s for each in stretches]),
        braked_m2_s2=expected.braked_m2_s2[:, position : position + most].T.copy(),
    )
    return Ways(routes, legs)


@frozen_arrays
class Stretch:
    """A position and the free roll behind it, as `Legs` has them."""

    speeds_m_s: Floats
    won_m2_s2: Floats
    path_m: Floats
    share: Floats
    behind: Legs
    most_entry_m_s: Floats
    least_entry_m_s: Floats


def stretch(
    routes: HumpRoutes, expected: Expected, position: int, heads_m: Floats, start: Moving, choices: Choices
) -> Stretch:
    """`position` with each of the `choices` for cuts that come as at `start`, at the fastest. On a route that has no
    such position it has no length, at the end of the way that is forecast, and cuts keep their speed."""
    exit_m = routes.exit_m[expected.cars.routes, position]
    there = np.isfinite(exit_m)
    leaves = np.where(there, exit_m + expected.last_axle_m, start.head_m)
    no_marks = np.empty((len(leaves), 0))
    unbraked = rolled(expected, ("unbraked", position, 1), start.head_m, start.speed_m_s[:, None], leaves, no_marks)
    unbraked_m_s = unbraked.ends_m_s[:, 0]
    most = np.maximum(unbraked_m_s, SLOWEST_M_S)
    speeds = np.where(there[:, None], choices.speeds(most), most[:, None])
    ahead = entrance_m(routes, expected, position + 1)
    behind = rolled(expected, ("behind", position, speeds.shape[1]), leaves, speeds, ahead, heads_m)
    path = leaves - start.head_m
    share = (heads_m - start.head_m[:, None]) / np.where(there, path, np.nan)[:, None]
    return Stretch(
        speeds_m_s=speeds,
        won_m2_s2=unbraked_m_s**2 - start.speed_m_s**2,
        path_m=path,
        share=np.where((share > 0.0) & (share <= 1.0), share, np.nan),
        behind=behind,
        most_entry_m_s=np.where(there, choices.most_entry_m_s, np.inf),
        least_entry_m_s=np.where(there, choices.least_entry_m_s, 0.0),
    )


def heads_m(routes: HumpRoutes, expected: Expected) -> Floats:
    """Where the heads are when first axles come in and last axles go out, (n, elements · 2)."""
    places = routes.place_m[expected.cars.routes][:, :, BOTH_MARKS]
    axles = np.stack((expected.first_axle_m, expected.last_axle_m), axis=1)
    return np.asarray((places + axles[:, None, :]).reshape(len(places), -1))


def entrance_m(routes: HumpRoutes, expected: Expected, position: int) -> Floats:
    """Where the heads are when the passes of `position` begin: at its entrance, but not before the last axles are out
    of the position before it. Behind the last position of a route: when they are out of its last element."""
    rows = expected.cars.routes
    if position == routes.positions:
        return np.asarray(routes.ends_m[rows] + expected.last_axle_m)
    out = np.full(len(rows), -np.inf)
    if position > 0:
        out = routes.exit_m[rows, position - 1] + expected.last_axle_m
    begins = np.maximum(routes.entrance_m[rows, position] + expected.first_axle_m, out)
    if routes.even:
        return np.asarray(begins)
    ends = routes.ends_m[rows] + expected.last_axle_m
    return np.where(np.isfinite(routes.entrance_m[rows, position]), begins, ends)
