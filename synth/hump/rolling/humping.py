"""Trains over the hump: cut after cut of many trains at once, each through free rolls and positions to its track."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from plant_models.frozen_arrays import Bools, Floats, Ints, frozen_arrays
from synth.hump.rolling.hump_position import Arrivals, HumpPosition
from synth.hump.rolling.hump_routes import OF_FIRST_AXLE, HumpRoutes, Mark
from synth.hump.rolling.meeting import Ahead, LastUsers, Tails, first_of, followed, meeting
from synth.hump.rolling.motion import Cars, CoupledRolls, Moving, Push, braked_evenly, merged, rolled_free
from synth.hump.rolling.standing_cars import NEARLY_M, RolledOn, StandingCars, remember
from synth.hump.rolling.train_cuts import TrainCuts
from synth.hump.rolling.train_memory import Asked, ExitSpeeds, HumpSpeeds, TrainMemory


@frozen_arrays
class Hump:
    """A hump for trains: its routes, its positions in order from the crest, and what rolls its cuts.

    `left_share` (routes,): of the speed of a cut, what the skates of a track leave just ahead of the standing cars;
    None: all. A cut that stops before, or that meets one which still rolls, is not held by them.
    """

    routes: HumpRoutes
    positions: tuple[HumpPosition, ...]
    rolls: CoupledRolls
    left_share: Floats | None = None

    def coupled_m_s(self, routes: Ints, speed_m_s: Floats) -> Floats:
        """With what speed cuts (n,) on `routes` (n,) couple that come with `speed_m_s` (n,)."""
        return speed_m_s if self.left_share is None else self.left_share[routes] * speed_m_s


def humped(hump: Hump, trains: TrainCuts, free_m: Floats, speeds: HumpSpeeds, control: ExitSpeeds) -> TrainMemory:
    """Hump all `trains`; `free_m` (trains, routes): where the standing cars of each track begin before the train."""
    memory = TrainMemory(trains.trains, trains.cuts, hump.routes)
    memory.found_free_m = free_m
    users, standing = LastUsers(trains.trains, hump.routes), StandingCars(free_m, hump.rolls)
    for cut in range(trains.cuts):
        OneCut(hump, trains, cut, memory, users, standing).run(speeds, control)
    memory.left_free_m = standing.free_m
    return memory


class OneCut:
    """Cut number `cut` of every train while it rolls."""

    def __init__(
        self, hump: Hump, trains: TrainCuts, cut: int, memory: TrainMemory, users: LastUsers, standing: StandingCars
    ) -> None:
        self.hump, self.trains, self.cut, self.memory, self.users, self.standing = (
            hump, trains, cut, memory, users, standing,
        )  # fmt: skip
        self.lanes = np.arange(trains.trains)
        self.rows = self.lanes * trains.cuts + cut
        self.routes = trains.route[self.rows].copy()
        self.first_m, self.last_m = trains.first_axle_m[self.rows], trains.last_axle_m[self.rows]
        self.length_m = trains.length_m[self.rows]
        self.times = np.full((trains.trains, hump.routes.elements, len(Mark)), np.nan)
        self.rolling = np.ones(trains.trains, dtype=bool)
        self.halt_s = np.full(trains.trains, np.inf)

    def run(self, speeds: HumpSpeeds, control: ExitSpeeds) -> None:
        """All the way from the crest to the track; then the memory and the users of the elements know it."""
        moving = self.released(speeds)
        for position in range(self.hump.routes.positions):
            moving = self.to_position(moving, position)
            moving = self.through_position(moving, position, control)
        self.to_track(moving)
        self.memory.route[:, self.cut] = self.routes
        self.memory.time_s[:, self.cut] = self.times
        self.users.add(self.cut, self.routes, np.where(np.isnan(self.times), np.inf, self.times))

    def released(self, speeds: HumpSpeeds) -> Moving:
        """The cut when its middle is at the crest. The train is pushed at an even rate between two such moments."""
        memory, cut = self.memory, self.cut
        speed = speeds.speed(cut, memory)
        apart, time = self.length_m, np.zeros(len(speed))
        if cut > 0:
            apart = 0.5 * (self.length_m + self.trains.length_m[self.rows - 1])
            time = memory.crest_s[:, cut - 1] + 2.0 * apart / (speed + memory.hump_speed_m_s[:, cut - 1])
        memory.crest_s[:, cut], memory.hump_speed_m_s[:, cut] = time, speed
        head = 0.5 * self.length_m
        push = Push(memory.hump_speed_m_s[:, cut - 1] if cut > 0 else speed, apart)
        moving, sent, every = Moving(head, speed, time), self.rolling, np.ones(len(speed), dtype=bool)
        while sent.any():  # a long cut may come on the first points while it is still pushed
            self.times[sent] = np.nan
            self.note(push.times_s(moving, self.heads_m(every))[sent], sent)
            sent = self.misroute()
        return moving

    def heads_m(self, chosen: Bools) -> Floats:
        """Where the heads are at each mark of their routes, (n, elements · marks)."""
        axle = np.where(OF_FIRST_AXLE, self.first_m[chosen, None], self.last_m[chosen, None])
        places = self.hump.routes.place_m[self.routes[chosen]] + axle[:, None, :]
        return np.asarray(places.reshape(len(places), self.times[0].size))

    def cars(self, chosen: Bools) -> Cars:
        """The cuts `chosen` on their routes."""
        return Cars(self.hump.rolls, self.rows[chosen], self.routes[chosen])

    def note(self, times: Floats, chosen: Bools) -> None:
        """Add the times (n, elements · marks) of the cuts `chosen`, where they are not NaN."""
        times = times.reshape(len(times), *self.times.shape[1:])
        self.times[chosen] = np.where(np.isnan(times), self.times[chosen], times)

    def ahead(self) -> Ahead:
        """Who is ahead, on the routes as they are."""
        return self.users.on(self.routes, self.lanes)

    def to_position(self, moving: Moving, position: int) -> Moving:
        """Free roll until the first axle is at the entrance of `position`. Cuts whose routes have none stay where they
        are, unless they are misrouted to one."""

        def to_m() -> Floats:
            entrance = self.hump.routes.entrance_m[self.routes, position] + self.first_m
            return np.where(np.isfinite(entrance), entrance, self.standing.free_m[self.lanes, self.routes])

        known = self.times.copy()
        ended = self.free(moving, to_m)
        stays = ~np.isfinite(self.hump.routes.entrance_m[self.routes, position])
        self.times[stays] = known[stays]
        ended = merged(ended, moving.chosen(stays), stays)
        self.halt(moving, ended)
        self.touch()
        return ended

    def free(self, moving: Moving, to_m: Callable[[], Floats]) -> Moving:
        """Free roll to `to_m`, which tells places on the routes as they are; cuts whose points cannot be thrown any
        more roll on behind those ahead of them."""
        pending, ended, known = self.rolling, moving, self.times.copy()
        while pending.any():
            self.times[pending] = known[pending]
            to = np.maximum(to_m()[pending], moving.head_m[pending])
            end, times = rolled_free(self.cars(pending), moving.chosen(pending), to, self.heads_m(pending))
            self.note(times, pending)
            ended = merged(ended, end, pending)
            pending = pending & self.misroute()
        return ended

    def misroute(self) -> Bools:
        """Send the cuts whose points are too late the way of those ahead; returned: which."""
        ahead = self.ahead()
        late = meeting(self.hump.routes, self.routes, self.times, ahead).late
        at = first_of(late)
        sent = self.rolling & (at < late.shape[1])
        lanes = self.lanes[sent]
        self.memory.misrouted_at[lanes, self.cut] = np.minimum(self.memory.misrouted_at[lanes, self.cut], at[sent])
        self.routes[sent] = self.memory.route[lanes, ahead.cut[sent, at[sent]]]
        return np.asarray(sent)

    def touch(self) -> None:
        """Cuts in contact roll behind those ahead of them from there on."""
        ahead = self.ahead()
        met = meeting(self.hump.routes, self.routes, self.times, ahead)
        at = first_of(met.contact)
        touching = self.rolling & (at < met.contact.shape[1])
        if not touching.any():
            return
        lanes, column, memory = self.lanes[touching], at[touching], self.memory
        leader = ahead.cut[touching, column]
        came = met.touches_in[touching, column]
        since = self.times[lanes, column, np.where(came, Mark.FIRST_IN, Mark.FIRST_OUT)]
        self.routes[touching] = memory.route[lanes, leader]
        memory.contact_at[lanes, self.cut], memory.behind[lanes, self.cut] = column, leader
        memory.since_s[lanes, self.cut] = since
        self.follow(lanes, leader, since)
        self.rolling = self.rolling & ~touching

    def follow(self, lanes: Ints, leader: Ints, since_s: Floats) -> None:
        """What the memory and the marks have of cuts whose first axles follow the last axles of their leaders."""
        memory, trains, cut = self.memory, self.trains, self.cut
        base = (self.last_m - self.first_m)[lanes]
        wanted = self.hump.routes.place_m[self.routes[lanes]] + np.where(OF_FIRST_AXLE, 0.0, base[:, None, None])
        tails = Tails(self.hump.routes, self.hump.rolls, trains, memory)
        times = tails.times_s(lanes, leader, wanted.reshape(len(lanes), -1)).reshape(wanted.shape)
        self.times[lanes] = followed(self.times[lanes], since_s[:, None, None], times)
        memory.tail_m[lanes, cut] = memory.tail_m[lanes, leader] - base
        memory.still_s[lanes, cut] = memory.still_s[lanes, leader]
        ruled = memory.ruled_m_s[lanes, cut]
        memory.ruled_m_s[lanes, cut] = np.where(np.isnan(ruled), memory.ruled_m_s[lanes, leader], ruled)

    def through_position(self, moving: Moving, position: int, control: ExitSpeeds) -> Moving:
        """The pass of `position`: commanded by the control, or as the cut ahead that is still in it."""
        routes, memory = self.hump.routes, self.memory
        held = self.rolling & np.isfinite(routes.entrance_m[self.routes, position]) & (moving.speed_m_s > 0.0)
        if not held.any():
            return moving
        lanes = self.lanes[held]
        start = moving.chosen(held)
        free = self.standing.seen_m(lanes, self.routes[held], start.time_s)
        asked = Asked(self.cut, position, lanes, self.routes[held], start, free, memory)
        command = self.obeyed(control.command(asked), held, position)
        to = routes.exit_m[self.routes[held], position] + self.last_m[held]
        unbraked, _ = rolled_free(self.cars(held), start, to, np.empty((len(lanes), 0)))
        rows, fastest = self.rows[held], 0.5 * (start.speed_m_s + unbraked.speed_m_s)
        mean = np.minimum(0.5 * (start.speed_m_s + command), fastest)
        passed = self.hump.positions[position].passed(
            Arrivals(
                rows=rows,
                retarder=routes.retarder_numbers[self.routes[held], position],
                train=self.trains.numbers[lanes],
                cut=np.full(len(lanes), self.cut),
                position=position,
                entry_m_s=start.speed_m_s,
                unbraked_exit_m_s=unbraked.speed_m_s,
                path_m=to - start.head_m,
                commanded_m_s=command,
                mass_t=self.trains.mass_t[rows],
                axles=self.trains.axles[rows],
                category=self.trains.category[rows],
                resistance_n_per_kn=self.trains.resistance_at(rows, mean),
                unbraked_resistance_n_per_kn=self.trains.resistance_at(rows, fastest),
                seed=self.trains.seed,
            )
        )
        known, sent = self.times.copy(), held
        while sent.any():
            self.times[held] = known[held]
            end, times = braked_evenly(start, to, passed.exit_m_s, passed.time_s, self.heads_m(held))
            end, times = self.stopped_within(held, start, to, end, times)
            self.note(times, held)
            sent = self.misroute()
        place = lanes, self.cut, position
        memory.begin_s[place], memory.entry_m_s[place] = start.time_s, start.speed_m_s
        memory.command_m_s[place], memory.exit_m_s[place] = command, passed.exit_m_s
        memory.unbraked_m_s[place], memory.ruled_m_s[place] = unbraked.speed_m_s, command
        memory.end_s[place], memory.strokes[place] = end.time_s, passed.switchings
        ended = merged(moving, end, held)
        self.halt(moving, ended)
        self.touch()
        return ended

    def stopped_within(
        self, held: Bools, start: Moving, to_m: Floats, end: Moving, times: Floats
    ) -> tuple[Moving, Floats]:
        """Cuts `held` that stop in a position roll on as far as they would without brake, which is open for them."""
        stops = end.speed_m_s <= 0.0
        if not stops.any():
            return end, times
        which = held.copy()
        which[held] = stops
        rolled, passed = rolled_free(self.cars(which), start.chosen(stops), to_m[stops], self.heads_m(which))
        times[stops] = passed
        return merged(end, Moving(rolled.head_m, np.zeros(len(passed)), rolled.time_s + np.inf), stops), times

    def obeyed(self, command: Floats, held: Bools, position: int) -> Floats:
        """Two cuts on a retarder: the mode of the first one rules, also through one in contact between them."""
        element = self.hump.routes.retarder[self.routes[held], position]
        ahead = self.ahead()
        met = meeting(self.hump.routes, self.routes, self.times, ahead)
        own = np.arange(len(element))
        both = met.unseparated[held][own, element]
        first = ahead.cut[held][own, element]
        ruling = self.memory.ruled_m_s[self.lanes[held], np.maximum(first, 0), position]
        return np.where(both & np.isfinite(ruling), ruling, command)

    def to_track(self, moving: Moving) -> None:
        """Free roll to the standing cars, and what the whole way was like."""
        cut, memory, standing = self.cut, self.memory, self.standing
        end = self.free(moving, lambda: standing.free_m[self.lanes, self.routes])
        self.halt(moving, end)
        self.touch()
        met = meeting(self.hump.routes, self.routes, self.times, self.ahead())
        memory.unseparated[:, cut], memory.foul[:, cut] = met.unseparated, met.foul
        memory.free_m[:, cut] = standing.free_m[self.lanes, self.routes]
        rolls = self.rolling
        ended = np.where(end.speed_m_s > 0.0, end.time_s, self.halt_s)
        lanes, still = self.lanes[rolls], Moving(end.head_m, end.speed_m_s, ended).chosen(rolls)
        memory.end_m[lanes, cut], memory.end_time_s[lanes, cut] = still.head_m, still.time_s
        memory.tail_m[lanes, cut], memory.still_s[lanes, cut] = still.head_m - self.last_m[rolls], still.time_s
        memory.end_speed_m_s[lanes, cut] = self.hump.coupled_m_s(self.routes[rolls], still.speed_m_s)
        marks = self.heads_m(rolls)
        added = standing.add(lanes, self.cars(rolls), moving.chosen(rolls), still, self.length_m[rolls], marks)
        self.note_behind(marks[added.which], added)
        coupled = self.hump.coupled_m_s(added.route, added.end_m_s)
        remember(memory, self.trains, cut, added, coupled)
        standing.block(self.lanes[~rolls], self.routes[~rolls], self.length_m[~rolls])

    def note_behind(self, marks_m: Floats, found: RolledOn) -> None:
        """The times of the marks `marks_m` that cuts pass with others ahead of them."""
        later = (marks_m > found.contact.head_m[:, None]).reshape(len(marks_m), *self.times.shape[1:])
        self.times[found.lanes] = np.where(later, found.marks_s.reshape(later.shape), self.times[found.lanes])

    def halt(self, moving: Moving, ended: Moving) -> None:
        """Note when cuts that rolled freely from `moving` stopped of themselves where they `ended`."""
        stops = self.rolling & (moving.speed_m_s > 0.0) & (ended.speed_m_s <= 0.0)
        if stops.any():
            near = np.maximum(ended.head_m[stops] - NEARLY_M, moving.head_m[stops])
            almost, _ = rolled_free(self.cars(stops), moving.chosen(stops), near, np.empty((int(stops.sum()), 0)))
            self.halt_s[stops] = almost.time_s
