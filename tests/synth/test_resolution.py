"""How fine the grids are, by what they are for."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from scipy.optimize import brentq

from synth.problem.any_time_resolution import LARGE_SPREAD_M_S, design_resolution
from synth.problem.estimator_resolution import design_error_m_s, estimator_resolution
from synth.problem.resolution import Resolution, finer_for_check
from tests.synth.case_factory import make_plant


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
