"""Periodic tasks under fixed priorities, with preemption: the longest response of each."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction


@dataclass(frozen=True)
class PeriodicTask:
    """Jobs at least `period_s` apart, each with `work_s` of processor time at most.

    A job may be let in up to `jitter_s` late; the response counts from when it should have been. Tasks of lower
    priority, or disabled interrupts, hold it up by `blocking_s` at most. `priority`: 1 is the most urgent. All
    times are worst cases.
    """

    name: str
    period_s: float
    work_s: float
    priority: int
    jitter_s: float = 0.0
    blocking_s: float = 0.0


def longest_responses_s(tasks: tuple[PeriodicTask, ...]) -> tuple[float, ...]:
    """The longest time of each task from when a job should come to its end, s; equal priorities wait for each other.

    The times are taken as the decimals that they print as, and computed with exactly, so no rounding moves a job
    across a release. `exact_load` must be below 1, or 1 where there is neither jitter nor blocking.
    """
    return tuple(float(_longest(task, tasks)) for task in tasks)


def exact_load(tasks: tuple[PeriodicTask, ...]) -> Fraction:
    """The share of the processor's time that all jobs take."""
    return sum((exact(task.work_s) / exact(task.period_s) for task in tasks), Fraction(0))


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
