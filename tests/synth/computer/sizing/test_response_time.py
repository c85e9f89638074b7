"""Response times: textbook sets, and every set of small random tasks against a schedule simulated tick by tick."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from synth.computer.sizing.carried_positions import PeriodicTask, longest_responses_s
from synth.computer.sizing.trackside_controllers import ScanCycle


def task(period: float, work: float, priority: int) -> PeriodicTask:
    """A task named by its priority."""
    return PeriodicTask(str(priority), period, work, priority)


Jobs = list[list[tuple[int, int]]]
"""For each task (when a job should come, when it is let in)."""


def together(tasks: tuple[PeriodicTask, ...], offsets: tuple[int, ...], until: int) -> Jobs:
    """The first jobs are let in at their `offsets`, as late as their jitter lets them be, all others in time."""
    return [
        [(start - late + turn * period, start if turn == 0 else max(start, start - late + turn * period))
         for turn in range((until + late) // period + 1)]
        for start, late, period in zip(
            offsets, (int(t.jitter_s) for t in tasks), (int(t.period_s) for t in tasks), strict=True
        )
    ]  # fmt: skip


def scheduled(tasks: tuple[PeriodicTask, ...], offsets: tuple[int, ...], until: int) -> list[int]:
    """The longest response of each task in a schedule with whole times: the most urgent job runs at each tick."""
    coming = together(tasks, offsets, until)
    jobs: list[list[int]] = []  # priority, let in, should come, rest, task
    longest = [0] * len(tasks)
    for now in range(until):
        for index, each in enumerate(tasks):
            jobs += [[each.priority, now, due, int(each.work_s), index] for due, let in coming[index] if let == now]
        if jobs:
            job = min(jobs)
            job[3] -= 1
            if job[3] == 0:
                longest[job[4]] = max(longest[job[4]], now + 1 - job[2])
                jobs.remove(job)
    return longest


@st.composite
def small_sets(draw: st.DrawFn) -> tuple[PeriodicTask, ...]:
    """Up to four tasks with whole times and a load of at most 1."""
    tasks: list[PeriodicTask] = []
    load = 0.0
    for priority in range(1, draw(st.integers(1, 4)) + 1):
        period, work = draw(st.sampled_from([4, 5, 6, 8, 10, 12, 15])), draw(st.integers(1, 6))
        if load + work / period > 1.0 - 1e-9:
            continue
        load += work / period
        tasks.append(task(period, work, priority))
    return tuple(tasks) or (task(4, 1, 1),)


@given(small_sets())
def test_the_longest_response_is_that_of_the_schedule_where_all_come_together(tasks: tuple[PeriodicTask, ...]) -> None:
    hyperperiod = math.lcm(*(int(each.period_s) for each in tasks))
    found = list(longest_responses_s(tasks))
    assert found == scheduled(tasks, (0,) * len(tasks), hyperperiod + 1)


SECOND_JOB = (task(8, 1, 1), task(10, 2, 2), task(8, 2, 3), task(12, 5, 4))
"""With the jitter below, the second job of the last task is the slowest: a search found it."""


@example(SECOND_JOB, [8, 8, 0, 9])
@given(small_sets(), st.lists(st.integers(0, 9), min_size=4, max_size=4))
def test_with_jitter_the_longest_response_is_that_after_the_latest_release(
    tasks: tuple[PeriodicTask, ...], late: list[int]
) -> None:
    jittery = tuple(replace(each, jitter_s=float(j)) for each, j in zip(tasks, late, strict=False))
    load = sum(each.work_s / each.period_s for each in jittery)
    if load < 0.999:
        hyperperiod = math.lcm(*(int(each.period_s) for each in jittery))
        found = list(longest_responses_s(jittery))
        assert found == scheduled(jittery, (0,) * len(jittery), 3 * hyperperiod + int(max(found)) + 1)


def test_tasks_of_equal_priority_wait_for_each_other() -> None:
    assert list(longest_responses_s((task(20, 2, 1), task(20, 3, 1)))) == [5, 5]


@given(small_sets(), st.integers(0, 2**32 - 1))
def test_no_other_phases_are_worse(tasks: tuple[PeriodicTask, ...], seed: int) -> None:
    offsets = tuple(int(o) for o in np.random.default_rng(seed).integers(0, 15, len(tasks)))
    hyperperiod = math.lcm(*(int(each.period_s) for each in tasks))
    for longest, seen in zip(longest_responses_s(tasks), scheduled(tasks, offsets, 2 * hyperperiod + 20), strict=True):
        assert seen <= longest


def test_jitter_and_blocking_by_hand() -> None:
    urgent = PeriodicTask("urgent", 10.0, 2.0, 1, jitter_s=1.0, blocking_s=3.0)
    other = PeriodicTask("other", 20.0, 7.0, 2)
    first, second = longest_responses_s((urgent, other))
    assert first == 1.0 + 3.0 + 2.0
    # w = 7 + ⌈(w + 1)/10⌉ 2: 9 → 7 + 2 = 9, where (9 + 1)/10 is 1 exactly
    assert second == 9.0
    assert longest_responses_s((replace(urgent, jitter_s=1.01), other))[1] == 11.0


def test_decimals_are_taken_as_they_are_written() -> None:
    # 0.3 = 3 · 0.1 in decimals, not in binary: a float would count a fourth release
    urgent, other = task(0.1, 0.05, 1), task(1.0, 0.15, 2)
    assert longest_responses_s((urgent, other))[1] == 0.3


def test_a_processor_may_be_used_up() -> None:
    assert longest_responses_s((task(4, 2, 1), task(4, 2, 2))) == (2, 4)


def test_the_scan_response_is_the_worst_of_all_moments() -> None:
    scan, work_s = ScanCycle(0.010, 0.001, 0.003, 0.002), 0.004
    worst = 0.0
    for change_s in np.linspace(0.0, 0.01, 2001):
        seen_s = change_s + 0.003
        read_s = 0.010 * math.ceil(seen_s / 0.010 - 1e-12)  # inputs are read when a cycle begins
        worst = max(worst, read_s + 0.001 + work_s + 0.002 - change_s)
    assert scan.longest_response_s(work_s) == pytest.approx(worst, abs=1e-5)
    assert scan.longest_response_s(0.0091) == math.inf
    assert scan.fits(0.009)
    assert scan.used_share(work_s) == pytest.approx(0.5)
