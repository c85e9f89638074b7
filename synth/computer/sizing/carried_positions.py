"""Periodic tasks under fixed priorities, with preemption, the longest response of each; and how many retarder
positions a controller carries.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction

from plant_models.library.sourced_value import JUDGEMENT
from synth.computer.sizing.trackside_controllers import TracksideController
from synth.frame.settings.section import Section, setting


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


MOST_POSITIONS = 1_000_000


class PositionTimes(Section):
    """What every retarder position asks of the controller at the track."""

    sample_s: float = setting(0.1, "s", 1e-4, 10.0, "sampling period", "of the library's radar")
    answer_s: float = setting(0.02, "s", 1e-4, 10.0, "time to a command", "computing delay of the library's radar")
    cut_s: float = setting(
        2.0, "s", 0.1, 1000.0, "shortest time between two cuts", f"{JUDGEMENT}: as cuts are kept apart"
    )
    table_s: float = setting(0.1, "s", 1e-4, 100.0, "time to choose a table for a cut", f"{JUDGEMENT}: one sample")


@dataclass(frozen=True)
class Carried:
    """So many positions on one controller: the longest times to an answer and to a table, s (inf: not all is done).

    `used_share`: of the processor's time, or of the worst scan.
    """

    positions: int
    times: PositionTimes
    answer_s: float
    table_s: float
    used_share: float

    @property
    def answer_margin_s(self) -> float:
        """What is left to the deadline of a sample; negative if it can be missed."""
        return self.times.answer_s - self.answer_s

    @property
    def in_time(self) -> bool:
        """Whether no deadline is ever missed."""
        return self.answer_s <= self.times.answer_s and self.table_s <= self.times.table_s


def carried(controller: TracksideController, times: PositionTimes, positions: int) -> Carried:
    """The longest responses with so many positions, which may all have a sample and a cut at the same moment.

    In a scan all of that is one program. Else samples are more urgent than cuts; the positions of one kind are served
    one after the other, so together they are one task with the work of all, whose response is that of the last. The
    choice for one position is not interrupted, since a sample must not see half a table: it blocks.
    """
    if controller.scan is not None:
        work_s = positions * (controller.sample_s + controller.cut_s)
        longest_s = controller.scan.longest_response_s(work_s)
        return Carried(positions, times, longest_s, longest_s, controller.scan.used_share(work_s))
    samples, cuts = _tasks(controller, times, positions)
    used = exact_load((samples, cuts))
    if used >= 1:
        return Carried(positions, times, math.inf, math.inf, float(used))
    answer_s, table_s = longest_responses_s((samples, cuts))
    return Carried(positions, times, answer_s, table_s, float(used))


def most_positions(controller: TracksideController, times: PositionTimes) -> int:
    """The largest number of positions that never misses a deadline; 0 if not even one is in time.

    More positions make every response longer, so the number is found by bisection; at most `MOST_POSITIONS`.
    """
    if not carried(controller, times, 1).in_time:
        return 0
    low, high = 1, 2
    while high <= MOST_POSITIONS and carried(controller, times, high).in_time:
        low, high = high, 2 * high
    high = min(high, MOST_POSITIONS + 1)
    while high - low > 1:
        middle = (low + high) // 2
        if carried(controller, times, middle).in_time:
            low = middle
        else:
            high = middle
    return low


def _tasks(controller: TracksideController, times: PositionTimes, positions: int) -> tuple[PeriodicTask, PeriodicTask]:
    """All samples, all cuts."""
    latency_s = controller.latency_s
    samples = PeriodicTask(
        name="samples",
        period_s=times.sample_s,
        work_s=positions * controller.sample_s,
        priority=1,
        jitter_s=latency_s,
        blocking_s=controller.cut_s,
    )
    cuts = PeriodicTask(
        name="cuts",
        period_s=times.cut_s,
        work_s=positions * controller.cut_s,
        priority=2,
        jitter_s=latency_s,
    )
    return samples, cuts
