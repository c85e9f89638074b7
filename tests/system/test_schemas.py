"""JSON Schemas of all files that a user writes: they take what `init` prints, and flag what the program refuses."""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from plant_models.library import BUILT_IN, KINDS, TypeFileError
from plant_models.library.library import Kind, TypeFile
from plant_models.library.type_schema import type_schema
from synth.cli.file_kinds import FILE_KINDS, FileKind
from synth.frame.faults import InputError
from synth.frame.settings.settings_file import parse_settings
from synth.frame.settings.template import toml_text
from synth.retarder.configuration.settings import Settings
from tests.system.conftest import Command

SCHEMA_LINE = re.compile(r"#:schema \./([a-z-]+\.schema\.json)")


def validator(kind: FileKind) -> jsonschema.Draft202012Validator:
    schema = kind.schema()
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


@pytest.mark.parametrize("kind", FILE_KINDS, ids=[kind.word for kind in FILE_KINDS])
def test_what_init_prints_is_what_its_schema_allows(kind: FileKind, command: Command) -> None:
    for name in ("", *kind.names[:3]):
        printed = command("init", kind.word, *filter(None, [name])).out
        tree = tomllib.loads(printed)
        found = SCHEMA_LINE.fullmatch(printed.splitlines()[0])
        assert found is not None
        assert found[1] == kind.schema_name
        check = validator(kind)
        check.validate(tree)
        wrong = {**tree, "ti tel": "x"}
        assert not check.is_valid(wrong)
    assert json.loads(command("init", kind.word, "--schema").out) == kind.schema()


def test_a_file_is_written_with_its_schema_beside_it(command: Command, tmp_path: Path) -> None:
    assert command("init", "car", "tank-4", "-o", tmp_path / "my-tank.toml").code == 0
    schema = json.loads((tmp_path / "car.schema.json").read_text(encoding="utf-8"))
    jsonschema.validate(tomllib.loads((tmp_path / "my-tank.toml").read_text(encoding="utf-8")), schema)
    again = command("init", "car", "-o", tmp_path / "my-tank.toml")
    assert (
        again.sentence == f"{tmp_path / 'my-tank.toml'}: it is there already, and is not overwritten; give another "
        "name, or move it away"
    )
    assert command("init", "car", "-o", tmp_path / "second.toml").out == f"{tmp_path / 'second.toml'}\n"


@pytest.mark.parametrize("kind", KINDS, ids=[kind.folder for kind in KINDS])
def test_types_of_the_library_are_allowed(kind: Kind) -> None:
    check = jsonschema.Draft202012Validator(type_schema(kind))
    for name in BUILT_IN.names(kind):
        check.validate(tomllib.loads(BUILT_IN.file(kind, name).text))


MISTAKES = """\
titel = "My yard"
weight_categories = 5

[retarder]
stage_pressures_kpa = [0.0, "a lot", 300.0]
zones_m = 4.0
max_entry_speed_m_s = "fast"

[retarder.pneumatics]
brake_delay = 0.2
dead_band_kpa = true

[entry]
low_m_s = "5 knots"
hihg_m_s = 6.5

[friction]
common_cv = [0.1]

[targets]
exit_speeds_m_s = 3.0

[regulator]
commands = "sometimes"
estimator = 1

[grid]
path_step_m = 500.0
friction_scenarios = 2.5

[fit]
degree = "three"

[validation]
passes = -5
sed = 7

[output]
plots = "yes"

[acceptance]
prediction_ratio_low = "0.8"

[[cut]]
car = 4
mass_t = "heavy"
cars = 200
"""
"""Twenty and more that users make: words for keys and values, types, limits."""

AT_FAULT = {
    "titel", "weight_categories", "retarder.stage_pressures_kpa", "retarder.zones_m", "retarder.max_entry_speed_m_s",
    "retarder.pneumatics.brake_delay", "retarder.pneumatics.dead_band_kpa", "entry.low_m_s", "entry.hihg_m_s",
    "friction.common_cv", "targets.exit_speeds_m_s", "regulator.commands", "regulator.estimator", "grid.path_step_m",
    "grid.friction_scenarios", "fit.degree", "validation.passes", "validation.sed", "output.plots",
    "acceptance.prediction_ratio_low", "cut.car", "cut.mass_t", "cut.cars",
}  # fmt: skip


def flagged(fault: jsonschema.ValidationError) -> Iterator[str]:
    """The keys that a fault of a schema is about."""
    path = [str(part) for part in fault.absolute_path if isinstance(part, str)]
    if fault.validator == "additionalProperties":
        known = fault.schema["properties"]
        yield from (".".join([*path, key]) for key in fault.instance if key not in known)
    else:
        yield ".".join(path)


def test_schema_and_program_flag_the_same_keys_all_at_once() -> None:
    of_schema = {
        key for fault in validator(FILE_KINDS[0]).iter_errors(tomllib.loads(MISTAKES)) for key in flagged(fault)
    }
    with pytest.raises(InputError) as caught:
        parse_settings(Settings, MISTAKES, "my.toml")
    told = [re.sub(r"\[\d+\]", "", sentence.removeprefix("my.toml: ")) for sentence in caught.value.sentences]
    of_program = {key for key in AT_FAULT for sentence in told if re.match(rf"{re.escape(key)}\b(?!\.)", sentence)}
    assert len(AT_FAULT) >= 20
    assert of_schema == AT_FAULT
    assert of_program == AT_FAULT
    assert len(told) == len(AT_FAULT)


def without(tree: dict[str, Any], path: tuple[str, ...]) -> dict[str, Any]:
    key, *below = path
    return {
        name: without(value, tuple(below)) if name == key and below else value
        for name, value in tree.items()
        if name != key or below
    }


def paths_in(tree: Any) -> Iterator[tuple[str, ...]]:
    for name, value in tree.items() if isinstance(tree, dict) else ():
        yield (name,)
        yield from ((name, *below) for below in paths_in(value))


@pytest.mark.parametrize("kind", KINDS, ids=[kind.folder for kind in KINDS])
def test_what_the_schema_of_a_type_refuses_the_reader_refuses(kind: Kind) -> None:
    """Each key left out, mistyped, and with another value."""
    check = jsonschema.Draft202012Validator(type_schema(kind))
    tree = tomllib.loads(BUILT_IN.file(kind, BUILT_IN.names(kind)[0]).text)
    refused = 0
    for path in list(paths_in(tree)):
        for changed in (without(tree, path), {**without(tree, path), "-".join(path): 1}, replaced(tree, path)):
            if check.is_valid(changed):
                continue
            refused += 1
            with pytest.raises(TypeFileError):
                read_type(TypeFile(kind, "mine", toml_text(changed), "mine.toml"))
    assert refused > 20


def replaced(tree: dict[str, Any], path: tuple[str, ...]) -> dict[str, Any]:
    key, *below = path
    return {
        name: (replaced(value, tuple(below)) if below else [{}]) if name == key else value
        for name, value in tree.items()
    }


def read_type(file: TypeFile) -> object:
    """The entry in `file`, by the reader of its kind."""
    from plant_models.library.car_entry import car_from, car_mix_from
    from plant_models.library.position_entry import position_file
    from plant_models.library.retarder_entry import retarder_from
    from plant_models.library.sensor_entry import sensor_from, wheel_sensor_from
    from plant_models.library.track_entry import track_from
    from plant_models.library.weight_category import categories_from

    readers: dict[str, Any] = {
        "cars": car_from,
        "car_mixes": lambda file: car_mix_from(file, BUILT_IN),
        "positions": position_file,
        "retarders": retarder_from,
        "sensors": sensor_from,
        "tracks": track_from,
        "weight_categories": categories_from,
        "wheel_sensors": wheel_sensor_from,
    }
    return readers[file.kind.folder](file)
