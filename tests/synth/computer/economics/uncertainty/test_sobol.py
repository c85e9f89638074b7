"""Sobol indices of functions whose indices are known: Ishigami's, and a linear one."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
import pytest

from plant_models.errors import PlantError
from synth.computer.economics.uncertainty.ranges import LogNormal, Range, Uniform
from synth.computer.economics.uncertainty.sobol import SobolIndex, sobol_of
from tests.synth.computer.economics.made_cases import CASE, case_figures

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


def test_pay_back_of_a_yard() -> None:
    """What moves nothing has no index; the first-order indices and what several inputs do together make one."""
    ranges: dict[str, Range] = {
        "prices.per_car": LogNormal(20_000.0, 80_000.0),
        "terms.investment": Uniform(2e6, 9e6),
        "traffic.cars_per_day": Uniform(3000.0, 4500.0),
        "terms.discount_per_year": Uniform(0.05, 0.12),
    }
    found = sobol_of(lambda at: case_figures(CASE, at), ranges, ("pay_back_rate_per_year",), points=256, resamples=100)
    told = by_input(found)
    assert told["terms.discount_per_year"].total == 0.0
    assert told["terms.investment"].total > 0.3
    assert sum(each.first for each in found) < 1.05


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
