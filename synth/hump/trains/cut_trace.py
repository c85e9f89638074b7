"""The way of each cut of one train, metre by metre, told anew from what the memory kept of it."""

from __future__ import annotations

import numpy as np

from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from synth.hump.rolling.hump_routes import OF_FIRST_AXLE
from synth.hump.rolling.humping import Hump
from synth.hump.rolling.motion import even_speed_m_s
from synth.hump.rolling.train_cuts import TrainCuts
from synth.hump.rolling.train_memory import TrainMemory

SAMPLE_M = 1.0
"""Samples are so far apart at most; more stand where axles pass the marks of elements."""


SAME_M = 1e-6
"""Places that are no farther apart are one."""


@frozen_arrays
class CutTrace:
    """Where the head of a cut is (k,), metres from the crest, and how fast, at rising times; it stays at the end.

    The first sample is that of the head at the crest. Times of marks on the way are those of the memory, but for the
    step with which the roll is worked out (a few ms). A cut that stops is at rest in the last sample.
    """

    time_s: Floats
    head_m: Floats
    speed_m_s: Floats

    def head_at(self, time_s: Floats) -> Floats:
        """Where the head is at `time_s`; before the first sample and behind the last one as in these."""
        return np.interp(time_s, self.time_s, self.head_m)

    def behind(self, leader: CutTrace, length_m: float, by_s: float) -> tuple[CutTrace, float]:
        """This way as far as it is clear of the cut `leader`, which is `length_m` long, then coupled to its tail; and
        when they touch.

        That is at `by_s` at the latest, when the model found it from their axles at a joint.
        """
        inside = (self.head_m > leader.head_at(self.time_s) - length_m) | (self.time_s >= by_s)
        inside[0] = False
        own = int(inside.argmax()) if inside.any() else len(inside)
        touch_s, touch_m = float(self.time_s[own - 1]), float(self.head_m[own - 1])
        led = (leader.time_s > touch_s) & (leader.head_m - length_m > touch_m)
        parts = (
            (self.time_s, leader.time_s),
            (self.head_m, leader.head_m - length_m),
            (self.speed_m_s, leader.speed_m_s),
        )
        return CutTrace(*(np.concatenate((mine[:own], theirs[led])) for mine, theirs in parts)), touch_s

    def rolling_on(self, body: CutTrace, behind_m: float) -> CutTrace:
        """This way until it couples to others, then with the `body` of all of them, `behind_m` behind its head. A cut
        that is there before the tail ahead waits for it."""
        heads = body.head_m - behind_m
        own = max(int(((self.time_s < body.time_s[0]) & (self.head_m <= heads[0] + SAME_M)).sum()), 1)
        parts = (
            (self.time_s[:own], body.time_s),
            (self.head_m[:own], np.maximum(heads, self.head_m[own - 1])),
            (self.speed_m_s[:own], body.speed_m_s),
        )
        return CutTrace(*(np.concatenate(part) for part in parts))


class TracedTrain:
    """The cuts of the train `lane`, a row each, while their ways are told anew, leg by leg."""

    def __init__(self, hump: Hump, trains: TrainCuts, memory: TrainMemory, lane: int) -> None:
        self.hump, self.memory, self.lane = hump, memory, lane
        self.rows = lane * trains.cuts + np.arange(trains.cuts)
        self.routes = memory.route[lane]
        self.length_m = trains.length_m[self.rows]
        self.first_m, self.last_m = trains.first_axle_m[self.rows], trains.last_axle_m[self.rows]
        axle = np.where(OF_FIRST_AXLE, self.first_m[:, None], self.last_m[:, None])
        self.mark_heads_m = (hump.routes.place_m[self.routes] + axle[:, None, :]).reshape(trains.cuts, -1)
        self.head_m, self.speed_m_s = 0.5 * self.length_m, memory.hump_speed_m_s[lane]
        self.time_s = memory.crest_s[lane]
        self.parts: list[list[tuple[Floats, Floats, Floats]]] = [[] for _ in self.rows]

    def traces(self) -> tuple[CutTrace, ...]:
        """The ways of all cuts, each by itself: a cut in contact goes on as if nobody were ahead."""
        self.push()
        for position in range(self.hump.routes.positions):
            passed = np.flatnonzero(np.isfinite(self.memory.begin_s[self.lane, :, position]))
            self.roll(passed, self.hump.routes.entrance_m[self.routes, position] + self.first_m)
            self.brake(passed, position)
        self.roll(np.flatnonzero(np.isfinite(self.time_s)), self.ends_m())
        self.rest()
        return tuple(CutTrace(*(np.concatenate(column) for column in zip(*part, strict=True))) for part in self.parts)

    def push(self) -> None:
        """From the head at the crest to the middle there, at hump speed."""
        for cut, (head, speed, time) in enumerate(zip(self.head_m, self.speed_m_s, self.time_s, strict=True)):
            at = self.samples_m(cut, 0.0, head, np.array([0.0]))
            self.parts[cut].append((time - (head - at) / speed, at, np.full(len(at), speed)))

    def samples_m(self, cut: int, from_m: float, to_m: float, more: Floats) -> Floats:
        """Heads of a cut behind `from_m` up to `to_m` at whole metres and marks, and those of `more`."""
        marks = self.mark_heads_m[cut]
        whole = np.arange(np.floor(from_m / SAMPLE_M) + 1.0, to_m / SAMPLE_M) * SAMPLE_M
        marks = marks[(marks > from_m) & (marks < to_m)]
        return np.unique(np.concatenate((more, whole, marks, [to_m])))

    def roll(self, cuts: Ints, to_m: Floats) -> None:
        """Free roll of `cuts` to `to_m` (of all cuts); a cut that stops ahead of it has the way until then."""
        cuts = cuts[to_m[cuts] > self.head_m[cuts]]
        if len(cuts) == 0:
            return
        each = [self.samples_m(int(cut), self.head_m[cut], to_m[cut], np.empty(0)) for cut in cuts]
        stations = np.repeat(to_m[cuts, None], max(map(len, each)), axis=1)
        for row, own in enumerate(each):
            stations[row, : len(own)] = own
        rolled = self.hump.rolls.roll_on(
            self.rows[cuts], self.routes[cuts], self.head_m[cuts], self.speed_m_s[cuts], stations
        )
        for row, (cut, at) in enumerate(zip(cuts, each, strict=True)):
            time, speed = rolled.time_s[row, : len(at)], rolled.speed_m_s[row, : len(at)]
            rolls = np.isfinite(time) & (speed > 0.0)
            self.parts[cut].append((self.time_s[cut] + time[rolls], at[rolls], speed[rolls]))
        self.head_m = self.replaced(self.head_m, cuts, to_m[cuts])

    def brake(self, cuts: Ints, position: int) -> None:
        """The pass of `position`, from the entry that the memory has; a cut that stops in it stands at its entrance."""
        memory, lane = self.memory, self.lane
        ends = self.hump.routes.exit_m[self.routes, position] + self.last_m
        for cut in cuts:
            begin, entry = memory.begin_s[lane, cut, position], memory.entry_m_s[lane, cut, position]
            end, leave = memory.end_s[lane, cut, position], memory.exit_m_s[lane, cut, position]
            head, time, speed = self.parts[cut][-1][1][-1], self.parts[cut][-1][0], self.parts[cut][-1][2]
            # the memory tells the entry exactly; the roll just ended there
            time[-1], speed[-1] = begin, entry
            if not np.isfinite(end):
                continue
            at = self.samples_m(int(cut), head, ends[cut], np.empty(0))
            share = (at - head) / (ends[cut] - head)
            between = even_speed_m_s(entry, leave, share)
            takes = (end - begin) * share * (entry + leave) / (entry + between)
            self.parts[cut].append((begin + takes, at, between))
        self.head_m = self.replaced(self.head_m, cuts, ends[cuts])
        self.speed_m_s = self.replaced(self.speed_m_s, cuts, memory.exit_m_s[lane, cuts, position])
        self.time_s = self.replaced(self.time_s, cuts, memory.end_s[lane, cuts, position])

    def body(self, cuts: Ints, cut: int) -> CutTrace:
        """The way of the head of these `cuts`, of which the last, `cut`, coupled to the others while they rolled."""
        memory, lane, route = self.memory, self.lane, self.routes[cut]
        head = memory.touch_m[lane, cut] + self.length_m[cuts[:-1]].sum()
        to = max(memory.free_m[lane, cuts[0]], head)
        at = np.unique(np.append(np.arange(np.floor(head / SAMPLE_M) + 1.0, to / SAMPLE_M) * SAMPLE_M, to))
        speed = memory.together_m_s[lane, cut]
        rolled = self.hump.rolls.coupled(self.rows[cuts][None]).roll_on(
            np.zeros(1, np.int64), np.array([route]), np.array([head]), np.array([speed]), at[None]
        )
        time, speeds = rolled.time_s[0], rolled.speed_m_s[0]
        rolls = np.isfinite(time) & (speeds > 0.0)
        way = [np.append(first, more[rolls]) for first, more in ((0.0, time), (head, at), (speed, speeds))]
        if np.isfinite(rolled.stop_m[0]) and rolled.stop_m[0] > way[1][-1] + SAME_M:
            last_s = 2.0 * (rolled.stop_m[0] - way[1][-1]) / way[2][-1]
            ends = way[0][-1] + last_s, rolled.stop_m[0], 0.0
            way = [np.append(each, end) for each, end in zip(way, ends, strict=True)]
        return CutTrace(memory.touch_s[lane, cut] + way[0], way[1], way[2])

    def replaced(self, values: Floats, cuts: Ints, new: Floats) -> Floats:
        """`values`, those of `cuts` being `new`."""
        changed = values.copy()
        changed[cuts] = new
        return changed

    def ends_m(self) -> Floats:
        """Where the heads come to; of cuts in contact it is not known, and the end of the route is taken."""
        end = self.memory.end_m[self.lane]
        return np.asarray(np.where(np.isfinite(end), end, self.hump.routes.length_m[self.routes]))

    def rest(self) -> None:
        """The last bit of the way of cuts that stop: evenly braked from the last sample."""
        end, speed = self.memory.end_m[self.lane], self.memory.end_speed_m_s[self.lane]
        for cut in np.flatnonzero(np.isfinite(end) & (speed <= 0.0) & np.isfinite(self.time_s)):
            time, at, rolls = self.parts[cut][-1]
            ahead = at < end[cut] - 1e-6
            left = end[cut] - at[ahead][-1] if ahead.any() else 0.0
            if left <= 0.0:
                continue
            stop = time[ahead][-1] + 2.0 * left / rolls[ahead][-1]
            last = np.append(time[ahead], stop), np.append(at[ahead], end[cut]), np.append(rolls[ahead], 0.0)
            self.parts[cut][-1] = last
