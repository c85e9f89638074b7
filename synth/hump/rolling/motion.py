"""Heads of cuts on their way: free over the track, or braked at an even rate, and when they pass given places.

Free rolls that a control expects are worked out once: a plan and its feedback ask for the same ones again and again.
Where the train is pushed at another speed, most cuts still come fast enough for the same exit speeds; behind a position
they then roll as before.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, Protocol

import numpy as np

from plant_models.frozen_arrays import Bools, Floats, Ints, frozen_arrays
from synth.simulation.free_roll import Rolled


@frozen_arrays
class Moving:
    """Where the heads of n cuts are, how fast, and when: (n,) each. A cut that stopped has speed 0 and time infinite;
    `head_m` is then where it stands."""

    head_m: Floats
    speed_m_s: Floats
    time_s: Floats

    def chosen(self, which: Bools | Ints) -> Moving:
        """Some of them."""
        return Moving(self.head_m[which], self.speed_m_s[which], self.time_s[which])


def merged(all_lanes: Moving, some: Moving, which: Bools) -> Moving:
    """`all_lanes`, of which those `which` are now as in `some`."""
    head, speed, time = all_lanes.head_m.copy(), all_lanes.speed_m_s.copy(), all_lanes.time_s.copy()
    head[which], speed[which], time[which] = some.head_m, some.speed_m_s, some.time_s
    return Moving(head, speed, time)


class Rolls(Protocol):
    """What rolls cuts, `rows`, on `routes`; see `RouteRolling`."""

    def roll_on(
        self,
        rows: Ints,
        routes: Ints,
        start_m: Floats,
        speed_m_s: Floats,
        stations_m: Floats,
        resistance_n_per_kn: Floats | None = None,
    ) -> Rolled:
        """Over `stations_m` (n, k), from the heads at `start_m` (n,) with `speed_m_s` (n,)."""


class CoupledRolls(Rolls, Protocol):
    """The same, of cuts that may couple and roll on as one."""

    def coupled(self, members: Ints) -> Rolls:
        """The cuts `members` (n, k), the first ahead, −1 behind the last one, as n cuts."""

    def inertia_t(self, rows: Ints) -> Floats:
        """Mass of the cuts `rows` (m,), with what their wheels add as they turn."""


@frozen_arrays
class Cars:
    """Which cuts move, on which routes, (n,) each; `resistance_n_per_kn`: taken for their own, None: their own."""

    rolls: Rolls
    rows: Ints
    routes: Ints
    resistance_n_per_kn: Floats | None = None

    def chosen(self, which: Bools | Ints) -> Cars:
        """Some of them."""
        own = self.resistance_n_per_kn
        return Cars(self.rolls, self.rows[which], self.routes[which], None if own is None else own[which])


def rolled_free(cars: Cars, start: Moving, to_m: Floats, heads_m: Floats) -> tuple[Moving, Floats]:
    """Where the cuts are when their heads are at `to_m` (n,), and when their heads pass `heads_m` (n, k) on the way.

    NaN for places that are not on the way, infinite for those behind a stop.
    """
    on_way = (heads_m > start.head_m[:, None]) & (heads_m <= to_m[:, None])
    used = np.flatnonzero(on_way.any(axis=0))
    places = np.clip(heads_m[:, used], start.head_m[:, None], to_m[:, None])
    order = np.argsort(places, axis=1, kind="stable")
    stations = np.concatenate((np.take_along_axis(places, order, axis=1), to_m[:, None]), axis=1)
    rolled = cars.rolls.roll_on(
        cars.rows, cars.routes, start.head_m, start.speed_m_s, stations, cars.resistance_n_per_kn
    )
    times = np.full(heads_m.shape, np.nan)
    passed = np.empty(places.shape)
    np.put_along_axis(passed, order, rolled.time_s[:, :-1], axis=1)
    times[:, used] = np.where(on_way[:, used], start.time_s[:, None] + passed, np.nan)
    stops = np.isfinite(rolled.stop_m)
    head = np.where(stops, np.minimum(rolled.stop_m, to_m), to_m)
    return Moving(head, rolled.speed_m_s[:, -1], start.time_s + rolled.time_s[:, -1]), times


def braked_evenly(
    start: Moving, to_m: Floats, exit_m_s: Floats, duration_s: Floats, heads_m: Floats
) -> tuple[Moving, Floats]:
    """As `rolled_free` for cuts whose energy falls evenly to that of `exit_m_s` at `to_m`, where they are `duration_s`
    later: times in between are in proportion."""
    path = to_m - start.head_m
    moves = (start.speed_m_s > 0.0) & (exit_m_s > 0.0)
    end = np.where(moves, start.time_s + duration_s, np.inf)
    on_way = (heads_m > start.head_m[:, None]) & (heads_m <= to_m[:, None])
    lane, column = np.nonzero(on_way)
    share = (heads_m[lane, column] - start.head_m[lane]) / path[lane]
    before, after = start.speed_m_s[lane], exit_m_s[lane]
    between = even_speed_m_s(before, after, share)
    with np.errstate(divide="ignore", invalid="ignore"):
        passed = start.time_s[lane] + duration_s[lane] * (share * (before + after) / (before + between))
    times = np.full(heads_m.shape, np.nan)
    times[lane, column] = np.where(moves[lane], passed, np.inf)
    return Moving(np.where(moves, to_m, start.head_m), np.where(moves, exit_m_s, 0.0), end), times


def even_speed_m_s(entry_m_s: Floats, exit_m_s: Floats, share: Floats) -> Floats:
    """Speed after this share of a path on which a cut is braked at an even rate."""
    return np.sqrt(entry_m_s**2 + share * (exit_m_s**2 - entry_m_s**2))


@frozen_arrays
class Push:
    """How n cuts are pushed before they are let go: at an even rate from the speed `before_m_s`, which the train had
    `apart_m` before, when the cut ahead was let go; (n,) each."""

    before_m_s: Floats
    apart_m: Floats

    def times_s(self, start: Moving, heads_m: Floats) -> Floats:
        """When the heads pass `heads_m` (n, k) ahead of `start`, where they are let go; NaN for places behind it."""
        left = start.head_m[:, None] - heads_m
        now = start.speed_m_s[:, None]
        gain = (now**2 - self.before_m_s[:, None] ** 2) / self.apart_m[:, None]
        then = np.sqrt(np.maximum(now**2 - gain * np.clip(left, 0.0, self.apart_m[:, None]), 1e-6))
        return np.where(left >= 0.0, start.time_s[:, None] - 2.0 * left / (now + then), np.nan)


MOST_NUMBERS: Final = 8_000_000
"""So many are kept of each leg, 64 MB; of longer trains every roll is worked out anew."""

Leg = tuple[str, int, int]
"""What is rolled: a name, the position, and how many speeds are tried."""


@frozen_arrays
class Legs:
    """n cuts that roll with c speeds each, from time 0 on: when the heads are at k marks, `marks_s` (n, c, k); when,
    and with what speed, they are at the end of the leg, (n, c)."""

    marks_s: Floats
    ends_s: Floats
    ends_m_s: Floats


class KnownRolls:
    """What was worked out for the cuts of some trains, `rows` of them, by leg."""

    def __init__(self, rows: int) -> None:
        self.rows = rows
        self.kept: dict[Leg, Kept] = {}

    def found(self, leg: Leg, cars: Cars, begins: Floats, roll: Callable[[Ints], Legs]) -> Legs:
        """The rolls of `cars` over `leg`, which follow from how each of them `begins` (n, m), its speeds first; `roll`
        works out those of some of them."""
        kept = self.kept.get(leg)
        if kept is None:
            first = roll(np.arange(len(begins)))
            if self.rows * first.marks_s[0].size <= MOST_NUMBERS:
                kept = self.kept[leg] = Kept(self.rows, begins.shape[1], *first.marks_s.shape[1:])
                kept.keep(cars, begins, first)
            return first
        known = kept.has(cars, begins)
        told = kept.told(cars.rows)
        if not known.all():
            new = np.flatnonzero(~known)
            rolled = roll(new)
            kept.keep(cars.chosen(new), begins[new], rolled)
            for all_cuts, some in zip(told, (rolled.marks_s, rolled.ends_s, rolled.ends_m_s), strict=True):
                all_cuts[new] = some
        return Legs(*told)


class Kept:
    """Rolls over one leg, and how they began: a row each cut."""

    def __init__(self, rows: int, begins: int, speeds: int, marks: int) -> None:
        self.route, self.resistance_n_per_kn = np.full(rows, -1), np.full(rows, np.nan)
        self.begins = np.full((rows, begins), np.nan)
        self.marks_s = np.empty((rows, speeds, marks))
        self.ends_s, self.ends_m_s = (np.empty((rows, speeds)) for _ in range(2))

    def has(self, cars: Cars, begins: Floats) -> Bools:
        """Whether the rolls of `cars` that begin so are known, (n,)."""
        rows = cars.rows
        same = (self.route[rows] == cars.routes) & (self.resistance_n_per_kn[rows] == cars.resistance_n_per_kn)
        return np.asarray(same & (self.begins[rows] == begins).all(axis=1))

    def keep(self, cars: Cars, begins: Floats, rolled: Legs) -> None:
        """Those of `cars` are known from now on."""
        rows = cars.rows
        self.route[rows], self.resistance_n_per_kn[rows] = cars.routes, cars.resistance_n_per_kn
        self.begins[rows], self.marks_s[rows] = begins, rolled.marks_s
        self.ends_s[rows], self.ends_m_s[rows] = rolled.ends_s, rolled.ends_m_s

    def told(self, rows: Ints) -> tuple[Floats, Floats, Floats]:
        """What is kept of the cuts `rows`, copied: marks, times, speeds."""
        return self.marks_s[rows], self.ends_s[rows], self.ends_m_s[rows]
