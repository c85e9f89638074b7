"""Identified numbers in plants, and gains from them.

Identified numbers stand in the plants, with their origin; the written configuration and the one in memory agree.
How often a case is called better that is not: of one case, and of any of many.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from plant_models import Plant, PlantError, PressingForce, RollingResistance
from plant_models.motion import braked_axles, mean_braked_axles
from synth.frame.faults import InputError
from synth.logs.identified_config import configured_numbers, with_numbers
from synth.logs.retune.retune import MOST_FALSE, CaseGain, better, no_better
from synth.retarder.configuration.config_file import ConfigSource, parse_config, source_of_text
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.simulation.replicates import student_quantile
from tests.synth.logs.tables.conftest import TEXT

SLOPE = "retarder.force.slope_kn_per_kpa"
BY_AXLES = 0.04
NUMBERS = {
    SLOPE: 0.03, "retarder.force.touch_pressure_kpa": 41.0, "retarder.force.slope_by_axles": BY_AXLES,
    "retarder.pneumatics.fill_time_constant_s": 0.37, "retarder.pneumatics.exhaust_time_constant_s": 0.41,
    "retarder.pneumatics.brake_delay_s": 0.11, "retarder.pneumatics.touch_delay_s": 0.12,
    "retarder.pneumatics.release_delay_s": 0.13, "retarder.pneumatics.dead_band_kpa": 12.0,
    "friction.common_cv": 0.11, "friction.path_std": 0.07, "friction.correlation_length_m": 3.1,
    "sensor.noise_m_s": 0.03, "sensor.bias_m_s": 0.1, "rolling_resistance.mean_n_per_kn С": 2.2,
    "rolling_resistance.spread": 1.25, "gauge.noise_kpa": 4.0,
}  # fmt: skip
"""All that passes can be asked for, with a resistance of one of the two categories."""


@pytest.fixture(scope="module")
def source() -> ConfigSource:
    return source_of_text(TEXT, "test")


@pytest.fixture(scope="module")
def told(source: ConfigSource) -> ConfigSource:
    return with_numbers(source, NUMBERS, "identified from 7 passes", lambda key: f"told by {key}")


def in_memory(plant: Plant, middle: float) -> Plant:
    """`plant` with `NUMBERS` set field by field: a second account of where each of them belongs."""
    position, law = plant.position, plant.resistance
    assert isinstance(position.force, PressingForce)
    assert position.force.slope_factor_by_axles == (1.0,)
    inside = braked_axles(position, plant.cut, np.arange(0.0, plant.exit_m, 0.01))
    force = replace(
        position.force, slope_kn_per_kpa_per_pair=0.03, touch_pressure_kpa=41.0,
        slope_factor_by_axles=tuple(1.0 + BY_AXLES * (n - middle) for n in range(1, int(inside.max()) + 1)),
    )  # fmt: skip
    drive = replace(
        position.pneumatics, fill_time_constant_s=0.37, exhaust_time_constant_s=0.41, brake_delay_s=0.11,
        touch_delay_s=0.12, release_delay_s=0.13, dead_band_kpa=12.0,
    )  # fmt: skip
    return replace(
        plant,
        position=replace(position, force=force, pneumatics=drive),
        friction=replace(plant.friction, common_cv=0.11, path_std=0.07, correlation_length_m=3.1),
        sensor=replace(plant.sensor, noise_m_s=0.03),
        resistance=RollingResistance(2.2 if plant.cut.category == "С" else law.mean_n_per_kn, 1.25 * law.std_n_per_kn),
    )


def rounded(plant: Plant) -> Plant:
    """To the digits that a configuration is written with, where a number was worked out."""
    force, law = plant.position.force, plant.resistance
    assert isinstance(force, PressingForce)
    force = replace(
        force, slope_factor_by_axles=tuple(float(f"{factor:.6g}") for factor in force.slope_factor_by_axles)
    )
    resistance = replace(law, std_n_per_kn=float(f"{law.std_n_per_kn:.6g}"))
    return replace(plant, position=replace(plant.position, force=force), resistance=resistance)


def test_the_written_configuration_is_the_plant_with_the_numbers(source: ConfigSource, told: ConfigSource) -> None:
    before = dict(source.resolved().plants())
    middle = float(np.mean([mean_braked_axles(plant.position, plant.cut) for plant in before.values()]))
    expected = {label: rounded(in_memory(plant, middle)) for label, plant in before.items()}
    assert len({plant.cut.category for plant in before.values()}) == 2
    again = parse_config(told.files("config.toml")["config.toml"].decode(), "config.toml")
    assert dict(again.plants()) == expected
    assert dict(told.resolved().plants()) == expected
    assert again.sha256 == told.resolved().sha256 != source.resolved().sha256


def test_origins_are_told_of_the_numbers_that_were_set_and_no_other(source: ConfigSource, told: ConfigSource) -> None:
    config: ResolvedConfig = told.resolved()
    by = {number.key: number.by for number in configured_numbers(NUMBERS, source.resolved())}
    assert set(NUMBERS) - set(by.values()) == {"sensor.bias_m_s", "gauge.noise_kpa"}  # no numbers of a plant
    assert {each.key: each.source for each in config.parameters if each.source.startswith("told by")} == {
        key: f"told by {of}" for key, of in by.items()
    }
    assert sum(".rolling_resistance." in key for key in by) == 3  # a mean, two spreads


def test_a_slope_by_axles_is_that_of_the_likelihood(source: ConfigSource) -> None:
    """Force on N wheel pairs times 1 + b (N - mean N), whatever N stands inside."""
    plants = [plant for _, plant in source.resolved().plants()]
    numbers = {SLOPE: 0.03, "retarder.force.slope_by_axles": BY_AXLES}
    found = with_numbers(source, numbers, "x", lambda _: "x").resolved()
    middle = np.mean([mean_braked_axles(plant.position, plant.cut) for plant in plants])
    inside = braked_axles(plants[0].position, plants[0].cut, np.linspace(0.0, plants[0].exit_m, 400))
    for n in sorted(set(inside.tolist()) - {0}):
        got = found.retarder.position.force.slope_kn_per_kpa(plants[0].cut, int(n))
        assert got == pytest.approx(0.03 * (1.0 + BY_AXLES * (n - middle)), rel=1e-5)


def test_numbers_that_no_plant_has_are_refused(source: ConfigSource) -> None:
    numbers = {SLOPE: 0.03, "retarder.pneumatics.dead_band_kpa": 90.0}
    with pytest.raises((InputError, PlantError), match="dead_band_kpa"):
        with_numbers(source, numbers, "x", lambda _: "x").resolved().plants()


PLANTS, CASES, FAMILIES = 16, 30, 2000


def gain(number: int, p_value: float) -> CaseGain:
    return CaseGain(f"class {number}", 3.0, 0.05, 0.04, 0.8, (0.7, 0.9), p_value, PLANTS)


def test_a_p_value_belongs_to_the_interval() -> None:
    """It is half of 5 % just where the 95 % interval ends at a ratio of 1."""
    spread = 0.013
    edge = -student_quantile(PLANTS - 1) * spread
    assert no_better(edge, spread, PLANTS - 1) == pytest.approx(0.025, abs=1e-12)
    assert no_better(0.0, spread, PLANTS - 1) == pytest.approx(0.5)
    assert (no_better(-0.1, 0.0, 15), no_better(0.0, 0.0, 15)) == (0.0, 1.0)


def test_of_many_cases_hardly_ever_one_is_called_better_by_chance() -> None:
    """Cases whose true plant gains nothing; each plant of a case is drawn from the law that the true one is from."""
    rng = np.random.default_rng(19)
    logs = rng.normal(size=(FAMILIES, CASES, PLANTS + 1))
    middle = logs[:, :, 1:].mean(axis=2) - logs[:, :, 0]
    spread = logs[:, :, 1:].std(axis=2, ddof=1) * math.sqrt(1.0 + 1.0 / PLANTS)
    p = [
        [no_better(float(m), float(s), PLANTS - 1) for m, s in zip(*row, strict=True)]
        for row in zip(middle, spread, strict=True)
    ]
    one_by_one = np.mean(np.array(p) <= MOST_FALSE)
    assert one_by_one == pytest.approx(MOST_FALSE, abs=4.0 * math.sqrt(MOST_FALSE / (FAMILIES * CASES)))
    called = np.mean([bool(better([gain(i, each) for i, each in enumerate(row)])) for row in p])
    assert called <= MOST_FALSE + 3.0 * math.sqrt(MOST_FALSE / FAMILIES)
    assert np.mean([min(row) <= MOST_FALSE for row in p]) > 0.4, "without the rule it would be seldom too"


def test_cases_that_are_better_are_told_in_their_order() -> None:
    found = better([gain(0, 0.02), gain(1, 0.4), gain(2, 0.001)])
    assert [each.label for each in found] == ["class 2"]  # 0.02 is more than 0.025 / 2
    assert [each.label for each in better([gain(0, 0.012), gain(1, 0.4), gain(2, 0.001)])] == ["class 0", "class 2"]
