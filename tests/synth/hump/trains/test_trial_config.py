"""Hump trial configurations: the template, what a file may change, and every fault in one sentence."""

from __future__ import annotations

from pathlib import Path

import pytest

from plant_models.library.hump_entry import hump_names
from plant_models.rolling.resistance_law import Tb10062Law
from synth.frame.faults import InputError
from synth.hump.configuration.trial_file import default_trial_toml, parse_trial_file, read_trial_file
from synth.hump.control.cut_record import SortingList
from synth.hump.control.train_population import TrainPopulation
from synth.hump.hump_file import hump_text
from synth.hump.planning.forecast import SpeedRange
from synth.hump.planning.position_roles import Fixed, Spacing
from synth.hump.trial.resolved_trial import ResolvedTrial, load_trial, resolve_trial


def resolved(text: str, place: str = "trial.toml") -> ResolvedTrial:
    """The trial that `text` asks for."""
    return resolve_trial(parse_trial_file(text, place))


def sentence(text: str, place: str = "trial.toml") -> str:
    """What is said of the faulty configuration `text`."""
    with pytest.raises(InputError) as caught:
        resolved(text, place)
    (said,) = caught.value.sentences
    assert said.startswith(f"{place}: ")
    return said.removeprefix(f"{place}: ")


def test_the_template_is_the_built_in_trial_to_the_last_origin() -> None:
    told, built_in = resolved(default_trial_toml()), load_trial(None)
    assert told.parameters == built_in.parameters
    assert told.sha256 == built_in.sha256
    assert (told.trains, told.roles.exits, told.positions) == (
        built_in.trains,
        built_in.roles.exits,
        built_in.positions,
    )
    assert not built_in.warnings


def test_what_changes_no_train_changes_only_the_hash_of_the_figures() -> None:
    built_in = load_trial(None)
    same = resolved('title = "x"\n[output]\nplots = false\n[sensors]\nspeed_std_m_s = 0.2\n')
    assert (same.sha256, same.trains_sha256) == (built_in.sha256, built_in.trains_sha256)
    for text in ("[trains]\nnumber = 5\n", "[acceptance]\ncatch_ups = 0.01\n"):
        other = resolved(text)
        assert other.trains_sha256 == built_in.trains_sha256
        assert other.sha256 != built_in.sha256


@pytest.mark.parametrize(
    "text",
    [
        'hump = "medium"',
        "[trains]\nseed = 1",
        "[trains]\ncuts = 41",
        "[trains]\none_wind_a_train = true",
        "[trains]\ntrack_shares = { 1 = 1.0, 2 = 1.0 }",
        "[trains]\nclosed_tracks = [1, 2]",
        "[trains]\ncategory_shares = { T = 1.0 }",
        "[couplings]\nallowed_m_s = 1.2",
        "[cars]\nfollowing_share = 0.3",
        '[resistance]\nlaw = "tb-10062"',
        "[weather]\nhead_wind_mean_m_s = 1.0",
        '[tracks]\nstanding = "file"',
        "[tracks]\nfree_low = 0.3",
        "[hump_speed]\nconstant_m_s = 1.7",
        "[hump_speed]\nuncoupling_m_s = 2.5",
        '[hump_speed]\nmethod = "pair-by-pair"',
        "[hump_speed]\nworst_pair = true",
        "[hump_speed]\nslow_down_s = 0.0",
        "[exit_speeds]\nfeedback = false",
        '[exit_speeds]\nknowledge = "measured"',
        "[[position]]\nnumber = 2\nlowest_m_s = 3.0",
        "[[position]]\nnumber = 1\nmost_entry_m_s = 8.0",
        "[[position]]\nnumber = 2\nexit_m_s = 4.5",
        "[[position]]\nnumber = 2\nexit_m_s = { T = 4.5, all = 4.0 }",
        '[[position]]\nnumber = 3\nrole = "spacing"',
        '[aim]\nknowledge = "measured"',
        "[aim]\np_overspeed = 0.05",
        "[[position]]\nnumber = 2\nexit_std_m_s = 0.35",
        "[[position]]\nnumber = 2\nout_of_service = true",
        "[[position]]\nnumber = 2\nsupply_share = 0.8",
    ],
)
def test_what_changes_trains_changes_their_hash(text: str) -> None:
    assert resolved(text).trains_sha256 != load_trial(None).trains_sha256


def test_what_a_plan_at_one_speed_depends_on_is_in_the_hash() -> None:
    """Exit speeds of such a plan come from a first sweep that keeps `early_s`; no slower step has a part in it."""
    one = "[hump_speed]\nconstant_m_s = 2.2\n"
    assert resolved(f"{one}early_s = 4.0").trains_sha256 != resolved(one).trains_sha256
    assert resolved(f"{one}least_s = 4.0").trains_sha256 == resolved(one).trains_sha256
    assert resolved(f"{one}slow_down_s = 4.0").trains_sha256 == resolved(one).trains_sha256


def test_the_same_hump_by_name_path_and_in_a_configuration(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(hump_text(Path("medium")), encoding="utf-8")
    config = tmp_path / "trial.toml"
    config.write_text('hump = "mine.toml"\n', encoding="utf-8")
    hashes = {load_trial(source).sha256 for source in (Path("medium"), path, config)}
    assert len(hashes) == 1
    assert hashes != {load_trial(None).sha256}


@pytest.mark.parametrize("name", hump_names())
def test_the_built_in_trial_goes_on_every_hump_of_the_library(name: str) -> None:
    trial = load_trial(Path(name))
    assert len(trial.positions) == trial.routes.positions
    assert trial.roles.aims[-1].all()  # park positions stand on one track each
    assert trial.roles.not_of_all == tuple(range(len(trial.positions) - 1))


def test_the_values_of_a_file_reach_the_trial() -> None:
    trial = resolved(
        'hump = "large-two-leads"\nlead = 202\n[resistance]\nlaw = "tb-10062"\n[weather]\ntemperature_c = -20.0\n'
        '[trains]\ncategory_shares = { "Л" = 3.0, T = 1.0 }\ntrack_shares = { 4 = 2.0, 5 = 1.0 }\ncars_mean = 1.3\n'
        "[[position]]\nnumber = 3\nexit_std_m_s = 0.05\n[[position]]\nnumber = 1\nsupply_share = 0.7\n"
        "lowest_m_s = 3.5\nhighest_m_s = 6.0\nmost_entry_m_s = 7.5\n"
        "[[position]]\nnumber = 2\nexit_m_s = { T = 4.5, all = 4 }\n"
    )
    assert isinstance(trial.people.law, Tb10062Law)
    assert trial.people.weather.temperature_c == -20.0
    assert trial.routes.lead == 202
    assert isinstance(trial.trains, TrainPopulation)
    assert (dict(trial.trains.category_shares), dict(trial.trains.track_shares)) == ({1: 3.0, 5: 1.0}, {4: 2.0, 5: 1.0})
    assert trial.trains.cars_mean == 1.3
    first, second, _ = trial.roles.exits
    assert first == Spacing(SpeedRange(3.5, 6.0, 7, 7.5))
    assert isinstance(second, Fixed)
    assert second.speed_m_s.tolist() == [4.0, 4.0, 4.0, 4.0, 4.5]
    assert [(each.exit_std_m_s, each.supply_share) for each in trial.positions] == [
        (0.15, 0.7),
        (0.15, 1.0),
        (0.05, 1.0),
    ]
    values = {value.key: value for value in trial.parameters}
    assert values["position.3.exit_std_m_s"].source == "configuration"
    assert values["position.2.exit_std_m_s"].assumed
    assert values["trains.category_shares.L"].value == 3.0
    assert (values["position.2.exit_m_s.T"].value, values["position.1.lowest_m_s"].assumed) == (4.5, False)


def test_retarders_of_one_position_that_differ_need_a_word(tmp_path: Path) -> None:
    text = hump_text(Path("large")).replace("{ number = 411,", "{ number = 411, exit_std_m_s = 0.2,", 1)
    (tmp_path / "mine.toml").write_text(text, encoding="utf-8")
    config = str(tmp_path / "trial.toml")
    said = sentence('hump = "mine.toml"', config)
    assert said.startswith("hump: position 2: its retarders differ in exit_std_m_s or book")
    trial = resolved('hump = "mine.toml"\n[[position]]\nnumber = 2\nexit_std_m_s = 0.2\n', config)
    assert trial.positions[1].exit_std_m_s == 0.2


def test_long_cuts_are_left_out_where_the_first_position_is_near(tmp_path: Path) -> None:
    far = "length_m = 26.0\ngrade_permille = [[0.0, 22.0], [24.0, 12.0]]"
    assert far in hump_text(Path("large"))
    near = hump_text(Path("large")).replace(far, "length_m = 12.0\ngrade_permille = 22.0", 1)
    (tmp_path / "near.toml").write_text(near, encoding="utf-8")
    config = str(tmp_path / "trial.toml")
    trial = resolved('hump = "near.toml"', config)
    assert isinstance(trial.trains, TrainPopulation)
    assert trial.trains.most_cars == int(2.0 * trial.routes.entrance_m.min() / 14.73) == 7
    assert next(value for value in trial.parameters if value.key == "trains.most_cars").assumed  # nobody has set it
    said = sentence('hump = "near.toml"\n[trains]\nmost_cars = 8\n', config)
    assert said.startswith("trains.most_cars is 8: such a cut is 117.8")
    assert said.endswith("set it to 7 or less")


LIST = "cut,cars,axles,mass_t,category,track,length_m,lead,marks\n"


def listed(tmp_path: Path, *rows: str) -> Path:
    """A sorting list."""
    path = tmp_path / "train.csv"
    path.write_text(LIST + "".join(f"{row}\n" for row in rows), encoding="utf-8")
    return path


def test_a_list_takes_the_place_of_the_population(tmp_path: Path) -> None:
    listed(tmp_path, "1,1,4,23,L,3,13.9,0,", "2,2,8,100,S,4,28,0,do-not-hump", "3,1,4,80,T,5,14,0,")
    trial = resolved('[trains]\nlist = "train.csv"\ncuts = 77\n', str(tmp_path / "trial.toml"))
    assert isinstance(trial.trains, SortingList)
    assert [cut.serial for cut in trial.trains.cuts] == [1, 3]
    assert not any(value.key == "trains.cuts" for value in trial.parameters)
    named = resolve_trial(read_trial_file(None).with_trains(None, None, tmp_path / "train.csv"))
    assert named.trains_sha256 == trial.trains_sha256


@pytest.mark.parametrize(
    ("row", "said"),
    [
        ("2,1,4,23,L,77,13.9,0,", "row 3: cut 2 goes to track 77; signal 201 leads to tracks 1 to 32"),
        ("2,1,5,23,L,7,13.9,0,", "row 3: cut 2 has 5 axles on 1 cars"),
        ("2,1,4,23,L,7,13.9,1,", "row 3: cut 2 comes over lead 1, and the trial has lead 0, with signal 201"),
        ("2,50,200,2300,L,7,700,0,", "row 3: cut 2 is 700 m long; behind the last position of track 7 there are 643 m"),
        ("2,15,60,600,L,7,200,0,", "row 3: cut 2 is 200 m long; let go with its middle over the crest"),
        ("2,1,4,23,L,7,13.9,0,do-not-hump", "cuts of it that go over the hump: 1; a train must have two or more"),
        ("2,1,4,23,Q,7,13.9,0,", "row 3: category: weight category 'Q' is not in the library"),
    ],
)
def test_a_list_that_does_not_fit_is_refused_with_row_and_reason(row: str, said: str, tmp_path: Path) -> None:
    path = listed(tmp_path, "1,1,4,23,L,3,13.9,0,", row)
    with pytest.raises(InputError) as caught:
        resolve_trial(read_trial_file(None).with_trains(None, None, path))
    (sentence_of_list,) = caught.value.sentences
    assert sentence_of_list.startswith(f"{path}: {said}")
