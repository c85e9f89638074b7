"""Laws of service, tails of waits, and the speed that keeps them.

Laws of service: moments against the derivatives of the transform and against draws.
Tails of the wait: closed forms against exact fractions, inversion against closed forms, transforms against means.
The speed that is needed, cyclic and on demand, and the 16 bits of [hump-computer-1970s], chapter 3.
"""

from __future__ import annotations

import math
from decimal import Decimal, localcontext

import numpy as np
import pytest

from plant_models.errors import PlantError
from scripts.studies.control_computer.published_sizes import SOURCE_WORD_BITS, source_memory
from synth.computer.sized_computer import AllowedWait, largest_tail, longest_mean_s, needed_speed
from synth.computer.sizing.counted_needs import Memory, common_word_bits, hump_quantities
from synth.computer.sizing.service import Cycle, Discipline, cyclic_speed, mean_waits
from synth.computer.sizing.task import (
    Complexes,
    Constant,
    Erlang,
    Exponential,
    Hyperexponential,
    ServiceLaw,
    Stream,
    Task,
    TaskMix,
)
from synth.computer.sizing.waiting_tail import (
    constant_tail,
    delayed,
    exponential_tail,
    inverted,
    sojourn_law,
    sojourn_tail,
    start_law,
    start_tail,
    survival,
)
from synth.frame.settings.settings_file import changed
from tests.synth.computer.sizing.test_demand_service import EXPONENTIAL, MIXED

LAWS: tuple[ServiceLaw, ...] = (
    Constant(2.0),
    Erlang(2.0, 1),
    Erlang(2.0, 4),
    Exponential(2.0),
    Hyperexponential(2.0, 1.5),
    Hyperexponential(2.0, 9.0),
)


def squared_cv(law: ServiceLaw) -> float:
    """The squared coefficient of variation, Var X / E[X]²."""
    return law.second_moment / law.mean**2 - 1.0


@pytest.mark.parametrize("law", LAWS, ids=repr)
def test_moments_are_the_derivatives_of_the_transform(law: ServiceLaw) -> None:
    # the n-th derivative at 0 by Cauchy's integral on a circle inside the region where the transform is analytic
    radius, points = 0.02, 64
    angles = 2.0 * math.pi * np.arange(points) / points
    values = law.transform(radius * np.exp(1j * angles))
    first = float(np.mean(values * np.exp(-1j * angles)).real) / radius
    second = 2.0 * float(np.mean(values * np.exp(-2j * angles)).real) / radius**2
    assert -first == pytest.approx(law.mean, rel=1e-11)
    assert second == pytest.approx(law.second_moment, rel=1e-9)
    assert law.transform(np.zeros(1, dtype=np.complex128))[0] == pytest.approx(1.0)


@pytest.mark.parametrize("law", LAWS, ids=repr)
def test_draws_have_the_moments_and_the_transform(law: ServiceLaw) -> None:
    drawn, count = law.draw(np.random.default_rng(5), 400_000), 400_000
    for values, right in (
        (drawn, law.mean),
        (drawn**2, law.second_moment),
        (np.exp(-0.7 * drawn), law.transform(np.array([0.7 + 0j]))[0].real),
    ):
        assert abs(values.mean() - right) <= 4.0 * values.std() / math.sqrt(count) + 1e-12


@pytest.mark.parametrize("law", LAWS, ids=repr)
def test_a_scaled_law_is_the_law_of_scaled_amounts(law: ServiceLaw) -> None:
    s = np.array([0.3 + 0.8j, 4.0 - 1.0j])
    quarter = law.transform(np.asarray(0.25 * s, dtype=np.complex128))
    assert np.allclose(law.scaled(0.25).transform(s), quarter, rtol=1e-14)
    assert law.scaled(0.25).mean == pytest.approx(0.5)
    assert squared_cv(law.scaled(0.25)) == pytest.approx(squared_cv(law))


def test_a_hyperexponential_law_varies_more_than_an_exponential_one() -> None:
    with pytest.raises(PlantError, match=r"squared_cv is 1\.0"):
        Hyperexponential(1.0, 1.0)


TIMES_S = (0.1, 0.5, 0.999, 1.0, 1.001, 1.7, 2.0, 3.5, 8.0, 20.0, 60.0)


def erlang_form(rate: float, wait_s: float) -> float:
    """P(W > t) of M/D/1, service 1, by Erlang's alternating sum, with 120 digits."""
    with localcontext() as context:
        context.prec = 120
        one, by = Decimal(rate), Decimal(wait_s)
        terms = [(one * (j - by)) ** j / math.factorial(j) * (one * (by - j)).exp() if j else (one * by).exp()
                 for j in range(math.floor(wait_s) + 1)]  # fmt: skip
        return float(1 - (1 - one) * sum(terms))


@pytest.mark.parametrize("load", [0.055, 0.5, 0.8, 0.95])
@pytest.mark.parametrize("wait_s", [0.0, 0.5, 1.0, 2.5, 8.0, 40.0])
def test_the_closed_form_of_constant_service_is_erlangs(load: float, wait_s: float) -> None:
    assert constant_tail(load, 1.0, wait_s) == pytest.approx(erlang_form(load, wait_s), abs=3e-14)


@pytest.mark.parametrize("time_s", TIMES_S)
@pytest.mark.parametrize("load", [0.2, 0.8])
def test_inversion_agrees_with_the_closed_forms_within_its_own_error(load: float, time_s: float) -> None:
    for law, right in (
        (Constant(1.0), constant_tail(load, 1.0, time_s)),
        (Exponential(1.0), exponential_tail(load, 1.0, time_s)),
    ):
        streams = (Stream("a", load, law, 1),)
        found = survival(start_law(streams, Discipline.FIRST_COME, "a"), time_s)
        assert abs(found.value - right) <= found.error
        assert found.error < 1e-5  # at the kink of constant service; elsewhere far less


def test_inversion_of_known_functions() -> None:
    for time_s in (0.01, 1.0, 30.0):
        found = inverted(lambda s: 1.0 / (1.0 + s), time_s)
        assert abs(found.value - math.exp(-time_s)) <= found.error < 1e-9
        found = inverted(lambda s: (s + 2.0) / ((s + 2.0) ** 2 + 9.0), time_s)  # it changes sign: |f| ≤ 1
        assert abs(found.value - math.exp(-2.0 * time_s) * math.cos(3.0 * time_s)) <= found.error < 1e-9


@pytest.mark.parametrize("discipline", list(Discipline))
@pytest.mark.parametrize("streams", [EXPONENTIAL, MIXED])
def test_the_derivative_of_each_transform_is_the_mean(streams: tuple[Stream, ...], discipline: Discipline) -> None:
    step = 1e-5
    s: Complexes = np.array([step, 2.0 * step], dtype=np.complex128)
    for wait in mean_waits(streams, discipline):
        for law, mean in (
            (start_law(streams, discipline, wait.task), wait.start_s),
            (sojourn_law(streams, discipline, wait.task), wait.sojourn_s),
        ):
            one, two = ((1.0 - law.transform(s)) / s).real
            assert 2.0 * one - two == pytest.approx(mean, rel=1e-5)


def test_busy_period_of_exponential_service_is_known() -> None:
    # z = s + λ(1 − θ), and θ of M/M/1 in closed form
    stream, s = Stream("a", 0.6, Exponential(1.0), 1), np.array([0.05 + 0.3j, 1.0 + 0j, 3.0 - 8.0j])
    root = np.sqrt((s + 1.6) ** 2 - 4.0 * 0.6)
    busy = (s + 1.6 - root) / 1.2
    assert np.allclose(delayed(s, (stream,)), s + 0.6 * (1.0 - busy), rtol=1e-12)


def test_the_sojourn_of_mm1_is_exponential() -> None:
    streams = (Stream("a", 0.7, Exponential(1.0), 1),)
    for time_s in (0.3, 2.0, 10.0):
        found = sojourn_tail(streams, Discipline.FIRST_COME, "a", time_s)
        assert abs(found.value - math.exp(-0.3 * time_s)) <= found.error


def test_bad_questions_are_refused() -> None:
    with pytest.raises(PlantError, match="task is 'nobody'"):
        start_tail(MIXED, Discipline.RELATIVE, "nobody", 1.0)
    with pytest.raises(PlantError, match="overloaded"):
        start_tail((Stream("a", 1.0, Constant(1.0), 1),), Discipline.FIRST_COME, "a", 1.0)


RATE_PER_S = 0.825
CYCLE = Cycle()
"""(1 − δ)/(1 + α) = 0.5, however it is divided."""
ALLOWED = AllowedWait(mean_s=0.01, long_s=0.1, share=0.001)


def one_task(law: ServiceLaw) -> TaskMix:
    """All requests as one task."""
    return TaskMix((Task("all", RATE_PER_S, law),))


@pytest.mark.parametrize(("operations", "speed_op_s"), [(10_000, 20_000), (500_000, 1_000_000)])
def test_cyclic_speeds(operations: float, speed_op_s: float) -> None:
    assert cyclic_speed(changed(CYCLE, operations=operations)) == pytest.approx(speed_op_s)
    assert cyclic_speed(Cycle(operations=operations, check_share=0.0, recovery_share=0.5)) == pytest.approx(speed_op_s)


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
def test_cycles_that_cannot_be_are_refused(make: type, words: str) -> None:
    with pytest.raises(PlantError, match=words):
        make()
