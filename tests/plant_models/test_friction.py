"""Friction: dispersion of a cut, and the cell-wise equivalent of the path process."""

import math
from dataclasses import replace

import numpy as np
import pytest

from plant_models import Friction, PlantError

FRICTION = Friction(common_cv=0.15, axle_cv=0.2, path_std=0.1, correlation_length_m=2.0)


def test_cv_of_a_cut_averages_the_axles_and_keeps_the_common_part() -> None:
    assert FRICTION.cut_cv(4.0) == pytest.approx(math.sqrt(0.15**2 + 0.2**2 / 4))
    assert FRICTION.cut_cv(1e9) == pytest.approx(0.15)


def test_factor_of_a_cut_never_falls_under_the_floor() -> None:
    factor = FRICTION.cut_factor(np.array([-10.0, 0.0, 1.0]), 0.15)
    np.testing.assert_allclose(factor, [0.3, 1.0, 1.15])


def test_cell_std_tends_to_the_process_for_short_cells_and_to_white_noise_for_long_ones() -> None:
    assert float(FRICTION.path_cell_std(1e-6)) == pytest.approx(0.1, rel=1e-6)
    assert float(FRICTION.path_cell_std(1e4)) == pytest.approx(0.1 * math.sqrt(2 * 2.0 / 1e4), rel=1e-9)


@pytest.mark.requirement("PRED-04")
@pytest.mark.parametrize("cell_m", [0.1, 0.5, 2.0, 5.0])
def test_cells_as_a_chain_carry_the_work_variance_of_the_process(cell_m: float) -> None:
    """Σ of an AR(1) chain of cells has, per metre, the variance 2ℓσ² of the continuous process."""
    rho = float(FRICTION.path_correlation(cell_m))
    variance = float(FRICTION.path_cell_std(cell_m)) ** 2
    per_metre = variance * cell_m * (1 + rho) / (1 - rho)
    assert per_metre == pytest.approx(2 * 2.0 * 0.1**2, rel=1e-12)


def test_the_friction_of_any_day_has_the_spread_of_a_mean_that_is_drawn_too() -> None:
    law = replace(FRICTION, mean_cv=0.12)
    rng = np.random.default_rng(3)
    mean = 1.0 + law.mean_cv * rng.standard_normal(200_000)
    drawn = mean + law.cut_cv(6.0) * rng.standard_normal(200_000)
    assert law.of_any_day.cut_cv(6.0) == pytest.approx(drawn.std(), rel=0.01)
    assert law.of_any_day.mean_cv == 0.0
    assert law.cut_cv(6.0) == FRICTION.cut_cv(6.0)


def test_where_the_mean_is_known_any_day_is_like_the_other_to_the_bit() -> None:
    assert FRICTION.of_any_day == FRICTION


def test_the_widest_law_is_still_one() -> None:
    assert Friction(0.6, 0.0, 0.1, 2.0, mean_cv=0.3).of_any_day.common_cv == 0.6


@pytest.mark.parametrize("name", ["common_cv", "axle_cv", "path_std", "correlation_length_m", "floor", "mean_cv"])
def test_impossible_values_are_refused(name: str) -> None:
    values = {"common_cv": 0.1, "axle_cv": 0.1, "path_std": 0.1, "correlation_length_m": 1.0, "floor": 0.3}
    for bad in (-1.0, math.nan, math.inf):
        with pytest.raises(PlantError, match=f"friction: {name} is {bad}"):
            Friction(**(values | {name: bad}))
