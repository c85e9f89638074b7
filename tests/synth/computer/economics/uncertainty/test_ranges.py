"""Ranges of inputs, and what each of them moves.

Ranges against scipy's distributions and their own quantiles.
Sobol indices of functions whose indices are known: Ishigami's, and a linear one.
Tornado: bars of functions that can be followed by hand.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
import pytest
from scipy import stats

from plant_models.errors import PlantError, require
from synth.computer.economics.ranges import (
    Constant,
    LogNormal,
    Measured,
    Range,
    Triangular,
    Uniform,
    range_of,
)
from synth.computer.economics.sensitivity import SobolIndex, sobol_of, tornado
from synth.frame.interval import Interval
from tests.synth.computer.economics.made_cases import CASE, case_figures

P = np.linspace(0.001, 0.999, 999)


@pytest.mark.parametrize(
    ("made", "known"),
    [
        (Uniform(2.0, 5.0), stats.uniform(2.0, 3.0)),
        (Triangular(2.0, 3.0, 6.0), stats.triang(0.25, 2.0, 4.0)),
        (Triangular(2.0, 2.0, 6.0), stats.triang(0.0, 2.0, 4.0)),
        (Triangular(2.0, 6.0, 6.0), stats.triang(1.0, 2.0, 4.0)),
        (LogNormal(1.0, math.exp(2.0 * stats.norm.ppf(0.95))), stats.lognorm(1.0, 0.0, math.exp(stats.norm.ppf(0.95)))),
        (Measured(3.0, 3.0 - stats.norm.ppf(0.975), 3.0 + stats.norm.ppf(0.975)), stats.norm(3.0, 1.0)),
    ],
)
def test_quantiles_are_those_of_the_distribution(made: Range, known: stats.rv_continuous) -> None:
    np.testing.assert_allclose(made.quantile(P), known.ppf(P), rtol=1e-9)


def test_quantiles_that_were_told() -> None:
    np.testing.assert_allclose(LogNormal(2.0, 50.0).quantile(np.array([0.05, 0.95])), [2.0, 50.0])
    lopsided = Measured(0.22, 0.11, 0.40)
    np.testing.assert_allclose(lopsided.quantile(np.array([0.025, 0.5, 0.975])), [0.11, 0.22, 0.40])
    assert np.all(np.diff(lopsided.quantile(P)) > 0.0)
    np.testing.assert_array_equal(Constant(4.0).quantile(P), np.full(999, 4.0))


def test_measured_figures() -> None:
    assert range_of(Interval(2.0, 2.0, 2.0, 1)) == Constant(2.0)
    assert range_of(Interval(2.0, 1.0, 4.0, 9)) == Measured(2.0, 1.0, 4.0)
    one_sided = range_of(Interval(0.0, 0.0, 0.3, 9)).quantile(np.array([0.1, 0.5, 0.975]))
    np.testing.assert_allclose(one_sided, [0.0, 0.0, 0.3])


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: Uniform(2.0, 2.0), "uniform range goes from 2"),
        (lambda: Uniform(2.0, math.inf), "must be finite"),
        (lambda: Triangular(1.0, 5.0, 4.0), "the mode 5"),
        (lambda: LogNormal(0.0, 5.0), "must be above 0"),
        (lambda: Measured(5.0, 1.0, 4.0), "must lie in its interval"),
    ],
)
def test_impossible_ranges(make: object, sentence: str) -> None:
    assert callable(make)
    with pytest.raises(PlantError, match=sentence):
        make()


ISHIGAMI: dict[str, Range] = {name: Uniform(-math.pi, math.pi) for name in ("x1", "x2", "x3")}
A, B = 7.0, 0.1
V1 = 0.5 * (1.0 + B * math.pi**4 / 5.0) ** 2
V2, V13 = A**2 / 8.0, B**2 * math.pi**8 * 8.0 / 225.0
FIRST = {"x1": V1 / (V1 + V2 + V13), "x2": V2 / (V1 + V2 + V13), "x3": 0.0}
TOTAL = {"x1": (V1 + V13) / (V1 + V2 + V13), "x2": FIRST["x2"], "x3": V13 / (V1 + V2 + V13)}


def ishigami(at: Mapping[str, float]) -> dict[str, float]:
    """sin x₁ + 7 sin² x₂ + 0.1 x₃⁴ sin x₁ (Ishigami and Homma 1990)."""
    return {"y": math.sin(at["x1"]) + A * math.sin(at["x2"]) ** 2 + B * at["x3"] ** 4 * math.sin(at["x1"])}


def by_input(found: tuple[SobolIndex, ...]) -> dict[str, SobolIndex]:
    return {each.input: each for each in found}


def test_ishigami() -> None:
    found = by_input(sobol_of(ishigami, ISHIGAMI, ("y",), points=4096, resamples=200))
    for name in ISHIGAMI:
        assert found[name].first == pytest.approx(FIRST[name], abs=0.015)
        assert found[name].total == pytest.approx(TOTAL[name], abs=0.015)


def test_intervals_cover_the_truth() -> None:
    """60 scrambles of 256 points; each interval at least in 95 % less three standard errors."""
    hits = np.zeros((3, 2))
    for seed in range(60):
        found = sobol_of(ishigami, ISHIGAMI, ("y",), points=256, resamples=200, seed=seed)
        for place, each in enumerate(found):
            hits[place, 0] += each.first_ci95[0] <= FIRST[each.input] <= each.first_ci95[1]
            hits[place, 1] += each.total_ci95[0] <= TOTAL[each.input] <= each.total_ci95[1]
    assert np.all(hits / 60 > 0.866), hits / 60


def test_same_seed_same_indices() -> None:
    one, other, third = (sobol_of(ishigami, ISHIGAMI, ("y",), points=64, resamples=50, seed=seed) for seed in (1, 1, 2))
    assert one == other != third


def test_output_without_variance() -> None:
    found = sobol_of(lambda at: {"y": 2.0}, ISHIGAMI, ("y",), points=16, resamples=10)
    assert all((each.first, each.total, each.total_ci95) == (0.0, 0.0, (0.0, 0.0)) for each in found)


def test_outputs_that_are_not_finite_are_refused() -> None:
    with pytest.raises(PlantError, match=r"y is not finite at .* so it has no variance"):
        sobol_of(lambda at: {"y": math.inf if at["x1"] > 2.0 else 1.0}, ISHIGAMI, ("y",), points=16)
    with pytest.raises(PlantError, match=r"net_present_value is not finite at .*; the hump is overloaded"):
        sobol_of(
            lambda at: case_figures(CASE, at),
            {"traffic.cars_per_day": Uniform(3000.0, 9000.0)}, ("net_present_value",), points=16,
        )  # fmt: skip
    with pytest.raises(PlantError, match="is no output"):
        sobol_of(ishigami, ISHIGAMI, ("z",), points=16)


RANGES: dict[str, Range] = {
    "a": Uniform(0.0, 10.0),
    "b": Uniform(0.0, 1.0),
    "c": LogNormal(1.0, 100.0),
    "known": Constant(5.0),
}


def test_each_input_alone() -> None:
    found = tornado(lambda at: {"y": at["a"] - 20.0 * at["b"] + at["c"] + at["known"]}, RANGES, "y")
    assert found.at_medians == pytest.approx(5.0 - 10.0 + 10.0 + 5.0)
    assert [bar.input for bar in found.bars] == ["c", "b", "a"]
    c, b, a = found.bars
    assert (c.low_input, c.high_input) == pytest.approx((1.0, 100.0))
    assert (c.at_low, c.at_high) == pytest.approx((1.0, 100.0))
    assert (b.at_low, b.at_high, b.swing) == pytest.approx((19.0, 1.0, 18.0))
    assert (a.low_input, a.at_low, a.at_high) == pytest.approx((0.5, 5.5, 14.5))


def test_ends_that_are_impossible_or_never() -> None:
    def odd(at: Mapping[str, float]) -> dict[str, float]:
        require(at["b"] < 0.9, "b is too much")
        return {"y": math.inf if at["a"] < 1.0 else at["a"] + 0.0 * at["c"]}

    found = tornado(odd, RANGES, "y")
    assert [bar.input for bar in found.bars] == ["b", "a", "c"]
    b, a, c = found.bars
    assert math.isnan(b.at_high)
    assert math.isnan(b.swing)
    assert a.swing == math.inf
    assert c.swing == 0.0


def test_never_at_both_ends() -> None:
    found = tornado(lambda at: {"y": math.inf}, RANGES, "y")
    assert [bar.swing for bar in found.bars] == [0.0, 0.0, 0.0]
    assert [bar.input for bar in found.bars] == ["a", "b", "c"]
