"""One moving cut of the slow simulator: where it is, how it moves, and what it comes to next."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from enum import Enum
from math import inf, sqrt

from plant_models.hump import Route
from tests.synth.hump.trains.slow_train import Mark, MarkAt, SlowCut, marks_of
from tests.synth.hump.trains.slow_way import SlowWay

SAME_S = 1e-12


class Mode(Enum):
    """What moves the cut: the locomotive, its weight, a position, the cut ahead, or nothing."""

    PUSHED = 0
    ROLLING = 1
    BRAKED = 2
    TOWED = 3
    STANDING = 4


class Push:
    """The speed of the train on the hump: even between two releases, constant before the first and after the last."""

    def __init__(self, cuts: Sequence[SlowCut]) -> None:
        self.times = [cut.crest_s for cut in cuts]
        self.speeds = [cut.hump_speed_m_s for cut in cuts]

    def speed_m_s(self, time_s: float) -> float:
        """Speed at `time_s`."""
        k = bisect_right(self.times, time_s)
        if k in (0, len(self.times)):
            return self.speeds[min(k, len(self.times) - 1)]
        part = (time_s - self.times[k - 1]) / (self.times[k] - self.times[k - 1])
        return self.speeds[k - 1] + part * (self.speeds[k] - self.speeds[k - 1])

    def next_change_s(self, time_s: float) -> float:
        """The first release after `time_s`."""
        return next((time for time in self.times if time > time_s + SAME_S), inf)

    def path_m(self, from_s: float, to_s: float) -> float:
        """How far the train is pushed."""
        bounds = [from_s, *(time for time in self.times if from_s < time < to_s), to_s]
        speeds = [self.speed_m_s(time) for time in bounds]
        return sum(0.5 * (speeds[k] + speeds[k + 1]) * (bounds[k + 1] - bounds[k]) for k in range(len(bounds) - 1))


class MovingCut:
    """The head is at `x` with speed `v` at time `t`.

    `leader`: the cut behind which it rolls, from a contact on. `adopted`: the cut whose way it goes since it was
    misrouted.
    """

    def __init__(self, cut: SlowCut, route: Route, way: SlowWay, push: Push, start_s: float) -> None:
        self.cut, self.body, self.route, self.way, self.push = cut, cut.body, route, way, push
        self.mode, self.t = Mode.PUSHED, start_s
        self.x = 0.5 * cut.body.length_m - push.path_m(start_s, cut.crest_s)
        self.v, self.a, self.v_out = push.speed_m_s(start_s), 0.0, 0.0
        self.numbers = {element.number for element in route.elements}
        self.marks = marks_of(cut.body, route)
        self.leader: MovingCut | None = None
        self.adopted: MovingCut | None = None
        self.on_track, self.lag_m = False, 0.0
        self.legs: list[tuple[float, float, float, float]] = []

    def place_at(self, time_s: float) -> float:
        """Where the head is at a time of the step that is being made."""
        if self.mode is Mode.STANDING and time_s >= self.t:
            return self.x
        if self.leader is not None:
            return self.leader.place_at(time_s) - self.lag_m
        leg = max(bisect_right(self.legs, (time_s, inf, inf, inf)) - 1, 0)
        t, x, v, a = self.legs[leg]
        return x + (v + 0.5 * a * (time_s - t)) * (time_s - t)

    def tail_at(self, time_s: float) -> float:
        """Where its end is."""
        return self.place_at(time_s) - self.body.length_m

    def towed(self, ahead: MovingCut, time_s: float, lag_m: float) -> None:
        """Roll behind the cut ahead from now on, with the head `lag_m` behind its head."""
        self.leader, self.mode, self.on_track, self.lag_m = ahead, Mode.TOWED, False, lag_m
        self.t, self.x, self.v = time_s, ahead.place_at(time_s) - lag_m, ahead.v

    def rewind(self, time_s: float) -> None:
        """Go back to a time of the step that is being made."""
        leg = max(bisect_right(self.legs, (time_s, inf, inf, inf)) - 1, 0)
        t, _, v, a = self.legs[leg]
        self.mode, self.x, self.v = Mode.ROLLING, self.place_at(min(time_s, self.t)), v + a * (time_s - t)
        self.t, self.legs = time_s, self.legs[: leg + 1]

    def reroute(self, order: int, route: Route, way: SlowWay, *, entered: bool) -> None:
        """Go another way from the element `order` on; `entered`: its first mark has just been passed."""

        def is_next(each: MarkAt) -> bool:
            return each.order > order or (each.order == order and not (entered and each.mark is Mark.FIRST_FROM))

        self.route, self.way = route, way
        self.numbers = {element.number for element in route.elements}
        new = [each for each in marks_of(self.body, route) if is_next(each)]
        self.marks = sorted([*(each for each in self.marks if each.order < order), *new])

    def go(self, until: float, limit_m: float) -> bool:
        """Move on to the next mark or to `limit_m` (True), or until `until`, or to a stop (speed 0)."""
        if self.mode is Mode.PUSHED and self.t >= self.cut.crest_s - SAME_S:
            self.mode, self.x, self.v = Mode.ROLLING, 0.5 * self.body.length_m, self.cut.hump_speed_m_s
        goal = min(self.marks[0].head_m if self.marks else inf, limit_m)
        if goal <= self.x:
            return True
        if self.mode is Mode.ROLLING:
            return self._roll(until - self.t, goal)
        if self.mode is Mode.PUSHED:
            until = min(until, self.push.next_change_s(self.t))
            a = (self.push.speed_m_s(until) - self.v) / (until - self.t)
        else:
            a = self.a
        return self._even(a, until - self.t, goal)

    def _even(self, a: float, seconds: float, goal: float) -> bool:
        path, v_end = (self.v + 0.5 * a * seconds) * seconds, self.v + a * seconds
        if v_end > 0.0 and self.x + path < goal:
            self._moved(seconds, self.x + path, v_end)
            return False
        path = goal - self.x
        v_end = sqrt(max(self.v**2 + 2.0 * a * path, 0.0))
        self._moved(2.0 * path / (self.v + v_end), goal, v_end)
        return True

    def _roll(self, seconds: float, goal: float) -> bool:
        x, v = self.x, self.v
        path, v_end = self.way.after_time(x, v, seconds)
        if v_end <= 0.0:
            longest = v * seconds
            path = self.way.stop_after(x, v, longest)
            v_end = 0.0 if path < longest else self.way.after_path(x, v, path)
            seconds = 2.0 * path / (v + v_end)
        if x + path < goal:
            self._moved(seconds, x + path, v_end)
            return False
        v_end = self.way.after_path(x, v, goal - x)
        self._moved(2.0 * (goal - x) / (v + v_end), goal, v_end)
        return v_end > 0.0

    def _moved(self, seconds: float, x: float, v: float) -> None:
        if seconds > 0.0:
            self.legs.append((self.t, self.x, self.v, (v - self.v) / seconds))
        self.t, self.x, self.v = self.t + seconds, x, v

    def brake(self, command_m_s: float, exit_m: float, full_head_m: float) -> None:
        """Brake evenly until the head is at `exit_m`: to the command, or as far as the full brake does.

        A cut that would not even get there without braking rolls freely.
        """
        unbraked = self.unbraked_energy(exit_m)
        if unbraked <= 0.0:
            return
        least = unbraked - self.way.gravity * full_head_m
        energy = min(max(0.5 * command_m_s**2, least), unbraked)
        self.mode, self.v_out = Mode.BRAKED, sqrt(2.0 * energy)
        self.a = (energy - 0.5 * self.v**2) / (exit_m - self.x)

    def unbraked_energy(self, to_m: float, step_m: float = 0.2) -> float:
        """v²/2 with which its head would be at `to_m` if it rolled there freely; 0 where it would not get there."""
        steps = max(1, round((to_m - self.x) / step_m))
        v, h = self.v, (to_m - self.x) / steps
        for k in range(steps):
            v = self.way.after_path(self.x + k * h, v, h)
            if v == 0.0:
                return 0.0
        return 0.5 * v * v


def first_root(begin: float, middle: float, end: float) -> float:
    """Where the parabola through these values at 0, 1/2 and 1 first comes to 0; `end` is at most 0."""
    if begin <= 0.0:
        return 0.0
    bend, slope = 2.0 * (begin - 2.0 * middle + end), 4.0 * middle - 3.0 * begin - end
    # without cancellation, whatever the signs: the smaller root that is not negative
    root = sqrt(max(slope * slope - 4.0 * bend * begin, 0.0))
    return min(2.0 * begin / (root - slope), 1.0)
