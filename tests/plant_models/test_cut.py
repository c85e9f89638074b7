"""Cuts: inertia, reduced gravity and coupling of cars."""

import pytest

from plant_models import Car, Cut, PlantError, couple

GONDOLA = Car("gondola-4", (0.0, 1.85, 8.65, 10.5), 13.92, 22.0, 94.0)


@pytest.mark.parametrize(
    ("mass_t", "gravity_m_s2"),
    [(22, 9.11), (25, 9.19), (36, 9.37), (52, 9.50), (66, 9.57), (72, 9.59), (85, 9.62), (92, 9.63)],
)
def test_reduced_gravity_table_of_the_facts(mass_t: float, gravity_m_s2: float) -> None:
    cut = couple((GONDOLA,), mass_t, "Л", 2)
    assert cut.reduced_gravity_m_s2 == pytest.approx(gravity_m_s2, abs=0.0051)
    assert cut.inertia_t == pytest.approx(mass_t + 1.68)


def test_one_car_keeps_its_axles() -> None:
    assert couple((GONDOLA,), 22.0, "Л", 2).axle_offsets_m == GONDOLA.axle_offsets_m


def test_coupled_cars_repeat_at_the_length_over_couplers() -> None:
    cut = couple((GONDOLA, GONDOLA), 44.0, "Л", 2)
    assert cut.axle_offsets_m == (0.0, 1.85, 8.65, 10.5, 13.92, 15.77, 22.57, 24.42)
    assert cut.axle_load_t == pytest.approx(5.5)


def test_cars_of_different_length_meet_at_the_couplers() -> None:
    short = Car("short", (0.0, 4.0), 8.0, 10.0, 20.0)
    cut = couple((short, GONDOLA), 50.0, "Л", 2)
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
