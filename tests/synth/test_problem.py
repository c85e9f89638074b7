"""Which problems are taken, and how fine the grids are, by what they are for."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from plant_models import Friction, PlantError
from synth.problem.aim import Aim
from synth.problem.any_time_resolution import LARGE_SPREAD_M_S, design_resolution
from synth.problem.criterion import Criterion
from synth.problem.estimator_resolution import design_error_m_s, estimator_resolution
from synth.problem.problem import Problem
from synth.problem.requirement import FrictionRange
from synth.problem.resolution import Resolution, finer_for_check
from synth.solver.chain import grid
from synth.solver.chain.grid import memory_estimate_bytes, require_memory
from tests.synth.case_factory import make_plant


def test_a_target_is_below_the_highest_entry_speed() -> None:
    plant = make_plant(22.0, 3)
    highest_m_s = plant.entry.high_m_s
    assert Problem(plant, Aim(math.nextafter(highest_m_s, 0.0))).target_speed_m_s < highest_m_s
    with pytest.raises(PlantError, match="there is nothing to brake"):
        Problem(plant, Aim(highest_m_s))


@pytest.mark.parametrize("cv", [0.1, 0.3])
def test_a_worst_case_is_one_that_the_grid_covers(cv: float) -> None:
    """Four standard deviations of the friction of a cut on both sides, as the plant draws it."""
    plant = replace(make_plant(22.0, 3), friction=Friction(cv, 0.0, 0.1, 2.0))
    low, high = (float(factor) for factor in plant.friction.cut_factor(np.array([-4.0, 4.0]), plant.friction_cv))

    def problem(least: float, most: float) -> Problem:
        return Problem(plant, Aim(3.0, Criterion(requirement=FrictionRange(least, most))))

    assert problem(low, high).criterion.requirement == FrictionRange(low, high)
    for least, most in ((math.nextafter(low, 0.0), high), (low, math.nextafter(high, 9.0))):
        with pytest.raises(PlantError, match="the friction of this cut is modelled from"):
            problem(least, most)


def test_a_table_is_predicted_with_half_of_both_steps() -> None:
    design = Resolution(path_step_m=0.4, speed_step_m_s=0.05, reference_speed_m_s=2.5)
    check = finer_for_check(design)
    assert (check.path_step_m, check.speed_step_m_s, check.reference_speed_m_s) == (0.2, 0.025, 2.5)


@pytest.mark.parametrize(("share", "values"), [(0.9, 1), (1.1, 2)])
def test_surfaces_are_designed_for_two_resistances_where_their_spread_moves_the_exit_speed(
    share: float, values: int
) -> None:
    plant = make_plant(22.0, 3)
    taken = 2.0 * plant.cut.reduced_gravity_m_s2 * 1e-3 * plant.resistance.std_n_per_kn * plant.exit_m

    def beyond(target_m_s: float) -> float:
        slower = math.sqrt(max(target_m_s**2 - taken, 0.0))
        return target_m_s - slower - share * LARGE_SPREAD_M_S

    target_m_s = brentq(beyond, math.sqrt(taken), 19.0)
    assert design_resolution(plant, target_m_s).resistance_nodes == values


@pytest.mark.parametrize("lowest_m_s", [1.0, 2.0, 3.0, 5.0])
@pytest.mark.parametrize("noise_m_s", [0.05, 0.2])
def test_no_cell_is_wider_than_the_error_of_the_estimate(lowest_m_s: float, noise_m_s: float) -> None:
    sensor = replace(make_plant(22.0, 3).sensor, noise_m_s=noise_m_s)
    usual = Resolution(speed_step_m_s=0.03, reference_speed_m_s=3.0)
    found = estimator_resolution(usual, sensor, lowest_m_s)
    slowest_m_s = min(lowest_m_s, usual.reference_speed_m_s)
    widest_m_s = found.speed_step_m_s * usual.reference_speed_m_s / slowest_m_s
    usual_m_s = usual.speed_step_m_s * usual.reference_speed_m_s / slowest_m_s
    assert widest_m_s == pytest.approx(min(usual_m_s, design_error_m_s(sensor)))


def test_solves_may_take_four_fifths_of_the_free_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    plant, grids = make_plant(22.0, 3), (Resolution(), finer_for_check(Resolution()))
    needed = 2 * memory_estimate_bytes(plant, grids)
    monkeypatch.setattr(grid, "available_memory_bytes", lambda: int(needed / 0.79))
    require_memory("gondola", plant, grids, 2)
    monkeypatch.setattr(grid, "available_memory_bytes", lambda: int(needed / 0.81))
    with pytest.raises(PlantError, match="solving gondola would take about"):
        require_memory("gondola", plant, grids, 2)
