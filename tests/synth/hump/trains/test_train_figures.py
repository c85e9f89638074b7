"""Intervals of figures: how often they cover the truth where cuts of a train are alike, and exact special cases."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import stats

from synth.hump.trains.train_figures import ratio, share, train_figures
from tests.synth.hump.trains.made_trials import Day

Floats = NDArray[np.float64]

CUTS, SETS = 40, 400


def hits(p: float, correlation: float, trains: int) -> Floats:
    """Hits of each train (sets, trains): binomial, or beta-binomial with this correlation of two cuts of a train."""
    random, shape = np.random.default_rng(1), (SETS, trains)
    if correlation == 0.0:
        return random.binomial(CUTS, p, shape).astype(float)
    wide = (1.0 - correlation) / correlation
    return random.binomial(CUTS, random.beta(p * wide, (1.0 - p) * wide, shape)).astype(float)


@pytest.mark.parametrize(
    ("p", "trains", "correlation", "least"),
    [
        (0.001, 20, 0.0, 0.97),
        (0.001, 100, 0.0, 0.93),
        (0.001, 1000, 0.0, 0.94),
        (0.01, 20, 0.0, 0.94),
        (0.1, 20, 0.0, 0.94),
        (0.1, 20, 0.1, 0.92),
        (0.1, 100, 0.1, 0.92),
        (0.01, 1000, 0.1, 0.92),
        (0.01, 100, 0.1, 0.90),
        (0.01, 20, 0.1, 0.77),  # 8 hits in 3 trains or so
        (0.001, 100, 0.1, 0.73),
    ],
)
def test_shares_are_covered_as_told(p: float, trains: int, correlation: float, least: float) -> None:
    base = np.full(trains, float(CUTS))
    found = np.array([share(each, base)[1:3] for each in hits(p, correlation, trains)])
    covered = ((found[:, 0] <= p) & (p <= found[:, 1])).mean()
    assert least < covered
    if correlation > 0.0 and p * trains < 0.5:
        assert covered < 0.9, "better than told: tell it"


@pytest.mark.parametrize(("p", "trains", "correlation"), [(0.1, 20, 0.0), (0.1, 100, 0.1), (0.01, 1000, 0.1)])
def test_ratios_are_covered_as_told(p: float, trains: int, correlation: float) -> None:
    base = np.full(trains, float(CUTS))
    found = np.array([ratio(each, base)[1:] for each in hits(p, correlation, trains)])
    covered = ((found[:, 0] <= p) & (p <= found[:, 1])).mean()
    assert 0.91 < covered < 0.98


def test_without_any_hit_the_interval_is_that_of_independent_cuts() -> None:
    """Clopper and Pearson, but for Student's quantile: 1 − 0.025^(1/n) of n cuts worth (t999/t49)² of 2000."""
    found = share(np.zeros(50), np.full(50, 40.0))
    worth = 2000 * (stats.t.ppf(0.975, 1999) / stats.t.ppf(0.975, 49)) ** 2
    assert found[:2] == (0.0, 0.0)
    assert found[2] == pytest.approx(1.0 - 0.025 ** (1.0 / worth), rel=1e-9)


@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize(
    ("hits", "ends"), [((3.0, 4.0), (0.0, 0.8868)), ((6.0, 26.0), (0.0, 1.0)), ((20.0, 20.0), (0.0118, 0.9882))]
)
def test_two_trains_tell_no_end_that_is_next_to_nothing(
    hits: tuple[float, float], ends: tuple[float, float], mirrored: bool
) -> None:
    """The exact ends are 1.3e-10 of all cuts, 2.9e-43 and 1 less nothing; those of 20 hits a train are told."""
    base, few = np.full(2, 40.0), np.array(hits)
    found = share(base - few if mirrored else few, base)[1:3]
    assert found == pytest.approx((1.0 - ends[1], 1.0 - ends[0]) if mirrored else ends, abs=1e-4)
    for told, expected in zip(found, (0.0, 1.0), strict=True):
        assert told == expected or abs(told - expected) > 1e-3
    one = np.eye(1, 20)[0]
    assert 0.0 < share(one, np.full(20, 40.0))[1] < 1e-4, "a single hit of many trains tells that there are some"


def test_trains_of_unequal_cuts_weigh_by_them() -> None:
    value, low, high = ratio(np.array([1.0, 6.0, 2.0]), np.array([10.0, 40.0, 10.0]))
    assert value == pytest.approx(0.15)
    residual = (np.array([1.0, 6.0, 2.0]) - 0.15 * np.array([10.0, 40.0, 10.0])) / 20.0
    half = stats.t.ppf(0.975, 2) * residual.std(ddof=1) / np.sqrt(3)
    assert [low, high] == pytest.approx([0.15 - half, 0.15 + half])


def test_nothing_is_told_of_nothing_and_no_interval_of_one_train() -> None:
    assert np.isnan(share(np.zeros(3), np.zeros(3))).all()
    assert np.isnan(ratio(np.zeros(3), np.zeros(3))).all()
    assert ratio(np.array([3.0]), np.array([4.0]))[0] == 0.75
    assert np.isnan(ratio(np.array([3.0]), np.array([4.0]))[1:]).all()


def test_figures_are_those_of_the_counts() -> None:
    found = Day(cuts=10, steps_m_s=(3.0, 3.4)).on().batch(0, 40)
    told = {figure.name: figure for figure in train_figures(found, 0.01)}
    assert told["hump_speed"].value == pytest.approx(found.span_m.sum() / found.span_s.sum())
    assert told["cars_per_hour"].value == pytest.approx(3600.0 * found.span_cars.sum() / found.span_s.sum())
    assert told["catch_ups"].value == found.caught.sum() / 400 > 0.0
    assert told["catch_ups"].n == 400
    assert told["overspeed"].n == found.judged.sum()
    classes = sum(told[f"overspeed_{name}"].value for name in ("slight", "rough", "harmful"))
    assert told["overspeed"].value == pytest.approx(classes)
    assert told["gap_per_cut"].value == pytest.approx(found.gap_m.sum() / found.judged.sum())
    p, effect = told["catch_ups"].value, share(found.caught.astype(float), found.cuts.astype(float))[3]
    assert told["catch_ups"].enough_n == pytest.approx(1.959964**2 * p * (1.0 - p) / 0.01**2 * effect)
    for figure in told.values():
        assert figure.low95 <= figure.value <= figure.high95
