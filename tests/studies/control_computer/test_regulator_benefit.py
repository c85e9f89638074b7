"""The benefit of accuracy: equal to the savings of the figures, its intervals against repeated samples of trains."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from plant_models.errors import PlantError
from scripts.studies.control_computer.regulator_benefit import FIGURES, Benefit, Yard, regulator_benefit
from synth.computer.economics.hump_day_change import change_of_trains
from synth.computer.economics.hump_rates import rates_after
from synth.frame.settings.changed import changed
from tests.synth.computer.economics.made_cases import (
    CHANGE,
    HANDLING,
    PRICES,
    TODAY,
    TRAFFIC,
    half95,
    made_outcomes,
)

YARD = Yard(changed(TRAFFIC, cars_per_day=4000.0), HANDLING, PRICES)
BEFORE = changed(TODAY, catch_ups=0.03, misrouted=0.01)
AFTER = rates_after(BEFORE, CHANGE)


def pair(seed: int, trains: int) -> tuple[Benefit, ...]:
    """The benefit of two humps on the same drawn trains."""
    shared = np.random.default_rng(9000 + seed).gamma(100.0, 0.01, trains)
    today, new = made_outcomes(shared, BEFORE, seed), made_outcomes(shared, AFTER, 5000 + seed)
    return regulator_benefit(today, new, YARD, replicates=200, seed=seed)


def test_minutes_damages_and_locomotive_hours_follow_from_the_figures() -> None:
    shared = np.ones(200)
    today, new = made_outcomes(shared, BEFORE, 1), made_outcomes(shared, AFTER, 2)
    found = {each.name: each.less for each in regulator_benefit(today, new, YARD, replicates=100)}
    rate = [3600.0 * each.span_cars.sum() / each.span_s.sum() for each in (today, new)]
    assert found["humping of a train"].value == pytest.approx(60.0 * 60.0 * (1.0 / rate[0] - 1.0 / rate[1]))
    cuts = 4000.0 / 1.8
    above = [each.overspeed[:, 2].sum() / each.cuts.sum() for each in (today, new)]
    assert found["couplings above 2 m/s"].value == pytest.approx(cuts * (above[0] - above[1]))
    gaps = [each.gap_m.sum() / each.cuts.sum() for each in (today, new)]
    assert found["locomotive, pushing up gaps"].value == pytest.approx(cuts * (gaps[0] - gaps[1]) * 1e-4)


def test_intervals_are_those_of_paired_differences() -> None:
    """Gaps on their tracks are nearly linear in the figures: bootstrap and linearised interval agree."""
    shared = np.random.default_rng(4).gamma(100.0, 0.01, 400)
    today, new = made_outcomes(shared, BEFORE, 1), made_outcomes(shared, AFTER, 2)
    found = {each.name: each.less for each in regulator_benefit(today, new, YARD, replicates=1000)}
    linear = change_of_trains(today, new)["over_speeds_above_2"]
    on_track = 4000.0 / 1.8 * BEFORE.on_track
    assert half95(found["couplings above 2 m/s"]) == pytest.approx(on_track * half95(linear), rel=0.12)


def test_names_and_units() -> None:
    found = pair(1, 50)
    assert [each.name for each in found[-2:]] == ["running costs", "released capital"]
    assert found[-2].unit == "EUR a year"
    assert len(found) == len(FIGURES) + 2
    assert found == pair(1, 50), "the same seed, the same intervals"


def test_faults() -> None:
    shared = np.ones(20)
    today, new = made_outcomes(shared, BEFORE, 1), made_outcomes(shared, AFTER, 2)
    with pytest.raises(PlantError, match="replicates is 10"):
        regulator_benefit(today, new, YARD, replicates=10)
    full = replace(YARD, traffic=changed(TRAFFIC, cars_per_day=6000.0))
    with pytest.raises(PlantError, match="overloaded"):
        regulator_benefit(today, new, full)
    nearly = replace(YARD, traffic=changed(TRAFFIC, cars_per_day=24.0 / 0.2825 * 60.0 * 0.9995))
    with pytest.raises(PlantError, match="in a bootstrap sample of the trains the hump is overloaded"):
        regulator_benefit(made_outcomes(shared, TODAY, 3), new, nearly)
