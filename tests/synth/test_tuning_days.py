"""Days of another mean friction: the cuts of one are of a plant with that mean, all together those of any day."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from plant_models import Friction, Plant
from synth.retarder.estimation.tuning_days import tuning_days, tuning_row
from synth.simulation.closed_loop import LineController, close_loop, simulate
from synth.simulation.random_passes import PATH_CELLS, random_passes
from synth.simulation.stratified_passes import stratified_passes
from synth.solver.switching_lines import SwitchingLines

LOW_DAY, HIGH_DAY = 1.0 - np.sqrt(3.0) * 0.1, 1.0 + np.sqrt(3.0) * 0.1


def with_mean_cv(plant: Plant, mean_cv: float) -> Plant:
    return replace(plant, friction=replace(plant.friction, mean_cv=mean_cv))


def some_lines(plant: Plant) -> LineController:
    upper = np.linspace(4.5, 3.2, 5) + 0.3 * np.arange(plant.top_stage + 1)[:, None]
    lower = upper - 0.8
    lower[0], upper[-1] = -np.inf, np.inf
    return LineController(SwitchingLines(np.linspace(0.0, plant.exit_m, 5), lower, upper))


def test_a_known_mean_has_one_day_and_its_passes_to_the_bit(plant_52t: Plant) -> None:
    passes = random_passes(3, 0, 300)
    days = tuning_days(plant_52t, passes)
    asked = close_loop(plant_52t, plant_52t.top_stage + 1).draws(passes)
    assert days.weight.tolist() == [1.0]
    (found,) = days.draws
    for name, values in zip(asked._fields, asked, strict=True):
        np.testing.assert_array_equal(getattr(found, name), values)


def test_a_day_has_the_cuts_of_its_mean_and_all_days_those_of_any_day(plant_52t: Plant) -> None:
    """The mixture of the days has the moments of N(1, CV² + mean_cv²) up to the fourth (Gauss–Hermite, three nodes)."""
    plant = with_mean_cv(plant_52t, 0.1)
    passes = stratified_passes(4, 0, 60_000)
    days = tuning_days(plant, passes)
    by_day = [(np.asarray(d.cut_factor), np.asarray(d.weight) / np.asarray(d.weight).sum()) for d in days.draws]
    means = [float(w @ factor) for factor, w in by_day]
    assert means == pytest.approx([LOW_DAY, 1.0, HIGH_DAY], abs=2e-3)
    for (factor, w), mean in zip(by_day, means, strict=True):
        assert np.sqrt(w @ (factor - mean) ** 2) == pytest.approx(0.15, rel=0.01)
    moments = [sum(q * (w @ (f - 1.0) ** k) for q, (f, w) in zip(days.weight, by_day, strict=True)) for k in (2, 4)]
    whole = 0.15**2 + 0.1**2
    assert moments == pytest.approx([whole, 3.0 * whole**2], rel=0.02)


def test_without_spread_a_day_is_a_plant_of_that_friction(plant_52t: Plant) -> None:
    """The mean square of a day is that of passes whose friction is told to the simulator."""
    plant = with_mean_cv(replace(plant_52t, friction=Friction(0.0, 0.0, 0.1, 2.0)), 0.1)
    passes, lines = random_passes(5, 0, 600), some_lines(plant_52t)
    found = tuning_days(plant, passes).mean_squares(lines, 3.0)
    for day, factor in enumerate((LOW_DAY, 1.0, HIGH_DAY)):
        told = simulate(plant, lines, passes.part(200 * day, 200 * day + 200), cut_factor=float(factor))
        assert found[day] == pytest.approx(np.mean((told.exit_speed_m_s - 3.0) ** 2), rel=1e-9)


def test_rare_cuts_of_low_friction_count_where_the_mean_is_uncertain(plant_52t: Plant) -> None:
    plain = tuning_row(plant_52t.friction)(7, 0, 200, PATH_CELLS)
    strata = tuning_row(with_mean_cv(plant_52t, 0.1).friction)(7, 0, 200, PATH_CELLS)
    assert (plain.weight == 1.0).all()
    assert (strata.cut_z < -2.0).mean() > 0.2
    assert strata.weight @ (strata.cut_z < -2.0) / 200 == pytest.approx(0.0228, abs=0.02)
