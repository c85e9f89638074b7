"""Cuts of one's own: categories, mixed cuts, entry speeds and targets by class, or one sentence for each fault."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from plant_models import EntrySpeed, HistogramEntrySpeed, NormalEntrySpeed
from plant_models.library import load_position
from synth.retarder.configuration.config_file import parse_config
from tests.synth.test_own_types import CUT, config_in, number, sentences


def category(name: str, number_of: int, load: float, stage: int) -> str:
    """A category by axle load."""
    return (
        f'[{name}]\nname = "{name}"\nnumber = {number_of}\n{number("axle_load_above_t", load)}\n'
        f"{number('rolling_resistance.mean_n_per_kn', 1.5)}\n{number('rolling_resistance.std_n_per_kn', 0.4)}\n"
        f"{number('allowed_stage', stage)}\n"
    )


def test_categories_by_axle_load_split_where_they_say(tmp_path: Path) -> None:
    folder = tmp_path / "weight_categories"
    folder.mkdir()
    parts = [category(f"C{i}", 16 + i, 2.5 * i, 1 + i % 4) for i in range(8)]
    (folder / "eight.toml").write_text('title = "eight"\n' + "".join(parts), encoding="utf-8")
    cuts = "".join(CUT.replace("22", str(m)) for m in (22, 40, 40.1, 90))
    config = config_in(tmp_path, f'library = ["."]\nweight_categories = "eight"\n{cuts}')
    # 5.5, 10.0 (a limit belongs to the category below it), 10.025 and 22.5 t an axle
    assert [c.cut.category for c in config.cuts] == ["C2", "C3", "C4", "C7"]
    assert [c.cut.category_number for c in config.cuts] == [18, 19, 20, 23]
    limits = [c.mass_limits_t for c in config.cuts]
    assert limits == [(22.0, 30.0), (30.0, 40.0), (40.0, 50.0), (70.0, 94.0)]


def test_a_mixed_cut_weighs_what_its_cars_do(tmp_path: Path) -> None:
    each = (
        '[[cut]]\nconsist = [{ car = "gondola-4", cars = 2, mass_per_car_t = 23.5 }, '
        '{ car = "tank-8", mass_per_car_t = 60 }]\n'
    )
    shared = '[[cut]]\nmass_t = 107\nlabel = "x"\nconsist = [{ car = "gondola-4", cars = 2 }, { car = "tank-8" }]\n'
    one, other = config_in(tmp_path, each + shared).cuts
    assert one.cut == other.cut
    assert (one.cut.mass_t, one.cut.axles, one.cut.category) == (107.0, 16, "Л")
    assert one.label == "gondola-4x2_tank-8-107t"
    tree = json.loads(config_in(tmp_path, each).canonical_json())
    assert tree["cut"][0]["consist"] == [{"car": "gondola-4", "cars": 2}, {"car": "tank-8", "cars": 1}]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('consist = [{ car = "gondola-4" }]\n', "cut[0].mass_t is missing"),
        ('mass_t = 22\nconsist = [{ car = "gondola-4", mass_per_car_t = 22 }]\n', "keep one of the two"),
        ('consist = [{ car = "gondola-4", mass_per_car_t = 5 }]\n', "cut[0].consist[0].mass_per_car_t is 5.0; a car"),
        ('car = "gondola-4"\nmass_t = 22\nconsist = [{ car = "gondola-4" }]\n', "cut[0].car cannot stand beside"),
        ('mass_t = 22\nconsist = [{ car = "gondla-4" }]\n', "did you mean gondola-4?"),
        (
            'mass_t = 22\nconsist = [{ car = "gondola-4", count = 2 }]\n',
            "cut[0].consist[0].count = 2 is an unknown key",
        ),
        ("mass_t = 22\nconsist = []\n", "cut[0].consist is []; it must be a list of 1 to 60 tables"),
        ("mass_t = 22\n", "cut[0].car is missing"),
        (
            'consist = [{ car = "gondola-4", mass_per_car_t = 22 }, { car = "tank-8" }]\n',
            "cut[0].consist[1].mass_per_car_t is missing; give it for all groups",
        ),
    ],
)
def test_a_faulty_mixed_cut_is_told(text: str, said: str, tmp_path: Path) -> None:
    (sentence,) = sentences(tmp_path, f"[[cut]]\n{text}")
    assert said in sentence


def test_entry_speeds_of_every_law_for_all_and_for_a_class(tmp_path: Path) -> None:
    text = (
        "[entry]\nmean_m_s = 5.5\nstd_m_s = 0.4\n"
        + CUT
        + 'label = "own"\nentry = { edges_m_s = [5, 5.5, 6], shares = [3, 1] }\n'
        + CUT
        + 'label = "shifted"\nentry = { low_m_s = 4.5 }\n'
        + CUT
    )
    config = config_in(tmp_path, text)
    laws = {label: plant.entry for label, plant in config.plants()}
    assert laws["own"] == HistogramEntrySpeed((5.0, 5.5, 6.0), (3.0, 1.0))
    assert laws["shifted"] == NormalEntrySpeed(4.5, 6.5, 5.5, 0.4)
    assert laws["gondola-4-22t"] == config.entry == NormalEntrySpeed(5.0, 6.5, 5.5, 0.4)
    tree = json.loads(config.canonical_json())
    assert tree["entry"] == {"low_m_s": 5.0, "high_m_s": 6.5, "mean_m_s": 5.5, "std_m_s": 0.4}
    assert tree["cut"][0]["entry"] == {"edges_m_s": [5.0, 5.5, 6.0], "shares": [3.0, 1.0]}
    assert "entry" not in tree["cut"][2]
    sources = {p.key: p.source for p in config.parameters}
    assert sources["entry.low_m_s"].startswith("engineering judgement")
    assert sources["entry.mean_m_s"] == sources["cut[0].entry.shares"] == "configuration"


def test_a_histogram_takes_the_place_of_the_librarys_law() -> None:
    config = parse_config("[entry]\nedges_m_s = [5.0, 6.0]\nshares = [1]\n", "x.toml")
    assert config.entry == HistogramEntrySpeed((5.0, 6.0), (1.0,))
    assert not any(p.key in ("entry.low_m_s", "entry.high_m_s") for p in config.parameters)
    assert isinstance(load_position("knp-5-bunch").entry, EntrySpeed)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[entry]\nmean_m_s = 5.5\n", "entry.std_m_s is missing; give low_m_s and high_m_s (uniform)"),
        ("[entry]\nmean_m_s = 5.5\nedges_m_s = [5, 6]\n", "entry.mean_m_s cannot stand beside a histogram"),
        ("[entry]\nedges_m_s = [5, 6]\nshares = [1, 2]\n", "entry.shares has 2 numbers"),
        ("[entry]\nedges_m_s = [5, 9]\nshares = [1]\n", "the last of edges_m_s is 9; knp-5-bunch takes at most 7 m/s"),
        (CUT + "entry = { high_m_s = 9 }\n", "cut[0].entry.high_m_s is 9; knp-5-bunch takes at most 7 m/s"),
        (CUT + "entry = { shares = [1] }\n", "cut[0].entry.edges_m_s is missing"),
        (CUT + "targets_m_s = [2, 9]\n", "cut[0].targets_m_s holds 9.0; a target must be at least 0.3 m/s"),
        (CUT + "targets_m_s = [2, 2.0000001]\n", "give each only once"),
    ],
)
def test_impossible_entry_speeds_and_targets_of_a_class_are_told(text: str, said: str, tmp_path: Path) -> None:
    (sentence,) = sentences(tmp_path, text)
    assert sentence.startswith(str(tmp_path / "my.toml"))
    assert said in sentence


def test_targets_of_a_class_stand_in_place_of_the_general_ones() -> None:
    config = parse_config(f'{CUT}targets_m_s = [1.8]\n{CUT}label = "b"\n', "x.toml")
    assert config.targets_of("gondola-4-22t") == (1.8,)
    assert config.targets_of("b") == config.targets_m_s == (2.0, 3.0, 4.0)
    assert [(label, p.target_speed_m_s) for label, p in config.problems()] == [
        ("gondola-4-22t", 1.8), ("b", 2.0), ("b", 3.0), ("b", 4.0),
    ]  # fmt: skip
    assert json.loads(config.canonical_json())["cut"][0]["targets_m_s"] == [1.8]


@pytest.mark.parametrize("stages", range(1, 9))
def test_one_to_eight_braking_stages(stages: int) -> None:
    pressures = [650.0 * k / stages for k in range(stages + 1)]
    text = f"retarder.stage_pressures_kpa = {pressures}\n{CUT}allowed_stage = {stages}\n"
    ((_, plant),) = parse_config(text, "x.toml").plants()
    assert plant.top_stage == stages
