"""Retarder positions: force laws, exit, refusals."""

import pytest

from plant_models import Cut, PlantError, Pneumatics, PressingForce, RetarderPosition, WeightForce

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
