"""The section [sensors] of a configuration: what it changes, what it leaves alone, and a sentence for each fault."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from plant_models import every_axle
from synth.frame.faults import InputError
from synth.retarder.configuration.config_file import (
    DUMPER_POSITION,
    default_sensors_toml,
    filled_sensors_toml,
    parse_config,
)
from synth.retarder.configuration.resolved_config import ResolvedConfig

PLACES = "[sensors]\npath_m = [-5.0, 2.0, 9.0]\n"


def parsed(text: str) -> ResolvedConfig:
    """The configuration `text`."""
    return parse_config(text, "x.toml")


def test_without_the_section_nothing_changes() -> None:
    plain = parsed("")
    assert plain.sensors is None
    assert not any(value.key.startswith("sensors.") for value in plain.parameters)
    assert "sensors" not in json.loads(plain.canonical_json())


def test_sensors_come_from_the_type_and_the_file() -> None:
    config = parsed(PLACES + 'decides_on = "every_axle"\ntimer_noise_s = 0.0005\n')
    assert config.sensors is not None
    sensors = config.sensors.sensors
    assert (sensors.path_m, sensors.base_m, sensors.timer_noise_s) == ((-5.0, 2.0, 9.0), 0.2, 0.0005)
    assert sensors.axles is every_axle
    sources = {value.key: value.source for value in config.parameters}
    assert sources["sensors.timer_noise_s"] == sources["sensors.path_m"] == "configuration"
    assert sources["sensors.base_m"].startswith("[zhukovitsky-2012]")


def test_the_regulator_acts_from_the_first_sensor_on() -> None:
    config = parsed(PLACES + "[regulator]\napproach_m = 3.0\n")
    assert config.sensors is not None
    for (_, radar), c in zip(config.plants(), config.cuts, strict=True):
        plant = config.sensors.serving(radar)
        assert (radar.start_m, plant.start_m) == (-3.0, -5.0)
        assert plant.entrance_stage == min(c.entrance_stage, plant.top_stage)
        assert (plant.cut, plant.position, plant.friction) == (radar.cut, radar.position, radar.friction)


def test_the_hash_knows_the_sensors_and_nothing_twice() -> None:
    hashes = [
        parsed(text).sha256
        for text in ("", PLACES, PLACES + 'decides_on = "every_axle"\n', PLACES + "base_m = 0.25\n",
                     PLACES.replace("9.0", "9.5"))
    ]  # fmt: skip
    assert len(set(hashes)) == len(hashes)
    assert parsed(PLACES + 'type = "ds-2"\nbase_m = 0.2\n').sha256 == parsed(PLACES).sha256
    cut = '[[cut]]\ncar = "gondola-4"\nmass_t = 22\n'
    no_stage = parsed(PLACES + cut + "entrance_stage = 0\n")
    assert no_stage.sha256 != parsed(PLACES + cut).sha256  # the stage at the entrance counts, as sensors act before it


def test_a_source_can_be_named_for_a_number_of_the_sensors() -> None:
    config = parsed(PLACES + 'base_m = 0.25\n[sources]\n"sensors.base_m" = "measured by us"\n')
    assert {v.key: v.source for v in config.parameters}["sensors.base_m"] == "measured by us"


def test_a_number_outside_its_sensible_range_is_warned_of() -> None:
    assert any(
        w.startswith("sensors.base_tolerance is 0.05") for w in parsed(PLACES + "base_tolerance = 0.05").warnings
    )


FAULTS = {
    "no places": ("[sensors]\n", "sensors.path_m is missing; add it to sensors"),
    "behind the entrance": (
        "[sensors]\npath_m = [1.0]\n",
        "sensors.path_m begins at 1; the first sensor must stand at the entrance or ahead of it, at 0 or less "
        "(cut class gondola-4-22t)",
    ),
    "too near": (
        "[sensors]\npath_m = [-4.0, -3.9]\n",
        "sensors.path_m[1] is -3.9; it must be at least 0.3 m behind the sensor before it, which stands at -4",
    ),
    "too far ahead": ("[sensors]\npath_m = [-101.0]\n", "sensors.path_m[0] is -101.0; it must be a finite number from"),
    "hardly ahead": (
        "[sensors]\npath_m = [-0.0005, 4.0]\n",
        "sensors.path_m: the way from the first sensor to the entrance is 0.0005; it must be 0, or from 0.001 m up "
        "(cut class gondola-4-22t)",
    ),
    "from too far": (
        "[track]\ngrade_permille = 35.0\n[sensors]\npath_m = [-60.0]\n",
        "sensors.path_m: the way from the first sensor to the entrance is 60; there the grade alone brings each cut to",
    ),
    "no such type": (
        PLACES + 'type = "ds2"\n', "sensors.type is 'ds2', which the library does not hold; did you mean ds-2?",
    ),
    "base too long": (PLACES + "base_m = 3\n", "sensors.base_m is 3.0; it must be a finite number from 0.05 to 1"),
    "no such axle": (PLACES + 'decides_on = "last"\n', "sensors.decides_on is 'last'; it must be 'first_axle'"),
    "key of a radar": (PLACES + "noise_m_s = 0.1\n", "sensors.noise_m_s = 0.1 is an unknown key; did you mean "),
    "no list": ("[sensors]\npath_m = 3\n", "sensors.path_m is 3; it must be a list of at least one finite number"),
}  # fmt: skip


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_is_told_with_file_key_value_and_what_is_allowed(name: str) -> None:
    text, said = FAULTS[name]
    with pytest.raises(InputError) as caught:
        parsed(text)
    assert caught.value.sentences[0].startswith(f"x.toml: {said}")


@pytest.mark.parametrize("position", [DUMPER_POSITION, "knp-5-bunch", "rnz-2m-park"])
def test_what_init_prints_reads_back(position: str) -> None:
    text = default_sensors_toml(position)
    config = parsed(text)
    assert config.sensors is not None
    assert config.retarder.name == position
    assert config.sensors.sensors.path_m[0] < 0.0
    changed = {v.key for v in config.parameters if v.source == "configuration"}
    assert changed <= {"sensors.path_m"} | {
        f"cut[{i}].{key}" for i in range(2) for key in ("mass_t", "cars", "allowed_stage")
    }
    if position == DUMPER_POSITION:
        assert [(c.cut.axles, c.cut.mass_t) for c in config.cuts] == [(4, 22.0), (6, 32.0)]
        plants = [config.sensors.serving(plant) for _, plant in config.plants()]
        assert config.sensors.sensors.path_m[-1] > max(plant.exit_m for plant in plants)  # the last one logs


def test_a_file_with_sensors_is_printed_with_every_default_and_reads_back_the_same(tmp_path: Path) -> None:
    short = (
        '[position]\nname = "rnz-2m-park"\n[sensors]\npath_m = [-3.0, 5.0, 30.0]\n[targets]\nexit_speeds_m_s = [1.5]\n'
    )
    path = tmp_path / "sensors-3.toml"
    path.write_text(short, encoding="utf-8")
    printed = filled_sensors_toml(path)
    assert parse_config(printed, "printed").sha256 == parse_config(short, "short").sha256
    assert "missed_share" in printed
    path.write_text("", encoding="utf-8")
    with pytest.raises(InputError, match="there is no section"):
        filled_sensors_toml(path)
