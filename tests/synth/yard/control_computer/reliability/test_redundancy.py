"""k of n with common causes: the cases that it must reduce to, closed forms, and simulated lives."""

from __future__ import annotations

from dataclasses import replace
from math import comb

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from plant_models import PlantError
from synth.yard.control_computer.reliability.duplex import Duplex, single_availability
from synth.yard.control_computer.reliability.redundancy import Redundant, Repaired

CASES = (Redundant(1, 2, 0.01, 0.1), Redundant(2, 3, 0.02, 0.05), Redundant(2, 4, 0.05), Redundant(3, 3, 0.01, 0.3))
systems = st.integers(1, 5).flatmap(
    lambda n: st.builds(Redundant, st.integers(1, n), st.just(n), st.floats(1e-4, 0.5), st.floats(0.0, 1.0))
)


@pytest.mark.parametrize("period_h", [0.5, 24.0, 2000.0])
def test_without_repair_it_reduces_to_what_is_known(period_h: float) -> None:
    """One computer; the duplex whose checks take no time; one as good as all where all causes are common."""
    one = float(single_availability(0.01, 0.0, period_h))
    assert Redundant(1, 1, 0.01).checked_availability(period_h) == pytest.approx(one, rel=1e-9)
    assert Redundant(1, 1, 0.01, 0.4).checked_availability(period_h) == pytest.approx(one, rel=1e-9)
    assert Redundant(2, 4, 0.01, 1.0).checked_availability(period_h) == pytest.approx(one, rel=1e-9)
    pair = float(Duplex(0.01, 0.0).availability(period_h))
    assert Redundant(1, 2, 0.01).checked_availability(period_h) == pytest.approx(pair, rel=1e-9)
    series = float(single_availability(0.03, 0.0, period_h))
    assert Redundant(3, 3, 0.01).checked_availability(period_h) == pytest.approx(series, rel=1e-9)


@given(systems, st.floats(0.0, 200.0))
def test_failed_after_is_the_sum_over_the_ready(system: Redundant, hours: float) -> None:
    q, n = np.exp(-system.own_per_h * hours), system.computers
    enough = sum(comb(n, j) * q**j * (1.0 - q) ** (n - j) for j in range(system.needed, n + 1))
    expected = 1.0 - np.exp(-system.common_per_h * hours) * enough
    assert float(system.failed_after(hours)) == pytest.approx(expected, abs=1e-12)


def test_small_unavailability_keeps_its_digits() -> None:
    """1 of n: (λx)ⁿ/(n + 1); with a common share β: βλx/2 on top of it."""
    x = 1e-5
    assert Redundant(1, 3, x).checked_unavailability(1.0) == pytest.approx(x**3 / 4.0, rel=1e-4)
    assert Redundant(1, 3, x, 0.1).checked_unavailability(1.0) == pytest.approx(0.1 * x / 2.0, rel=1e-4)


def lives(system: Redundant, n: int, seed: int) -> NDArray[np.float64]:
    """Hours (n,) until fewer than k of fresh computers are ready."""
    rng = np.random.default_rng(seed)
    own = np.sort(rng.exponential(1.0 / system.own_per_h, (n, system.computers)), axis=1)
    failing = own[:, system.computers - system.needed]
    if system.common_per_h > 0.0:
        failing = np.minimum(failing, rng.exponential(1.0 / system.common_per_h, n))
    return np.asarray(failing)


@pytest.mark.parametrize("system", CASES)
@pytest.mark.parametrize("period_h", [10.0, 60.0])
def test_without_repair_it_is_what_simulated_lives_give(system: Redundant, period_h: float) -> None:
    n = 200_000
    ready = np.minimum(lives(system, n, 2), period_h) / period_h
    assert abs(ready.mean() - system.checked_availability(period_h)) < 3.9 * ready.std() / np.sqrt(n)


def test_with_repair_one_computer_is_repair_over_both_rates() -> None:
    for share in (0.0, 0.3, 1.0):
        assert Repaired(Redundant(1, 1, 0.01, share), 0.5).availability == pytest.approx(0.5 / 0.51, rel=1e-12)


@pytest.mark.parametrize("crews", [1, 2, 4])
def test_with_repair_and_without_common_causes_it_is_birth_and_death(crews: int) -> None:
    """p_j = p_0·Π (n − i)λ/(min(i + 1, crews)·γ)."""
    n, rate, repair = 4, 0.1, 0.4
    steps = [(n - i) * rate / (min(i + 1, crews) * repair) for i in range(n)]
    weights = np.cumprod([1.0, *steps])
    found = Repaired(Redundant(2, n, rate), repair, crews)
    np.testing.assert_allclose(found.shares(), weights / weights.sum(), rtol=1e-10)
    assert found.availability == pytest.approx(weights[:3].sum() / weights.sum())
    assert found.unavailability == pytest.approx(weights[3:].sum() / weights.sum())


def test_with_as_many_crews_as_computers_each_is_alone() -> None:
    """Each is ready with γ/(λ + γ), independently of the others: the plain parallel case."""
    for rate in (0.1, 1e-6):
        found = Repaired(Redundant(1, 3, rate), 0.5, 3).unavailability
        assert found == pytest.approx((rate / (rate + 0.5)) ** 3, rel=1e-12, abs=0.0)


def up_and_down_h(found: Repaired, events: int, seed: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Hours up and hours in all of cycles, each from one entry into "all ready" to the next; every computer has its own
    clock, the common cause one more."""
    rng, of = np.random.default_rng(seed), found.redundant
    up, total, failed = [0.0], [0.0], 0
    draws = rng.exponential(1.0, (events, of.computers + 2))
    for own in draws:
        ready = of.computers - failed
        clocks = {"common": own[-1] / of.common_per_h if ready and of.common_per_h else np.inf}
        clocks["own"] = own[:ready].min(initial=np.inf) / of.own_per_h
        clocks["repaired"] = own[-2] / (min(failed, found.crews) * found.repair_per_h) if failed else np.inf
        first = min(clocks, key=lambda name: float(clocks[name]))
        total[-1] += clocks[first]
        up[-1] += clocks[first] * (ready >= of.needed)
        failed = {"common": of.computers, "own": failed + 1, "repaired": failed - 1}[first]
        if failed == 0:
            up.append(0.0)
            total.append(0.0)
    return np.array(up[:-1]), np.array(total[:-1])


@pytest.mark.parametrize(
    "found",
    [
        Repaired(Redundant(1, 2, 0.1, 0.2), 0.5),
        Repaired(Redundant(2, 3, 0.1, 0.1), 0.4, 2),
        Repaired(Redundant(1, 3, 0.3, 0.05), 0.5, 1),
    ],
)
def test_with_repair_it_is_what_simulated_lives_give(found: Repaired) -> None:
    up, total = up_and_down_h(found, 60_000, 9)
    residual = up - found.availability * total
    assert abs(residual.mean()) < 3.9 * residual.std() / np.sqrt(len(up))


@given(systems, st.floats(0.01, 10.0), st.floats(1.05, 5.0))
def test_what_rises_and_what_falls(system: Redundant, repair: float, factor: float) -> None:
    """More failures, less; faster repair and more crews, more; a longer period, less; all within [0, 1]."""
    worse, now = replace(system, failure_per_h=factor * system.failure_per_h), Repaired(system, repair)
    assert 0.0 <= now.availability <= 1.0 + 1e-12
    assert now.availability + now.unavailability == pytest.approx(1.0)
    assert Repaired(worse, repair).availability < now.availability + 1e-12
    assert Repaired(system, factor * repair).availability > now.availability - 1e-12
    assert Repaired(system, repair, 2).availability >= now.availability - 1e-12
    for less, more in ((system, worse), (system, system)):
        longer = factor if less is more else 1.0
        assert 0.0 <= less.checked_unavailability(20.0) <= more.checked_unavailability(20.0 * longer) + 1e-12 <= 1.1


@given(st.floats(1e-4, 0.01), st.floats(0.0, 0.9), st.floats(0.01, 0.1))
def test_common_causes_cost_a_pair_availability(rate: float, share: float, more: float) -> None:
    """Rare failures, one of two needed."""
    few, many = (Redundant(1, 2, rate, each) for each in (share, share + more))
    assert few.checked_unavailability(10.0) < many.checked_unavailability(10.0)
    assert Repaired(few, 0.5).unavailability < Repaired(many, 0.5).unavailability


def test_impossible_values_are_refused() -> None:
    with pytest.raises(PlantError, match="needed is 3; it must be from 1 to computers, 2"):
        Redundant(3, 2, 0.1)
    with pytest.raises(PlantError, match="there must be 1 or more"):
        Redundant(1, 0, 0.1)
    with pytest.raises(PlantError, match=r"common_share is 1\.1"):
        Redundant(1, 2, 0.1, 1.1)
    with pytest.raises(PlantError, match="failure_per_h is 0"):
        Redundant(1, 2, 0.0)
    with pytest.raises(PlantError, match="repair_per_h is -1"):
        Repaired(Redundant(1, 2, 0.1), -1.0)
    with pytest.raises(PlantError, match="crews is 0"):
        Repaired(Redundant(1, 2, 0.1), 1.0, 0)
    with pytest.raises(PlantError, match="period_h is 0"):
        Redundant(1, 2, 0.1).checked_unavailability(0.0)
