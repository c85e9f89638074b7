"""Monte Carlo against sums of normals in closed form; coverage of its intervals; draws that are impossible or never."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
import pytest
from scipy import stats

from plant_models.errors import PlantError, require
from synth.computer.economics.monte_carlo import (
    QUANTILES,
    drawn,
    output_figures,
    quantile_of,
    share_of,
)
from synth.computer.economics.ranges import (
    Constant,
    LogNormal,
    Measured,
    Range,
    Triangular,
    Uniform,
    without_numbers,
)
from tests.synth.computer.economics.made_cases import CASE, case_figures, half95

NORMAL: dict[str, Range] = {
    "x": Measured(1.0, 1.0 - 1.96, 1.0 + 1.96),
    "y": Measured(2.0, 2.0 - 1.96, 2.0 + 1.96),
    "c": Constant(3.0),
}


def linear(at: Mapping[str, float]) -> dict[str, float]:
    return {"sum": at["x"] + 2.0 * at["y"] + at["c"], "product": at["x"] * at["y"]}


def test_sum_of_normals() -> None:
    made = drawn(linear, NORMAL, 20_000)
    spread = 1.96 / stats.norm.ppf(0.975) * math.sqrt(5.0)
    found = output_figures(made, "sum")
    assert found.mean is not None
    assert abs(found.mean.value - 8.0) < 1.5 * half95(found.mean)
    assert half95(found.mean) == pytest.approx(1.96 * spread / math.sqrt(20_000), rel=0.03)
    for p, (low, high) in zip(QUANTILES, ((each.low95, each.high95) for each in found.quantiles), strict=True):
        exact = 8.0 + spread * float(stats.norm.ppf(p))
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        assert abs(exact - middle) < 1.6 * half
    assert found.never.value == 0.0
    assert share_of(made.found["sum"] > 8.0).value == pytest.approx(0.5, abs=0.012)


def test_interval_of_a_quantile_against_every_rank() -> None:
    """By the binomial law, each tail holds at most 2.5 %, and the next rank inwards would hold more."""
    for n in (40, 200, 1001):
        for p in (0.05, 0.5, 0.95):
            _, low, high = quantile_of(np.arange(1.0, n + 1.0), p)
            below = stats.binom(n, p)
            if math.isfinite(low):  # the quantile is under the low-th value: fewer than `low` are below it
                assert below.cdf(low - 1) <= 0.025 < below.cdf(low)
            else:
                assert below.cdf(0) > 0.025
            if math.isfinite(high):
                assert below.sf(high - 1) <= 0.025 < below.sf(high - 2)
            else:
                assert below.sf(n - 1) > 0.025


def test_interval_of_a_share() -> None:
    for k, n in ((0, 50), (3, 50), (50, 50)):
        told = share_of(np.arange(n) < k)
        exact = stats.binomtest(k, n).proportion_ci(0.95, "exact")
        assert (told.low95, told.high95) == pytest.approx((exact.low, exact.high))


def test_never_and_impossible_are_told_apart() -> None:
    def odd(at: Mapping[str, float]) -> dict[str, float]:
        require(at["x"] < 0.8, f"x is {at['x']:.3f}; it must be below 0.8")
        return {"years": math.inf if at["x"] < 0.2 else 1.0 / at["x"], "x": at["x"]}

    made = drawn(odd, {"x": Uniform(0.0, 1.0)}, 20_000)
    assert made.impossible.value == pytest.approx(0.2, abs=0.01)
    assert made.impossible.low95 < 0.2 < made.impossible.high95
    assert len(made.found.faults) == 1
    assert made.found.faults[0][1] == round(made.impossible.value * 20_000)
    found = output_figures(made, "years")
    assert found.n == 20_000 - made.found.faults[0][1]
    assert found.never.low95 < 0.25 < found.never.high95, "of the possible draws"
    assert found.mean is None
    low, middle, high = (quantile.value for quantile in found.quantiles)
    assert low == pytest.approx(1.0 / 0.76, rel=0.02)
    assert middle == pytest.approx(1.0 / 0.4, rel=0.02)
    assert high == math.inf


def test_draws_follow_from_name_and_seed() -> None:
    one = drawn(linear, NORMAL, 200)
    other = drawn(linear, {**NORMAL, "z": Uniform(0.0, 1.0)}, 200)
    np.testing.assert_array_equal(one.points, other.points[: len(one.points)])
    assert not np.array_equal(one.points, drawn(linear, NORMAL, 200, seed=19).points)
    x, y = one.points[1], one.points[2]
    assert abs(np.corrcoef(x, y)[0, 1]) < 0.25, "inputs are independent"


def test_pay_back_of_a_yard() -> None:
    """The median case lies between the quantiles, and never agrees with the sign of the rate."""
    ranges: dict[str, Range] = {
        "prices.per_car": LogNormal(20_000.0, 80_000.0),
        "terms.investment": Triangular(2e6, 3e6, 9e6),
        "terms.running_cost_per_year": Uniform(0.0, 8e6),
        "change.cars_per_h": Measured(147.0, 122.0, 172.0),
        "traffic.cars_per_day": Uniform(3000.0, 5200.0),
    }
    made = drawn(lambda at: case_figures(CASE, at), ranges, 1000)
    assert 0.0 < made.impossible.value < 0.2, "5200 cars a day are more than today's hump can do"
    assert "overloaded" in made.found.faults[0][0]
    never = output_figures(made, "pay_back_years").never
    rates = made.found["pay_back_rate_per_year"]
    assert never == share_of(rates[~np.isnan(rates)] <= 0.0)
    assert 0.0 < never.value < 1.0
    value = output_figures(made, "net_present_value")
    assert value.mean is not None
    assert value.quantiles[0].value < value.mean.value < value.quantiles[2].value


def test_faults() -> None:
    with pytest.raises(PlantError, match="no input has a range"):
        drawn(linear, {"x": Constant(1.0)})
    with pytest.raises(PlantError, match=r"no draw of the inputs is possible; the first one: cars_per_h"):
        drawn(lambda at: case_figures(CASE, at), {"today.cars_per_h": Uniform(-2.0, -1.0)}, 100)
    with pytest.raises(PlantError, match="'x' is no output; there are sum, product"):
        output_figures(drawn(linear, NORMAL, 100), "x")
    assert without_numbers("a is 1.5; b") == without_numbers("a is -2; b")
