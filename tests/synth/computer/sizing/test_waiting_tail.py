"""Tails of the wait: closed forms against exact fractions, inversion against closed forms, transforms against means."""

from __future__ import annotations

import math
from decimal import Decimal, localcontext

import numpy as np
import pytest

from plant_models.errors import PlantError
from synth.computer.sizing.demand_service import Discipline, mean_waits
from synth.computer.sizing.laplace_inversion import inverted
from synth.computer.sizing.service_law import Complexes, Constant, Exponential
from synth.computer.sizing.task import Stream
from synth.computer.sizing.waiting_tail import (
    constant_tail,
    exponential_tail,
    sojourn_tail,
    start_tail,
    survival,
)
from synth.computer.sizing.waiting_transform import delayed, sojourn_law, start_law
from tests.synth.computer.sizing.mixes import EXPONENTIAL, MIXED

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


@pytest.mark.parametrize("discipline", list(Discipline))
def test_the_integral_of_each_tail_is_the_mean(discipline: Discipline) -> None:
    # t = e^x, trapezium: the ends are flat, so it converges fast; the kink of the constant service limits it
    nodes = np.arange(-8.0, 5.6, 0.2)
    wait = mean_waits(MIXED, discipline)[2]
    tails = [start_tail(MIXED, discipline, wait.task, math.exp(x)).value * math.exp(x) for x in nodes]
    assert 0.2 * sum(tails) == pytest.approx(wait.start_s, rel=1e-3)


def test_busy_period_of_exponential_service_is_known() -> None:
    # z = s + λ(1 − θ), and θ of M/M/1 in closed form
    stream, s = Stream("a", 0.6, Exponential(1.0), 1), np.array([0.05 + 0.3j, 1.0 + 0j, 3.0 - 8.0j])
    root = np.sqrt((s + 1.6) ** 2 - 4.0 * 0.6)
    busy = (s + 1.6 - root) / 1.2
    assert np.allclose(delayed(s, (stream,)), s + 0.6 * (1.0 - busy), rtol=1e-12)


def test_priorities_that_do_not_differ_give_the_tail_of_first_come() -> None:
    alike = tuple(Stream(s.name, s.rate_per_s, s.service, 1) for s in MIXED)
    first = start_tail(alike, Discipline.FIRST_COME, "hyper", 2.0)
    for discipline in (Discipline.RELATIVE, Discipline.ABSOLUTE):
        assert start_tail(alike, discipline, "hyper", 2.0).value == pytest.approx(first.value, abs=1e-9)


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
