"""Waits for humping against exact queues and a simulation that knows no formula."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.special import stdtrit

from plant_models.errors import PlantError
from synth.computer.economics.hump_queue import (
    HumpQueue,
    allen_cunneen_h,
    erlang_c,
    whitt_h,
)

Floats = NDArray[np.float64]

LAWS = (allen_cunneen_h, whitt_h)


def queue(load: float, arrival_scv: float = 1.0, service_scv: float = 1.0, leads: int = 1) -> HumpQueue:
    """A train takes a lead for 0.4 h."""
    return HumpQueue(load * leads / 0.4, arrival_scv, 0.4, service_scv, leads)


def kingman_bound_h(made: HumpQueue) -> float:
    """The mean wait on one lead is at most λ(σ_a² + σ_s²) / (2(1 − ρ)) for any arrivals (Kingman 1962)."""
    load = made.load
    return made.service_h * (made.arrival_scv / load + load * made.service_scv) / (2.0 * (1.0 - load))


def gamma_times(random: np.random.Generator, mean: float, scv: float, shape: tuple[int, int]) -> Floats:
    """Times with this mean and squared coefficient of variation."""
    return np.full(shape, mean) if scv == 0.0 else random.gamma(1.0 / scv, mean * scv, shape)


def simulated(made: HumpQueue, trains: int = 50_000, replicates: int = 24, seed: int = 3) -> tuple[float, float]:
    """Mean wait by Lindley's recursion and half its 95 % interval; a quarter of each replicate is run-up.

    W_{k+1} = max(0, W_k + S_k − A_k): the sum of S − A less its running minimum.
    """
    random = np.random.default_rng(seed)
    shape = replicates, trains
    service = gamma_times(random, made.service_h, made.service_scv, shape)
    between = gamma_times(random, 1.0 / made.trains_per_h, made.arrival_scv, shape)
    walk = np.cumsum(service - between, axis=1)
    wait = walk - np.minimum(np.minimum.accumulate(walk, axis=1), 0.0)
    means = wait[:, trains // 4 :].mean(axis=1)
    return float(means.mean()), float(stdtrit(replicates - 1, 0.975) * means.std(ddof=1) / math.sqrt(replicates))


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("load", [0.1, 0.5, 0.9])
def test_exact_waits(law: object, load: float) -> None:
    assert callable(law)
    assert law(queue(load)) == pytest.approx(0.4 * load / (1.0 - load), rel=1e-14)  # M/M/1: ρ/(μ − λ)
    assert law(queue(load, 1.0, 0.0)) == pytest.approx(0.4 * load / (2.0 * (1.0 - load)), rel=1e-14)  # M/D/1


def test_mean_wait_of_yard_facts() -> None:
    """Section 6: λ 0.825/s, 8000 operations at 120 000 a second, constant: 0.0019; exponential: 0.0039 s."""
    service = 8000.0 / 120000.0
    constant = HumpQueue(0.825, 1.0, service, 0.0)
    assert allen_cunneen_h(constant) == pytest.approx(0.0019, abs=5e-5)
    assert allen_cunneen_h(replace(constant, service_scv=1.0)) == pytest.approx(0.0039, abs=5e-5)


@pytest.mark.parametrize(("load", "service_scv"), [(0.5, 0.0), (0.7, 0.3), (0.85, 1.0), (0.7, 2.0)])
def test_poisson_trains_wait_as_simulated(load: float, service_scv: float) -> None:
    made = queue(load, 1.0, service_scv)
    wait, half = simulated(made)
    assert half < 0.05 * wait
    assert abs(whitt_h(made) - wait) < 1.5 * half  # 99.7 %, four cases


@pytest.mark.parametrize("load", [0.5, 0.8, 0.95])
@pytest.mark.parametrize("service_scv", [0.0, 0.3, 1.0])
def test_trains_that_come_in_bunches_wait_longer_than_told(load: float, service_scv: float) -> None:
    made = queue(load, 2.0, service_scv)
    wait, half = simulated(made)
    assert 0.8 * wait - 1.5 * half < whitt_h(made) < wait + 1.5 * half
    assert wait < kingman_bound_h(made) + 1.5 * half


def test_exact_wait_of_trains_by_timetable() -> None:
    """D/M/1: W = τσ/(1 − σ), σ = exp(−(1 − σ)/ρ) below 1."""
    for load in (0.5, 0.7, 0.9):
        sigma = float(brentq(lambda s, load=load: s - math.exp(-(1.0 - s) / load), 0.0, 1.0 - 1e-6))
        exact = 0.4 * sigma / (1.0 - sigma)
        made = queue(load, 0.0, 1.0)
        assert abs(whitt_h(made) - exact) < 0.06 * exact
        assert allen_cunneen_h(made) > 1.03 * exact, "Allen and Cunneen's is too long for even arrivals"


@pytest.mark.parametrize("leads", [2, 3])
def test_waits_on_several_leads(leads: int) -> None:
    """M/M/c from the balance of its states, summed up."""
    made = queue(0.8, leads=leads)
    offered = 0.8 * leads
    states = np.arange(400)
    rates = offered / np.minimum(states[1:], leads)
    p = np.concatenate([[1.0], np.cumprod(rates)])
    p /= p.sum()
    waiting = float((p * np.maximum(states - leads, 0)).sum())
    assert erlang_c(made) == pytest.approx(float(p[leads:].sum()), rel=1e-12)
    assert allen_cunneen_h(made) == pytest.approx(waiting / made.trains_per_h, rel=1e-12)  # Little


def test_limits() -> None:
    heavy = queue(0.9999, 0.4, 0.3)
    assert whitt_h(heavy) == pytest.approx(kingman_bound_h(heavy), rel=2e-3)
    assert whitt_h(queue(0.9, 0.0, 0.0)) == 0.0
    assert whitt_h(queue(0.0)) == 0.0
    for load in (0.95, 0.99):
        exact = 0.4 / (1.0 - math.sqrt(load)) ** 2
        assert queue(load).relaxation_h == pytest.approx(exact, rel=0.03)


def test_an_overloaded_hump_says_by_how_much() -> None:
    with pytest.raises(PlantError, match=r"2\.75 trains an hour come and fewer than 2\.5 .* load is 1\.1 "):
        queue(1.1)
    with pytest.raises(PlantError, match="overloaded"):
        queue(1.0)
