"""When each axle of one humped train comes in to each element of its way, and when it goes out."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from plant_models.frozen_arrays import Floats
from synth.hump.rolling.hump_routes import OF_FIRST_AXLE, HumpRoutes, Mark
from synth.hump.rolling.train_cuts import TrainCuts
from synth.hump.rolling.train_memory import TrainMemory


@dataclass(frozen=True)
class Passage:
    """A cut over the element of this number, out by `branch` (0 left, 1 right, 0 of what is no switch).

    `in_s`, `out_s`: when each axle passes the joints, infinite where it never does; () for the joint behind the last
    section of a track. `clear_s`: when its last axle is at the fouling point. Its first axle comes in at `from_m`.
    """

    element: int
    branch: int
    in_s: tuple[float, ...]
    out_s: tuple[float, ...]
    clear_s: float
    from_m: float


@dataclass(frozen=True)
class TrainPassages:
    """The passages of the cuts of a train in the order of their ways, and the track on which each way ends.

    The simulation tells when the first and the last axle of a cut pass a joint; the axles between them are taken to
    pass it as if the cut moved evenly meanwhile.
    """

    ways: tuple[tuple[Passage, ...], ...]
    tracks: tuple[int, ...]

    @property
    def begins_s(self) -> float:
        """When the first axle passes the first joint; 0, the first cut at the crest, where none ever does."""
        return min((passage.in_s[0] for way in self.ways for passage in way), default=0.0)

    @property
    def ends_s(self) -> float:
        """When the last axle passes the last joint; 0 as above."""
        times = [time for way in self.ways for passage in way for time in (*passage.in_s, *passage.out_s)]
        return max((time for time in times if np.isfinite(time)), default=0.0)


def train_passages(routes: HumpRoutes, trains: TrainCuts, memory: TrainMemory, lane: int) -> TrainPassages:
    """Those of the train `lane` of `memory`, on the routes that its cuts went at last."""
    times = with_contacts(memory, lane)
    shares = [axle_shares(trains, lane * trains.cuts + cut) for cut in range(trains.cuts)]
    ways = (tuple(way(routes, int(memory.route[lane, cut]), times[cut], share)) for cut, share in enumerate(shares))
    return TrainPassages(tuple(ways), tuple(int(track) for track in routes.tracks[memory.route[lane]]))


def with_contacts(memory: TrainMemory, lane: int) -> Floats:
    """Times (cuts, elements, marks) of a train. The simulation finds a contact at the next joint; there the cut comes
    no sooner than the last axle of the one that it touched; its first axle, where the last one never comes. It never
    comes there behind a cut that stands ahead of the joint with all its axles. Its axles pass what lies behind no
    sooner than this joint: a cut that touched rolls as if alone, and the one ahead may be held up on its track."""
    times: Floats = memory.time_s[lane].copy()
    for cut in range(len(times)):
        at = int(memory.contact_at[lane, cut])
        leader = int(memory.behind[lane, cut])
        if leader >= 0:
            joint = times[cut, at, Mark.FIRST_IN : Mark.LAST_IN + 1]
            ahead = times[leader, at, Mark.FIRST_IN : Mark.LAST_IN + 1]
            came = ahead[np.isfinite(ahead)]
            joint += max(0.0, came[-1] - joint[0]) if len(came) else np.inf
            behind = times[cut, at:]
            np.maximum(behind, np.where(OF_FIRST_AXLE, joint[0], joint[-1]), out=behind)  # NaN for never stays
    return times


def axle_shares(trains: TrainCuts, row: int) -> Floats:
    """Where the axles of a cut are, 0 for its first one and 1 for its last one."""
    drawn, types = trains.drawn, trains.drawn.types[row][: int(trains.cars[row])]
    behind = [drawn.overhangs_m[each] + np.array(drawn.mix.cars[each].car.axle_offsets_m) for each in types]
    places = np.concatenate([front + car for front, car in zip(drawn.car_fronts_m[row], behind, strict=False)])
    return np.asarray((places - places[0]) / (places[-1] - places[0]))


def way(routes: HumpRoutes, row: int, times: Floats, shares: Floats) -> Iterator[Passage]:
    """The passages of one cut on the route `row`, with that of the section in which its track ends; `times` (elements,
    marks)."""
    leaves: tuple[float, ...] = ()
    for column in np.flatnonzero(routes.vertex[row] >= 0):
        mark = times[column]
        if not np.isfinite(mark[Mark.FIRST_IN]):
            return
        leaves = axle_times(mark[Mark.FIRST_OUT], mark[Mark.LAST_OUT], shares)
        yield Passage(
            element=routes.numbers[routes.vertex[row, column]],
            branch=max(int(routes.points[row, column]), 0),
            in_s=axle_times(mark[Mark.FIRST_IN], mark[Mark.LAST_IN], shares),
            out_s=leaves,
            clear_s=never_if_unknown(mark[Mark.LAST_CLEAR]),
            from_m=float(routes.place_m[row, column, Mark.FIRST_IN]),
        )
    if leaves and np.isfinite(leaves[0]):
        last = routes.routes[row].elements[-1]
        yield Passage(last.number, 0, leaves, (), float("inf"), last.from_m)


def axle_times(first_s: float, last_s: float, shares: Floats) -> tuple[float, ...]:
    """When axles pass a joint; NaN counts as never. If the last one never does, all but the first never do."""
    begin, end = never_if_unknown(first_s), never_if_unknown(last_s)
    if not np.isfinite(begin):
        return (float("inf"),) * len(shares)
    between = shares[1:] * (end - begin) + begin if np.isfinite(end) else np.full(len(shares) - 1, np.inf)
    return (begin, *(float(time) for time in between))


def never_if_unknown(time_s: float) -> float:
    """The time, infinite where it is NaN."""
    return float("inf") if np.isnan(time_s) else float(time_s)
