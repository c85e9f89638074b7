"""What the fall of a hump gives single cars that nothing brakes, and what the brakes can take from them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from plant_models.hump import Route
from plant_models.library import load_car
from synth.hump.checking.places import RolledRoute, speed_at
from synth.hump.design.hump_under_test import HumpUnderTest
from synth.hump.design_runners import CAR, RunnerRoll, bad_runner, good_runner, roll_runners, very_good_runner

FASTEST_M_S: Final = 15.0
"""Speed at the crest up to which it is looked for what the fall lacks."""

NEARLY_M_S: Final = 1e-3


@dataclass(frozen=True)
class Fall:
    """Whether the bad runner comes `into_m` into `track`, the one where it fares worst.

    `fall_m`: from the crest to there. `left_m`: energy head that it has left there; below 0: what the fall lacks, as
    the speed head at the crest with which it would just come there. `stop_m`: where it stops, infinite for nowhere.
    """

    route: Route
    into_m: float
    fall_m: float
    left_m: float
    stop_m: float

    @property
    def needed_m(self) -> float:
        """The fall that would just do."""
        return self.fall_m - self.left_m


@dataclass(frozen=True)
class PositionNeed:
    """Position `number`, on the way on which it has least left for the very good runner, to `track`.

    `comes_m_s`: speed of the runner at its entrance where nothing brakes it. `needed_m`: energy head that it has at the
    exit, and that brakes must take so that it stops there; `there_m`: what the brakes up to there are counted upon to
    take, `own_m` of it by this position. `last`: whether no other position follows on that way.
    """

    number: int
    track: int
    comes_m_s: float
    needed_m: float
    own_m: float
    there_m: float
    last: bool

    @property
    def left_m(self) -> float:
        """Of the brake when the runner stands; below 0: what lacks."""
        return self.there_m - self.needed_m


@dataclass(frozen=True)
class Unbraked:
    """`rolls`: the very good, the good and the bad runner on the way of `fall`, for a picture."""

    fall: Fall
    positions: tuple[PositionNeed, ...]
    rolls: tuple[RunnerRoll, ...]


def unbraked(hump: HumpUnderTest) -> Unbraked:
    """Rolls of single cars without brakes, over all ways."""
    asked, speed = hump.asked, hump.asked.hump_speed_m_s
    runners = very_good_runner(asked), bad_runner(asked)
    rolled = [RolledRoute(route, *roll_runners(route, runners, speed)) for route in hump.routes.routes]
    fall = least_fall(rolled, hump)
    shown = very_good_runner(asked), good_runner(asked), bad_runner(asked)
    return Unbraked(fall, position_needs(rolled, hump), roll_runners(fall.route, shown, speed))


def least_fall(rolled: Sequence[RolledRoute], hump: HumpUnderTest) -> Fall:
    """That of the way on which the bad runner fares worst."""
    worst = min(rolled, key=lambda each: fares(each, point_m(each, hump)))
    at_m = point_m(worst, hump)
    speed = speed_at(worst.bad, at_m)
    if speed is None:
        left_m = -missing_m(worst.route, hump, at_m)
    else:
        left_m = speed**2 / (2.0 * worst.bad.runner.reduced_gravity_m_s2)
    return Fall(worst.route, at_m - worst.track_m, worst.fall_m(at_m), left_m, worst.bad.stop_m)


def point_m(rolled: RolledRoute, hump: HumpUnderTest) -> float:
    """To where the middle of the bad runner must come; on a shorter track, to its end."""
    length_m = load_car(CAR).car.length_m
    return min(rolled.track_m + hump.asked.into_track_m, rolled.route.length_m - length_m)


def fares(rolled: RolledRoute, at_m: float) -> tuple[float, float]:
    """How far the bad runner comes, up to `at_m`, and how fast it is there: less is worse."""
    return min(rolled.bad.stop_m, at_m), speed_at(rolled.bad, at_m) or 0.0


def missing_m(route: Route, hump: HumpUnderTest, at_m: float) -> float:
    """Speed head at the crest, beyond that of the test, with which the bad runner just comes to `at_m`."""
    runner = bad_runner(hump.asked)
    low, high = hump.asked.hump_speed_m_s, FASTEST_M_S
    while high - low > NEARLY_M_S:
        middle = 0.5 * (low + high)
        (roll,) = roll_runners(route, (runner,), middle)
        low, high = (low, middle) if roll.stop_m > at_m else (middle, high)
    return (high**2 - hump.asked.hump_speed_m_s**2) / (2.0 * runner.reduced_gravity_m_s2)


def position_needs(rolled: Sequence[RolledRoute], hump: HumpUnderTest) -> tuple[PositionNeed, ...]:
    """Of all positions, from the crest on, each on its worst way."""
    runner = very_good_runner(hump.asked)
    heads = hump.heads_m(runner)
    found: dict[int, list[PositionNeed]] = {}
    for row, each in enumerate(rolled):
        count = int(hump.routes.positions_of[row])
        for place in range(count):
            ends_m = hump.routes.entrance_m[row, place], hump.routes.exit_m[row, place]
            enters, leaves = (speed_at(each.good, float(at_m)) or 0.0 for at_m in ends_m)
            need = PositionNeed(
                number=place + 1,
                track=each.route.track,
                comes_m_s=enters,
                needed_m=leaves**2 / (2.0 * runner.reduced_gravity_m_s2),
                own_m=float(heads[place]),
                there_m=float(heads[: place + 1].sum()),
                last=place + 1 == count,
            )
            found.setdefault(place, []).append(need)
    return tuple(min(needs, key=lambda need: (not need.last, need.left_m)) for _, needs in sorted(found.items()))
