"""The law of a task's wait as a Laplace transform, for every discipline."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from plant_models.errors import require
from synth.computer.sizing.demand_service import Discipline
from synth.computer.sizing.service_law import Complexes
from synth.computer.sizing.task import Stream, by_priority, require_not_overloaded, total_load

MOST_ROUNDS = 100_000


@dataclass(frozen=True)
class WaitLaw:
    """The law of a time T ≥ 0: P(T > 0), and E[e^(−sT)] for s with Re s > 0."""

    positive_share: float
    transform: Callable[[Complexes], Complexes]


@dataclass(frozen=True)
class _Place:
    """A stream among the others: those that go before it, its equals and itself, those that it may wait for once."""

    stream: Stream
    ahead: tuple[Stream, ...]
    equals: tuple[Stream, ...]
    behind: tuple[Stream, ...]


def start_law(streams: tuple[Stream, ...], discipline: Discipline, task: str) -> WaitLaw:
    """Of the time from a request of `task` to the begin of its service; `PlantError` if ρ ≥ 1 or there is no such task.

    With g_X(s) = Σ_{i in X} λ_i (1 − B_i(s)) and z = s + g_ahead(z), in which the busy period of more urgent tasks is:
    [(1 − ρ) z + g_behind(z)] / [s − g_equals(z)] (Kesten and Runnenburg 1957; Conway, Maxwell and Miller, Theory of
    Scheduling, 1967, section 8-6). First come, first served is the case where all are equals: Pollaczek and Khinchine.
    With absolute priorities nobody is behind, and ρ is the load of the others.
    """
    place = _placed(streams, discipline, task)
    busy = total_load((*place.ahead, *place.equals, *place.behind))

    def transform(s: Complexes) -> Complexes:
        z = delayed(s, place.ahead)
        return ((1.0 - busy) * z + _arriving(z, place.behind)) / (s - _arriving(z, place.equals))

    return WaitLaw(busy, transform)


def sojourn_law(streams: tuple[Stream, ...], discipline: Discipline, task: str) -> WaitLaw:
    """Of the time from a request of `task` to its end: start and service, at z where the service can be interrupted."""
    place, start = _placed(streams, discipline, task), start_law(streams, discipline, task)
    ahead = place.ahead if discipline is Discipline.ABSOLUTE else ()

    def transform(s: Complexes) -> Complexes:
        return start.transform(s) * place.stream.service.transform(delayed(s, ahead))

    return WaitLaw(1.0, transform)


def delayed(s: Complexes, ahead: tuple[Stream, ...]) -> Complexes:
    """z = s + Σ λ_i (1 − B_i(z)), by iteration: it contracts by the load of `ahead`, as |B_i'| ≤ E[S_i] for Re s ≥ 0.

    A time x of one's own work becomes, with all that comes `ahead` meanwhile, a time with the transform e^(−zx).
    """
    if not ahead:
        return s
    share, z = total_load(ahead), s
    for _ in range(MOST_ROUNDS):
        new = s + _arriving(z, ahead)
        near = np.abs(new - z) * share <= 1e-14 * (1.0 - share) * np.abs(new)
        z = new
        if bool(np.all(near)):
            return z
    raise ArithmeticError(f"the busy period of a load of {share:.6g} was not found in {MOST_ROUNDS} rounds")


def _arriving(s: Complexes, streams: tuple[Stream, ...]) -> Complexes:
    """g(s) = Σ λ_i (1 − B_i(s))."""
    return sum((each.rate_per_s * (1.0 - each.service.transform(s)) for each in streams), np.zeros_like(s))


def _placed(streams: tuple[Stream, ...], discipline: Discipline, task: str) -> _Place:
    require_not_overloaded(streams)
    found = [stream for stream in streams if stream.name == task]
    require(
        len(found) == 1,
        f"task is {task!r}; it must be one of {', '.join(stream.name for stream in streams)}",
    )
    stream = found[0]
    if discipline is Discipline.FIRST_COME:
        return _Place(stream, (), streams, ())
    groups = by_priority(streams)
    ahead = tuple(each for priority, group in groups.items() if priority < stream.priority for each in group)
    behind = tuple(each for priority, group in groups.items() if priority > stream.priority for each in group)
    return _Place(stream, ahead, groups[stream.priority], () if discipline is Discipline.ABSOLUTE else behind)
