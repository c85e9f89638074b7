"""The figures of [hump-computer-1970s], chapter 3, beside ours: cyclic, on demand, which law, priorities, 16 bits."""

from __future__ import annotations

import pytest

from plant_models.errors import PlantError
from scripts.studies.control_computer.published_sizes import SOURCE_WORD_BITS, source_memory
from scripts.studies.control_computer.published_speeds import operations_for_use
from synth.computer.sizing.cyclic_service import Cycle, cyclic_speed, used_share
from synth.computer.sizing.demand_service import Discipline, mean_waits
from synth.computer.sizing.memory_need import Memory
from synth.computer.sizing.needed_speed import AllowedWait, largest_tail, longest_mean_s, needed_speed
from synth.computer.sizing.service_law import Constant, Erlang, Exponential, Hyperexponential, ServiceLaw
from synth.computer.sizing.task import Task, TaskMix
from synth.computer.sizing.word_length import common_word_bits, hump_quantities
from synth.frame.settings.changed import changed

RATE_PER_S = 0.825
CYCLE = Cycle()
"""(1 − δ)/(1 + α) = 0.5, however it is divided."""

ALLOWED = AllowedWait(mean_s=0.01, long_s=0.1, share=0.001)


def one_task(law: ServiceLaw) -> TaskMix:
    """All requests as one task."""
    return TaskMix((Task("all", RATE_PER_S, law),))


def kept(law: ServiceLaw, speed_op_s: float) -> tuple[bool, bool]:
    """Whether the mean wait is below 0.01 s, and P(W > 0.1 s) at most 0.001."""
    mix = one_task(law)
    return (
        longest_mean_s(mix, Discipline.FIRST_COME, speed_op_s) < 0.01,
        largest_tail(mix, Discipline.FIRST_COME, speed_op_s, 0.1) <= 0.001,
    )


@pytest.mark.parametrize(("operations", "speed_op_s"), [(10_000, 20_000), (500_000, 1_000_000)])
def test_cyclic_speeds(operations: float, speed_op_s: float) -> None:
    assert cyclic_speed(changed(CYCLE, operations=operations)) == pytest.approx(speed_op_s)
    assert cyclic_speed(Cycle(operations=operations, check_share=0.0, recovery_share=0.5)) == pytest.approx(speed_op_s)


def test_a_use_of_7_to_8_percent_is_of_another_mix_than_the_waits() -> None:
    found = {
        (speed, checks): [operations_for_use(share, speed, RATE_PER_S, CYCLE, checks) for share in (0.07, 0.08)]
        for speed in (20_000.0, 1e6)
        for checks in (True, False)
    }
    assert found[20_000.0, True] + found[20_000.0, False] == pytest.approx([848, 970, 1697, 1939], abs=1)
    assert found[1e6, True] + found[1e6, False] == pytest.approx([42_424, 48_485, 84_848, 96_970], abs=1)
    # such requests do not even fit a mean wait of 0.01 s at the speeds that the source gives for it
    for operations, speed in ((848.0, 1500.0), (42_424.0, 120_000.0)):
        assert longest_mean_s(one_task(Constant(operations)), Discipline.FIRST_COME, speed) > 0.05
    share = used_share(one_task(Constant(8000.0)), 1e6, CYCLE, checks_count=True)
    assert share == pytest.approx(2 * 0.825 * 8000 / 1e6)  # 1.3 %, not 7


def test_constant_service_keeps_both_claims_at_120000_and_exponential_does_not() -> None:
    assert kept(Constant(8000.0), 120_000.0) == (True, True)
    assert kept(Erlang(8000.0, 2), 120_000.0) == (True, False)
    assert kept(Exponential(8000.0), 120_000.0) == (True, False)
    assert kept(Hyperexponential(8000.0, 3.0), 120_000.0) == (True, False)
    assert longest_mean_s(one_task(Constant(8000.0)), Discipline.FIRST_COME, 120_000.0) == pytest.approx(
        0.00194, abs=5e-6
    )
    assert largest_tail(one_task(Constant(8000.0)), Discipline.FIRST_COME, 120_000.0, 0.1) == pytest.approx(
        0.00044, abs=5e-6
    )
    assert largest_tail(one_task(Exponential(8000.0)), Discipline.FIRST_COME, 120_000.0, 0.1) == pytest.approx(
        0.0133, abs=5e-5
    )


@pytest.mark.parametrize(
    ("law", "by_mean", "by_tail"),
    [
        (Constant(1.0), 219.0, 113.5),
        (Erlang(1.0, 2), 181.0, 61.1),
        (Exponential(1.0), 158.0, 45.4),
        (Hyperexponential(1.0, 3.0), 113.2, 23.4),
    ],
)
def test_the_largest_request_that_1500_operations_a_second_carry(
    law: ServiceLaw, by_mean: float, by_tail: float
) -> None:
    # speed and operations have one ratio, so the speed for one operation gives the operations for a speed
    mix = one_task(law)
    assert 1500.0 / needed_speed(mix, Discipline.FIRST_COME, AllowedWait(mean_s=0.01)) == pytest.approx(by_mean, 3e-3)
    tail = AllowedWait(long_s=0.1, share=0.001)
    assert 1500.0 / needed_speed(mix, Discipline.FIRST_COME, tail) == pytest.approx(by_tail, 3e-3)


def test_the_needed_speed_just_meets_what_is_allowed() -> None:
    mix = TaskMix((Task("urgent", 0.5, Erlang(4000.0, 3), 1), Task("other", 0.325, Exponential(9000.0), 2)))
    for discipline in Discipline:
        speed = needed_speed(mix, discipline, ALLOWED)
        assert largest_tail(mix, discipline, speed, 0.1) == pytest.approx(0.001, rel=1e-4)
        assert longest_mean_s(mix, discipline, speed) < 0.01
        slow = needed_speed(mix, discipline, AllowedWait(mean_s=0.5))
        assert longest_mean_s(mix, discipline, slow) == pytest.approx(0.5, rel=1e-6)
        assert needed_speed(mix, discipline, AllowedWait(0.5, 0.1, 0.001)) == pytest.approx(speed)


def test_the_needed_speed_is_found_next_to_overload() -> None:
    mix = one_task(Exponential(1000.0))
    speed = needed_speed(mix, Discipline.FIRST_COME, AllowedWait(mean_s=1e5))
    # M/M/1: W = ρ/(μ − λ), a quadratic for μ
    assert longest_mean_s(mix, Discipline.FIRST_COME, speed) == pytest.approx(1e5, rel=1e-6)
    assert 825.0 < speed < 825.02


def test_priorities_hardly_matter_because_the_load_is_small() -> None:
    tasks = tuple(Task(f"position {k}", RATE_PER_S / 3, Constant(8000.0), k) for k in (1, 2, 3))
    streams = TaskMix(tasks).streams(120_000.0)
    first = mean_waits(streams, Discipline.FIRST_COME)[0].start_s
    relative = [wait.start_s / first for wait in mean_waits(streams, Discipline.RELATIVE)]
    load = RATE_PER_S * 8000 / 120_000
    right = [(1 - load) / ((1 - load * (k - 1) / 3) * (1 - load * k / 3)) for k in (1, 2, 3)]
    assert relative == pytest.approx(right, rel=1e-12)
    assert 0.96 < min(relative) < max(relative) < 1.04
    speeds = [needed_speed(TaskMix(tasks), each, AllowedWait(mean_s=0.01)) for each in Discipline]
    assert max(speeds) / min(speeds) < 1.15


def test_only_interruption_keeps_the_hump_speed_program_out_of_the_way() -> None:
    # a million operations a train, a train every ten minutes: 8.3 s each at 120 000 op/s
    mix = TaskMix((Task("control", RATE_PER_S, Constant(8000.0), 1), Task("hump speed", 1 / 600, Constant(1e6), 2)))
    streams = mix.streams(120_000.0)
    waits = {each: mean_waits(streams, each)[0].start_s for each in Discipline}
    assert waits[Discipline.ABSOLUTE] < 0.01
    assert waits[Discipline.RELATIVE] > 0.05
    assert waits[Discipline.FIRST_COME] > 0.05


def test_16_bits_and_the_memory_table() -> None:
    assert common_word_bits(hump_quantities()) <= SOURCE_WORD_BITS == 16
    memory = source_memory()
    assert memory.words(Memory.FIXED, 17) == 1800 <= 2000
    assert memory.words(Memory.WORKING, 53) == 1438 <= 2000


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: changed(CYCLE, cycle_s=0.0), r"cycle_s is 0\.0"),
        (lambda: changed(CYCLE, recovery_share=1.0), r"recovery_share is 1\.0"),
        (lambda: changed(CYCLE, check_share=-0.1), r"check_share is -0\.1"),
        (lambda: changed(CYCLE, operations=0.0), "operations is"),
    ],
)
def test_bad_questions_are_refused(make: type, words: str) -> None:
    with pytest.raises(PlantError, match=words):
        make()
