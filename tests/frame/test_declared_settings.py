"""Declared settings: templates, lists, faults and units follow from the declaration, of every command of the
frame.
"""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from annotated_types import Ge
from pydantic import ValidationError
from pydantic.fields import FieldInfo
from pydantic_core import ErrorDetails

from plant_models import PlantError
from plant_models.library.hump_forms import UNITS, in_unit
from plant_models.library.sourced_value import SET_BY_USER
from synth.aim.configuration.settings import AimFileSettings
from synth.cli import main
from synth.computer.settings import ComputerSettings
from synth.frame.faults import InputError
from synth.frame.settings.numbers import numbers_of, schema_of
from synth.frame.settings.section import Section, many, sections_in, setting, setting_limits, setting_unit
from synth.frame.settings.settings_file import changed, parse_settings, settings_in, with_inputs
from synth.frame.settings.template import template, toml_text
from synth.hump.configuration.settings import HumpTrialSettings
from synth.hump.hump_file import parse_hump
from synth.hump.hump_forms import from_csv, to_csv
from synth.retarder.configuration.settings import Settings
from tests.frame.small_command import CoinFile
from tests.plant_models.hump.random_humps import SMALL

FILES: tuple[Section, ...] = (CoinFile(), ComputerSettings(), Settings(), AimFileSettings(), HumpTrialSettings())

CONFIGURATIONS = [(), ("point-sensors",), ("aim",), ("trial",), ("computer",)]
"""What `init` prints configurations for."""


def declared(section: Section, path: tuple[str, ...]) -> Iterator[tuple[tuple[str, ...], Any, FieldInfo]]:
    """(path, value, field) of every key of plain tables."""
    for key, field in type(section).model_fields.items():
        value = getattr(section, key)
        if isinstance(value, Section):
            yield from declared(value, (*path, key))
        else:
            yield (*path, key), value, field


def nested(file: Section, path: tuple[str, ...], value: object) -> dict[str, Any]:
    """The tables of a file that says only this value, and what stands beside it in its table."""
    table: Any = file
    for key in path[:-1]:
        table = getattr(table, key)
    beside = {} if table is file else table.model_dump(mode="json", exclude_none=True)
    tree: Any = {key: each for key, each in beside.items() if not isinstance(each, dict | list)} | {path[-1]: value}
    for key in reversed(path[:-1]):
        tree = {key: tree}
    found: dict[str, Any] = tree
    return found


LIMITED = [
    pytest.param(file, path, field, id=f"{type(file).__name__}-{'.'.join(path)}")
    for file in FILES
    for path, _, field in declared(file, ())
    if any(isinstance(limit, Ge) for limit in field.metadata)
]
"""Numbers with limits; lists of them are faulty in their own ways."""


@pytest.mark.parametrize("file", FILES, ids=lambda file: type(file).__name__)
def test_a_template_reads_back_to_the_defaults_and_says_every_unit(file: Section) -> None:
    text = template(file, "A thing", "do")
    assert parse_settings(type(file), text, "t.toml") == file
    for path, value, field in declared(file, ()):
        if value not in (None, (), {}) or field.examples:
            assert path[-1] in text
            assert (field.description or "") in text
            assert setting_unit(field) in text


@pytest.mark.parametrize("file", FILES, ids=lambda file: type(file).__name__)
def test_every_number_has_a_unit_and_is_listed_once(file: Section) -> None:
    told = [value.key for value in numbers_of(file)]
    assert len(told) == len(set(told))
    for path, value, field in declared(file, ()):
        if isinstance(value, int | float) and not isinstance(value, bool):
            assert setting_unit(field), path
            assert ".".join(path) in told


@pytest.mark.parametrize(("file", "path", "field"), LIMITED)
def test_a_value_beyond_its_limits_is_one_sentence(file: Section, path: tuple[str, ...], field: FieldInfo) -> None:
    limits = setting_limits(field)
    assert limits is not None
    whole = field.annotation in (int, int | None)
    beyond = (limits[0] - 1, limits[1] + max(1.0, abs(limits[1])))
    for value in (int(each) if whole else float(each) for each in beyond):
        if whole and not -(2**63) <= value < 2**63:
            continue
        with pytest.raises(InputError) as caught:
            parse_settings(type(file), toml_text(nested(file, path, value)), "c.toml")
        (said,) = caught.value.sentences
        assert said == f"c.toml: {'.'.join(path)} is {value!r}; it must be from {limits[0]:g} to {limits[1]:g}"


@pytest.mark.parametrize(("file", "path", "field"), LIMITED)
def test_a_word_for_a_number_and_a_mistyped_key_are_one_sentence(
    file: Section, path: tuple[str, ...], field: FieldInfo
) -> None:
    for tree, word in (
        (nested(file, path, "many"), "a whole number" if field.annotation in (int, int | None) else "a number"),
        (nested(file, (*path[:-1], f"{path[-1]}x"), 1.0), "did you mean"),
    ):
        with pytest.raises(InputError) as caught:
            parse_settings(type(file), toml_text(tree), "c.toml")
        (said,) = caught.value.sentences
        assert said.startswith(f"c.toml: {'.'.join(path)}")
        assert word in said


@pytest.mark.parametrize("file", FILES, ids=lambda file: type(file).__name__)
def test_what_stands_as_an_example_may_be_set(file: Section) -> None:
    for path, _, field in declared(file, ()):
        for example in field.examples or ():
            tree: Any = example if not sections_in(field) else [each.model_dump(exclude_none=True) for each in example]
            for key in reversed(path):
                tree = {key: tree}
            for fault in faults_of(type(file), tomllib.loads(toml_text(tree))):
                assert fault["type"] == "value_error", path  # a rule may want another key beside it
                assert fault["loc"] != path


def faults_of(model: type[Section], tree: dict[str, Any]) -> list[ErrorDetails]:
    """What is at fault in the settings of `tree`."""
    try:
        model.model_validate(tree)
    except ValidationError as error:
        return error.errors()
    return []


def test_what_the_user_sets_is_his() -> None:
    told = parse_settings(CoinFile, "[coin]\nheads = 0.25\n", "c.toml")
    sources = {value.key: value.source for value in numbers_of(told)}
    assert sources == {"coin.heads": SET_BY_USER, "coin.throws": "default of the tool"}


def test_a_list_of_tables_is_the_tools_own_or_the_users() -> None:
    usual = {value.key: value.source for value in numbers_of(ComputerSettings())}
    assert usual["range.terms.investment.low"].startswith("engineering judgement")
    own = parse_settings(
        ComputerSettings, '[[range]]\ninput = "terms.years"\nlow = 5.0\nhigh = 20.0\nsource = "our book"\n', "c.toml"
    )
    (low, high) = (value for value in numbers_of(own) if value.key.startswith("range."))
    assert (low.key, low.value, high.value, low.source) == ("range.terms.years.low", 5.0, 20.0, "our book")


def test_changed_values_are_checked_as_those_of_a_file() -> None:
    coin = CoinFile().coin
    assert changed(coin, heads=0.25).heads == 0.25
    with pytest.raises(PlantError, match=r"heads is 2\.0; it must be from 0 to 1"):
        changed(coin, heads=2.0)
    assert with_inputs(CoinFile(), {"coin.throws": 20.4}).coin.throws == 20
    with pytest.raises(PlantError, match="is no input of"):
        with_inputs(CoinFile(), {"coin.side": 1.0})


def test_templates_are_toml_whatever_they_say() -> None:
    for file in FILES:
        assert tomllib.loads(template(file, "", ""))


@pytest.mark.parametrize("words", CONFIGURATIONS)
def test_every_key_that_init_prints_is_explained_above_it(
    words: tuple[str, ...], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["init", *words]) == 0
    lines, listed, numbers = capsys.readouterr().out.splitlines()[1:], False, 0
    for above, line in pairwise(lines):
        listed = line.startswith("[[") if line.startswith("[") else listed  # the keys of a list are explained once
        if listed or " = " not in line or line.startswith("#"):
            continue
        assert above.startswith("# "), line
        if re.search(r"= \[*-?\d", line):
            assert re.match(r"# [^;]+; (any|fixed|\S+ to \S+); \S", above), line
            numbers += 1
    assert numbers > 20


def test_a_schema_has_limits_and_units(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["init", "computer", "--schema"]) == 0
    schema = json.loads(capsys.readouterr().out)
    speed = schema["$defs"]["Service"]["properties"]["speed_op_s"]
    assert (speed["minimum"], speed["maximum"], speed["unit"]) == (1.0, 1e15, "op/s")
    with pytest.raises(jsonschema.ValidationError, match="less than the minimum"):
        jsonschema.validate({"service": {"speed_op_s": 0.5}}, schema)


class Measured(Section):
    """A number, and lists and tables of them."""

    speed_m_s: float = setting(1.0, "m/s", 0.1, 5.0, "a speed")
    places_m: tuple[float, ...] = many((), 0, 3, "places", "places", "m")
    masses_t: dict[str, float] = many({}, 0, 3, "masses", "masses", "t")
    share: float = setting(0.5, "1", 0.0, 1.0, "a share")


def test_units_are_what_treaties_and_laws_say() -> None:
    # International yard and pound agreement of 1959: exact.
    assert in_unit("1 ft", "m") * 3.0 == pytest.approx(in_unit("1 yd", "m"), rel=1e-15) == pytest.approx(0.9144)
    assert in_unit("1 mph", "m/s") * 3600.0 == pytest.approx(1760.0 * 0.9144, rel=1e-15)
    assert in_unit("105 km/h", "m/s") * 3.6 == pytest.approx(105.0, rel=1e-15)
    assert in_unit("2000 lb", "t") == pytest.approx(in_unit("1 short tons", "t"), rel=1e-15)
    assert in_unit("2240 lb", "t") == pytest.approx(in_unit("1 long tons", "t"), rel=1e-15)
    assert in_unit("-1.5 %", "permille") == -15.0


def test_lists_and_tables_take_them_and_all_faults_are_told() -> None:
    tree = {"speed_m_s": "4 mph", "places_m": ["60ft", 20], "masses_t": {"L": "80 short tons"}}
    assert settings_in(Measured, tree, "x.toml") == Measured(
        speed_m_s=4 * 0.44704, places_m=(60 * 0.3048, 20.0), masses_t={"L": 80 * 0.90718474}
    )
    validator = jsonschema.Draft202012Validator(schema_of(Measured, "Measured"))
    assert validator.is_valid(tree)
    wrong = {"speed_m_s": "4 kn", "places_m": ["60 ft ahead"], "masses_t": {"L": "80 tons"}, "share": "50 %"}
    assert {error.path[0] for error in validator.iter_errors(wrong)} == set(wrong)
    with pytest.raises(InputError) as caught:
        settings_in(Measured, wrong, "x.toml")
    assert [each.split(";")[0] for each in caught.value.sentences] == [
        "x.toml: speed_m_s is '4 kn'",
        "x.toml: places_m[0] is '60 ft ahead'",
        "x.toml: masses_t.L is '80 tons'",
        "x.toml: share is '50 %'",
    ]
    assert caught.value.sentences[0].endswith(
        "; it must be a number in m/s, or in quotes a number with one of the units m/s, km/h, mph, ft/s"
    )
    with pytest.raises(InputError, match=r"speed_m_s is 13\.4112; it must be from 0\.1 to 5"):
        settings_in(Measured, {"speed_m_s": "30 mph"}, "x.toml")


WRITTEN = [
    pytest.param(file, path, value, unit, id=f"{type(file).__name__}-{'.'.join(path)}")
    for file in FILES
    for path, value, field in declared(file, ())
    if (unit := setting_unit(field)) in UNITS and isinstance(value, float) and setting_limits(field)
]


@pytest.mark.parametrize(("file", "path", "value", "unit"), WRITTEN)
def test_every_declared_number_may_be_written_with_its_units(
    file: Section, path: tuple[str, ...], value: float, unit: str
) -> None:
    for name, factor in UNITS[unit].items():
        found: Any = settings_in(type(file), nested(file, path, f"{value / factor:.12f} {name}"), "x.toml")
        for key in path:
            found = getattr(found, key)
        assert found == pytest.approx(value, rel=1e-9, abs=1e-9)


def test_the_page_tells_all_of_them() -> None:
    page = (Path(__file__).parents[2] / "docs" / "how-to" / "hump-trials.md").read_text(encoding="utf-8")
    for unit, written in UNITS.items():
        assert f"| {unit} | {', '.join(f'`{name}`' for name in written)} |\n" in page


def test_a_hump_file_takes_them_too_as_toml_and_as_a_table() -> None:
    hump = parse_hump(SMALL, "small", "small.toml")
    switch = hump.graph.switches[0]
    text = SMALL.replace(f"entry_joint_m = {switch.entry_joint_m:g}", 'entry_joint_m = "18 ft"')
    assert text != SMALL
    assert parse_hump(text, "small", "small.toml").graph.switches[0].entry_joint_m == pytest.approx(18 * 0.3048)
    table = to_csv(hump)
    column = table.splitlines()[0].split(",").index("entry_joint_m")
    rows = [line.split(",") for line in table.splitlines()]
    (row,) = (row for row in rows if row[0] == "switch" and str(switch.number) in row[:5])
    row[column] = "18 ft"
    again = from_csv("\n".join(map(",".join, rows)), "small", "small.csv")
    assert again.graph.switches[0].entry_joint_m == pytest.approx(18 * 0.3048)
    with pytest.raises(InputError, match="entry_joint_m is '18 mph'; it must be a number in m, or in quotes"):
        parse_hump(text.replace("18 ft", "18 mph"), "small", "small.toml")
