"""The design test: its plan against cars that are humped, its worst pairs against all pairs, its fall and brakes."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from plant_models.brake_power import FullBrake
from plant_models.library import load_car, load_position
from synth.cli import main
from synth.hump.configuration.trial_file import parse_trial_file
from synth.hump.design.hump_under_test import HumpUnderTest, hump_under_test
from synth.hump.design.intervals import NEARLY_M_S, depths, intervals, least_margins_s
from synth.hump.design.runners_unbraked import unbraked
from synth.hump.design.triples import margins_s, pairs_of, triples
from synth.hump.design_runners import bad_runner, roll_runners
from synth.hump.trains.hump_routes import Mark
from synth.hump.trains.resolved_trial import resolve_trial
from synth.hump.trains.train_plan import TrainPlan

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
