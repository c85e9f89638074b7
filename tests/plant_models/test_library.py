"""The library: it loads, says where each number is from, and refuses what is not as it should be."""

import re

import numpy as np
import pytest

from plant_models import PlantError, WeightForce
from plant_models.library import (
    BUILT_IN,
    CARS,
    RETARDERS,
    WEIGHT_CATEGORIES,
    YARD_CATEGORIES,
    Kind,
    TypeFile,
    TypeFileError,
    WeightCategories,
    car_names,
    load_car,
    load_position,
    load_weight_categories,
    position_names,
)
from plant_models.library.car_entry import car_from
from plant_models.library.position_entry import INITIAL_STAGE
from plant_models.library.retarder_entry import retarder_from
from plant_models.library.weight_category import categories_from

GOOD = BUILT_IN.file(RETARDERS, "knp-5").text
CATEGORIES = BUILT_IN.file(WEIGHT_CATEGORIES, YARD_CATEGORIES).text
YARD = load_weight_categories()
DELAY = next(line for line in GOOD.splitlines() if line.startswith("brake_delay_s"))


def bad(kind: Kind, text: str) -> TypeFile:
    """A file of the library with this text."""
    return TypeFile(kind, "bad", text, f"{kind.folder}/bad.toml")


def categories_in(text: str) -> WeightCategories:
    """The categories written in `text`."""
    return categories_from(TypeFile(WEIGHT_CATEGORIES, "x", text, "weight_categories.toml"))


def test_holds_the_promised_types() -> None:
    assert {"knp-5-bunch", "vzpg-5-bunch", "rnz-2m-park", "t-50-bunch", "kv-3-bunch"} <= set(position_names())
    assert {"rnz-2m-dumper"} <= set(position_names())
    retarders = set(BUILT_IN.names(RETARDERS))
    assert {"knp-5", "vzpg-5", "rnz-2m", "rnz-2m-oiled", "t-50", "kv-3"} <= retarders
    assert not set(position_names()) & retarders  # a message calls both by the name alone
    assert {"gondola-4", "box-4", "flat-4", "tank-4", "hopper-4", "tank-8", "gondola-6"} <= set(car_names())


@pytest.mark.parametrize("name", position_names())
def test_every_number_of_a_position_has_an_origin(name: str) -> None:
    entry = load_position(name)
    assert entry.position.name == name
    stated = [v for v in entry.provenance if v.key != INITIAL_STAGE]
    assert all(v.source and v.confidence and v.range is not None and v.in_range for v in stated)
    assert any(v.assumed for v in entry.provenance)
    assert entry.entry.high_m_s <= entry.position.max_entry_speed_m_s
    assert max(entry.target_speeds_m_s) < entry.entry.high_m_s


@pytest.mark.parametrize("name", car_names())
def test_every_car_loads_with_equal_overhangs_left_over(name: str) -> None:
    entry = load_car(name)
    assert 0.5 < (entry.car.length_m - entry.car.axle_offsets_m[-1]) / 2 < 2.5
    assert all(v.source and v.in_range for v in entry.provenance)


def test_full_stage_force_is_that_of_the_facts() -> None:
    position = load_position("knp-5-bunch").position
    cut_free_slope = position.force.slope_kn_per_kpa(None, 1)  # type: ignore[arg-type]  # a pressing force asks no cut
    assert cut_free_slope * (600 - 50) == pytest.approx(20.0)
    assert position.zones_m == ((0.0, 12.475), (14.475, 26.95))


def test_weight_force_gives_the_energy_head_whatever_the_mass() -> None:
    position = load_position("kv-3-bunch").position
    assert isinstance(position.force, WeightForce)
    over = position.stage_pressures_kpa[-1] - position.force.touch_pressure_kpa
    head_m = position.force.slope_kn_per_kpa_per_t * over * 12.475 / 9.81
    assert head_m == pytest.approx(1.2, rel=1e-3)


def test_axle_patterns() -> None:
    assert load_car("gondola-4").car.axle_offsets_m == (0.0, 1.85, 8.65, 10.5)
    assert load_car("tank-8").car.axle_offsets_m == (0.0, 1.85, 3.2, 5.05, 13.79, 15.64, 16.99, 18.84)
    assert len(load_car("gondola-6").car.axle_offsets_m) == 6


@pytest.mark.parametrize(
    ("mass_t", "axles", "name"),
    [
        (22, 4, "Л"),
        (28, 4, "Л"),
        (28.01, 4, "ЛС"),
        (44, 4, "ЛС"),
        (60, 4, "С"),
        (72, 4, "СТ"),
        (72.1, 4, "Т"),
        (33, 6, "Л"),
        (48, 8, "Л"),
        (176, 8, "Т"),
        (120, 8, "С"),
        (500, 4, "Т"),
    ],
)
def test_weight_category_goes_by_axle_load(mass_t: float, axles: int, name: str) -> None:
    assert YARD.of(mass_t, axles).name == name


def test_weight_categories_keep_their_numbers_wherever_they_stand() -> None:
    assert {c.name: c.number for c in YARD.members} == {"Л": 1, "ЛС": 2, "С": 3, "СТ": 4, "Т": 5}
    first, *others = CATEGORIES.split("\n[")
    heaviest = f"{first}\n[{others[-1]}".replace(
        "value = 72.0, range = [72.0, 72.0]", "value = 0.0, range = [0.0, 0.0]"
    )
    assert [(c.name, c.number) for c in categories_in(heaviest).members] == [("Т", 5)]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("number = 3\n", "", "S: number is None; it must be 3, the number of С in every table"),
        ("number = 3\n", "number = 6\n", "S: number is 6"),
        ("number = 3\n", "number = 256\n", "S: number is 256"),
        ("number = 3\n", "number = true\n", "S: number is True"),
        ("number = 3\n", "number = 1\n", "S: number is 1"),
        ('name = "С"', 'name = "Л"', "S: number is 3; it must be 1, the number of Л"),
        ('name = "С"', 'name = "X"', "S: number is 3; it must be a whole number from 16 to 255"),
    ],
)
def test_a_category_without_a_number_of_its_own_is_refused(old: str, new: str, message: str) -> None:
    assert CATEGORIES.count(old) == 1
    with pytest.raises(PlantError, match=rf"weight_categories.toml, line \d+: {message}"):
        categories_in(CATEGORIES.replace(old, new))


def test_weight_categories_are_those_of_the_facts() -> None:
    assert [c.name for c in YARD.members] == ["Л", "ЛС", "С", "СТ", "Т"]
    assert [c.allowed_stage for c in YARD.members] == [2, 3, 4, 4, 4]
    shapes = [c.resistance.shape for c in YARD.members]
    np.testing.assert_allclose(shapes, [6.82, 6.81, 7.84, 10.82, 12.35], atol=0.005)


@pytest.mark.parametrize(
    ("typed", "name"), [("Л", "Л"), ("LS", "ЛС"), ("CT", "СТ"), ("T", "Т"), ("S", "С"), ("C", "С")]
)
def test_categories_answer_to_latin_letters(typed: str, name: str) -> None:
    assert YARD.named(typed).name == name


def test_unknown_names_get_a_hint() -> None:
    with pytest.raises(PlantError, match="did you mean knp-5-bunch"):
        load_position("knp5-bunch")
    with pytest.raises(PlantError, match="known: box-4"):
        load_car("zzz")
    with pytest.raises(PlantError, match="weight category 'XX' is not in the library"):
        YARD.named("XX")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "brake_delay_s",
            "brake_dela_s",
            r"unknown key pneumatics.brake_dela_s; did you mean .*brake_delay_s",
        ),
        (DELAY, "", r"key pneumatics.brake_delay_s is missing"),
        (DELAY, "brake_delay_s = 0.1", r"pneumatics.brake_delay_s is 0.1; it must be a table"),
        (
            DELAY,
            DELAY.replace("value = 0.1", "value = '0.1'"),
            r"brake_delay_s.value is '0.1'; it must be a finite number",
        ),
        (DELAY, DELAY.replace("value = 0.1", "value = nan"), r"brake_delay_s.value is nan; it must be a finite number"),
        (DELAY, DELAY.replace("value = 0.1", "value = true"), r"brake_delay_s.value is True"),
        (
            DELAY,
            DELAY.replace("value = 0.1", "value = 0.3"),
            r"brake_delay_s.value is 0.3; it is outside its own range",
        ),
        (DELAY, DELAY.replace("[0.05, 0.20]", "[0.2, 0.05]"), r"brake_delay_s.range is \[0.2, 0.05\]"),
        (DELAY, DELAY.replace('"L"', '"X"'), r"brake_delay_s.confidence is 'X'; it must be one of H"),
        (
            DELAY,
            DELAY.replace("source", "sauce"),
            r"unknown key pneumatics.brake_delay_s.sauce; did you mean source",
        ),
        (
            DELAY,
            DELAY.replace(', confidence = "L"', ""),
            r"key pneumatics.brake_delay_s.confidence is missing",
        ),
        ('law = "pressing"', 'law = "presing"', r"law is 'presing'; did you mean pressing"),
        ('law = "pressing"', 'law = "weight"', r"unknown key force.slope_kn_per_kpa; did you mean"),
        ("value = 12.475", "value = [12.475]", r"length_m.value is \[12.475\]; it must be a finite number"),
        (
            "value = 700.0, range = [600.0, 800.0]",
            "value = 500.0, range = [400.0, 800.0]",
            r"stage_pressures_kpa ends at 600; the supply of 500 kPa cannot reach it",
        ),
        ("[force]", "[force", r"not valid TOML: .*line"),
        ("value = 12.475", f"value = 0x{'f' * 5000}", "thousands of digits"),
    ],
)
def test_damaged_retarder_file_is_refused_by_name_and_key(old: str, new: str, message: str) -> None:
    assert GOOD.count(old) >= 1
    with pytest.raises(PlantError, match=r"retarders/bad.toml(, line \d+)?: .*" + message):
        retarder_from(bad(RETARDERS, GOOD.replace(old, new, 1)))


def test_damaged_car_and_category_files_are_refused() -> None:
    with pytest.raises(PlantError, match=r"cars/bad.toml: key title is missing"):
        car_from(bad(CARS, ""))
    swapped = CATEGORIES.replace("value = 28.0, range = [28.0, 28.0]", "value = 70.0, range = [0.0, 90.0]")
    with pytest.raises(PlantError, match=r"weight_categories.toml, line \d+: S: mass_above_t is 44"):
        categories_in(swapped)
    with pytest.raises(PlantError, match="holds no category"):
        categories_in('title = "none"')


def test_with_values_marks_what_changed_and_only_that() -> None:
    entry = load_position("knp-5-bunch")
    changed = entry.with_values({"retarder.pneumatics.brake_delay_s": 0.12, "sensor.noise_m_s": 0.05})
    assert changed.position.pneumatics.brake_delay_s == 0.12
    sources = {v.key: v.source for v in changed.provenance}
    assert sources["retarder.pneumatics.brake_delay_s"] == "configuration"
    assert sources["sensor.noise_m_s"].startswith("engineering judgement: ")
    assert entry.position.pneumatics.brake_delay_s == 0.10
    with pytest.raises(PlantError, match=r"slope_kn_per_kpa_per_t is 1.0; the pressing force law of knp-5-bunch"):
        entry.with_values({"retarder.force.slope_kn_per_kpa_per_t": 1.0})


def test_all_faults_of_the_numbers_of_a_file_are_told_each_with_its_line() -> None:
    late = GOOD.replace("brake_delay_s = { value = 0.1", "brake_delay_s = { value = 9.1")
    text = late.replace("dead_band_kpa", "dead_band")
    with pytest.raises(TypeFileError) as caught:
        retarder_from(bad(RETARDERS, text))
    unknown, outside = caught.value.sentences
    lines = text.splitlines()
    for sentence, key in ((unknown, "dead_band"), (outside, "brake_delay_s")):
        told = re.match(r"retarders/bad\.toml, line (\d+): (?:unknown key )?pneumatics\.(\w+)", sentence)
        assert told is not None, sentence
        assert told[2] == key
        assert lines[int(told[1]) - 1].startswith(key)
