"""Types of one's own, in files and in the configurations that use them: found, checked, traced to their files, refused
in one sentence.
"""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import jsonschema
import pytest

from plant_models.library import CARS, KINDS, POSITIONS, RETARDERS, Kind, TypeFile, load_car
from plant_models.library.hump_forms import unit_in_name
from plant_models.library.library import BUILT_IN, Library, TypeFileError
from synth.cli.type_template import START_FROM, type_toml
from synth.frame.faults import InputError
from synth.frame.settings.numbers import schema_of
from synth.frame.settings.settings_file import settings_in
from synth.retarder.configuration.config_file import load_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.configuration.settings import Settings

CUT = '[[cut]]\ncar = "gondola-4"\nmass_t = 22\n'


def own(folder: Path, kind: Kind, name: str, **changes: str) -> Path:
    """A file as init prints it under another name; `changes`: lines by the key that they begin with."""
    lines = type_toml(kind, None).splitlines()
    for key, line in changes.items():
        (place,) = (i for i, text in enumerate(lines) if text.startswith(f"{key} "))
        lines[place] = line
    path = folder / kind.folder / f"{name}.toml"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join(lines), encoding="utf-8")
    return path


def config_in(folder: Path, text: str) -> ResolvedConfig:
    """The configuration `text` as a file in `folder`."""
    path = folder / "my.toml"
    path.write_text(text, encoding="utf-8")
    return load_config(path)


def sentences(folder: Path, text: str) -> tuple[str, ...]:
    """What is said of the faulty configuration `text`."""
    with pytest.raises(InputError) as caught:
        config_in(folder, text)
    return caught.value.sentences


def number(key: str, value: object, span: str = "[0.0, 1000.0]") -> str:
    """The line of a number."""
    return f'{key} = {{ value = {value}, range = {span}, source = "test", confidence = "L" }}'


USED = {
    "positions": '[position]\nname = "mine"\n',
    "retarders": '[retarder]\ntype = "mine"\n',
    "cars": '[[cut]]\ncar = "mine"\nmass_t = 22\n',
    "sensors": '[sensor]\ntype = "mine"\n',
    "wheel_sensors": '[sensors]\ntype = "mine"\npath_m = [-4.0, 6.0]\n',
    "weight_categories": 'weight_categories = "mine"\n',
}
"""A configuration that uses the type "mine", by its kind; tracks and car mixes are of an aim configuration."""


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind.folder in USED], ids=lambda kind: kind.folder)
def test_what_init_prints_reads_back_as_a_type_of_ones_own(kind: Kind, tmp_path: Path) -> None:
    own(tmp_path / "my", kind, "mine")
    text = USED[kind.folder]
    changed = config_in(tmp_path, f'library = ["my/"]\n{text}')
    same = config_in(tmp_path, text.replace("mine", START_FROM[kind]))
    assert changed.plants()[0][1].cut == same.plants()[0][1].cut
    assert changed.retarder.sensor == same.retarder.sensor
    assert [each.sensors and each.sensors.sensors for each in (changed, same)].count(None) in (0, 2)
    assert changed.retarder.position.zones_m == same.retarder.position.zones_m
    traced = {p.key for p in changed.parameters if p.source.endswith(f"(my/{kind.folder}/mine.toml)")}
    assert traced, "the numbers must name the user's file"
    for p, q in zip(changed.parameters, same.parameters, strict=True):
        if p.key in traced:
            assert p.source.startswith(q.source)
            assert (p.value, p.range, p.confidence, p.assumed) == (q.value, q.range, q.confidence, q.assumed)
        else:
            assert replace(p, source="") == replace(q, source="")  # masses of another car are no default book


def test_files_are_named_by_path_from_the_file_that_names_them(tmp_path: Path) -> None:
    own(tmp_path / "here", CARS, "short", length_m=number("length_m", 12.0))
    own(tmp_path / "there", RETARDERS, "strong")
    site = own(tmp_path / "there", POSITIONS, "hump-2", retarder='retarder = "../retarders/strong.toml"')
    assert site.is_file()
    text = '[position]\nname = "there/positions/hump-2.toml"\n[[cut]]\ncar = "here/cars/short.toml"\nmass_t = 22\n'
    config = config_in(tmp_path, text)
    assert config.retarder.name == config.plants()[0][1].position.name == "hump-2"
    assert config.cuts[0].label == "short-22t"
    sources = {p.key: p.source for p in config.parameters}
    assert sources["cut[0].car.length_m"].endswith("(here/cars/short.toml)")
    assert sources["retarder.force.touch_pressure_kpa"].endswith("(there/positions/../retarders/strong.toml)")


FAULTS = {
    "unknown key": (CARS, "length_m", number("lenght_m", 12.0), "unknown key lenght_m; did you mean length_m?"),
    "missing key": (CARS, "gross_t", "", "key gross_t is missing"),
    "plain number": (CARS, "tare_t", "tare_t = 20", "tare_t is 20; it must be a table of value, range, source"),
    "wrong type": (CARS, "tare_t", number("tare_t", '"x"'), "tare_t.value is 'x'; it must be a finite number"),
    "outside its range": (CARS, "tare_t", number("tare_t", 5, "[6, 9]"), "tare_t.value is 5; it is outside its own"),
    "too long": (CARS, "length_m", number("length_m", 250.0), "length_m is 250.0; it must be a finite number from"),
    "axles do not rise": (
        CARS, "bogie_axle_offsets_m", number("bogie_axle_offsets_m", "[0.0, 0.0]"), "axle_offsets_m is (0.0, 0.0",
    ),
    "stages fall": (
        RETARDERS, "stage_pressures_kpa", number("stage_pressures_kpa", "[0, 300, 150]"),
        "stage_pressures_kpa is (0.0, 300.0, 150.0); give at least two pressures, each above the one before",
    ),
    "supply too low": (
        RETARDERS, "supply_pressure_kpa", number("supply_pressure_kpa", 500.0), "the supply of 500 kPa cannot reach",
    ),
    "no such law": (RETARDERS, "law", 'law = "hydraulic"', "law is 'hydraulic'; known: pressing, weight"),
    "zones overlap": (POSITIONS, "starts_m", number("starts_m", "[0.0, 9.0]"), "zones_m is .* must not overlap"),
    "no such retarder": (
        POSITIONS, "retarder", 'retarder = "knp-6"', "retarder 'knp-6' is not in the library; did you mean knp-5?",
    ),
    "no such file": (POSITIONS, "sensor", 'sensor = "x.toml"', "sensor names the file .*x.toml', which does not exist"),
    "entry too fast": (POSITIONS, "high_m_s", number("high_m_s", 9.0), "entry.the highest speed is 9 m/s; "),
    "not valid TOML": (CARS, "title", "title = ", "not valid TOML"),
}  # fmt: skip


@pytest.mark.parametrize("name", FAULTS)
def test_a_faulty_file_is_told_in_one_sentence_with_file_key_and_value(name: str, tmp_path: Path) -> None:
    kind, key, line, said = FAULTS[name]
    path = own(tmp_path / "my", kind, "mine", **{key: line})
    (sentence,) = sentences(tmp_path, f'library = ["my/"]\n{USED[kind.folder]}')
    assert re.match(rf"{re.escape(str(path))}(, line \d+)?: ", sentence), sentence
    assert re.search(said if ".*" in said else re.escape(said), sentence), sentence
    assert "\n" not in sentence


def test_a_name_of_the_library_is_not_to_be_had(tmp_path: Path) -> None:
    for kind, name in ((CARS, "gondola-4"), (CARS, "Gondola-4"), (POSITIONS, "knp-5"), (RETARDERS, "knp-5-bunch")):
        path = own(tmp_path / name / kind.folder, kind, name)
        (sentence,) = sentences(tmp_path, f'library = ["{name}/{kind.folder}/"]\n')
        assert sentence.startswith(f"{path}: its name {name} is that of a ")
        assert sentence.endswith("rename the file")
    one, two = (own(tmp_path / folder, CARS, "mine") for folder in ("a", "b"))
    (sentence,) = sentences(tmp_path, 'library = ["a", "b"]\n')
    assert sentence == f"{two}: {one} gives the name mine, too; rename one of the two files"


@pytest.mark.parametrize("name", ["-x", "a b", "x" * 41, "con", "a.", "ä", "a;b", "*/", '"'])
def test_a_name_that_no_file_or_code_should_bear_is_refused(name: str) -> None:
    with pytest.raises(TypeFileError, match="rename the file"):
        TypeFile(CARS, name, "", "x.toml")


def test_folders_and_files_that_are_not_there_are_all_told(tmp_path: Path) -> None:
    (tmp_path / "my" / "car").mkdir(parents=True)
    (tmp_path / "my" / "car" / "x.toml").write_text("", encoding="utf-8")
    text = 'library = ["my/", "nowhere/"]\n[[cut]]\ncar = "x.toml"\nmass_t = 22\n'
    first, second, third = sentences(tmp_path, text)
    assert "library[0]" in first
    assert "did you mean cars?" in first
    assert "library[1] is 'nowhere/', and there is no such folder; give one that holds positions/" in second
    assert "cut[0].car names the file" in third
    assert third.endswith("'retarder-synth init car' prints one to start from")


def test_a_position_with_another_retarder_is_called_by_both_names(tmp_path: Path) -> None:
    own(tmp_path / "my", RETARDERS, "mine")
    config = config_in(tmp_path, 'library = ["my"]\nretarder.type = "mine"\n')
    assert config.plants()[0][1].position.name == config.retarder.name == "knp-5-bunch-with-mine"
    assert config_in(tmp_path, 'retarder.type = "knp-5"\n').retarder.name == "knp-5-bunch"
    (sentence,) = sentences(tmp_path, 'retarder.type = "knp-6"\n')
    assert sentence.endswith("retarder.type is 'knp-6', which the library does not hold; did you mean knp-5?")


def test_a_categorys_table_that_would_write_on_a_terminal_is_refused_in_quotes(tmp_path: Path) -> None:
    (tmp_path / "x.toml").write_text('title = "x"\n"\\u001b[31m" = 5\n', encoding="utf-8")
    (sentence,) = sentences(tmp_path, 'weight_categories = "x.toml"\n')
    assert "'\\x1b[31m' is no name of a category's table" in sentence
    assert sentence.isprintable()


def test_a_library_without_own_types_is_that_of_the_program() -> None:
    assert Library() == BUILT_IN
    assert load_car("gondola-4").name == "gondola-4"


def test_a_position_that_does_not_state_how_uncertain_its_mean_friction_is_takes_it_as_known(tmp_path: Path) -> None:
    own(tmp_path, POSITIONS, "silent", mean_cv="")
    own(tmp_path, POSITIONS, "telling", mean_cv=number("mean_cv", "0.11"))
    text = 'library = ["{}/"]\n[position]\nname = "{}"\n' + CUT
    silent, telling = (config_in(tmp_path, text.format(".", name)) for name in ("silent", "telling"))
    assert silent.retarder.friction.mean_cv == 0.0
    assert telling.retarder.friction.mean_cv == 0.11
    (told,) = (value for value in silent.parameters if value.key == "friction.mean_cv")
    assert told.source.startswith("not stated")


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
