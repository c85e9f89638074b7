"""Ranges against scipy's distributions and their own quantiles."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import stats

from plant_models.errors import PlantError
from synth.computer.economics.uncertainty.ranges import (
    Constant,
    LogNormal,
    Measured,
    Range,
    Triangular,
    Uniform,
    range_of,
)
from synth.frame.interval import Interval

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
