"""Cuts on other ways, and cuts that stand.

A misrouted cut rolls as one that was sent there: on humps whose ways differ in places, positions and lengths.
Cuts that stand between the crest and the first element: a slow hump in a storm, and a hump that rises.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest
from numpy.typing import NDArray

from plant_models.hump import HumpGraph
from plant_models.rolling.roll_track import Weather
from synth.frame.exhibits import Chapter, Sentence, Tiles, exhibits_of
from synth.frame.faults import InputError
from synth.hump.configuration.trial_file import parse_trial_file
from synth.hump.control.train_population import TrainPopulation
from synth.hump.hump_file import hump_text
from synth.hump.rolling.hump_position import NormalHumpPosition
from synth.hump.rolling.hump_routes import HumpRoutes, Mark, hump_routes
from synth.hump.rolling.humping import Hump, humped
from synth.hump.rolling.train_cuts import TrainCuts, trains
from synth.hump.rolling.train_memory import Asked, TrainMemory
from synth.hump.trains.humped_trial import HumpedTrial
from synth.hump.trains.outcome_file import TRAINS
from synth.hump.trains.simulate_command import show
from synth.hump.trains.traced_train import OneTrain, controlled_train, one_train
from synth.hump.trains.train_passages import TrainPassages, train_passages, with_contacts
from synth.hump.trial.made_trial import made_trial
from synth.hump.trial.resolved_trial import resolve_trial
from tests.plant_models.hump.random_humps import random_hump
from tests.plant_models.rolling.populations import CATEGORIES, MIX, population
from tests.synth.hump.trains.humped_trains import route_rolling
from tests.synth.hump.trains.made_trials import Day, GivenHead
from tests.system.conftest import changed

Floats = NDArray[np.float64]
LANES, CUTS = 40, 2
SPEED_M_S = 2.4


@dataclass(frozen=True)
class Steady:
    """One hump speed, and exit speeds that each cut has of its own in each position."""

    speeds_m_s: Floats

    def speed(self, cut: int, memory: TrainMemory) -> Floats:
        """For all trains."""
        return np.full(len(memory.crest_s), SPEED_M_S)

    def command(self, asked: Asked) -> Floats:
        """(n,)."""
        return np.asarray(self.speeds_m_s[asked.lanes, asked.cut])


def two_cuts(routes: HumpRoutes) -> TrainCuts:
    """Short cuts to any tracks."""
    shares = {member.number: 1.0 for member in CATEGORIES.members}
    lists = TrainPopulation(MIX, CATEGORIES, shares, dict.fromkeys(routes.tracks.tolist(), 1.0), 1.3, 2)
    return trains(lists, population(), routes.routes, 3, 0, LANES, CUTS)


def run(routes: HumpRoutes, made: TrainCuts) -> TrainMemory:
    """Both cuts over the hump, by ideal positions."""
    rolls = route_rolling(made.population, routes.routes, made.drawn, threads=1)
    positions = tuple(NormalHumpPosition(0.0, GivenHead(3.0)) for _ in range(routes.positions))
    control = Steady(np.random.default_rng(4).uniform(2.0, 5.0, (LANES, CUTS)))
    free = np.tile(routes.length_m, (LANES, 1))
    return humped(Hump(routes, positions, rolls), made, free, control, control)


def same_as_sent(graph: HumpGraph) -> tuple[int, int]:
    """How many cuts were misrouted, and how many of these went to other positions or places than their own route has;
    each is compared with the same cut sent behind its leader."""
    routes = hump_routes(graph, graph.leads[0])
    if len(routes.routes) < 2:
        return 0, 0
    made = two_cuts(routes)
    own = run(routes, made)
    sent_to = made.route.copy()
    sent_to[1::2] = own.route[:, 1]
    sent = run(routes, replace(made, route=sent_to))
    none = routes.elements
    lost = (own.misrouted_at[:, 1] < none) & (own.contact_at[:, 1] == none) & (sent.contact_at[:, 1] == none)
    np.testing.assert_array_equal(own.route[lost, 1], own.route[lost, 0])
    for name in ("time_s", "begin_s", "entry_m_s", "exit_m_s", "end_s", "end_m", "end_speed_m_s", "free_m"):
        np.testing.assert_array_equal(getattr(own, name)[lost, 1], getattr(sent, name)[lost, 1], err_msg=name)
    was, is_now = made.route[1::2][lost], own.route[lost, 1]
    places = [routes.entrance_m, routes.length_m[:, None], np.isfinite(routes.entrance_m)]
    other = np.any([np.any(each[was] != each[is_now], axis=1) for each in places], axis=0)
    return int(lost.sum()), int(other.sum())


def test_a_misrouted_cut_is_as_one_that_was_sent_there() -> None:
    """Random humps: some have no position or element on a way at all."""
    counts = np.array([same_as_sent(random_hump(seed)) for seed in range(60)])
    assert counts[:, 0].sum() > 200
    assert counts[:, 1].sum() > 100


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
