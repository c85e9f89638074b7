"""Periodic tasks under fixed priorities, with preemption: the longest response of each, and whether deadlines hold."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction

from plant_models.errors import require
from synth.computer.sizing.periodic_task import PeriodicTask


@dataclass(frozen=True)
class Response:
    """The longest time from when a job of `task` should come to its end, s."""

    task: PeriodicTask
    longest_s: float

    @property
    def margin_s(self) -> float:
        """What is left to the deadline; negative if it can be missed."""
        return self.task.deadline_s - self.longest_s

    @property
    def in_time(self) -> bool:
        """Whether no job ever misses its deadline."""
        return self.longest_s <= self.task.deadline_s

    @property
    def sentence(self) -> str:
        """The verdict, in words."""
        times = f"{self.task.name}: at most {self.longest_s:.6g} s, deadline {self.task.deadline_s:.6g} s"
        if self.in_time:
            return f"{times}: kept, with {self.margin_s:.6g} s to spare"
        return f"{times}: can be missed by {-self.margin_s:.6g} s"


def responses(tasks: tuple[PeriodicTask, ...]) -> tuple[Response, ...]:
    """The longest response of each task, in the order of `tasks`; tasks of equal priority count as ahead of each other.

    The times are taken as the decimals that they print as, and computed with exactly, so no rounding moves a job
    across a release. `PlantError` if the processor has too little time for all jobs.
    """
    require(len(tasks) > 0, "response times: there is no task; there must be at least one")
    load = exact_load(tasks)
    require(
        load <= 1,
        f"the processor is overloaded: its tasks take {float(load):.6g} of its time, "
        f"{100.0 * float(load - 1):.4g} % more than there is",
    )
    require(
        load < 1 or not _held_up(tasks),
        "the processor has no time left: its tasks take all of it, so jitter or blocking is never made up for",
    )
    return tuple(Response(task, float(_longest(task, tasks))) for task in tasks)


def exact_load(tasks: tuple[PeriodicTask, ...]) -> Fraction:
    """The share of the processor's time that all jobs take."""
    return sum((exact(task.work_s) / exact(task.period_s) for task in tasks), Fraction(0))


def _held_up(tasks: tuple[PeriodicTask, ...]) -> bool:
    """Whether any has jitter or blocking."""
    return any(task.jitter_s > 0.0 or task.blocking_s > 0.0 for task in tasks)


def exact(value: float) -> Fraction:
    """The shortest decimal that reads back as `value`."""
    return Fraction(repr(float(value)))


def _longest(task: PeriodicTask, tasks: tuple[PeriodicTask, ...]) -> Fraction:
    """max over the jobs q = 0, 1, … of the busy period of w(q) − qT + J.

    w(q) = (q + 1) C + B + Σ_{j ahead} ⌈(w(q) + J_j)/T_j⌉ C_j is the least root, from the begin of the period. It is
    the equation of Joseph and Pandya (1986) with the jitter and blocking of Audsley and others (1993); several jobs
    after Lehoczky (1990). The busy period ends with the first job that is done before the next can come.
    """
    work, period, jitter = exact(task.work_s), exact(task.period_s), exact(task.jitter_s)
    ahead = [
        (exact(other.work_s), exact(other.period_s), exact(other.jitter_s))
        for other in tasks
        if other is not task and other.priority <= task.priority
    ]
    own, jobs, longest = exact(task.blocking_s), 0, Fraction(0)
    end = own + work
    while True:
        own += work
        end = _least_root(max(end, own), own, ahead)
        longest = max(longest, end - jobs * period + jitter)
        jobs += 1
        if end <= jobs * period - jitter:
            return longest


def _least_root(first: Fraction, own: Fraction, ahead: list[tuple[Fraction, Fraction, Fraction]]) -> Fraction:
    """The least w ≥ `first` with w = own + Σ ⌈(w + J)/T⌉ C, by iteration from below."""
    end = first
    while True:
        new = own + sum((math.ceil((end + jitter) / period) * work for work, period, jitter in ahead), Fraction(0))
        if new <= end:
            return end
        end = new
