"""How one processor serves its tasks: in cycles, in which it goes through all objects, whether something is new or
not; or on demand, where requests wait in a queue: mean waits of each task, in closed form.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum
from typing import Final

from pydantic import Field

from synth.computer.origins import SPEED
from synth.computer.sizing.task import Stream, TaskMix, by_priority, require_not_overloaded, total_load
from synth.frame.settings.section import Section, setting


class Cycle(Section):
    """The other way of service: all objects in every cycle, whether something is new or not.

    α is the time of the checks that cannot be done beside the work, δ what is kept to go through the work again.
    """

    cycle_s: float = setting(1.0, "s", 1e-6, 1e6, "length of a cycle", SPEED)
    operations: float = setting(
        500_000.0, "1", 1.0, 1e18, "operations of a cycle", f"{SPEED}: what its speed of 1 000 000 op/s tells"
    )
    check_share: float = setting(
        1.0, "1", 0.0, 100.0, "α: time for checks, of that for the work", f"{SPEED}: half of the time is left"
    )
    recovery_share: float = setting(0.0, "1", 0.0, 0.99, "δ: part of the cycle kept to recover from errors", SPEED)

    @property
    def useful_share(self) -> float:
        """(1 − δ) / (1 + α): the share of the cycle that is left for the work.

        The print of [hump-computer-1970s] has (1 − δ)/(1 + α) in the formula and (1 − α) in the text. With α = 1,
        checks as long as the work, the second has no finite speed, and the work takes half of the time: (1 + α).
        """
        return (1.0 - self.recovery_share) / (1.0 + self.check_share)


def cyclic_speed(cycle: Cycle) -> float:
    """V = N_c / [((1 − δ)/(1 + α)) · T_c], op/s: the least speed at which all N_c operations end within the cycle.

    [hump-computer-1970s], chapter 3.
    """
    return cycle.operations / (cycle.useful_share * cycle.cycle_s)


def used_share(mix: TaskMix, speed_op_s: float, cycle: Cycle, checks_count: bool) -> float:
    """The share of the speed that brings something new: Σ λ_i L_i / V, with the checks of that work if they count.

    The rest of a cycle confirms what is known. [hump-computer-1970s] tells 7 to 8 %, not whether checks count.
    """
    work = mix.operations_per_s / speed_op_s
    return work / cycle.useful_share if checks_count else work


class Discipline(Enum):
    """Which request is served next; within a priority always the one that came first."""

    FIRST_COME = "first-come"
    RELATIVE = "relative"
    ABSOLUTE = "absolute"

    @property
    def said(self) -> str:
        """The same in words."""
        return SAID[self]


SAID: Final = {
    Discipline.FIRST_COME: "first come, first served",
    Discipline.RELATIVE: "relative priorities: a service that has begun goes on to its end",
    Discipline.ABSOLUTE: "absolute priorities: a more urgent request interrupts, and what was begun goes on afterwards",
}


class Service(Section):
    """The processor that serves the tasks on demand, and how long they may wait for it."""

    speed_op_s: float = setting(120_000.0, "op/s", 1.0, 1e15, "speed of the processor", f"{SPEED}: with feedback")
    discipline: Discipline = Field(
        Discipline.RELATIVE, strict=False, description="who is next; with priorities, 1 is the most urgent"
    )
    mean_wait_s: float = setting(0.01, "s", 1e-9, 1e6, "longest mean wait for the begin of service", SPEED)
    long_wait_s: float = setting(0.1, "s", 1e-9, 1e6, "what counts as a long wait", SPEED)
    long_wait_share: float = setting(0.001, "1", 1e-6, 0.5, "share of requests that may wait longer", SPEED)
    simulated_requests: int = setting(50_000, "1", 1000, 10_000_000, "requests of the simulation beside the formulas")


@dataclass(frozen=True)
class MeanWait:
    """Means of one task, s: from request to the begin of service, all the time without service, request to end.

    `start_s` and `wait_s` differ only where a service can be interrupted; `sojourn_s` is `wait_s` and the service.
    """

    task: str
    start_s: float
    wait_s: float
    sojourn_s: float


def mean_waits(streams: tuple[Stream, ...], discipline: Discipline) -> tuple[MeanWait, ...]:
    """The means of each stream, in the order of `streams`; `PlantError` if ρ ≥ 1.

    With W₀ = Σ λ_i E[S_i²]/2 and σ_k the load of the priorities up to k (σ₀ = 0, σ = ρ for all):

    - first come: W = W₀/(1 − ρ) (Pollaczek, Khinchine);
    - relative: W_k = W₀/[(1 − σ_{k−1})(1 − σ_k)] (Cobham 1954);
    - absolute: to the start Σ_{i≤k} λ_i E[S_i²]/2 / [(1 − σ_{k−1})(1 − σ_k)], and from there E[S]/(1 − σ_{k−1}).

    The first two stand in [hump-computer-1970s], chapter 3, the second in damaged print.
    """
    require_not_overloaded(streams)
    if discipline is Discipline.FIRST_COME:
        start_s = residual(streams) / (1.0 - total_load(streams))
        return tuple(_uninterrupted(stream, start_s) for stream in streams)
    found: dict[str, MeanWait] = {}
    ahead: tuple[Stream, ...] = ()
    for equals in by_priority(streams).values():
        upto = ahead + equals
        room = (1.0 - total_load(ahead)) * (1.0 - total_load(upto))
        for stream in equals:
            if discipline is Discipline.RELATIVE:
                found[stream.name] = _uninterrupted(stream, residual(streams) / room)
            else:
                found[stream.name] = _interrupted(stream, residual(upto) / room, total_load(ahead))
        ahead = upto
    return tuple(found[stream.name] for stream in streams)


def residual(streams: tuple[Stream, ...]) -> float:
    """Σ λ_i E[S_i²]/2, s."""
    return math.fsum(stream.residual_s for stream in streams)


def _uninterrupted(stream: Stream, start_s: float) -> MeanWait:
    return MeanWait(stream.name, start_s, start_s, start_s + stream.service.mean)


def _interrupted(stream: Stream, start_s: float, more_urgent: float) -> MeanWait:
    sojourn_s = start_s + stream.service.mean / (1.0 - more_urgent)
    return MeanWait(stream.name, start_s, sojourn_s - stream.service.mean, sojourn_s)
