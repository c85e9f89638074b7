"""Retarder positions and cuts: force laws, brake power, friction, inertia, coupling of cars, and what is refused."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from plant_models import (
    Car,
    Cut,
    Friction,
    PlantError,
    Pneumatics,
    PressingForce,
    RetarderPosition,
    TrackProfile,
    WeightForce,
    couple,
)
from plant_models.library.catalogue import load_car, load_position
from plant_models.motion import path_breaks_m, path_coefficients
from plant_models.stage_regulator import FullBrake

DRIVE = Pneumatics(700.0, 0.0, 0.1, 0.2, 0.1, 0.3, 0.3, 15.0)
STAGES_KPA = (0.0, 150.0, 300.0, 450.0, 600.0)
LIGHT = Cut("Л", 22.0, (0.0, 1.85, 8.65, 10.5), 2)
HEAVY = Cut("Т", 88.0, (0.0, 1.85, 8.65, 10.5), 4)


def test_pressing_force_does_not_know_the_car() -> None:
    force = PressingForce(0.036, 50.0)
    assert force.slope_kn_per_kpa(LIGHT, 1) == force.slope_kn_per_kpa(HEAVY, 4) == 0.036


def test_weight_force_goes_with_the_axle_load() -> None:
    force = WeightForce(0.0017, 50.0)
    assert force.slope_kn_per_kpa(HEAVY, 2) == pytest.approx(4 * force.slope_kn_per_kpa(LIGHT, 2))
    assert force.slope_kn_per_kpa(LIGHT, 2) == pytest.approx(0.0017 * 5.5)


def test_slope_factor_of_the_last_entry_holds_beyond_the_list() -> None:
    force = PressingForce(0.01, 50.0, (1.0, 0.9))
    assert [force.slope_kn_per_kpa(HEAVY, n) for n in (1, 2, 3, 8)] == pytest.approx([0.01, 0.009, 0.009, 0.009])


def test_exit_is_where_the_last_axle_leaves() -> None:
    position = RetarderPosition("x", ((0.0, 3.0), (4.0, 7.0)), STAGES_KPA, PressingForce(0.03, 50.0), DRIVE, 6.0)
    assert position.exit_m(LIGHT) == pytest.approx(17.5)
    assert position.top_stage == 4


@pytest.mark.parametrize(
    ("zones", "stages", "message"),
    [
        (((1.0, 3.0),), STAGES_KPA, "zones_m .*must start at 0"),
        ((), STAGES_KPA, "zones_m .*must start at 0"),
        (((0.0, 3.0), (2.0, 5.0)), STAGES_KPA, "must not overlap"),
        (((0.0, 0.0),), STAGES_KPA, "must be ordered"),
        (((0.0, 501.0),), STAGES_KPA, "end under 500 m"),
        (((0.0, 3.0),), (0.0, 300.0, 150.0), "each above the one before"),
        (((0.0, 3.0),), (0.0,), "at least two pressures"),
        (((0.0, 3.0),), (0.0, 800.0), "cannot reach it"),
        (((0.0, 3.0),), (-100.0, 300.0), "stage_pressures_kpa is -100"),
        (((0.0, 3.0),), (100.0, 300.0, 320.0), "dead band|overlap"),
    ],
)
def test_impossible_positions_are_refused(
    zones: tuple[tuple[float, float], ...], stages: tuple[float, ...], message: str
) -> None:
    with pytest.raises(PlantError, match=message):
        RetarderPosition("x", zones, stages, PressingForce(0.03, 50.0), DRIVE, 6.0)


@pytest.mark.parametrize("law", [PressingForce, WeightForce])
def test_impossible_forces_are_refused(law: type[PressingForce] | type[WeightForce]) -> None:
    with pytest.raises(PlantError, match="slope_kn_per_kpa"):
        law(-0.01, 50.0)
    with pytest.raises(PlantError, match="touch_pressure_kpa"):
        law(0.01, -1.0)
    with pytest.raises(PlantError, match="slope_factor_by_axles is empty"):
        law(0.01, 50.0, ())
    with pytest.raises(PlantError, match=r"slope_factor_by_axles is 0.0"):
        law(0.01, 50.0, (0.0,))


GONDOLA = load_car("gondola-4").car
BUNCH = load_position("knp-5-bunch").position
BRAKED_M, TOUCH_KPA, BAND_KPA = 2 * 12.475, 50.0, 15.0


def heads(position: RetarderPosition, mass_t: list[float], axles: list[int], stage: list[int]) -> np.ndarray:
    return FullBrake(position, GONDOLA).head_m(np.array(mass_t), np.array(axles), np.array(stage))


def test_pressing_force_is_axles_times_force_times_length() -> None:
    slope = 20.0 / 550.0
    found = heads(BUNCH, [22.0, 66.0, 85.0, 500.0, 120.0], [4, 4, 4, 20, 6], [2, 4, 9, 4, 3])
    pressure = np.array([300.0, 600.0, 600.0, 600.0, 450.0]) - BAND_KPA - TOUCH_KPA
    work_kj = np.array([4, 4, 4, 20, 6]) * slope * pressure * BRAKED_M
    np.testing.assert_allclose(found, work_kj / (np.array([22.0, 66.0, 85.0, 500.0, 120.0]) * 9.81), rtol=1e-9)


def test_weight_force_gives_one_head_whatever_the_mass() -> None:
    position = replace(BUNCH, force=WeightForce(0.004, TOUCH_KPA))
    found = heads(position, [22.0, 85.0, 210.0, 120.0], [4, 4, 12, 6], [4, 4, 4, 4])
    np.testing.assert_allclose(found, 0.004 * 535.0 * BRAKED_M / 9.81, rtol=1e-9)


@pytest.mark.parametrize("law", [PressingForce(0.03, 50.0, (1.0, 0.8, 0.9)), WeightForce(0.004, 50.0, (1.0, 0.9, 0.7))])
@pytest.mark.parametrize("cars", [1, 3])
def test_factors_by_wheel_pairs_count_as_in_the_motion(law: PressingForce | WeightForce, cars: int) -> None:
    """Against the coefficients of the cut itself, at a mass between and beyond those that the work is taken at."""
    position, flat = replace(BUNCH, force=law), TrackProfile.uniform(0.0)
    for mass_t in (24.0 * cars, 61.0 * cars, 140.0 * cars):
        cut = couple((GONDOLA,) * cars, mass_t, "С", 4)
        edges = path_breaks_m(position, cut, flat)
        brake = path_coefficients(position, cut, flat, edges).brake_m_s2_per_kpa
        energy = 535.0 * float(brake @ np.diff(edges))
        expected = energy / cut.reduced_gravity_m_s2
        assert heads(position, [mass_t], [cut.axles], [4])[0] == pytest.approx(expected, rel=1e-9)


def test_stage_0_brakes_nothing_and_a_cut_without_mass_is_none() -> None:
    assert heads(BUNCH, [22.0], [4], [0])[0] == 0.0
    with pytest.raises(PlantError, match="must have a mass"):
        heads(BUNCH, [22.0, 0.0], [4, 4], [2, 2])


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


MADE_CAR = Car("gondola-4", (0.0, 1.85, 8.65, 10.5), 13.92, 22.0, 94.0)


@pytest.mark.parametrize(
    ("mass_t", "gravity_m_s2"),
    [(22, 9.11), (25, 9.19), (36, 9.37), (52, 9.50), (66, 9.57), (72, 9.59), (85, 9.62), (92, 9.63)],
)
def test_reduced_gravity_table_of_the_facts(mass_t: float, gravity_m_s2: float) -> None:
    cut = couple((MADE_CAR,), mass_t, "Л", 2)
    assert cut.reduced_gravity_m_s2 == pytest.approx(gravity_m_s2, abs=0.0051)
    assert cut.inertia_t == pytest.approx(mass_t + 1.68)


def test_one_car_keeps_its_axles() -> None:
    assert couple((MADE_CAR,), 22.0, "Л", 2).axle_offsets_m == MADE_CAR.axle_offsets_m


def test_coupled_cars_repeat_at_the_length_over_couplers() -> None:
    cut = couple((MADE_CAR, MADE_CAR), 44.0, "Л", 2)
    assert cut.axle_offsets_m == (0.0, 1.85, 8.65, 10.5, 13.92, 15.77, 22.57, 24.42)
    assert cut.axle_load_t == pytest.approx(5.5)


def test_cars_of_different_length_meet_at_the_couplers() -> None:
    short = Car("short", (0.0, 4.0), 8.0, 10.0, 20.0)
    cut = couple((short, MADE_CAR), 50.0, "Л", 2)
    assert cut.axle_offsets_m[2] == pytest.approx(4.0 + 2.0 + (13.92 - 10.5) / 2)


@pytest.mark.parametrize(
    ("mass_t", "offsets", "stage", "message"),
    [
        (-1.0, (0.0,), 2, "mass_t is -1.0"),
        (float("nan"), (0.0,), 2, "mass_t is nan"),
        (22.0, (0.5, 1.0), 2, "must start with 0"),
        (22.0, (0.0, 2.0, 1.0), 2, "must increase"),
        (22.0, (), 2, "must start with 0"),
        (22.0, (0.0,), 0, "allowed_stage is 0"),
    ],
)
def test_impossible_cuts_are_refused(mass_t: float, offsets: tuple[float, ...], stage: int, message: str) -> None:
    with pytest.raises(PlantError, match=message):
        Cut("Л", mass_t, offsets, stage)


def test_impossible_cars_are_refused() -> None:
    with pytest.raises(PlantError, match=r"gross_t is 10.0"):
        Car("x", (0.0, 2.0), 5.0, 20.0, 10.0)
    with pytest.raises(PlantError, match=r"length_m is 1.0"):
        Car("x", (0.0, 2.0), 1.0, 10.0, 20.0)
    with pytest.raises(PlantError, match="at least one car"):
        couple((), 22.0, "Л", 2)
