"""Numbers with a unit of their own: every declared number takes those of its kind, and no others."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import jsonschema
import pytest

from plant_models.library.written_units import UNITS, in_unit, unit_in_name
from synth.frame.input_error import InputError
from synth.frame.settings.schema import schema_of
from synth.frame.settings.section import Section, many, setting, setting_limits, setting_unit
from synth.frame.settings.settings_file import settings_in
from synth.hump.forms.hump_csv import from_csv, to_csv
from synth.hump.hump_file import parse_hump
from synth.retarder.configuration.settings import Settings
from tests.frame.test_declared_settings import FILES, declared, nested
from tests.plant_models.hump.small_hump import SMALL


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


def test_numbers_of_the_library_take_those_of_the_unit_in_their_key() -> None:
    tree = {
        "entry": {"low_m_s": "18 km/h"},
        "targets": {"exit_speeds_m_s": [2.5, "9 km/h"]},
        "track": {"grade_permille": "1.1 %"},
        "cut": [{"car": "gondola-4", "mass_t": "80 short tons"}],
    }
    found = settings_in(Settings, tree, "x.toml")
    assert (found.entry.low_m_s, found.targets.exit_speeds_m_s, found.track.grade_permille) == (5.0, (2.5, 2.5), 11.0)
    assert found.cut[0].mass_t == pytest.approx(72.574779)
    validator = jsonschema.Draft202012Validator(schema_of(Settings, "Configuration"))
    assert validator.is_valid(tree)
    assert not validator.is_valid({"entry": {"low_m_s": "18 t"}})
    assert unit_in_name("slope_kn_per_kpa_per_t") == unit_in_name("delay_s") == ""


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
