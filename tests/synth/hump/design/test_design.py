"""The design test: its plan against cars that are humped, its worst pairs against all pairs, its fall and brakes; and
runners without brakes: their rolls against an integration of the law in time, and the picture that shows them.
"""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from plant_models.hump import Route
from plant_models.library import load_car, load_position
from plant_models.library.hump_entry import load_hump
from plant_models.stage_regulator import FullBrake
from synth.cli import main
from synth.frame.picture.house_style import draw
from synth.hump.configuration.trial_file import parse_trial_file
from synth.hump.design.hump_under_test import HumpUnderTest, hump_under_test, unbraked
from synth.hump.design.intervals import NEARLY_M_S, depths, intervals, least_margins_s
from synth.hump.design.triples import margins_s, pairs_of, triples
from synth.hump.design_runners import DESIGN_RUNNERS, DesignRunner, bad_runner, roll_runners
from synth.hump.hump_picture import hump_picture
from synth.hump.plan_layout import plan_layout
from synth.hump.planning.train_plan import TrainPlan
from synth.hump.rolling.hump_routes import Mark
from synth.hump.trial.resolved_trial import resolve_trial
from tests.effort import every

TRIAL = """hump = "medium"
[[position]]
number = 2
most_entry_m_s = 5.5
"""


def under_test(text: str) -> HumpUnderTest:
    """The hump of a trial."""
    return hump_under_test(resolve_trial(parse_trial_file(text, "trial.toml")))


@pytest.fixture(scope="module")
def medium() -> HumpUnderTest:
    """A hump of 16 tracks and three positions."""
    return under_test('hump = "medium"')


def test_cars_that_are_humped_one_by_one_come_when_the_plan_expects_them(medium: HumpUnderTest) -> None:
    """Two computations of the same motion: the choices of a control, and the simulator of trains."""
    cars = triples(medium, pairs_of(medium.routes))
    plan = cars.planned(np.full(len(cars), 1.7))
    alone = cars.alone(plan).time_s[:, 0]
    crest = plan.crest_s.reshape(-1, 1)
    for mark, expected in ((Mark.FIRST_IN, plan.first_in_s), (Mark.LAST_OUT, plan.last_out_s)):
        told = expected.reshape(alone.shape[:2])
        assert np.nanmax(np.abs(alone[:, :, mark] + crest - told)) < 5e-4
        assert np.isfinite(told).sum() > 5 * len(told)


def test_the_worst_pairs_are_those_of_all_pairs(medium: HumpUnderTest) -> None:
    """Without leaving any pair out: the least margins at the speed of the test, and where the highest speeds end."""
    found, pairs = intervals(medium), pairs_of(medium.routes)
    cars, depth = triples(medium, pairs), depths(medium.routes, pairs)
    at_test = least_margins_s(cars, np.full(len(cars), medium.asked.hump_speed_m_s))
    assert [each.depth for each in found.partings] == [1, 2, 3, 4]
    assert [each.pairs for each in found.partings] == [128, 64, 32, 16]
    highest = np.array([each.highest_m_s for each in found.partings])[depth - 1]
    kept, beyond = (least_margins_s(cars, speed) for speed in (highest, highest + 2.0 * NEARLY_M_S))
    for each in found.partings:
        of_it = depth == each.depth
        assert each.least_s == pytest.approx(at_test[of_it].min(), abs=1e-9)
        assert kept[of_it].min() >= 0.0 > beyond[of_it].min()
    assert found.highest_m_s == highest.min()


def test_no_other_exit_speeds_give_a_longer_least_interval(medium: HumpUnderTest) -> None:
    """Brute force over the exit speeds of the good runner in both positions that keep cuts apart."""
    worst, choices = intervals(medium).worst, np.linspace(4.0, 7.0, 31)
    cars = triples(medium, worst.repeat(choices.size**2, axis=0))
    one = triples(medium, worst).planned(np.full(1, 2.0))
    plan = TrainPlan(**{name: array.repeat(len(cars), axis=0) for name, array in vars(one).items()})
    exits = plan.exit_m_s.copy()
    exits[:, 1, :2] = np.stack(np.meshgrid(choices, choices), axis=-1).reshape(-1, 2)
    alone = cars.alone(replace(plan, exit_m_s=exits)).time_s[:, 0] + plan.crest_s.reshape(-1, 1, 1)
    comes, leaves = (alone[:, :, mark].reshape(plan.first_in_s.shape) for mark in (Mark.FIRST_IN, Mark.LAST_OUT))
    tried = margins_s(cars, replace(plan, first_in_s=comes, last_out_s=leaves)).min(axis=(1, 2))
    found = margins_s(cars, plan)[0].min()
    assert found == pytest.approx(tried.max(), abs=0.06)  # a step of the exit speeds, 0.1 m/s, is worth so much
    assert np.median(tried) < found - 0.5  # it matters which are chosen


def test_what_the_fall_lacks_is_what_brings_the_bad_runner_there() -> None:
    poor = under_test('hump = "medium"\n[design]\nbad_n_per_kn = 9.0\ninto_track_m = 100.0')
    fall, runner = unbraked(poor).fall, bad_runner(poor.asked)
    assert fall.left_m < 0.0
    assert fall.needed_m == pytest.approx(fall.fall_m - fall.left_m)
    gravity = runner.reduced_gravity_m_s2
    at_m = fall.stop_m
    for share, comes in ((1.02, True), (0.98, False)):
        speed = np.sqrt(poor.asked.hump_speed_m_s**2 - 2.0 * gravity * share * fall.left_m)
        (roll,) = roll_runners(fall.route, (runner,), float(speed))
        (begins,) = (e.at_m for e in fall.route.elements if getattr(e.vertex, "track", None) is not None)
        assert (roll.stop_m > begins + fall.into_m) is comes
        assert roll.stop_m > at_m
    enough = unbraked(under_test('hump = "medium"')).fall
    assert enough.left_m > 0.0


def test_brakes_are_those_of_the_library_with_their_share(medium: HumpUnderTest) -> None:
    first = unbraked(medium).positions[0]
    full = FullBrake(load_position("knp-5-bunch").position, load_car("gondola-4").car)
    head = full.head_m(np.array([85.0]), np.array([4]), np.array([99]))
    assert first.own_m == pytest.approx(0.85 * float(head[0]), rel=1e-9)
    weaker = unbraked(under_test(TRIAL + "out_of_service = true\n")).positions
    assert [each.there_m for each in weaker][1] == pytest.approx(first.own_m)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('hump = "dumper"', "the least interval is 0.86 s too short, between bad and good at switch 4"),
        ('hump = "dumper"', "the good runner leaves position 1 up to 1.05 m/s faster than it may"),
        ('hump = "dumper"\n[design]\nbad_n_per_kn = 12.0', "does not come 50 m into track 1"),
        (TRIAL, "cars of the test come to position 2 at 6.47 m/s or less; 5.5 m/s are allowed"),
    ],
)
def test_what_is_not_kept_is_a_sentence(text: str, said: str, tmp_path: Path) -> None:
    (tmp_path / "trial.toml").write_text(text, encoding="utf-8")
    out = tmp_path / "out"
    assert main(["hump", "design", str(tmp_path / "trial.toml"), "-o", str(out)]) == 1
    missed = [
        each["sentence"] for each in json.loads((out / "summary.json").read_bytes())["limits"] if not each["kept"]
    ]
    assert any(said in sentence for sentence in missed), missed


def in_time(route: Route, runner: DesignRunner, until_m: float) -> float:
    """Speed at `until_m` by integrating acceleration over time: forces on each axle, no step of the kernel."""
    car = load_car("gondola-4").car
    axles = np.asarray(car.axle_offsets_m)
    track = route.roll_track

    def rate(_: float, state: np.ndarray) -> list[float]:
        middle, speed = state
        at = middle + axles[-1] / 2.0 - axles
        grade = np.where(at >= 0.0, track.profile.grade_permille(at), 0.0).mean()
        against = speed + runner.head_wind_m_s
        air = 17.8 * 1.36 * 8.5 / 283.0 / runner.mass_t * against * abs(against)
        bends = sum(
            (0.56 * bend.switches + 0.23 * bend.turn_deg) * speed**2 / (bend.to_m - bend.from_m)
            for bend in track.bends
            if bend.from_m <= middle < bend.to_m
        )
        g = 9.81 / (1.0 + 0.42 * 4 / runner.mass_t)
        return [speed, g * 1e-3 * (grade - runner.resistance_n_per_kn - air - bends)]

    def arrived(_: float, state: np.ndarray) -> float:
        return float(state[0] - until_m)

    arrived.terminal = True  # type: ignore[attr-defined]  # as solve_ivp wants it
    found = solve_ivp(rate, (0.0, 600.0), [0.0, 1.7], events=arrived, max_step=0.02, rtol=1e-8)
    return float(found.y[1, -1])


@pytest.mark.parametrize("runner", every(3, DESIGN_RUNNERS), ids=lambda runner: runner.name)
def test_a_runner_rolls_as_the_law_says(runner: DesignRunner) -> None:
    route = load_hump("large").graph.route(201, 22)
    (roll,) = roll_runners(route, (runner,))
    for place in (112.0, 246.0, 500.0):
        assert np.interp(place, roll.at_m, roll.speed_m_s) == pytest.approx(in_time(route, runner, place), abs=0.02)


def test_the_bad_runner_stops_and_the_others_do_not() -> None:
    route = load_hump("large").graph.route(201, 1)
    good, mean, bad = roll_runners(route)
    assert np.isinf(good.stop_m)
    assert np.isinf(mean.stop_m)
    assert 500.0 < bad.stop_m < 900.0
    assert bad.at_m[-1] < bad.stop_m <= bad.at_m[-1] + 1.0
    for roll in (good, mean, bad):
        assert (np.diff(roll.energy_head_m) < 0.0).all()  # nothing gives a rolling car energy
    # at the crest the light car has more energy for its weight: its wheels are the larger part of it
    assert good.energy_head_m[0] < bad.energy_head_m[0]
    assert (good.energy_head_m[10 : len(bad.at_m)] > bad.energy_head_m[10:]).all()
    assert route.yard_from_m == 316.0 + 11.0


def test_a_plan_gives_each_track_a_row_and_each_element_its_metres() -> None:
    graph = load_hump("large-two-leads").graph
    layout = plan_layout(graph)
    assert [layout.row[track] for track in graph.tracks] == list(range(32))
    places = set(layout.at.values())
    assert len(places) == len(graph.vertices)  # nothing is drawn upon another thing
    for lead in graph.leads:
        for route in graph.routes(lead).values():
            for element in route.elements:
                assert layout.at[element.number][0] == pytest.approx(element.at_m)


def test_the_picture_has_the_same_bytes_twice() -> None:
    hump = load_hump("dumper")
    route = hump.graph.route(201, 3)
    pictures = [draw(hump_picture(hump, route, roll_runners(route))) for _ in range(2)]
    assert pictures[0] == pictures[1]
