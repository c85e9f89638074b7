"""Humping of one train, slowly: all cuts at once, step by step in time, by the rules of the model of humping.

Only the length of a step is chosen. Within it each cut goes from mark to mark at times that are worked out, and a cut
depends on cuts ahead of it alone, which have made the step before; so no decision hangs on the step.
"""

from __future__ import annotations

from dataclasses import replace
from math import inf

from plant_models.hump import HumpGraph, Retarder, RouteElement, Switch
from tests.synth.hump.trains.slow_cut import SAME_S, Mode, MovingCut, Push, first_root
from tests.synth.hump.trains.slow_train import (
    Kind,
    Mark,
    MarkAt,
    Passage,
    SlowRecord,
    SlowRun,
    SlowTrain,
    coupled,
    require_fit,
)
from tests.synth.hump.trains.slow_way import SlowWay

STEP_S = 0.02
LONGEST_S = 7200.0
SAME_M = 1e-9
ENDS = (Kind.COUPLED, Kind.GAP, Kind.STOPPED)


def humped_slowly(graph: HumpGraph, train: SlowTrain, step_s: float = STEP_S) -> SlowRun:
    """Hump `train` over `graph` until every cut stands."""
    return SlowHumping(graph, train).run(step_s)


class SlowHumping(SlowRecord):
    """A train that is being humped."""

    def __init__(self, graph: HumpGraph, train: SlowTrain) -> None:
        self.routes, self.train = graph.routes(train.lead), train
        for route in self.routes.values():
            for cut in train.cuts:
                require_fit(cut, route, train.free_to_m[route.track])
        self.ways: dict[tuple[int, int], SlowWay] = {}
        first = train.cuts[0]
        self.now = first.crest_s - 0.5 * first.body.length_m / first.hump_speed_m_s
        push, routes = Push(train.cuts), self.routes
        self.cuts = [
            MovingCut(c, routes[c.track], self.way(i, c.track), push, self.now) for i, c in enumerate(train.cuts)
        ]
        super().__init__()
        self.commands: dict[tuple[int, int], float] = {}
        self.entered: set[tuple[int, int]] = set()

    def way(self, i: int, track: int) -> SlowWay:
        """What cut `i` feels on the route to `track`."""
        if (i, track) not in self.ways:
            self.ways[i, track] = SlowWay(self.train.cuts[i].body, self.routes[track], self.train)
        return self.ways[i, track]

    def run(self, step_s: float) -> SlowRun:
        """Make steps until every cut stands."""
        start, step = self.now, 0
        while any(moving.mode is not Mode.STANDING for moving in self.cuts):
            step += 1
            until = start + step * step_s
            for i, moving in enumerate(self.cuts):
                if moving.mode is not Mode.STANDING:
                    self.advance(i, moving, until)
            if until > start + LONGEST_S:
                raise RuntimeError(f"cuts still roll {LONGEST_S:g} s after the first one came to the crest")
        return self.told()

    def told(self) -> SlowRun:
        """What came of it."""
        events = []
        for event in self.events:
            stood_m = self.cuts[event.cut].x
            ends = {Kind.GAP: self.free_to(event.cut) - stood_m, Kind.TRACK_CONTACT: stood_m - event.value}
            events.append(replace(event, value=ends.get(event.kind, event.value)))
        return SlowRun(
            events=tuple(sorted(events, key=lambda e: (e.time_s, e.cut))),
            passages=self.passages,
            tracks=tuple(moving.route.track for moving in self.cuts),
            heads_m=tuple(moving.x for moving in self.cuts),
            in_contact=tuple(moving.leader is not None for moving in self.cuts),
            closest_s=self.closest(),
        )

    def advance(self, i: int, moving: MovingCut, until: float) -> None:
        """Let cut `i` make its part of the step."""
        moving.legs = [(moving.t, moving.x, moving.v, 0.0)]
        self.go_on(i, moving, until)

    def go_on(self, i: int, moving: MovingCut, until: float) -> None:
        """The rest of its part."""
        while moving.mode not in (Mode.TOWED, Mode.STANDING) and moving.t < until - SAME_S:
            t, x, limit_m = moving.t, moving.x, self.limit(i)
            arrived = moving.go(until, limit_m)
            if moving.on_track and self.touches(i, t, x):
                continue
            if arrived and moving.x >= limit_m:
                self.couple(i)
            elif arrived:
                self.arrive(i, moving.marks.pop(0))
            elif moving.v <= 0.0:
                self.stop(i)
        if moving.mode is Mode.TOWED and moving.leader is not None:
            self.tow(i, moving, moving.leader, until)

    def user(self, i: int, number: int) -> int | None:
        """The last cut ahead of `i` whose way leads over the element."""
        return next((j for j in range(i - 1, -1, -1) if number in self.cuts[j].numbers), None)

    def ahead_on_track(self, i: int) -> int | None:
        """The last cut ahead of `i` for the same track."""
        return self.user(i, self.cuts[i].route.elements[-1].number)

    def free_to(self, i: int) -> float:
        """Where cars begin on the track of cut `i` when all ahead of it stand."""
        j = self.ahead_on_track(i)
        return self.train.free_to_m[self.cuts[i].route.track] if j is None else self.cuts[j].tail_at(inf)

    def limit(self, i: int) -> float:
        """Where cut `i` would couple with standing cars now; infinite while the cars ahead of it roll."""
        j = self.ahead_on_track(i) if self.cuts[i].on_track else None
        stands = j is None or self.cuts[j].mode is Mode.STANDING
        return self.free_to(i) if self.cuts[i].on_track and stands else inf

    def touches(self, i: int, t: float, x: float) -> bool:
        """Whether cut `i` came to a rolling cut since `t`, when its head was at `x`; then it rolls behind that one."""
        moving, j = self.cuts[i], self.ahead_on_track(i)
        if j is None or (self.cuts[j].mode is Mode.STANDING and self.cuts[j].t <= t):
            return False
        ahead = self.cuts[j]
        middle = 0.5 * (t + moving.t)
        gap = ahead.tail_at(moving.t) - moving.x
        if gap > 0.0:
            return False
        share = first_root(ahead.tail_at(t) - x, ahead.tail_at(middle) - moving.place_at(middle), gap)
        time_s = t + (moving.t - t) * share
        if ahead.mode is Mode.STANDING:
            self.margins_s.append(abs(time_s - ahead.t))
            if time_s >= ahead.t:
                return False
        at_m_s = moving.v  # within a step, that at its end: the step is short
        moving.towed(ahead, time_s, ahead.body.length_m)
        self.tell(time_s, Kind.TRACK_CONTACT, moving.route.elements[-1].number, i, moving.x)
        self.roll_on(ahead, moving, at_m_s)
        return True

    def roll_on(self, ahead: MovingCut, behind: MovingCut, behind_m_s: float) -> None:
        """The cut `behind` has touched the one `ahead` on their track; both roll on with their common momentum."""
        while ahead.leader is not None:
            ahead = ahead.leader
        first, until = self.cuts.index(ahead), max(ahead.t, behind.t)
        if not ahead.on_track:
            return
        ahead.rewind(behind.t)
        self.events = [e for e in self.events if e.cut != first or e.time_s < behind.t or e.kind not in ENDS]
        whole = coupled(ahead.way.body, behind.body)
        weighs = [way.body.mass_t / way.gravity for way in (ahead.way, behind.way)]
        ahead.v = (weighs[0] * ahead.v + weighs[1] * behind_m_s) / sum(weighs)
        ahead.way = SlowWay(whole, ahead.route, self.train)
        self.go_on(first, ahead, until)

    def couple(self, i: int) -> None:
        """Cut `i` has come to standing cars."""
        moving, j = self.cuts[i], self.ahead_on_track(i)
        if j is not None:
            self.margins_s.append(abs(moving.t - self.cuts[j].t))
        self.tell(moving.t, Kind.COUPLED, moving.route.elements[-1].number, i, moving.v)
        moving.mode = Mode.STANDING

    def stop(self, i: int) -> None:
        """Cut `i` stands where nothing is ahead of it."""
        moving = self.cuts[i]
        moving.mode = Mode.STANDING
        last = moving.route.elements[-1]
        first_axle = moving.x - moving.body.first_axle_m
        under = [e.number for e in moving.route.elements if e.from_m <= first_axle]
        gap = moving.x >= last.from_m
        self.tell(moving.t, Kind.GAP if gap else Kind.STOPPED, last.number if gap else under[-1], i)

    def arrive(self, i: int, at: MarkAt) -> None:
        """Cut `i` has come to a mark by itself."""
        moving = self.cuts[i]
        element = moving.route.elements[at.order]
        held_up = False
        if at.mark is Mark.FIRST_FROM:
            held_up = self.enter(i, element, moving.t)
        elif at.mark is Mark.FIRST_TO:
            held_up = self.meet(i, element, Mark.LAST_TO, moving.t)
        elif at.mark is Mark.FIRST_FOULING:
            self.foul(i, element, moving.t)
        elif at.mark is Mark.ENTRANCE:
            self.brake(i, element)
        elif at.mark is Mark.EXIT and moving.mode is Mode.BRAKED:
            moving.mode, moving.v = Mode.ROLLING, moving.v_out
        elif at.mark is Mark.TRACK:
            moving.on_track = True
            held_up = self.touches(i, moving.t, moving.x)
        if not held_up or at.mark is Mark.TRACK:
            self.passages[i, element.number, at.mark] = Passage(moving.t, moving.v)
        else:
            moving.marks = sorted([at, *moving.marks])

    def enter(self, i: int, element: RouteElement, time_s: float) -> bool:
        """The first axle of cut `i` comes to the section of `element`; True if it is now behind the last user."""
        moving, number = self.cuts[i], element.number
        self.entered.add((i, number))
        j = self.user(i, number)
        if isinstance(element.vertex, Retarder):
            self.commands[i, number] = self.planned(i, number)
        if j is None or element is moving.route.elements[-1]:
            return False
        if not self.passed(j, number, Mark.LAST_TO, time_s):
            self.tell(time_s, Kind.NOT_SEPARATED, number, i)
            if isinstance(element.vertex, Retarder):
                self.commands[i, number] = self.ruling(j, number)
        at = moving.route.elements.index(element)
        if isinstance(element.vertex, Switch) and self.cuts[j].route.elements[at].position != element.position:
            delay_s = element.vertex.relay_s + element.vertex.throw_s
            if not self.passed(j, number, Mark.LAST_TO, time_s, delay_s):
                self.tell(time_s, Kind.MISROUTED, number, i)
                moving.adopted = self.cuts[j]
                self.reroute(i, at, self.cuts[j].route.track, entered=True)
        return moving.leader is None and self.meet(i, element, Mark.LAST_FROM, time_s)

    def reroute(self, i: int, order: int, track: int, *, entered: bool) -> None:
        """Send cut `i` to `track` from its element `order` on, and all behind it that go its way."""
        self.cuts[i].reroute(order, self.routes[track], self.way(i, track), entered=entered)
        for k in range(i + 1, len(self.cuts)):
            if self.cuts[k].adopted is self.cuts[i]:
                self.reroute(k, order, track, entered=False)

    def meet(self, i: int, element: RouteElement, joint: Mark, time_s: float) -> bool:
        """Whether cut `i` is at a joint before the last axle of the last user; then it rolls behind that one."""
        j = self.user(i, element.number)
        if j is None or self.cuts[i].leader is not None or self.passed(j, element.number, joint, time_s):
            return False
        self.tell(time_s, Kind.CONTACT, element.number, i)
        ahead = self.cuts[j]
        self.cuts[i].towed(ahead, time_s, ahead.body.last_axle_m - self.cuts[i].body.first_axle_m)
        return True

    def tow(self, i: int, moving: MovingCut, ahead: MovingCut, until: float) -> None:
        """Let cut `i`, which rolls behind the cut ahead, come to its marks."""
        if until - moving.t <= SAME_S:
            return
        x, x_then, t = moving.place_at(until), moving.x, moving.t
        while moving.marks and moving.marks[0].head_m <= x:
            at = moving.marks.pop(0)
            element = moving.route.elements[at.order]
            time_s = t + max(at.head_m - x_then, 0.0) / max(x - x_then, SAME_M) * (until - t)
            if at.mark is Mark.FIRST_FROM and (i, element.number) not in self.entered:
                self.enter(i, element, time_s)
            elif at.mark is Mark.FIRST_FOULING:
                self.foul(i, element, time_s)
            self.passages[i, element.number, at.mark] = Passage(time_s, (x - x_then) / (until - t))
        moving.t, moving.x = until, x
        if ahead.mode is Mode.STANDING:
            moving.mode, moving.t, moving.x, moving.v = Mode.STANDING, ahead.t, ahead.tail_at(inf), 0.0

    def foul(self, i: int, element: RouteElement, time_s: float) -> None:
        """The first axle of cut `i` comes to its fouling point behind a switch."""
        j = self.user(i, element.number)
        if j is None or self.cuts[j].route.element(element.number).position == element.position:
            return
        if not self.passed(j, element.number, Mark.LAST_FOULING, time_s):
            self.tell(time_s, Kind.FOULED, element.number, i)

    def ruling(self, i: int, number: int) -> float:
        """The command by which the position lets cut `i` go; that of the cut ahead, if it comes in contact with it."""
        leader = self.cuts[i].leader
        if (i, number) in self.commands or leader is None:
            return self.commands.get((i, number), self.planned(i, number))
        return self.ruling(self.cuts.index(leader), number)

    def planned(self, i: int, number: int) -> float:
        """The command of cut `i` for the position, as it was given."""
        return self.cuts[i].cut.exit_speeds_m_s[self.position(i, number)]

    def position(self, i: int, number: int) -> int:
        """How many positions are ahead of this one."""
        positions = [e.number for e in self.cuts[i].route.elements if isinstance(e.vertex, Retarder)]
        return positions.index(number)

    def brake(self, i: int, element: RouteElement) -> None:
        """The first axle of cut `i` is at the entrance of a position."""
        moving, vertex, heads = self.cuts[i], element.vertex, self.cuts[i].cut.brake_heads_m
        assert isinstance(vertex, Retarder)
        command = self.commands.get((i, element.number), self.planned(i, element.number))
        full_head_m = heads[self.position(i, element.number)] if heads else inf
        moving.brake(command, element.at_m + vertex.exit_m + moving.body.last_axle_m, full_head_m)
