"""One humped train to look at: the way of each cut, who occupied which element, and what went wrong when."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from enum import Enum

import numpy as np

from synth.hump.rolling.hump_routes import HumpRoutes, Mark
from synth.hump.rolling.humping import Hump
from synth.hump.rolling.meeting import first_of
from synth.hump.rolling.outcomes import USUAL_COUPLINGS
from synth.hump.rolling.train_cuts import TrainCuts
from synth.hump.rolling.train_memory import TrainMemory
from synth.hump.trains.cut_trace import CutTrace, TracedTrain


class AlarmKind(Enum):
    """What can go wrong, as it is called."""

    MISROUTED = "misrouted"
    CONTACT = "contact"
    UNSEPARATED = "not separated"
    FOUL = "foul"
    ON_TRACK = "coupled to a rolling cut"
    OVERSPEED = "coupled too fast"
    STOPPED = "stopped before its track"

    @property
    def severe(self) -> bool:
        """Whether something went wrong; cuts are often close together in a retarder, or meet gently on a track."""
        return self not in (AlarmKind.UNSEPARATED, AlarmKind.ON_TRACK)


@dataclass(frozen=True)
class Alarm:
    """`cut` of the train, counted from 0, met `ahead` (None: nobody) at the element `number` (None: on its track)."""

    kind: AlarmKind
    time_s: float
    cut: int
    ahead: int | None
    number: int | None


@dataclass(frozen=True)
class Occupied:
    """`cut` is on the element `number`, `from_m` to `to_m` from the crest, until its last axle is out, which is never
    where it stays there."""

    number: int
    cut: int
    from_m: float
    to_m: float
    from_s: float
    to_s: float


@dataclass(frozen=True)
class Passage:
    """A pass of the retarder `number`, speeds in m/s; `end_s` is infinite where the cut stopped in it."""

    number: int
    begin_s: float
    end_s: float
    entry_m_s: float
    command_m_s: float
    exit_m_s: float


@dataclass(frozen=True)
class TracedCut:
    """Cut number `cut` of a train, from 0: what it is, and what became of it.

    `route`: row of the route that it went, `wanted`: of that to its track. `coupled_m_s`, `gap_m`: how much faster it
    was than the cars that it met on its track, and what it left free ahead of them; None where it did not, and where
    neither counts: it was misrouted, in contact, or stopped on the way.
    """

    cut: int
    route: int
    wanted: int
    cars: int
    category: int
    mass_t: float
    length_m: float
    crest_s: float
    hump_speed_m_s: float
    passages: tuple[Passage, ...]
    free_m: float
    coupled_m_s: float | None
    gap_m: float | None
    trace: CutTrace


@dataclass(frozen=True)
class TrainTrace:
    """The train `number`, from 0, of its seed; its cuts in order; alarms by time. Couplings above `allowed_m_s` are
    over-speeds."""

    number: int
    routes: HumpRoutes
    cuts: tuple[TracedCut, ...]
    occupied: tuple[Occupied, ...]
    alarms: tuple[Alarm, ...]
    allowed_m_s: float

    @property
    def end_s(self) -> float:
        """When everything stands."""
        return max(float(cut.trace.time_s[-1]) for cut in self.cuts)

    @property
    def mean_hump_speed_m_s(self) -> float:
        """From the middle of the first cut at the crest to that of the last one; NaN of one cut."""
        if len(self.cuts) < 2:
            return float("nan")
        pushed = sum(cut.length_m for cut in self.cuts) - 0.5 * (self.cuts[0].length_m + self.cuts[-1].length_m)
        return pushed / (self.cuts[-1].crest_s - self.cuts[0].crest_s)


def train_trace(
    hump: Hump, trains: TrainCuts, memory: TrainMemory, lane: int, allowed_m_s: float = USUAL_COUPLINGS.allowed_m_s
) -> TrainTrace:
    """The train `lane` of those that `memory` tells; `hump` and `trains` must be those that were humped.

    Nothing is simulated anew: free rolls go from the states that the memory has, passes as they were.
    """
    traced = TracedTrain(hump, trains, memory, lane)
    ways = list(traced.traces())
    touch_s: dict[int, float] = {}
    for cut in range(trains.cuts):
        leader = leader_of(memory, lane, cut)
        if leader is not None and memory.caught_on_track[lane, cut]:
            touch_s[cut], behind_m = float(memory.touch_s[lane, cut]), 0.0
            members = body_of(memory, lane, cut)
            body = traced.body(members, cut)
            for each in members:
                ways[each] = ways[each].rolling_on(body, behind_m)
                behind_m += float(traced.length_m[each])
        elif leader is not None:
            length, by_s = float(traced.length_m[leader]), float(memory.since_s[lane, cut])
            ways[cut], touch_s[cut] = ways[cut].behind(ways[leader], length, by_s)
    cuts = tuple(traced_cut(hump, trains, memory, lane, way) for way in enumerate(ways))
    occupied = tuple(occupations(hump.routes, memory, lane))
    told = alarms(hump.routes, memory, lane, cuts, touch_s, allowed_m_s)
    found = sorted(told, key=lambda alarm: (alarm.time_s, alarm.cut))
    return TrainTrace(int(trains.numbers[lane]), hump.routes, cuts, occupied, tuple(found), allowed_m_s)


def leader_of(memory: TrainMemory, lane: int, cut: int) -> int | None:
    """The cut with which `cut` came in contact, on the way or, while both rolled, on their track."""
    if not memory.caught_on_track[lane, cut]:
        leader = int(memory.behind[lane, cut])
        return leader if leader >= 0 else None
    by_itself = np.isfinite(memory.end_m[lane, :cut])
    same = np.flatnonzero(by_itself & (memory.route[lane, :cut] == memory.route[lane, cut]))
    return int(same[-1]) if len(same) else None


def body_of(memory: TrainMemory, lane: int, cut: int) -> np.ndarray:
    """The cuts that rolled on as one with `cut` behind them, from the first to it."""
    found = [cut]
    while memory.caught_on_track[lane, found[0]]:
        ahead = leader_of(memory, lane, found[0])
        assert ahead is not None
        found.insert(0, ahead)
    return np.array(found)


def user_ahead(routes: HumpRoutes, memory: TrainMemory, lane: int, cut: int, column: int) -> int | None:
    """Who used the element of `column` last before `cut`; nobody, where there is no such column."""
    if column >= routes.elements:
        return None
    vertex = routes.vertex[memory.route[lane], column]
    used = np.isfinite(memory.time_s[lane, :cut, column, Mark.FIRST_IN])
    same = np.flatnonzero(used & (vertex[:cut] == vertex[cut]))
    return int(same[-1]) if len(same) else None


def traced_cut(
    hump: Hump, trains: TrainCuts, memory: TrainMemory, lane: int, numbered: tuple[int, CutTrace]
) -> TracedCut:
    """One cut with its way."""
    cut, way = numbered
    row, elements = lane * trains.cuts + cut, hump.routes.elements
    caught = min(memory.misrouted_at[lane, cut], memory.contact_at[lane, cut]) < elements
    judged = not (caught or stopped_early(hump.routes, memory, lane, cut))
    speed = float(memory.end_speed_m_s[lane, cut])
    coupled = judged and (speed > 0.0 or bool(memory.caught_on_track[lane, cut]))
    gap = float(memory.free_m[lane, cut] - memory.end_m[lane, cut])
    return TracedCut(
        cut,
        route=int(memory.route[lane, cut]),
        wanted=int(trains.route[row]),
        cars=int(trains.cars[row]),
        category=int(trains.category[row]),
        mass_t=float(trains.mass_t[row]),
        length_m=float(trains.length_m[row]),
        crest_s=float(memory.crest_s[lane, cut]),
        hump_speed_m_s=float(memory.hump_speed_m_s[lane, cut]),
        passages=tuple(passages(hump.routes, memory, lane, cut)),
        free_m=float(memory.free_m[lane, cut]),
        coupled_m_s=speed if coupled else None,
        gap_m=gap if judged and not coupled else None,
        trace=way,
    )


def stopped_early(routes: HumpRoutes, memory: TrainMemory, lane: int, cut: int) -> bool:
    """Whether a cut stopped of itself with its head ahead of the end of its last position."""
    return bool(memory.end_m[lane, cut] < routes.release_m[memory.route[lane, cut]])


def passages(routes: HumpRoutes, memory: TrainMemory, lane: int, cut: int) -> Iterator[Passage]:
    """The passes of a cut in order."""
    route = memory.route[lane, cut]
    for position in np.flatnonzero(np.isfinite(memory.begin_s[lane, cut])):
        number = routes.numbers[routes.vertex[route, routes.retarder[route, position]]]
        kept = (memory.begin_s, memory.end_s, memory.entry_m_s, memory.command_m_s, memory.exit_m_s)
        yield Passage(number, *(float(array[lane, cut, position]) for array in kept))


def occupations(routes: HumpRoutes, memory: TrainMemory, lane: int) -> Iterator[Occupied]:
    """Which cut is on which element from when to when, in the order of cuts and of their ways."""
    time = memory.time_s[lane]
    for cut, column in zip(*np.nonzero(np.isfinite(time[:, :, Mark.FIRST_IN])), strict=True):
        route = memory.route[lane, cut]
        vertex = routes.vertex[route, column]
        if vertex >= 0:
            place = routes.place_m[route, column]
            ends = time[cut, column, Mark.LAST_OUT]
            yield Occupied(
                number=routes.numbers[vertex],
                cut=int(cut),
                from_m=float(place[Mark.FIRST_IN]),
                to_m=float(place[Mark.LAST_OUT]),
                from_s=float(time[cut, column, Mark.FIRST_IN]),
                to_s=float(np.nan_to_num(ends, nan=np.inf, posinf=np.inf)),
            )


def alarms(
    routes: HumpRoutes, memory: TrainMemory, lane: int, cuts: tuple[TracedCut, ...], touch_s: Mapping[int, float],
    allowed_m_s: float,
) -> Iterator[Alarm]:  # fmt: skip
    """What went wrong, cut by cut. Elements where two cuts are not separated count at the first of them alone, and not
    where they are coupled already.

    `touch_s`: when cuts in contact touch those ahead of them.
    """
    unseparated, foul = first_of(memory.unseparated[lane]), first_of(memory.foul[lane])
    for each in cuts:
        cut = each.cut
        met = (
            (AlarmKind.MISROUTED, int(memory.misrouted_at[lane, cut]), Mark.FIRST_IN),
            (AlarmKind.CONTACT, int(memory.contact_at[lane, cut]), Mark.FIRST_IN),
            (AlarmKind.UNSEPARATED, int(unseparated[cut]), Mark.FIRST_IN),
            (AlarmKind.FOUL, int(foul[cut]), Mark.FIRST_CLEAR),
        )
        for kind, column, mark in met:
            if column < routes.elements:
                number = routes.numbers[routes.vertex[each.route, column]]
                ahead = user_ahead(routes, memory, lane, cut, column)
                met_s = float(memory.time_s[lane, cut, column, mark])
                if kind is AlarmKind.UNSEPARATED and met_s > touch_s.get(cut, np.inf):
                    continue
                yield Alarm(kind, touch_s.get(cut, met_s) if kind is AlarmKind.CONTACT else met_s, cut, ahead, number)
        ends_s = float(each.trace.time_s[-1])
        if memory.caught_on_track[lane, cut]:
            ahead = leader_of(memory, lane, cut)
            yield Alarm(AlarmKind.ON_TRACK, touch_s.get(cut, ends_s), cut, ahead, None)
        if each.coupled_m_s is not None and each.coupled_m_s > allowed_m_s:
            yield Alarm(AlarmKind.OVERSPEED, touch_s.get(cut, ends_s), cut, None, None)
        if stopped_early(routes, memory, lane, cut):
            yield Alarm(AlarmKind.STOPPED, ends_s, cut, None, None)
