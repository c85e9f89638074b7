"""Cuts that stand between the crest and the first element: a slow hump in a storm, and a hump that rises."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from plant_models.rolling.weather import Weather
from synth.frame.exhibits import Chapter, Sentence, Tiles, exhibits_of
from synth.frame.input_error import InputError
from synth.hump.configuration.trial_file import parse_trial_file
from synth.hump.hump_file import hump_text
from synth.hump.trains.controlled_train import controlled_train
from synth.hump.trains.hump_routes import Mark
from synth.hump.trains.humped_trial import HumpedTrial
from synth.hump.trains.made_trial import made_trial
from synth.hump.trains.outcome_file import TRAINS
from synth.hump.trains.resolved_trial import resolve_trial
from synth.hump.trains.simulate_command import show
from synth.hump.trains.traced_train import OneTrain, one_train
from synth.hump.trains.train_memory import TrainMemory
from synth.hump.trains.train_passages import TrainPassages, train_passages, with_contacts
from tests.synth.hump.trains.made_trials import Day
from tests.system.conftest import changed

STORM = Day(cuts=10, weather=Weather(10.0, 0.0, 15.0), constant_m_s=0.3)
SPEED_EDGE = "grade_permille = [[0.0, 45.0], [40.0, 22.0]]"


@pytest.fixture(scope="module")
def in_storm() -> OneTrain:
    """A train of which a cut stands behind the crest, and another one comes up to it."""
    trial = STORM.on("medium")
    for number in range(20):
        found = one_train(trial, number)
        if np.isnan(with_known_leaders(found.memory)).any():
            return found
    raise AssertionError("no train of these has such a pair")


def with_known_leaders(memory: TrainMemory) -> np.ndarray:
    """When the first axles of the leaders of cuts in contact come in where these touch them; NaN for never."""
    cuts = np.flatnonzero(memory.behind[0] >= 0)
    times = memory.time_s[0, memory.behind[0, cuts], memory.contact_at[0, cuts], Mark.FIRST_IN]
    return np.where(np.isfinite(times), times, np.nan)


def test_a_cut_behind_one_that_stands_ahead_of_the_joint_never_comes_to_it(in_storm: OneTrain) -> None:
    memory, times = in_storm.memory, with_contacts(in_storm.memory, 0)
    held = [
        cut
        for cut in np.flatnonzero(memory.behind[0] >= 0)
        if not np.isfinite(times[memory.behind[0, cut], memory.contact_at[0, cut], Mark.FIRST_IN])
    ]
    assert held
    for cut in held:
        assert np.isposinf(times[cut, memory.contact_at[0, cut], Mark.FIRST_IN])


def test_the_hump_control_follows_such_a_train_to_its_end(in_storm: OneTrain) -> None:
    ways = train_passages(in_storm.trial.routes, in_storm.trains, in_storm.memory, 0).ways
    assert in_storm.standing() == sum(way == () for way in ways) > 0
    assert len(in_storm.traced().cuts) == 10
    assert in_storm.controlled().events


def test_a_train_of_which_no_cut_comes_anywhere_has_a_log() -> None:
    trial = STORM.on("medium")
    trains, _, _ = trial.humped(0, 1)
    nothing = TrainMemory(1, trains.cuts, trial.routes)
    nothing.route[:] = trains.route
    nothing.hump_speed_m_s[:] = 0.3
    assert TrainPassages(((), ()), (1, 2)).begins_s == TrainPassages(((), ()), (1, 2)).ends_s == 0.0
    assert {e.cut for e in controlled_train(trial.routes, trains, nothing, 0).events} >= set(range(1, 11))


def rising(tmp_path: Path, grades: str) -> Path:
    """A trial of the medium hump with other grades behind the crest."""
    text, hump = hump_text(Path("medium")), tmp_path / "rising.toml"
    hump.write_text(changed(text, (SPEED_EDGE, f"grade_permille = {grades}")), encoding="utf-8")
    return tmp_path / "trial.toml"


def test_a_hump_whose_grades_have_the_wrong_sign_is_refused_in_a_sentence(tmp_path: Path) -> None:
    place = rising(tmp_path, "[[0.0, -42.0], [32.0, -24.0]]")
    with pytest.raises(InputError, match=r"trial.toml: hump: on the way to track 1, 42 m .* lies 1.58 m above the"):
        resolve_trial(parse_trial_file('hump = "rising.toml"\n', str(place)))


def test_cuts_that_stand_are_told_and_figures_come_before_the_train_that_is_shown(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    place = rising(tmp_path, "-5.0")
    text = 'hump = "rising.toml"\n[trains]\nnumber = 2\ncuts = 6\n[aim]\ndesign_cuts = 200\n'
    config = resolve_trial(parse_trial_file(text + "[output]\nplots = false\nreport = false\n", str(place)))
    trial = made_trial(config)
    result = HumpedTrial(config, trial, trial.batch(0, 2))
    told = [each for each in exhibits_of(tuple(show(result))) if isinstance(each, Sentence) and each.brief]
    assert "5 of the 6 cuts of train 1 stand before element 1; the track falls by -0.18 m up to there" in told[1].text
    assert told[1].figures == {"standing_cuts": 5}

    def fails(*_: object) -> OneTrain:
        raise ZeroDivisionError

    monkeypatch.setattr("synth.hump.trains.simulate_command.one_train", fails)
    chapters = show(result)
    made: list[Chapter] = []
    with pytest.raises(ZeroDivisionError):
        made += chapters
    names = {each.name for each in exhibits_of(made) if not isinstance(each, Sentence | Tiles)}
    assert {TRAINS, "shares", "means", "positions"} <= names


def test_behind_the_joint_of_a_contact_no_axle_passes_sooner() -> None:
    """The cut ahead is held up on its track: its last axle comes to the joint after the one behind would have left."""
    times = np.array([[[10.0, 90.0, 20.0, 95.0, 25.0, 96.0]], [[30.0, 34.0, 40.0, 44.0, np.nan, 50.0]]])
    memory = SimpleNamespace(time_s=times[None], contact_at=np.array([[0, 0]]), behind=np.array([[-1, 0]]))
    found = with_contacts(cast(TrainMemory, memory), 0)
    assert found[0].tolist() == times[0].tolist()
    assert found[1, 0, :4].tolist() == [90.0, 94.0, 90.0, 94.0]
    assert np.isnan(found[1, 0, 4])
    assert found[1, 0, 5] == 94.0
