"""Identified numbers stand in the plants, with their origin, and make another configuration."""

from __future__ import annotations

import numpy as np
import pytest

from plant_models import PlantError, PressingForce
from plant_models.motion import braked_axles, mean_braked_axles
from synth.yard.measured_passes.identified_plants import with_identified

from .conftest import Yard

SLOPE = "retarder.force.slope_kn_per_kpa"
NUMBERS = {
    SLOPE: 0.03, "retarder.force.touch_pressure_kpa": 41.0, "retarder.pneumatics.fill_time_constant_s": 0.37,
    "retarder.pneumatics.dead_band_kpa": 12.0, "friction.common_cv": 0.11, "friction.path_std": 0.07,
    "friction.correlation_length_m": 3.1, "sensor.noise_m_s": 0.03, "sensor.bias_m_s": 0.1,
    "rolling_resistance.mean_n_per_kn С": 2.2, "rolling_resistance.spread": 1.3, "gauge.noise_kpa": 4.0,
}  # fmt: skip


def test_every_number_stands_where_it_belongs(assumed: Yard) -> None:
    found = with_identified(assumed.config, NUMBERS, "identified from 7 passes")
    before = dict(assumed.config.plants())
    plants = dict(found.plants())
    plant = plants["S-1"]
    force = plant.position.force
    assert isinstance(force, PressingForce)
    assert (force.slope_kn_per_kpa_per_pair, force.touch_pressure_kpa) == (0.03, 41.0)
    assert (plant.position.pneumatics.fill_time_constant_s, plant.position.pneumatics.dead_band_kpa) == (0.37, 12.0)
    law = plant.friction
    assert (law.common_cv, law.path_std, law.correlation_length_m, plant.sensor.noise_m_s) == (0.11, 0.07, 3.1, 0.03)
    assert plant.resistance.mean_n_per_kn == 2.2
    assert plants["LS-1"].resistance.mean_n_per_kn == before["LS-1"].resistance.mean_n_per_kn
    for label in plants:
        assert plants[label].resistance.std_n_per_kn == pytest.approx(1.3 * before[label].resistance.std_n_per_kn)
    assert (
        plant.position.pneumatics.exhaust_time_constant_s == before["S-1"].position.pneumatics.exhaust_time_constant_s
    )


def test_origins_are_told_and_the_configuration_is_another(assumed: Yard) -> None:
    found = with_identified(assumed.config, NUMBERS, "identified from 7 passes")
    told = {each.key for each in found.parameters if each.source == "identified from 7 passes"}
    resistances = {key for key in told if ".rolling_resistance." in key}
    assert told - resistances == {key for key in NUMBERS if key.partition(".")[0] in ("retarder", "friction")} | {
        "sensor.noise_m_s", "retarder.force.slope_factor_by_axles",
    }  # fmt: skip
    assert len(resistances) == 3  # a mean, two spreads
    assert found.sha256 != assumed.config.sha256
    assert "0.03" in found.canonical_json()


def test_a_slope_by_axles_is_that_of_the_likelihood(assumed: Yard) -> None:
    """Force on N wheel pairs times 1 + b (N - mean N), whatever N stands inside."""
    b, plants = 0.04, [plant for _, plant in assumed.config.plants()]
    found = with_identified(assumed.config, {SLOPE: 0.03, "retarder.force.slope_by_axles": b}, "x")
    middle = np.mean([mean_braked_axles(plant.position, plant.cut) for plant in plants])
    inside = braked_axles(plants[0].position, plants[0].cut, np.linspace(0.0, plants[0].exit_m, 400))
    for n in sorted(set(inside.tolist()) - {0}):
        got = found.retarder.position.force.slope_kn_per_kpa(plants[0].cut, int(n))
        assert got == pytest.approx(0.03 * (1.0 + b * (n - middle)))


def test_numbers_that_no_plant_has_are_refused(assumed: Yard) -> None:
    with pytest.raises(PlantError, match="dead_band_kpa"):
        with_identified(assumed.config, {SLOPE: 0.03, "retarder.pneumatics.dead_band_kpa": 90.0}, "x")
