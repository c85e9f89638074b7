"""Motion: braked wheel pairs, exact cell means, work and energy head."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plant_models import Car, Cut, Pneumatics, PressingForce, RetarderPosition, TrackProfile, couple, path_coefficients
from plant_models.motion import braked_axles, mean_braked_axles, path_breaks_m
from tests.effort import sized

DRIVE = Pneumatics(700.0, 0.0, 0.1, 0.2, 0.1, 0.3, 0.3, 15.0)
LENGTH_M = 12.475
GONDOLA = Cut("Т", 85.0, (0.0, 1.85, 8.65, 10.5), 4)
STAGES_KPA = (0.0, 150.0, 300.0, 450.0, 600.0)


def position(*zones: tuple[float, float], factors: tuple[float, ...] = (1.0,)) -> RetarderPosition:
    return RetarderPosition("test", zones, STAGES_KPA, PressingForce(20 / 550, 50.0, factors), DRIVE, 7.0)


ONE = position((0.0, LENGTH_M))
TWO = position((0.0, LENGTH_M), (LENGTH_M + 2.0, 2 * LENGTH_M + 2.0))
FLAT = TrackProfile.uniform(0.0)


def test_braked_axles_table_of_the_facts() -> None:
    edges = [0, 1.85, 8.65, 10.50, 12.475, 14.325, 21.125, 22.975]
    np.testing.assert_allclose(path_breaks_m(ONE, GONDOLA, FLAT), edges)
    middle = 0.5 * (np.array(edges[1:]) + np.array(edges[:-1]))
    assert braked_axles(ONE, GONDOLA, middle).tolist() == [1, 2, 3, 4, 3, 2, 1]
    short, pair = position((0.0, 2.0)), Cut("Т", 40.0, (0.0, 1.0), 4)
    assert braked_axles(short, pair, np.arange(4.0)).tolist() == [1, 2, 1, 0]  # out where the zone ends
    assert ONE.exit_m(GONDOLA) == pytest.approx(LENGTH_M + 10.5)


def test_mean_braked_axles_of_the_facts() -> None:
    assert mean_braked_axles(ONE, GONDOLA) == pytest.approx(4 * LENGTH_M / 22.975)
    assert mean_braked_axles(ONE, GONDOLA) == pytest.approx(2.17, abs=0.005)


def test_energy_head_follows_from_the_force() -> None:
    """F = Q·g·h/(4·L): 20 kN on each wheel pair takes 1.2 m of head from a car of 85 t."""
    edges = path_breaks_m(ONE, GONDOLA, FLAT)
    c = path_coefficients(ONE, GONDOLA, FLAT, edges)
    work_kj = float((c.brake_m_s2_per_kpa * np.diff(edges)).sum()) * 550.0 * GONDOLA.inertia_t
    assert work_kj == pytest.approx(4 * 20.0 * LENGTH_M)
    assert work_kj / (85.0 * 9.81) == pytest.approx(1.2, abs=0.005)


@pytest.mark.parametrize(("mass_t", "deceleration"), [(22, 3.38), (36, 2.12), (52, 1.49), (85, 0.92)])
def test_deceleration_table_of_the_facts(mass_t: float, deceleration: float) -> None:
    cut = Cut("С", mass_t, GONDOLA.axle_offsets_m, 4)
    c = path_coefficients(ONE, cut, FLAT, np.array([11.0, 12.0]))
    assert float(c.brake_m_s2_per_kpa[0]) * 550.0 == pytest.approx(deceleration, abs=0.006)


@settings(max_examples=sized(10, 40), deadline=None, derandomize=True)
@given(cells=st.integers(3, 200), cars=st.integers(1, 3))
def test_work_does_not_depend_on_the_cells(cells: int, cars: int) -> None:
    cut = couple((Car("g", GONDOLA.axle_offsets_m, 13.92, 22.0, 94.0),) * cars, 50.0 * cars, "С", 4)
    profile = TrackProfile((0.0, 9.0, 20.0), (12.0, 8.0, 1.5))
    edges = np.linspace(0.0, TWO.exit_m(cut), cells + 1)
    c = path_coefficients(TWO, cut, profile, edges)
    brake_m = float((c.brake_m_s2_per_kpa * np.diff(edges)).sum()) * cut.inertia_t / (20 / 550)
    assert brake_m == pytest.approx(4 * cars * 2 * LENGTH_M)
    breaks = path_breaks_m(TWO, cut, profile)
    fine = path_coefficients(TWO, cut, profile, breaks)
    assert (c.gravity_m_s2 * np.diff(edges)).sum() == pytest.approx((fine.gravity_m_s2 * np.diff(breaks)).sum())


def test_gravity_and_resistance_coefficients() -> None:
    c = path_coefficients(ONE, GONDOLA, TrackProfile.uniform(8.0), np.array([0.0, 5.0, 22.975]))
    np.testing.assert_allclose(c.gravity_m_s2, 8e-3 * 9.81 * 85 / 86.68)
    assert c.resistance_m_s2_per_n_kn == pytest.approx(1e-3 * 9.81 * 85 / 86.68)


def test_grade_is_the_mean_under_the_axles() -> None:
    """First axle past the break, the other three before it: a quarter of the drop is felt."""
    profile = TrackProfile((0.0, 10.0), (8.0, 4.0))
    c = path_coefficients(ONE, GONDOLA, profile, np.array([10.0, 11.0]))
    assert float(c.gravity_m_s2[0]) == pytest.approx(7e-3 * GONDOLA.reduced_gravity_m_s2)
    assert profile.grade_permille(np.array([-1.0, 0.0, 9.9, 10.0, 99.0])).tolist() == [8.0, 8.0, 8.0, 4.0, 4.0]


def test_slope_factor_depends_on_the_number_of_braked_axles() -> None:
    edges = np.array([0.0, 1.85, 8.65, 10.5, 12.475])
    plain = path_coefficients(ONE, GONDOLA, FLAT, edges).brake_m_s2_per_kpa
    factored = position((0.0, LENGTH_M), factors=(1.0, 0.9, 0.8))
    got = path_coefficients(factored, GONDOLA, FLAT, edges).brake_m_s2_per_kpa
    np.testing.assert_allclose(got / plain, [1.0, 0.9, 0.8, 0.8])


def test_coefficients_are_read_only() -> None:
    c = path_coefficients(ONE, GONDOLA, FLAT, np.array([0.0, 5.0]))
    with pytest.raises(ValueError, match="read-only"):
        c.brake_m_s2_per_kpa[0] = 1.0
