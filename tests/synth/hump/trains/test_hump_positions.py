"""Positions: exact, stuck, at full brake, their roles, and skates.

The position of known exactness: its error, what it cannot do, and the time that a cut takes.
A position that is stuck: what it takes from cuts, by hand, and beside the sound position.
The full brake of a position beside the closed loop whose regulator raises at every decision.
Roles of positions: which aim unless told, and that each command is that of the role.
Skates: they take their share of the energy of cuts that come to the standing cars, and change nothing else.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy import stats

from plant_models import PlantError, RollingResistance, couple
from plant_models.library.catalogue import load_car, load_position, load_weight_categories
from plant_models.plant import Plant
from plant_models.stage_regulator import FullBrake
from plant_models.track_profile import Approach
from scripts.studies.control_computer.failed_hump import StuckPosition, StuckStage, released
from synth.hump.configuration.trial_file import parse_trial_file
from synth.hump.rolling.hump_position import SLOWEST_M_S, Arrivals, LibraryBrake, NormalHumpPosition
from synth.hump.trial.made_trial import made_trial
from synth.hump.trial.resolved_trial import ResolvedTrial, resolve_trial
from synth.simulation.closed_loop import close_loop
from synth.simulation.controllers import full_brake
from synth.simulation.random_passes import random_passes
from tests.effort import every
from tests.synth.hump.trains.test_uneven_routes import SHORT_TRACKS, bunch_without_park

BRAKE = LibraryBrake(load_position("knp-5-bunch").position, load_weight_categories(), load_car("gondola-4").car)


def test_error_is_normal_about_the_command(arrivals: Callable[..., Arrivals]) -> None:
    error = NormalHumpPosition(0.15, BRAKE).passed(arrivals(20_000)).exit_m_s - 3.0
    assert abs(error.mean()) < 3.9 * 0.15 / np.sqrt(20_000)
    assert error.std() == pytest.approx(0.15, rel=3.9 / np.sqrt(40_000))
    assert stats.kstest(error / 0.15, "norm").pvalue > 1e-4


def test_errors_of_two_positions_are_independent_and_scale_with_the_deviation(
    arrivals: Callable[..., Arrivals],
) -> None:
    first, second = (NormalHumpPosition(0.15, BRAKE).passed(arrivals(9000, position=p)).exit_m_s for p in (0, 1))
    assert abs(np.corrcoef(first, second)[0, 1]) * np.sqrt(9000) < 3.9
    half = NormalHumpPosition(0.075, BRAKE).passed(arrivals(9000, position=1)).exit_m_s
    np.testing.assert_allclose(half - 3.0, 0.5 * (second - 3.0), atol=1e-12)


def test_an_ideal_position_obeys_within_its_power(arrivals: Callable[..., Arrivals]) -> None:
    """By hand: 90 t, four wheel pairs, 535 kPa · 20/550 kN/kPa, 24.95 m; 7 m/s unbraked."""
    commands = np.array([0.0, 1.0, 3.0, 7.0, 9.0])
    came = replace(arrivals(5, mass_t=90.0, unbraked_m_s=7.0, category=4), commanded_m_s=commands)
    passed = NormalHumpPosition(0.0, BRAKE).passed(came)
    least = np.sqrt(7.0**2 - 2.0 * 4 * 535.0 * 20.0 / 550.0 * 24.95 / (90.0 + 0.42 * 4))
    assert 1.0 < least < 3.0
    np.testing.assert_allclose(passed.exit_m_s, [least, least, 3.0, 7.0, 7.0], rtol=1e-9)
    assert (passed.switchings == 0).all()


def test_a_light_cut_may_be_given_low_stages_only(arrivals: Callable[..., Arrivals]) -> None:
    """Stage 2 takes 52 t from 6.5 m/s to 3.7, stage 4 to almost nothing."""
    ordered, light = arrivals(2, mass_t=52.0, commanded_m_s=0.0), np.array([0, 2])
    exit_m_s = NormalHumpPosition(0.0, BRAKE).passed(replace(ordered, category=light)).exit_m_s
    taken = 2.0 * 4 * 235.0 * 20.0 / 550.0 * 24.95 / (52.0 + 0.42 * 4)
    assert exit_m_s[0] == pytest.approx(np.sqrt(6.5**2 - taken))
    assert exit_m_s[1] == SLOWEST_M_S


def test_what_stops_unbraked_never_leaves(arrivals: Callable[..., Arrivals]) -> None:
    passed = NormalHumpPosition(0.2, BRAKE).passed(arrivals(50, unbraked_m_s=0.0))
    assert (passed.exit_m_s == 0.0).all()
    assert np.isinf(passed.time_s).all()


def test_time_is_that_of_even_deceleration(arrivals: Callable[..., Arrivals]) -> None:
    passed = NormalHumpPosition(0.2, BRAKE).passed(arrivals(50))
    deceleration = (6.0**2 - passed.exit_m_s**2) / (2.0 * 37.45)
    np.testing.assert_allclose(passed.time_s, (6.0 - passed.exit_m_s) / deceleration, rtol=1e-12)


def test_a_cut_passes_the_same_whoever_is_beside_it(arrivals: Callable[..., Arrivals]) -> None:
    position, came = NormalHumpPosition(0.2, BRAKE), arrivals(300)
    whole = position.passed(came)
    few = position.passed(came.chosen(np.array([250, 3, 77])))
    assert (few.exit_m_s == whole.exit_m_s[[250, 3, 77]]).all()
    assert (few.time_s == whole.time_s[[250, 3, 77]]).all()


def test_bad_values_are_refused(arrivals: Callable[..., Arrivals]) -> None:
    with pytest.raises(ValueError, match="mass_t has the shape"):
        replace(arrivals(5), mass_t=np.ones(4))


def test_stuck_released_it_lets_all_roll(arrivals: Callable[..., Arrivals]) -> None:
    """As a sound position without brake power does."""
    came = arrivals(30, commanded_m_s=1.0)
    passed, powerless = StuckPosition(released).passed(came), NormalHumpPosition(0.3, released).passed(came)
    assert (passed.exit_m_s == came.unbraked_exit_m_s).all()
    assert (passed.exit_m_s == powerless.exit_m_s).all()
    assert (passed.time_s == powerless.time_s).all()
    assert (passed.switchings == 0).all()


def test_stuck_at_a_stage_by_hand(arrivals: Callable[..., Arrivals]) -> None:
    """90 t, four wheel pairs, stage 2 rests 15 kPa below 300, 50 of which touch; 20/550 kN/kPa over 24.95 m."""
    came = replace(arrivals(3, mass_t=90.0, unbraked_m_s=6.0, category=4), commanded_m_s=np.array([0.5, 3.0, 9.0]))
    passed = StuckPosition(StuckStage(BRAKE, 2)).passed(came)
    expected = np.sqrt(6.0**2 - 2.0 * 4 * 235.0 * 20.0 / 550.0 * 24.95 / (90.0 + 0.42 * 4))
    np.testing.assert_allclose(passed.exit_m_s, expected, rtol=1e-9)
    np.testing.assert_allclose(passed.time_s, 2.0 * 37.45 / (6.0 + expected), rtol=1e-9)


def test_stuck_at_the_stage_that_a_category_is_allowed_it_is_the_full_brake(arrivals: Callable[..., Arrivals]) -> None:
    """A sound position that is commanded to stop a cut of category 1 gives it stage 2 all along."""
    came = arrivals(5, mass_t=60.0, commanded_m_s=0.0, category=0)
    stuck, sound = StuckPosition(StuckStage(BRAKE, 2)), NormalHumpPosition(0.0, BRAKE)
    np.testing.assert_allclose(stuck.passed(came).exit_m_s, sound.passed(came).exit_m_s, rtol=1e-12)
    higher = StuckPosition(StuckStage(BRAKE, 3)).passed(came).exit_m_s
    assert (higher < sound.passed(came).exit_m_s).all()


def test_it_holds_a_cut_that_has_less_energy(arrivals: Callable[..., Arrivals]) -> None:
    passed = StuckPosition(StuckStage(BRAKE, 4)).passed(arrivals(5, mass_t=30.0))
    assert (passed.exit_m_s == 0.0).all()
    assert np.isinf(passed.time_s).all()


def test_with_less_supply_it_takes_less(arrivals: Callable[..., Arrivals]) -> None:
    came = arrivals(2)
    half = StuckStage(replace(BRAKE, share=0.5), 3)(came)
    np.testing.assert_allclose(half, 0.5 * StuckStage(BRAKE, 3)(came), rtol=1e-12)


@pytest.mark.parametrize("stage", [0, 5])
def test_a_stage_that_is_not_there_is_refused(stage: int) -> None:
    with pytest.raises(PlantError, match="the stages 1 to 4"):
        StuckStage(BRAKE, stage)


GONDOLA = load_car("gondola-4").car


def taken_head_m(name: str, cars: int, ahead_m: float, closed: bool, entry_m_s: float) -> tuple[float, float]:
    """Energy head that the closed loop's brake takes at mean friction, and that of the full brake."""
    entry, mass_t = load_position(name), 94.0 * cars
    cut, top = couple((GONDOLA,) * cars, mass_t, "С", 4), entry.position.top_stage
    plant = Plant(
        entry.position, cut, entry.profile, replace(entry.friction, path_std=0.0), RollingResistance(1.3, 0.0),
        entry.sensor, entry.entry, Approach(ahead_m, top, top if closed else 0),
    )  # fmt: skip
    loop = close_loop(plant, plant.top_stage + 1)
    drawn = loop.draws(random_passes(1, 0, 1), cut_factor=1.0)
    start = plant.start_speed_m_s(np.array([entry_m_s]), 1.3)
    drawn = drawn._replace(entry_m_s=start)
    braked = loop.run(full_brake(loop.stages, plant.start_m, plant.exit_m), drawn).exit_speed_m_s[0]
    none = drawn._replace(brake_m_s2_per_kpa=np.zeros_like(drawn.brake_m_s2_per_kpa))
    free = loop.run(full_brake(loop.stages, plant.start_m, plant.exit_m), none).exit_speed_m_s[0]
    assert braked > 0.5
    taken = (free**2 - braked**2) / (2.0 * cut.reduced_gravity_m_s2)
    head = FullBrake(entry.position, GONDOLA).head_m(np.array([mass_t]), np.array([cut.axles]), np.array([4]))
    return float(taken), float(head[0])


@pytest.mark.parametrize(("name", "entry_m_s"), [("knp-5-bunch", 7.0), ("kv-3-bunch", 7.0), ("rnz-2m-park", 5.5)])
@pytest.mark.parametrize("cars", every(2, [3, 1]))
def test_a_brake_closed_before_the_entrance_takes_it_all(name: str, entry_m_s: float, cars: int) -> None:
    """The top stage stands from the cut ahead, as it is reached from below."""
    taken, head = taken_head_m(name, cars, 0.0, True, entry_m_s)
    assert taken == pytest.approx(head, rel=1e-6)


@pytest.mark.parametrize(("name", "entry_m_s"), [("knp-5-bunch", 7.0), ("rnz-2m-park", 5.5)])
@pytest.mark.parametrize("cars", [1, 3])
def test_rising_pressure_costs_a_part_of_it(name: str, entry_m_s: float, cars: int) -> None:
    """The top stage is commanded 4 m ahead of the entrance: 0.995 of it for one car, 0.998 for 3; at 5.5 m/s all."""
    taken, head = taken_head_m(name, cars, 4.0, False, entry_m_s)
    assert 0.99 * head < taken <= head * (1.0 + 1e-9)


FEW = "[trains]\ncuts = 10\ntrack_shares = { 1 = 1, 2 = 1, 9 = 1 }\n[aim]\ndesign_cuts = 200\n"
BUNCH, PARK = 1, 2
"""Places of the second and the third position."""


@pytest.fixture(scope="module")
def hump(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The large hump, but behind its second position tracks 1 to 8 have switches and no retarder."""
    path = tmp_path_factory.mktemp("roles") / "mine.toml"
    path.write_text(bunch_without_park(), encoding="utf-8")
    return path


def resolved(hump: Path, roles: str) -> ResolvedTrial:
    """The trial on it."""
    return resolve_trial(parse_trial_file(f'hump = "{hump.name}"\n{FEW}{roles}', str(hump.with_name("trial.toml"))))


def test_the_last_position_aims_unless_a_switch_is_behind_it(hump: Path) -> None:
    trial = resolved(hump, "")
    short = np.isin(trial.routes.tracks, SHORT_TRACKS)
    assert not trial.roles.aims[:PARK].any()
    np.testing.assert_array_equal(trial.roles.aims[PARK], ~short)
    told = resolved(hump, '[[position]]\nnumber = 2\nrole = "aim"\n')
    np.testing.assert_array_equal(told.roles.aims[BUNCH], short)
    assert told.warnings[0].startswith(
        "position 2 aims at the standing cars of tracks 1 to 8, and switches are behind it"
    )
    assert not trial.warnings
    none = resolved(hump, '[[position]]\nnumber = 3\nrole = "spacing"\n')
    assert not none.roles.aims.any()
    assert none.roles.not_of_all == (0, 1, 2)


@pytest.mark.parametrize("feedback", ["true", "false"])
def test_each_position_is_commanded_by_its_role(hump: Path, feedback: str) -> None:
    """Fixed speeds to the bit; chosen ones within their range; what aims is slower than that on the whole."""
    roles = "[[position]]\nnumber = 1\nexit_m_s = { T = 5.1, all = 5.3 }\n[[position]]\nnumber = 2\nlowest_m_s = 3.0\n"
    trial = made_trial(resolved(hump, f"[exit_speeds]\nchoices = 3\nfeedback = {feedback}\n{roles}"))
    trains, _, memory = trial.humped(0, 6)
    passed = np.isfinite(memory.command_m_s)
    alone = np.asarray(passed & ~memory.unseparated.max(axis=2)[:, :, None])
    places = trains.category.reshape(passed.shape[:2])
    commanded = np.where(places == len(trains.population.categories.members) - 1, 5.1, 5.3)
    np.testing.assert_array_equal(memory.command_m_s[..., 0][alone[..., 0]], commanded[alone[..., 0]])
    chosen, aimed = memory.command_m_s[..., BUNCH][alone[..., BUNCH]], memory.command_m_s[..., PARK][alone[..., PARK]]
    assert len(chosen) >= 40
    assert len(aimed) >= 5
    assert chosen.min() >= 2.0  # a cut that comes slower is let go with its own speed
    assert np.median(chosen) >= 3.0 > np.median(aimed)


TRIAL = """hump = "dumper"
[trains]
cuts = 12
most_cars = 1
category_shares = { L = 1 }
[tracks]
skates_share = SHARE
[aim]
design_cuts = 200
"""
FIXED = "[[position]]\nnumber = 1\nexit_m_s = 3.0\n"


def trial_with(share: float, position: str = FIXED) -> ResolvedTrial:
    """The trial with skates that take this `share`."""
    return resolve_trial(parse_trial_file(TRIAL.replace("SHARE", f"{share}") + position, "trial.toml"))


def test_skates_take_their_share_of_the_energy() -> None:
    free, held = (made_trial(trial_with(share)).humped(0, 4)[2] for share in (0.0, 0.75))
    alone = ~free.caught_on_track
    assert (free.end_speed_m_s[alone] > 1.0).sum() > 20
    np.testing.assert_allclose(held.end_speed_m_s[alone], 0.5 * free.end_speed_m_s[alone], rtol=1e-12)
    np.testing.assert_array_equal(held.end_speed_m_s[~alone], free.end_speed_m_s[~alone])
    np.testing.assert_array_equal(held.time_s, free.time_s)
    np.testing.assert_array_equal(held.end_m, free.end_m)


@pytest.mark.parametrize(("position", "warned"), [(FIXED, False), ("", True)])
def test_skates_lie_where_no_position_aims(position: str, warned: bool) -> None:
    config = trial_with(0.5, position)
    assert any("tracks.skates_share" in sentence for sentence in config.warnings) is warned
    trial = made_trial(config)
    left = trial.hump_for(trial.rolls_of(trial.source.trains(0, 1))).left_share
    assert left is not None
    np.testing.assert_array_equal(left, np.full(8, 1.0 if warned else np.sqrt(0.5)))
