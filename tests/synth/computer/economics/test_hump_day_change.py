"""Figures of two humps and their differences: against sums by hand, bootstrap and repeated samples."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from plant_models.errors import PlantError
from synth.computer.economics.hump_day_change import NAMES as SUMMARY_NAMES
from synth.computer.economics.hump_day_change import (
    change_of,
    change_of_figures,
    change_of_trains,
    figures_of_trains,
    ranges_of_change,
    rates_of,
    train_sums,
)
from synth.computer.economics.ranges import Constant
from synth.computer.economics.traffic import RATES, rates_after
from synth.frame.interval import Interval
from synth.frame.settings.settings_file import changed, with_inputs
from synth.hump.trains.train_figures import train_figures
from tests.synth.computer.economics.made_cases import CASE, CHANGE, TODAY, half95, made_outcomes

NAMES = RATES
RARE = changed(TODAY, catch_ups=0.03, misrouted=0.01)


def effects(seed: int, trains: int) -> np.ndarray:
    """How trains differ, mean 1."""
    random = np.random.default_rng(seed)
    return random.gamma(100.0, 0.01, trains)


def test_figures_of_trains_are_those_of_the_summary() -> None:
    found = made_outcomes(effects(1, 50), RARE, 2)
    told, ours = {figure.name: figure for figure in train_figures(found)}, figures_of_trains(found)
    for name, theirs in SUMMARY_NAMES.items():
        assert isinstance(told[theirs].told, Interval)
        assert ours[name] == told[theirs].told
    assert ours["on_track"].value == told["overspeed"].n / int(found.cuts.sum())


def test_rates_are_ratios_of_sums() -> None:
    found = made_outcomes(effects(1, 50), RARE, 2)
    rates = rates_of(figures_of_trains(found))
    assert train_sums(found).rates().model_dump() == pytest.approx(rates.model_dump(), rel=1e-12)
    assert rates.cars_per_h == pytest.approx(3600.0 * found.span_cars.sum() / found.span_s.sum())
    assert rates.over_speeds_to_2 == pytest.approx(found.overspeed[:, 1].sum() / found.judged.sum())
    assert rates.on_track == pytest.approx(found.judged.sum() / found.cuts.sum())
    doubled = train_sums(found).rates(np.where(np.arange(50) < 10, 2.0, 0.0))
    assert doubled.gap_m == pytest.approx(found.gap_m[:10].sum() / found.judged[:10].sum())


def test_differences_are_those_of_the_figures() -> None:
    shared = effects(1, 100)
    today, new = made_outcomes(shared, RARE, 2), made_outcomes(shared, rates_after(RARE, CHANGE), 3)
    found = change_of_trains(today, new)
    one, other = (rates_of(figures_of_trains(each)) for each in (today, new))
    for name in NAMES:
        assert found[name].value == pytest.approx(getattr(other, name) - getattr(one, name), abs=1e-12)
    back = change_of_trains(new, today)
    assert back["gap_m"].low95 == pytest.approx(-found["gap_m"].high95)


def test_what_trains_have_in_common_cancels() -> None:
    shared = effects(1, 400)
    today, new = made_outcomes(shared, RARE, 2), made_outcomes(shared, rates_after(RARE, CHANGE), 3)
    paired = change_of_trains(today, new)
    unpaired = change_of_figures(figures_of_trains(today), figures_of_trains(new))
    assert half95(paired["gap_m"]) < 0.6 * half95(unpaired["gap_m"])
    assert half95(paired["cars_per_h"]) < 0.4 * half95(unpaired["cars_per_h"])
    alone = half95(unpaired["over_speeds_to_2"])  # the two runs have none of them in common
    assert half95(paired["over_speeds_to_2"]) == pytest.approx(alone, rel=0.1)
    for name in NAMES:
        assert paired[name].value == pytest.approx(unpaired[name].value, abs=1e-12)


def test_differences_are_inputs_of_a_case() -> None:
    shared = effects(1, 100)
    found = change_of_trains(made_outcomes(shared, RARE, 2), made_outcomes(shared, rates_after(RARE, CHANGE), 3))
    ranges = ranges_of_change(found)
    medians = {name: float(each.quantile(np.array(0.5))) for name, each in ranges.items()}
    assert with_inputs(CASE, medians).change == change_of(found)
    told = ranges["change.gap_m"].quantile(np.array([0.025, 0.975]))
    np.testing.assert_allclose(told, [found["gap_m"].low95, found["gap_m"].high95])
    same = change_of_trains(made_outcomes(shared, RARE, 2), made_outcomes(shared, RARE, 2))
    assert all(isinstance(each, Constant) for each in ranges_of_change(same).values())


def test_the_same_trains_twice_differ_by_nothing() -> None:
    found = made_outcomes(effects(1, 20), RARE, 2)
    same = change_of_trains(found, found)
    for name in NAMES:
        told = same[name]
        assert (told.value, told.low95, told.high95) == pytest.approx((0.0, 0.0, 0.0), abs=1e-12)


def test_intervals_of_differences_cover_the_truth() -> None:
    """200 sets of 100 trains: 95 % within ± 4.6 points (three standard errors)."""
    wanted = ("cars_per_h", "over_speeds_to_2", "over_speeds_above_2", "gap_m")
    hits = dict.fromkeys(wanted, 0)
    for place in range(200):
        shared = effects(1000 + place, 100)
        today, new = made_outcomes(shared, RARE, place), made_outcomes(shared, rates_after(RARE, CHANGE), 500 + place)
        found = change_of_trains(today, new)
        for name in wanted:
            told = found[name]
            hits[name] += told.low95 <= getattr(CHANGE, name) <= told.high95
    assert all(0.904 < n / 200 <= 1.0 for n in hits.values()), hits


def test_other_trains_are_no_pairs() -> None:
    found = made_outcomes(effects(1, 20), RARE, 2)
    with pytest.raises(PlantError, match="20 and 21 trains that are not the same"):
        change_of_trains(found, made_outcomes(effects(1, 21), RARE, 2))
    with pytest.raises(PlantError, match="not the same"):
        change_of_trains(found, replace(found, train=found.train + 1))
    one = made_outcomes(effects(1, 1), RARE, 2)
    with pytest.raises(PlantError, match="have 1 trains"):
        change_of_trains(one, one)
    with pytest.raises(PlantError, match="an interval takes two"):
        figures_of_trains(one)


def test_estimates() -> None:
    with pytest.raises(PlantError, match="must be numbers and hold the figure"):
        Interval(2.0, 2.5, 4.0, 10)
    with pytest.raises(PlantError, match="n is 0"):
        Interval(2.0, 1.0, 4.0, 0)


def test_figures_outside_their_range_are_refused() -> None:
    share = Interval(1.5, 1.5, 1.5, 1)
    with pytest.raises(PlantError, match="catch_ups is 1"):
        rates_of(dict.fromkeys(NAMES, share))
