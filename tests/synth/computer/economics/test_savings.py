"""Work of a hump, waits for it, and what is saved.

Work and savings of a yard against sums over drawn trains, against counts by hand, and in their limits.
Waits for humping against exact queues and a simulation that knows no formula.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.special import stdtrit

from plant_models.errors import PlantError
from synth.computer.economics.economic_case import operating_savings, released_capital, total
from synth.computer.economics.hump_work import HumpQueue, allen_cunneen_h, erlang_c, hump_queue, hump_work, whitt_h
from synth.computer.economics.traffic import RATES, HumpChange, HumpRates, rates_after
from synth.frame.settings.settings_file import changed
from tests.synth.computer.economics.made_cases import CHANGE, HANDLING, PRICES, TODAY, TRAFFIC


def hump_rates(*figures: float) -> HumpRates:
    """The figures in their order."""
    return HumpRates(**dict(zip(RATES, figures, strict=True)))


def test_work_of_a_day_is_that_of_drawn_trains() -> None:
    """Trains one by one: cars, times over the crest, locomotive hours, gaps, and the queue by Lindley's recursion."""
    random, n = np.random.default_rng(7), 400_000
    k = (TRAFFIC.cars_per_train / TRAFFIC.cars_per_train_std) ** 2
    cars = random.gamma(k, TRAFFIC.cars_per_train / k, n)
    between = random.gamma((0.1 / 0.03) ** 2, 0.03**2 / 0.1, n)
    humping = cars / TODAY.cars_per_h
    gap = cars / 1.8 * TODAY.on_track * TODAY.gap_m
    misrouted = cars / 1.8 * TODAY.misrouted
    extra = 0.3 * (gap * 1e-4 + misrouted * 0.25)
    walk = np.cumsum(humping + between + extra - random.exponential(24.0 / TRAFFIC.trains_per_day, n))
    wait = walk - np.minimum(np.minimum.accumulate(walk), 0.0)
    found = hump_work(TODAY, TRAFFIC, HANDLING)
    a_day = TRAFFIC.trains_per_day
    assert found.load == pytest.approx(float((humping + between + extra).mean()) * a_day / 24.0, rel=2e-3)
    service = humping + between + extra
    told = hump_queue(TODAY, TRAFFIC, HANDLING).service_scv
    assert told == pytest.approx(float(service.var() / service.mean() ** 2), rel=0.015)  # 0.3 % is its standard error
    assert found.car_h_humping == pytest.approx(a_day * float((cars * humping).mean()), rel=3e-3)
    assert found.locomotive_h_humping == pytest.approx(a_day * float((humping + between).mean()), rel=2e-3)
    assert found.locomotive_h_pushing_up == pytest.approx(a_day * 1e-4 * float(gap.mean()), rel=2e-3)
    blocks = wait[n // 20 :].reshape(20, -1).mean(axis=1)
    assert abs(found.wait_h - blocks.mean()) < 3.0 * blocks.std(ddof=1) / math.sqrt(20)
    # Cars of a train wait with it, and a wait has nothing to do with the cars of the train itself.
    waited = a_day * float((cars * wait)[n // 20 :].mean())
    assert found.car_h_waiting == pytest.approx(waited, rel=3.0 * blocks.std(ddof=1) / math.sqrt(20) / found.wait_h)


def test_savings_by_hand() -> None:
    """One car a cut, trains by timetable of equal length, nothing else: everything can be counted."""
    traffic = changed(
        TRAFFIC, cars_per_day=2400.0, cars_per_train=50.0, cars_per_train_std=0.0, cars_per_cut=1.0, arrival_scv=0.0
    )
    handling = changed(HANDLING, between_trains_std_h=0.0, blocked_share=0.0)
    today = hump_rates(500.0, 0.01, 0.005, 0.9, 0.02, 0.06, 0.01, 80.0)
    new = hump_rates(625.0, 0.0, 0.0, 1.0, 0.02, 0.03, 0.0, 50.0)
    before, after = hump_work(today, traffic, handling), hump_work(new, traffic, handling)
    assert (before.wait_h, after.wait_h) == (0.0, 0.0)
    items = {each.name: each for each in operating_savings(before, after, traffic, PRICES, 1234.0)}
    by_hand = {
        "what does not depend on the work of the hump": 1234.0,
        "cars: shorter humping": 365 * 2400 * (0.1 - 0.08) * 0.5,
        "cars: shorter wait for humping": 0.0,
        "locomotive: shorter humping": 365 * 48 * (0.1 - 0.08) * 200.0,
        "locomotive: gaps pushed up": 365 * 2400 * (0.9 * 80 - 50) * 1e-4 * 200.0,
        "locomotive: cuts sorted again": 365 * 12 * 0.25 * 200.0,
        "damage: couplings to 1.5 m/s": 365 * 2400 * (0.018 - 0.02) * 2.0,
        "damage: couplings to 2 m/s": 365 * 2400 * (0.054 - 0.03) * 20.0,
        "damage: couplings above 2 m/s": 365 * 2400 * 0.009 * 300.0,
        "catch-ups": 365 * 24 * 50.0,
        "cuts sorted again, besides the locomotive": 365 * 12 * 30.0,
        "gaps pushed up, besides the locomotive": 365 * 2400 * (0.9 * 80 - 50) * 0.01,
    }
    assert {name: each.amount for name, each in items.items()} == pytest.approx(by_hand)
    assert total(tuple(items.values())) == pytest.approx(sum(by_hand.values()))
    cars, cargo = released_capital(before, after, traffic, PRICES)
    assert cars.quantity == pytest.approx(2400 * 0.02 / 24.0), "N·Δt/24"
    assert cargo.amount == pytest.approx(2400 * 0.02 / 24.0 * 0.6 * 50.0 * 600.0)


def test_each_improvement_saves() -> None:
    before = hump_work(TODAY, TRAFFIC, HANDLING)
    for name, step in (
        ("cars_per_h", 50.0), ("catch_ups", -5e-4), ("misrouted", -3e-4), ("over_speeds_to_1_5", -0.01),
        ("over_speeds_to_2", -0.01), ("over_speeds_above_2", -0.01), ("gap_m", -10.0),
    ):  # fmt: skip
        after = hump_work(rates_after(TODAY, HumpChange(**{name: step})), TRAFFIC, HANDLING)
        items = operating_savings(before, after, TRAFFIC, PRICES)
        assert total(items) > 0.0, name
        assert min(item.amount for item in items) >= -1e-9, name


def test_another_wait_law_is_asked() -> None:
    even = changed(TRAFFIC, arrival_scv=0.3)
    told = hump_work(TODAY, even, HANDLING, allen_cunneen_h).wait_h
    assert told == allen_cunneen_h(hump_queue(TODAY, even, HANDLING))
    assert told > hump_work(TODAY, even, HANDLING).wait_h


def test_changes_stay_within_what_is_possible() -> None:
    rare = rates_after(TODAY, HumpChange(catch_ups=-1.0, on_track=1.0, gap_m=-1e3))
    assert (rare.catch_ups, rare.on_track, rare.gap_m) == (0.0, 1.0, 0.0)
    with pytest.raises(PlantError, match="cars_per_h is -"):
        rates_after(TODAY, HumpChange(cars_per_h=-1000.0))


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: changed(PRICES, per_car=-1.0), "per_car is -1"),
        (lambda: changed(PRICES, currency=" "), "currency is"),
        (lambda: changed(TRAFFIC, cars_per_cut=80.0), "cars_per_cut is 80"),
        (lambda: changed(TRAFFIC, leads=0), "leads is 0"),
        (lambda: changed(TRAFFIC, loaded_share=1.1), "loaded_share is 1.1"),
        (lambda: changed(HANDLING, blocked_share=2.0), "blocked_share is 2"),
        (lambda: changed(TODAY, catch_ups=-0.1), "catch_ups is -0.1"),
        (lambda: changed(TODAY, cars_per_h=0.0), "cars_per_h is 0"),
        (lambda: changed(CHANGE, gap_m=math.nan), "gap_m is nan"),
    ],
)
def test_impossible_inputs(make: object, sentence: str) -> None:
    assert callable(make)
    with pytest.raises(PlantError, match=sentence):
        make()


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
