"""Uneven humps, and trains over them.

Copies of the large hump whose routes have different numbers of positions.
Humps whose routes have different numbers of positions: who commands, what is forecast, and where cuts end.
"""

from __future__ import annotations

import csv
import itertools
import json
import re
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from synth.cli import main
from synth.hump.configuration.trial_file import parse_trial_file
from synth.hump.hump_file import hump_text, parse_hump
from synth.hump.planning.forecast import Given, SpeedRange, from_crest, from_entrance
from synth.hump.rolling.hump_position import NormalHumpPosition
from synth.hump.rolling.hump_routes import OF_FIRST_AXLE, HumpRoutes, Mark, hump_routes
from synth.hump.rolling.humping import Hump, humped
from synth.hump.rolling.motion import Moving
from synth.hump.rolling.route_rolling import rolling_on
from synth.hump.rolling.train_cuts import expected
from synth.hump.trains.speed_program import speed_program
from synth.hump.trains.train_trace import body_of
from synth.hump.trial.made_trial import made_trial
from synth.hump.trial.resolved_trial import resolve_trial
from synth.hump.trial.trial import Control, HumpTrial, Sensing
from synth.simulation.free_roll import rolling_cuts
from tests.effort import every
from tests.plant_models.hump.random_humps import SMALL
from tests.synth.hump.trains.made_trials import Day, GivenHead
from tests.synth.hump.trains.mixed_cuts import without_padding
from tests.synth.hump.trains.test_forecast import COUNT, AsTold, single_cuts

SHORT_TRACKS = tuple(range(1, 9))
OWN_TRACK = 33


def bunch_without_park() -> str:
    """Tracks 1 to 8 have no park retarders: what led to one leads to the section behind it."""
    text = hump_text(Path("large"))
    for track in SHORT_TRACKS:
        park, section = 420 + track, 600 + track
        text = without_rows(text, {park})
        text, swaps = re.subn(rf"to = {park}\b", f"to = {section}", text)
        assert swaps == 1
    return text


def track_behind_the_second_position() -> str:
    """The bunch of retarder 414 is gone: one track stands in its place, right behind that retarder."""
    text = hump_text(Path("large"))
    text = without_rows(text, behind(text, 7))
    own = f"""{{ number = 654, type = "track", track = {OWN_TRACK}, next = {{ length_m = 720.0 }} }},"""
    section = "section = [\n"
    assert text.count(section) == 1
    text, swaps = re.subn(r"to = 7\b", "to = 654", text)
    assert swaps == 1
    return text.replace(section, f"{section}    {own}\n")


def without_rows(text: str, numbers: set[int]) -> str:
    """`text` without the rows of these elements."""
    kept = [line for line in text.splitlines() if not any(line.startswith(f"    {{ number = {n},") for n in numbers)]
    assert len(kept) == len(text.splitlines()) - len(numbers)
    return "\n".join(kept) + "\n"


def behind(text: str, number: int) -> set[int]:
    """`number` and the elements behind it."""
    hump = tomllib.loads(text)["hump"]
    rows = {row["number"]: row for kind in ("signal", "switch", "retarder", "section") for row in hump[kind]}
    found, ahead = {number}, [number]
    while ahead:
        row = rows[ahead.pop()]
        to = [row[key]["to"] for key in ("left", "right", "next") if "to" in row.get(key, {})]
        ahead += to
        found |= set(to)
    return found


UNEVEN = {"bunch": bunch_without_park, "own track": track_behind_the_second_position}


def routes_of(name: str) -> HumpRoutes:
    """The routes of one of them."""
    return hump_routes(parse_hump(UNEVEN[name](), "uneven", "uneven.toml").graph, 201)


NAMES = tuple(UNEVEN)
MEASURED = Control(sensing=Sensing(), slow_down_s=0.2)


def trial_on(name: str, day: Day) -> HumpTrial:
    """A trial on one of the humps."""
    return day.on(routes_of(name).graph)


def made_on(tmp_path: Path, name: str, text: str = "") -> HumpTrial:
    """The trial that a configuration asks for on one of the humps."""
    (tmp_path / "uneven.toml").write_text(UNEVEN[name](), encoding="utf-8")
    base = "[aim]\ndesign_cuts = 300\n[trains]\nnumber = 40\ncuts = 12\nmost_cars = 4\n"
    file = parse_trial_file(f'hump = "uneven.toml"\n{base}{text}', str(tmp_path / "trial.toml"))
    return made_trial(resolve_trial(file))


def test_places_of_the_routes() -> None:
    bunch, own = routes_of("bunch"), routes_of("own track")
    assert not bunch.even
    assert bunch.tracks[bunch.positions_of == 2].tolist() == list(SHORT_TRACKS)
    assert own.tracks[own.positions_of == 2].tolist() == [OWN_TRACK]
    for routes in (bunch, own):
        last = routes.positions_of == 3
        assert (routes.standing_from_m[last] == [route.yard_from_m for route in np.array(routes.routes)[last]]).all()
    row = int(np.flatnonzero(bunch.tracks == 1)[0])
    assert bunch.standing_from_m[row] == bunch.routes[row].fouling_m(16) > bunch.release_m[row]
    assert bunch.ends_m[row] == bunch.routes[row].element(16).to_m


@pytest.mark.parametrize("name", NAMES)
def test_the_last_position_of_each_route_aims_and_no_other(name: str) -> None:
    """The aim commands 1.4 m/s, all ranges begin at 2.5: so each command tells who gave it."""
    for control in (Control(), Control(False), MEASURED):
        trial = trial_on(name, Day(cuts=12, control=control))
        trains, _, memory = trial.humped(0, 40)
        aimed = np.isclose(memory.command_m_s, 1.4, atol=1e-5, rtol=0.0)
        held, routes = np.isfinite(memory.begin_s), trial.routes
        own = memory.route == trains.route.reshape(memory.route.shape)
        last = routes.positions_of[memory.route][:, :, None] == np.arange(1, 4)
        together = np.asarray(memory.unseparated.any(axis=2))[:, :, None]  # two cuts on a retarder have one command
        judged = held & own[:, :, None] & ~together
        assert (aimed[judged] == last[judged]).all()
        assert (judged & last)[:, :, 1].sum() > 10
        assert not held[routes.positions_of[memory.route] == 2][:, 2].any()


@pytest.mark.parametrize("name", NAMES)
def test_cuts_that_roll_as_expected_pass_when_forecast(name: str) -> None:
    """Beside the simulation, on all elements of their routes: switches behind the last position, too."""
    tracks = {track: 10.0 if track == OWN_TRACK else 1.0 for track in routes_of(name).tracks.tolist()}
    trial = trial_on(name, Day(cuts=1, cars_mean=1.8, most_cars=4, tracks=tracks))
    routes = trial.routes
    made, own, start, push = single_cuts(trial)
    speeds = tuple(Given(np.full(COUNT, 4.5 - 0.5 * q)) for q in range(routes.positions))
    choices = trial.planner.roles.aimed(speeds, made.route, speeds[-1])
    told = from_crest(routes, own, start, push, choices).followed()
    positions = tuple(NormalHumpPosition(0.0, GivenHead(9.0)) for _ in range(routes.positions))
    hump = Hump(routes, positions, rolling_on(trial.ways, made.population, expected(made), 1))
    control = AsTold(told.exit_m_s)
    memory = humped(hump, made, np.tile(routes.length_m, (COUNT, 1)), control, control)
    there = routes.vertex[made.route] >= 0
    assert (routes.positions_of[made.route] == 2).sum() >= 5
    for mark, times in ((Mark.FIRST_IN, told.first_in_s), (Mark.LAST_OUT, told.last_out_s)):
        simulated = memory.time_s[:, 0, :, mark] + start.time_s[:, None]
        np.testing.assert_allclose(simulated[there], times[there], atol=1e-2)
        assert np.isnan(times[~there]).all()
    short = routes.positions_of[made.route] == 2
    np.testing.assert_allclose(told.exit_m_s[short, 1], 3.5)  # by the aim


def two_positions(routes: HumpRoutes) -> HumpRoutes:
    """`routes` without their third positions: of those that have two nothing is lost."""
    cut = {name: getattr(routes, name)[:, :2] for name in ("retarder", "entrance_m", "exit_m")}
    return replace(routes, **cut)


@pytest.mark.parametrize("name", NAMES)
def test_short_routes_are_compared_as_on_a_hump_that_has_no_others(name: str) -> None:
    """Each choice has the margins of the same one among two positions."""
    tracks = SHORT_TRACKS if name == "bunch" else (OWN_TRACK,)
    trial = trial_on(name, Day(cuts=1, tracks=dict.fromkeys(tracks, 1.0)))
    routes, random = trial.routes, np.random.default_rng(3)
    made, own, start, push = single_cuts(trial)
    ranges = SpeedRange(3.0, 6.0, 3, 6.5, 1.0), SpeedRange(2.5, 5.0, 4), SpeedRange(1.0, 1.0, 1)
    aim = Given(np.full(COUNT, 2.6), 6.0, 1.5)
    shape = COUNT, routes.elements
    times = random.uniform(0.0, 60.0, shape), random.uniform(20.0, 90.0, shape)
    pair = two_positions(routes)
    assert pair.even
    two = replace(own, braked_m2_s2=own.braked_m2_s2[:, :2])
    choices = trial.planner.roles.aimed(ranges, made.route, aim)
    found = from_crest(routes, own, start, push, choices).compared(*times)
    plain = from_crest(pair, two, start, push, (ranges[0], aim)).compared(*times)
    for field in ("ahead_s", "behind_s", "able", "beyond_m_s", "arrival_s"):
        np.testing.assert_array_equal(getattr(found, field), getattr(plain, field), err_msg=field)
    begin = Moving(start.head_m + 60.0, start.speed_m_s + 3.0, start.time_s)
    last = from_entrance(routes, own, begin, 1, choices[1:]).compared(*times)
    of_pair = from_entrance(pair, two, begin, 1, (aim,)).compared(*times)
    np.testing.assert_array_equal(last.ahead_s, of_pair.ahead_s)
    assert np.isfinite(found.arrival_s).mean() > 0.9


@pytest.mark.parametrize("name", NAMES)
def test_a_cut_rolls_freely_from_its_last_position_to_the_standing_cars(name: str) -> None:
    """Each cut alone, on the track of its route: gap or coupling speed as rolled there from where it was let go, over
    the joints that are on its way."""
    trial = trial_on(name, Day(cuts=6, std_m_s=0.3))
    trains, _, memory = trial.humped(0, 60)
    routes, none, seen = trial.routes, trial.routes.elements, 0
    touched = np.argwhere(memory.caught_on_track).tolist()
    pushed = [lane * 6 + cut for lane, last in touched for cut in body_of(memory, lane, last)]
    for lane, cut in itertools.product(range(60), range(6)):
        row, route = lane * 6 + cut, memory.route[lane, cut]
        caught = min(memory.contact_at[lane, cut], memory.misrouted_at[lane, cut]) < none
        if caught or np.isin(lane * 6 + cut, pushed) or routes.positions_of[route] == 3:
            continue
        way = routes.routes[route]
        one = without_padding(trains.drawn, np.array([row])).on_bends(trains.population.law, way.roll_track.bends)
        rolling = rolling_cuts(trains.population, way.roll_track, way.yard_from_m, one)
        leaves = routes.exit_m[route, 1] + trains.last_axle_m[row]
        to = memory.free_m[lane, cut]
        axles = np.where(OF_FIRST_AXLE, trains.first_axle_m[row], trains.last_axle_m[row])
        marks = np.unique(routes.place_m[route] + axles)
        stations = np.append(marks[(marks > leaves) & (marks < to)], to)
        rolled = rolling.roll_on(np.array([leaves]), memory.exit_m_s[lane, cut, 1:2], stations[None, :])
        assert memory.end_m[lane, cut] == pytest.approx(min(rolled.stop_m[0], to), abs=1e-6)
        assert memory.end_speed_m_s[lane, cut] == pytest.approx(rolled.speed_m_s[0, -1], abs=1e-9)
        seen += 1
    assert seen >= 10


def test_a_list_may_send_cuts_to_short_and_long_routes(tmp_path: Path) -> None:
    head = "cut,cars,axles,mass_t,category,track,length_m,lead,marks\n"
    rows = ("1,1,4,23,L,3,13.9,0,", "2,2,8,100,S,28,28,0,", "3,1,4,80,T,5,14,0,", "4,1,4,23,L,7,14,0,")
    (tmp_path / "train.csv").write_text(head + "".join(f"{row}\n" for row in rows), encoding="utf-8")
    trial = made_on(tmp_path, "bunch", 'list = "train.csv"\n')
    trains, _, memory = trial.humped(0, 4)
    assert (trial.routes.positions_of[trains.route.reshape(4, 4)] == [2, 3, 2, 2]).all()
    assert np.isfinite(memory.exit_m_s[:, :, 1]).all()


def test_tracks_without_any_position_are_humped(tmp_path: Path) -> None:
    """A cut to track 2 of the example hump rolls unbraked, and nobody is asked for its speed."""
    (tmp_path / "small.toml").write_text(SMALL, encoding="utf-8")
    text = 'hump = "small.toml"\n[trains]\ncuts = 6\nmost_cars = 2\n[aim]\ndesign_cuts = 200\n'
    trial = made_trial(resolve_trial(parse_trial_file(text, str(tmp_path / "trial.toml"))))
    assert trial.routes.positions_of.tolist() == [1, 0]
    _, _, memory = trial.humped(0, 20)
    assert np.isfinite(memory.exit_m_s[:, :, 0][memory.route == 0]).mean() > 0.8
    assert np.isnan(memory.exit_m_s[:, :, 0][memory.route == 1]).all()
    assert [len(row.exit_m_s) for row in speed_program(trial, 0).rows] == (1 - memory.route[0]).tolist()


@pytest.mark.parametrize("name", every(2, NAMES))
def test_the_command_humps_them_and_tells_all(name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "uneven.toml").write_text(UNEVEN[name](), encoding="utf-8")
    config, out = tmp_path / "trial.toml", tmp_path / "out"
    config.write_text(
        'hump = "uneven.toml"\n[trains]\nnumber = 3\ncuts = 8\nmost_cars = 3\n[aim]\ndesign_cuts = 200\n'
        '[acceptance]\ncatch_ups = 1\noverspeed = 1\n[[position]]\nnumber = 2\nrole = "aim"\n'
    )
    assert main(["hump", "simulate", str(config), "-o", str(out)]) == 0
    summary = json.loads((out / "summary.json").read_text())
    short = list(SHORT_TRACKS) if name == "bunch" else [OWN_TRACK]
    first, second, third = (each["aims_on_tracks"] for each in summary["tables"]["positions"])
    assert (first, second) == ([], short)
    assert set(third) == set(routes_of(name).tracks.tolist()) - set(short)
    rows = list(csv.DictReader((out / "sheets" / "program.csv").read_text(encoding="utf-8").splitlines()))
    assert {row["track"] in map(str, short) for row in rows} <= {row["exit_3_m_s"] == "" for row in rows}
    assert all((row["exit_3_m_s"] == "") == (int(row["track"]) in short) for row in rows)
    assert all(0.5 <= float(row["exit_2_m_s"]) <= 7.0 for row in rows)
    for made in ("report.html", "hump.html", "events.csv", "plots/hump-time-path.svg", "plots/hump-contacts.svg"):
        assert (out / made).stat().st_size > 0
    assert main(["hump", "speed", str(config), "-o", str(tmp_path / "speed")]) == 0
    assert capsys.readouterr().out
