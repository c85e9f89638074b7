"""Where the layered simulator and the slow one say something else of a train."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from synth.hump.rolling.hump_routes import Mark as LayeredMark
from synth.hump.rolling.train_memory import TrainMemory
from tests.synth.hump.trains.fast_and_slow import BothTrains
from tests.synth.hump.trains.slow_train import Kind, Mark, SlowRun

Outcome = set[tuple[str, int, int]]

MARKS = {
    LayeredMark.FIRST_IN: Mark.FIRST_FROM,
    LayeredMark.LAST_IN: Mark.LAST_FROM,
    LayeredMark.FIRST_OUT: Mark.FIRST_TO,
    LayeredMark.LAST_OUT: Mark.LAST_TO,
    LayeredMark.FIRST_CLEAR: Mark.FIRST_FOULING,
    LayeredMark.LAST_CLEAR: Mark.LAST_FOULING,
}

ALMOST_STANDS_M = 0.1
"""Twice what the layered simulator leaves out of the last of a roll."""

SAME_PLACE_M = 0.02
"""A cut that almost stands takes long for so little; times are compared where it goes farther meanwhile."""

EARLY_M = 1.0
"""The layered simulator looks for contacts at places so far apart, or nearer."""

COMPARED = (Kind.NOT_SEPARATED, Kind.MISROUTED, Kind.CONTACT, Kind.FOULED, Kind.TRACK_CONTACT)


@dataclass(frozen=True)
class Agreement:
    """`differing`: (who alone says so, kind, element, cut); `times_s`, `heads_m`, `couplings_m_s`: largest differences
    at marks, where cuts stand, and of coupling speeds, of cuts that touched nobody, 0 where there is none."""

    differing: frozenset[tuple[str, str, int, int]]
    tracks: tuple[int, ...]
    times_s: float
    heads_m: float
    couplings_m_s: float


def layered_outcome(both: BothTrains, memory: TrainMemory, train: int) -> Iterator[tuple[str, int, int]]:
    """(kind, element, cut) of what the layered simulator noted, in the words of the slow one."""
    routes = both.routes
    for cut in range(both.cuts.cuts):
        row = memory.route[train, cut]
        numbers = [routes.numbers[vertex] for vertex in routes.vertex[row] if vertex >= 0]
        for kind, columns in ((Kind.MISROUTED, memory.misrouted_at), (Kind.CONTACT, memory.contact_at)):
            if columns[train, cut] < routes.elements:
                yield kind.value, numbers[columns[train, cut]], cut
        for kind, found in ((Kind.NOT_SEPARATED, memory.unseparated), (Kind.FOULED, memory.foul)):
            for column in np.flatnonzero(found[train, cut]):
                yield kind.value, numbers[column], cut
        if memory.caught_on_track[train, cut]:
            yield Kind.TRACK_CONTACT.value, routes.routes[row].elements[-1].number, cut


def behind(run: SlowRun, touched: set[int]) -> frozenset[int]:
    """Cuts with one of `touched` ahead of them on their track."""
    tracks = run.tracks
    return frozenset(
        cut for cut, track in enumerate(tracks) if any(other < cut and tracks[other] == track for other in touched)
    )


def judged(run: SlowRun) -> frozenset[int]:
    """Cuts of which both models speak alike: not of those on a track where one comes up behind a cut that is in contact
    since before, because the layered model does not push that one; nor where a cut that is pushed comes up with one
    ahead, which it does not look for."""
    behind_contact = behind(run, {event.cut for event in run.of(Kind.CONTACT)})
    touched = run.of(Kind.TRACK_CONTACT)
    lost = {run.tracks[event.cut] for event in touched if event.cut in behind_contact}
    for one, other in itertools.combinations(touched, 2):
        if run.tracks[one.cut] == run.tracks[other.cut] and (one.cut < other.cut) != (one.time_s < other.time_s):
            lost.add(run.tracks[one.cut])
    return frozenset(cut for cut, track in enumerate(run.tracks) if track not in lost)


def touched_early(both: BothTrains, memory: TrainMemory, train: int) -> set[int]:
    """Routes on which a cut touched the one ahead with its tail in the last position: the layered model lets them
    couple when it is out of it."""
    route = memory.route[train]
    rows = train * both.cuts.cuts + np.arange(both.cuts.cuts)
    out = both.routes.release_m[route] + both.cuts.last_axle_m[rows]
    return set(route[memory.touch_m[train] < out + EARLY_M].tolist())


def counted(outcome: Outcome, run: SlowRun) -> Outcome:
    """What is compared of an outcome.

    The layered model says nothing of the points behind a contact, and does not look whether a cut comes up on the track
    with one that rolls there in contact with a third. Neither counts a contact with a cut that all but stands.
    """
    nearly = {event.cut for event in run.of(Kind.TRACK_CONTACT) if event.value < ALMOST_STANDS_M}
    cuts, in_contact = judged(run), {event.cut for event in run.of(Kind.CONTACT)}
    behind_contact = behind(run, in_contact)
    return {
        (kind, element, cut)
        for kind, element, cut in outcome
        if cut in cuts
        and not (kind == Kind.MISROUTED.value and cut in in_contact)
        and not (kind == Kind.TRACK_CONTACT.value and cut in behind_contact | nearly)
    }


def agreement(both: BothTrains, memory: TrainMemory, run: SlowRun, train: int) -> Agreement:
    """What differs of one train."""
    cuts = judged(run)
    fast = counted(set(layered_outcome(both, memory, train)), run)
    slow = counted({each for each in run.outcome() if Kind(each[0]) in COMPARED}, run)
    alone = {("layered", *each) for each in fast - slow} | {("slow", *each) for each in slow - fast}
    tracks = both.routes.tracks[memory.route[train]].tolist()
    early = touched_early(both, memory, train)
    free = [cut for cut in cuts if not run.in_contact[cut] and memory.route[train, cut] not in early]
    coupled = {event.cut: event.value for event in run.of(Kind.COUPLED)}
    heads = [abs(memory.end_m[train, cut] - run.heads_m[cut]) for cut in free]
    speeds = [abs(memory.end_speed_m_s[train, cut] - coupled.get(cut, 0.0)) for cut in free]
    times = [time for cut in free for time in time_differences(both, memory, run, train, cut)]
    return Agreement(
        frozenset(alone),
        tuple(cut for cut in free if tracks[cut] != run.tracks[cut]),
        max(times, default=0.0),
        max(heads, default=0.0),
        max(speeds, default=0.0),
    )


def time_differences(both: BothTrains, memory: TrainMemory, run: SlowRun, train: int, cut: int) -> Iterator[float]:
    """Seconds between the times of both at each mark, 0 where it is there in nearly the same place; infinite where one
    alone knows of a passage."""
    row = memory.route[train, cut]
    for column, vertex in enumerate(both.routes.vertex[row]):
        number = both.routes.numbers[vertex]
        is_switch = vertex >= 0 and both.routes.points[row, column] >= 0
        for layered, slow in MARKS.items():
            if vertex < 0 or (slow in (Mark.FIRST_FOULING, Mark.LAST_FOULING) and not is_switch):
                continue
            own = float(np.nan_to_num(memory.time_s[train, cut, column, layered], nan=np.inf, posinf=np.inf))
            other = run.passages.get((cut, number, slow))
            apart = abs(own - run.time_s(cut, number, slow)) if np.isfinite(own) or other is not None else 0.0
            yield apart if other is None or apart * other.speed_m_s > SAME_PLACE_M else 0.0
