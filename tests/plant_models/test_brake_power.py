"""Brake power: work by hand, for each force law, and for factors that depend on the wheel pairs inside."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from plant_models import PlantError, PressingForce, RetarderPosition, TrackProfile, WeightForce, couple
from plant_models.brake_power import FullBrake
from plant_models.library.catalogue import load_car, load_position
from plant_models.motion import path_breaks_m, path_coefficients

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
