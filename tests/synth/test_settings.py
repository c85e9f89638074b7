"""Configuration files: defaults, overrides, origin of numbers, and one sentence for each fault."""

import hashlib
import json
from pathlib import Path

import pytest

from plant_models.library import position_names
from synth.frame.faults import InputError
from synth.problem.resolution import Resolution
from synth.retarder.configuration.config_file import default_config_toml, load_config, parse_config
from tuning_tables.json_text import canonical_json

CUT = '[[cut]]\ncar = "gondola-4"\nmass_t = 22\n'


def test_default_book() -> None:
    config = load_config(None)
    assert config.retarder.name == "knp-5-bunch"
    assert config.retarder.profile.grades_permille == (8.0,)
    assert [c.cut.mass_t for c in config.cuts] == [22, 36, 52, 66, 85]
    assert [c.cut.category for c in config.cuts] == ["Л", "ЛС", "С", "СТ", "Т"]
    assert [c.cut.allowed_stage for c in config.cuts] == [2, 3, 4, 4, 4]
    assert config.targets_m_s == (2.0, 3.0, 4.0)
    assert (config.entry.low_m_s, config.entry.high_m_s) == (5.0, 6.5)
    friction = config.retarder.friction
    assert (friction.common_cv, friction.axle_cv, friction.path_std) == (0.15, 0.0, 0.10)
    assert config.resolution == Resolution()
    assert (config.validation.passes, config.validation.seed, config.fit.degree) == (20_000, 20261120, 3)
    assert len(config.plants()) == 5
    assert len(config.problems()) == 15
    assert config.warnings == ()


def test_an_empty_file_is_the_default_book() -> None:
    assert parse_config("", "x.toml") == load_config(None)


@pytest.mark.parametrize("name", position_names())
def test_template_reads_back_to_the_defaults(name: str) -> None:
    config = parse_config(default_config_toml(name), "template")
    assert config == parse_config(f'position.name = "{name}"', "short")
    assert config.warnings == ()
    assert all(p.source != "configuration" for p in config.parameters)


def test_only_what_is_set_replaces_the_library() -> None:
    config = parse_config("[retarder.pneumatics]\nbrake_delay_s = 0.12\n[sensor]\nnoise_m_s = 0.02\n", "x.toml")
    default = load_config(None)
    assert config.retarder.position.pneumatics.brake_delay_s == 0.12
    changed = {p.key for p in config.parameters if p.source == "configuration"}
    assert changed == {"retarder.pneumatics.brake_delay_s", "sensor.noise_m_s"}
    assert not any(p.assumed for p in config.parameters if p.source == "configuration")
    assert config.sha256 != default.sha256
    before, after = json.loads(default.canonical_json()), json.loads(config.canonical_json())
    after["retarder"]["pneumatics"]["brake_delay_s"], after["sensor"]["noise_m_s"] = 0.10, 0.05
    assert before == after


def test_canonical_json_is_sorted_and_ignores_spelling_title_and_output() -> None:
    one = parse_config('title = "a"\ntrack.grade_permille = 8\n[output]\ncsv = true', "one.toml")
    two = parse_config("[track]\ngrade_permille = 8.0", "two.toml")
    assert one.canonical_json() == two.canonical_json()
    assert one.sha256 == two.sha256
    tree = json.loads(one.canonical_json())
    assert one.canonical_json().encode() == canonical_json(tree)
    assert one.sha256 == hashlib.sha256(one.canonical_json().encode()).hexdigest()


def test_how_uncertain_the_mean_friction_is_counts_only_where_lines_are_designed_for_it() -> None:
    known, thought = "[friction]\nmean_cv = 0.0\n", "[friction]\nmean_cv = 0.12\n"
    plain, estimator = "[regulator]\nestimator = false\n", "[regulator]\nestimator = true\n"
    by_mean = [[parse_config(mean + text, "x.toml") for mean in (known, thought)] for text in (plain, estimator)]
    assert by_mean[0][0].sha256 == by_mean[0][1].sha256
    assert by_mean[1][0].sha256 != by_mean[1][1].sha256
    assert "mean_cv" not in by_mean[1][0].canonical_json()
    assert by_mean[1][1].plants()[0][1].friction.mean_cv == 0.12


def test_every_parameter_is_listed_once() -> None:
    keys = [p.key for p in load_config(None).parameters]
    assert len(keys) == len(set(keys))
    assert {"retarder.pneumatics.brake_delay_s", "cut[4].mass_t", "cut[0].allowed_stage", "grid.path_step_m"} <= set(
        keys
    )


def test_cut_of_several_cars() -> None:
    text = (
        '[[cut]]\ncar = "gondola-4"\ncars = 3\nmass_t = 180\nrolling_resistance.std_n_per_kn = 0.2\nallowed_stage = 3\n'
    )
    (cut,) = parse_config(text, "x.toml").cuts
    assert cut.label == "gondola-4x3-180t"
    assert (cut.cut.axles, cut.cut.category, cut.cut.allowed_stage) == (12, "С", 3)
    assert (cut.resistance.mean_n_per_kn, cut.resistance.std_n_per_kn) == (1.40, 0.2)


def test_grade_in_pieces_and_other_zones() -> None:
    text = "track.grade_permille = [[0, 8], [12, 5]]\nretarder.zones_m = [[0, 12.475]]\n"
    config = parse_config(text, "x.toml")
    assert config.retarder.profile.starts_m == (0.0, 12.0)
    assert config.retarder.profile.grades_permille == (8.0, 5.0)
    assert config.plants()[0][1].exit_m == pytest.approx(22.975)


def test_weight_retarder_takes_its_own_slope() -> None:
    text = 'position.name = "kv-3-bunch"\nretarder.force.slope_kn_per_kpa_per_t = 0.0018\n'
    label, plant = parse_config(text, "x.toml").plants()[0]
    assert label == "gondola-4-22t"
    assert plant.position.force.slope_kn_per_kpa(plant.cut, 1) == pytest.approx(0.0018 * 5.5)
    assert plant.top_stage == 1


def test_unusual_values_are_warned_of_not_refused() -> None:
    text = f'retarder.pneumatics.brake_delay_s = 0.5\n{CUT}category = "T"\n'
    warnings = parse_config(text, "x.toml").warnings
    assert warnings[0] == "retarder.pneumatics.brake_delay_s is 0.5; its sensible range is 0.05 to 0.2 s"
    assert warnings[1] == "cut[0].category is Т; by its axle load the cut is Л"
    (shares,) = parse_config("friction.mean_cv = 0.3\n", "x.toml").warnings
    assert shares == "friction.mean_cv is 0.3; its sensible range is 0 to 0.25"


@pytest.mark.requirement("CMD-02")
@pytest.mark.parametrize(
    ("text", "key", "value", "rest"),
    [
        (
            "[retarder.pneumatics]\nbrake_delay = 0.1",
            "retarder.pneumatics.brake_delay",
            "0.1",
            "did you mean brake_delay_s?",
        ),
        (
            "[retarder]\nbrake_delay_s = 0.1",
            "retarder.brake_delay_s",
            "0.1",
            "did you mean retarder.pneumatics.brake_delay_s?",
        ),
        ("[retader]\nname = 'x'", "retader", "'x'", "did you mean retarder?"),
        ("[grid]\nzzz = 1", "grid.zzz", "1", "known: friction_scenarios"),
        ("[position]\nname = 'knp-5'", "position.name", "'knp-5'", "did you mean knp-5-bunch?"),
        ("[position]\nname = 5", "position.name", "5", "a string"),
        ("[retarder.pneumatics]\nbrake_delay_s = -0.1", "retarder.pneumatics.brake_delay_s", "-0.1", "from 0 to 5"),
        ("[retarder.pneumatics]\nbrake_delay_s = '0.1'", "retarder.pneumatics.brake_delay_s", "'0.1'", "a number"),
        ("[retarder.pneumatics]\nbrake_delay_s = true", "retarder.pneumatics.brake_delay_s", "true", "a number"),
        (
            "[retarder.pneumatics]\nclosing_delay_s = 0.2",
            "retarder.pneumatics.closing_delay_s",
            "0.2",
            "shorten the delay",
        ),
        (
            "[retarder.pneumatics]\nsupply_pressure_kpa = 500",
            "retarder.stage_pressures_kpa",
            "600",
            "raise supply_pressure_kpa",
        ),
        ("[retarder]\nzones_m = [[0, 12], [10, 20]]", "retarder.zones_m", "(10.0, 20.0)", "must not overlap"),
        ("[retarder]\nzones_m = [[0, 12], [14]]", "retarder.zones_m", "[14]", "a list of at least one pair"),
        ("[retarder]\nzones_m = [[1, 12]]", "retarder.zones_m", "(1.0, 12.0)", "must start at 0"),
        ("[retarder.pneumatics]\ndead_band_kpa = 90", "retarder.pneumatics.dead_band_kpa", "90", "overlap"),
        ("[retarder]\nzones_m = 12", "retarder.zones_m", "12", "a list of at least one pair"),
        (
            "[retarder]\nstage_pressures_kpa = [0, 300, 150]",
            "retarder.stage_pressures_kpa",
            "150.0",
            "each above the one before",
        ),
        ("[retarder]\nstage_pressures_kpa = [0, nan]", "retarder.stage_pressures_kpa", "nan", "finite number"),
        (
            "[retarder.force]\nslope_kn_per_kpa_per_t = 0.1",
            "retarder.force.slope_kn_per_kpa_per_t",
            "0.1",
            "did you mean",
        ),
        ("[retarder.force]\nslope_kn_per_kpa = 0", "retarder.force.slope_kn_per_kpa", "0.0", "from 0.0001 to 10"),
        ("[track]\ngrade_permille = 99", "track.grade_permille", "99.0", "from -60 to 60"),
        ("[track]\ngrade_permille = [[5, 1], [0, 2]]", "track.grade_permille", "(5.0, 0.0)", "must increase"),
        ("[track]\ngrade_permille = 'steep'", "track.grade_permille", "'steep'", "finite number or a list of pairs"),
        ("[entry]\nlow_m_s = 7", "entry.high_m_s", "6.5", "from low_m_s = 7"),
        ("[entry]\nhigh_m_s = 8", "entry.high_m_s", "8", "at most 7 m/s"),
        ("[friction]\ncommon_cv = 3", "friction.common_cv", "3.0", "from 0 to 0.6"),
        ("[friction]\nmean_cv = 0.5", "friction.mean_cv", "0.5", "from 0 to 0.3"),
        ("[sensor]\nnoise_m_s = nan", "sensor.noise_m_s", "nan", "a finite number"),
        ("[sensor]\nnoise_m_s = inf", "sensor.noise_m_s", "inf", "a finite number"),
        ("[sensor]\nsample_period_s = 0", "sensor.sample_period_s", "0.0", "from 0.005 to 2"),
        ("[targets]\nexit_speeds_m_s = [2, 9]", "targets.exit_speeds_m_s", "9.0", "below the highest entry speed"),
        ("[targets]\nexit_speeds_m_s = [0.1]", "targets.exit_speeds_m_s", "0.1", "at least 0.3 m/s"),
        ("[targets]\nexit_speeds_m_s = [2, 2]", "targets.exit_speeds_m_s", "2.0", "once"),
        ("[targets]\nexit_speeds_m_s = []", "targets.exit_speeds_m_s", "[]", "at least one"),
        ("[grid]\nfriction_scenarios = 2.5", "grid.friction_scenarios", "2.5", "a whole number"),
        ("[output]\nplots = 1", "output.plots", "1", "true or false"),
        ("sensor = 5", "sensor", "5", "a table"),
        ("cut = []", "cut", "[]", "1 to 1000 [[cut]]"),
        ("[cut]\ncar = 'gondola-4'\nmass_t = 22", "cut", "22", "write [[cut]], not [cut]"),
        ("[[cut]]\ncar = 'gondola-4'", "cut[0].mass_t", "missing", "add it to cut[0]"),
        (CUT + "[[cut]]\ncar = 'gondla-4'\nmass_t = 22", "cut[1].car", "'gondla-4'", "did you mean gondola-4?"),
        ("[[cut]]\ncar = 'gondola-4'\nmass_t = -22", "cut[0].mass_t", "-22.0", "from 22 t (tare) to 94 t (gross)"),
        (CUT + "cars = 2", "cut[0].mass_t", "22.0", "from 44 t"),
        (CUT + "cars = 0", "cut[0].cars", "0", "from 1 to 60"),
        (CUT + "category = 'XL'", "cut[0].category", "'XL'", "not in the library"),
        (CUT + "allowed_stage = 5", "cut[0].allowed_stage", "5", "from 1 to 4"),
        (
            CUT + "rolling_resistance.mean_n_per_kn = 0",
            "cut[0].rolling_resistance.mean_n_per_kn",
            "0.0",
            "from 0.01 to 50",
        ),
        (CUT + "label = 'a/b'", "cut[0].label", "'a/b'", "letters, digits"),
        (CUT + CUT, "cut[1].label", "'gondola-4-22t'", "give one of the two another label"),
    ],
)
def test_each_fault_is_one_sentence_with_file_key_and_value(text: str, key: str, value: str, rest: str) -> None:
    with pytest.raises(InputError) as caught:
        parse_config(text, "my.toml")
    sentence = str(caught.value)
    assert sentence.startswith(f"my.toml: {key}")
    assert value in sentence
    assert rest in sentence
    assert "\n" not in sentence
    assert "pydantic" not in sentence


@pytest.mark.parametrize("value", ["1" + "0" * 400, "1e400", "-1e400"])
@pytest.mark.parametrize("key", ["sensor.noise_m_s", "track.grade_permille", "grid.path_levels"])
def test_numbers_beyond_floats_are_input_faults(key: str, value: str) -> None:
    with pytest.raises(InputError, match=f"my.toml: {key} is"):
        parse_config(f"{key} = {value}", "my.toml")


def test_every_fault_is_told_in_a_line_of_its_own() -> None:
    text = "[[cut]]\ncar = 'gondola-4'\nmas_t = 22\n[grid]\npath_step_m = 'x'\npath_levels = 99\n"
    with pytest.raises(InputError) as caught:
        parse_config(text, "my.toml")
    assert caught.value.sentences == (
        "my.toml: cut[0].mas_t = 22 is an unknown key; did you mean mass_t?",
        "my.toml: grid.path_step_m is 'x'; it must be a number in m, or in quotes a number with one of the units m, "
        "ft, yd",
        "my.toml: grid.path_levels is 99; it must be from 1 to 9",
    )
    wrong = "targets.exit_speeds_m_s = [9]\n" + CUT.replace("22", "99") + CUT + CUT.replace("gondola", "gondla")
    with pytest.raises(InputError) as caught:
        parse_config(wrong, "my.toml")
    assert [sentence.split(" ")[1] for sentence in caught.value.sentences] == [
        "cut[0].mass_t", "cut[2].car", "targets.exit_speeds_m_s",
    ]  # fmt: skip


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"nowhere.toml: there is no such file; write one with 'retarder-synth init"):
        load_config(tmp_path / "nowhere.toml")
    with pytest.raises(InputError, match="this is a directory; give the path of a TOML"):
        load_config(tmp_path)
    latin = tmp_path / "latin.toml"
    latin.write_bytes(b'title = "caf\xe9"')
    with pytest.raises(InputError, match="byte 12 is not UTF-8"):
        load_config(latin)


def test_a_file_on_disk_is_read(tmp_path: Path) -> None:
    path = tmp_path / "park.toml"
    path.write_text(default_config_toml("rnz-2m-park"), encoding="utf-8")
    assert load_config(path).retarder.name == "rnz-2m-park"


def test_template_of_an_unknown_retarder() -> None:
    with pytest.raises(InputError, match="did you mean t-50-bunch"):
        default_config_toml("t-50")


def test_a_profile_in_pieces_is_warned_about_by_its_grades_alone() -> None:
    assert parse_config("[track]\ngrade_permille = [[0.0, 9.0], [20.0, 6.0]]", "my.toml").warnings == ()
    (warning,) = parse_config("[track]\ngrade_permille = [[0.0, 9.0], [20.0, 40.0]]", "my.toml").warnings
    assert "track.grade_permille" in warning


def test_a_grid_too_coarse_for_a_low_target_is_warned_of() -> None:
    text = "[regulator]\nestimator = false\n[targets]\nexit_speeds_m_s = [{}, 3.0]\n[grid]\nspeed_step_m_s = {}\n"
    assert not parse_config(text.format(2.0, 0.03), "a.toml").warnings
    (sentence,) = parse_config(text.format(1.5, 0.03), "a.toml").warnings
    assert "cells of 0.060 m/s at the target 1.5 m/s" in sentence
    advised = float(sentence.split("; ")[1].split(" ")[0])
    assert not parse_config(text.format(1.5, advised), "a.toml").warnings
