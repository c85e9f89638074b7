"""Work and savings of a yard against sums over drawn trains, against counts by hand, and in their limits."""

from __future__ import annotations

import math

import numpy as np
import pytest

from plant_models.errors import PlantError
from synth.computer.economics.hump_queue import allen_cunneen_h
from synth.computer.economics.hump_rates import RATES, HumpChange, HumpRates, rates_after
from synth.computer.economics.hump_work import hump_queue, hump_work
from synth.computer.economics.savings import operating_savings, released_capital, total
from synth.frame.settings.changed import changed
from tests.synth.computer.economics.made_cases import CHANGE, HANDLING, PRICES, TODAY, TRAFFIC

NEW = rates_after(TODAY, CHANGE)


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


def test_nothing_changed_saves_nothing() -> None:
    same = hump_work(TODAY, TRAFFIC, HANDLING)
    assert total(operating_savings(same, same, TRAFFIC, PRICES)) == 0.0
    assert total(released_capital(same, same, TRAFFIC, PRICES)) == 0.0


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


def test_a_shorter_wait_counts_most_where_the_hump_is_full() -> None:
    waits = []
    for cars in (1200.0, 3000.0, 4800.0):
        traffic = changed(TRAFFIC, cars_per_day=cars)
        before, after = (hump_work(rates, traffic, HANDLING) for rates in (TODAY, NEW))
        waits.append(before.wait_h - after.wait_h)
    assert waits[0] < waits[1] < waits[2]


def test_twenty_thousand_cars_a_day_need_more_leads() -> None:
    """The largest traffic of [hump-computer-1970s] is more than 736 cars an hour can hump on one lead."""
    most = changed(TRAFFIC, cars_per_day=20_000.0)
    with pytest.raises(PlantError, match="overloaded"):
        hump_work(NEW, most, HANDLING)
    found = hump_work(NEW, changed(most, leads=4), HANDLING)
    assert 0.5 < found.load < 1.0


def test_released_capital_grows_as_in_the_source() -> None:
    """[hump-computer-1970s]: 240 thousand roubles at 5000 cars a day, 1000 at 20 000: 48 and 50 roubles per daily car.

    So its Δt hardly depends on the traffic; without waits ours, N·Δt/24, does not either.
    """
    even = changed(TRAFFIC, cars_per_train_std=0.0, arrival_scv=0.0)
    calm = changed(HANDLING, between_trains_std_h=0.0)
    capital = []
    for cars, leads in ((5000.0, 1), (20_000.0, 4)):
        traffic = changed(even, cars_per_day=cars, leads=leads)
        before, after = (hump_work(rates, traffic, calm) for rates in (TODAY, NEW))
        capital.append(total(released_capital(before, after, traffic, PRICES)))
    assert capital[1] / capital[0] == pytest.approx(4.0)
    assert capital[1] / capital[0] == pytest.approx(1000.0 / 240.0, rel=0.05)


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
