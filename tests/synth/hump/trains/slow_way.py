"""What one cut feels on one route, summed up car by car and axle by axle, and how it rolls a while or a distance.

Nothing here is taken from the rolling issue's code: the falls come from the grades, by sums of this file.
"""

from __future__ import annotations

from bisect import bisect_right
from math import sqrt

from plant_models.hump import Retarder, Route
from plant_models.rolling.roll_track import Bend
from tests.synth.hump.trains.slow_train import Heads, SlowBody, SlowTrain

GRAVITY_M_S2 = 9.81
WHEEL_SET_T = 0.42
BEYOND_M = 5000.0
LEAST_M = 1e-6
ROUNDS = 3


def yard_from(route: Route) -> float:
    """The exit of the last position; without one, where the last section begins."""
    exits = [e.at_m + e.vertex.exit_m for e in route.elements if isinstance(e.vertex, Retarder)]
    return exits[-1] if exits else route.elements[-1].from_m


class SlowWay:
    """Metres of head won since the crest and heads taken per (m/s)², by the place of the head of the cut.

    Both are linear between knots: an axle at a change of grade, a middle of a car at an end of a bend.
    """

    def __init__(self, body: SlowBody, route: Route, train: SlowTrain) -> None:
        self.body, self.linear, self.yard_m = body, train.linear_n_per_kn, yard_from(route)
        self.slope, self.yard = train.slope_n_per_kn, train.yard_n_per_kn
        track = route.roll_track
        self.grades = list(zip(track.profile.starts_m, track.profile.grades_permille, strict=True))
        self.end_m, self.bends = track.end_m, track.bends
        none: Heads = ((0.0, 0.0),) * len(track.bends)
        self.heads = none if body.bend_heads is None else body.bend_heads[route.track]
        if len(self.heads) != len(track.bends):
            raise ValueError(f"bends: {len(self.heads)} heads for {len(track.bends)} bends to track {route.track}")
        axles = sum(len(car.axles_m) for car in body.cars)
        self.gravity = GRAVITY_M_S2 / (1.0 + WHEEL_SET_T * axles / body.mass_t)
        self.knots = self._knots()
        self.won = [self._won(x) for x in self.knots]
        self.taken = [self._in_bends(x, 0) for x in self.knots]

    def _knots(self) -> list[float]:
        body, knots = self.body, {-BEYOND_M, BEYOND_M}
        for front, car in zip(body.fronts_m, body.cars, strict=True):
            for axle in car.axles_m:
                places = [start for start, _ in self.grades] + [0.0, self.end_m, self.yard_m]
                knots.update(place + front + axle for place in places)
            for bend in self.bends:
                middle = front + 0.5 * car.length_m
                knots.update((bend.from_m + middle, bend.to_m + middle))
        return sorted(knots)

    def _fall(self, place: float) -> float:
        """Metres that the track falls from the crest to `place`, less what slope and yard take on the way."""
        fall = 0.0
        for k, (start, grade) in enumerate(self.grades):
            end = self.grades[k + 1][0] if k + 1 < len(self.grades) else self.end_m
            fall += 1e-3 * grade * max(min(place, end) - start, 0.0)
        on_slope = max(min(place, self.yard_m), 0.0)
        return fall - 1e-3 * (self.slope * on_slope + self.yard * max(place - self.yard_m, 0.0))

    def _won(self, x: float) -> float:
        won = 0.0
        for front, car in zip(self.body.fronts_m, self.body.cars, strict=True):
            of_axles = [self._fall(x - front - axle) for axle in car.axles_m]
            won += car.mass_t / self.body.mass_t * sum(of_axles) / len(of_axles)
        return won - self._in_bends(x, 1)

    def _in_bends(self, x: float, which: int) -> float:
        taken = 0.0
        for bend, heads in zip(self.bends, self.heads, strict=True):
            for front, car in zip(self.body.fronts_m, self.body.cars, strict=True):
                part = share_behind(bend, x - front - 0.5 * car.length_m)
                taken += heads[which] * part * car.mass_t / self.body.mass_t
        return taken

    def at(self, x: float) -> tuple[float, float]:
        """(metres won since the crest, metres taken by bends per (m/s)²) with the head at `x`."""
        k = bisect_right(self.knots, x) - 1
        part = (x - self.knots[k]) / (self.knots[k + 1] - self.knots[k])
        won, taken = self.won, self.taken
        return won[k] + part * (won[k + 1] - won[k]), taken[k] + part * (taken[k + 1] - taken[k])

    def mean(self, x: float, h: float, v: float, v_end: float) -> float:
        """Mean acceleration over the path `h` from `x`, on which the speed goes from `v` to `v_end`."""
        h = max(h, LEAST_M)
        (won, taken), (won_end, taken_end) = self.at(x), self.at(x + h)
        v_mean = 0.5 * (v + v_end)
        against = v_mean + self.body.wind_m_s
        lost = self.body.w0_n_per_kn + self.linear * v_mean + self.body.air_n_per_kn * against * abs(against)
        turned = (taken_end - taken) / h * 0.5 * (v * v + v_end * v_end)
        return self.gravity * ((won_end - won) / h - 1e-3 * lost - turned)

    def after_time(self, x: float, v: float, seconds: float) -> tuple[float, float]:
        """(path, speed) after `seconds`; a speed of 0 or less tells that the cut stops before."""
        v_end = v
        for _ in range(ROUNDS):
            v_end = v + seconds * self.mean(x, max(0.5 * seconds * (v + v_end), 0.0), v, max(v_end, 0.0))
        return 0.5 * seconds * (v + v_end), v_end

    def after_path(self, x: float, v: float, path: float) -> float:
        """Speed at the end of `path`, 0 where the cut does not get there."""
        v_end = v
        for _ in range(ROUNDS):
            v_end = sqrt(max(v * v + 2.0 * path * self.mean(x, path, v, v_end), 0.0))
        return v_end

    def stop_after(self, x: float, v: float, longest: float) -> float:
        """Path to where the cut stops from the speed `v`, at most `longest`."""
        path = longest
        for _ in range(2 * ROUNDS):
            a = self.mean(x, path, v, 0.0)
            path = min(longest, -0.5 * v * v / a) if a < 0.0 else longest
        return path


def share_behind(bend: Bend, place: float) -> float:
    """Share of the bend that lies before `place`."""
    return max(0.0, min(1.0, (place - bend.from_m) / (bend.to_m - bend.from_m)))
