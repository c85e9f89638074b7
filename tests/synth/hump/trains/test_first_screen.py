"""What is told of trains first: the verdict with its reasons, tiles, what brakes cannot do, where it is tight."""

from __future__ import annotations

import numpy as np
import pytest

from synth.frame.exhibits import Sentence, Table, Tiles
from synth.hump.configuration.trial_file import parse_trial_file
from synth.hump.control.cut_record import CutRecord
from synth.hump.trains.car_warnings import list_warnings
from synth.hump.trains.chosen_trains import chosen_trains
from synth.hump.trains.hump_routes import HumpRoutes, Mark
from synth.hump.trains.humped_trial import HumpedTrial
from synth.hump.trains.made_trial import made_trial
from synth.hump.trains.outcomes import TrainOutcomes, outcomes
from synth.hump.trains.position_strength import strengths, weak
from synth.hump.trains.resolved_trial import resolve_trial
from synth.hump.trains.shown.first_screen import first_screen, one_in
from synth.hump.trains.shown.positions import positions
from synth.hump.trains.train_cuts import TrainCuts
from synth.hump.trains.train_memory import TrainMemory
from synth.hump.trains.trial_limits import trial_limits

TRAINS = 20
FULL = 'hump = "dumper"\n[trains]\ncuts = 12\nmost_cars = 1\ncategory_shares = { T = 1 }\n[aim]\ndesign_cuts = 200\n'


def humped(text: str) -> tuple[HumpedTrial, TrainCuts, TrainMemory]:
    """What trains come to, and all that happened to them."""
    config = resolve_trial(parse_trial_file(text, "trial.toml"))
    trial = made_trial(config, 1)
    trains, _, memory = trial.humped(0, TRAINS)
    able = trial.able(trains, memory.route.ravel())
    return HumpedTrial(config, trial, outcomes(trial.routes, trains, memory, able)), trains, memory


@pytest.fixture(scope="module")
def full() -> tuple[HumpedTrial, TrainCuts, TrainMemory]:
    """Full cars behind brakes that are for empty ones."""
    return humped(FULL)


def test_a_brake_that_is_too_weak_is_told_everywhere(full: tuple[HumpedTrial, TrainCuts, TrainMemory]) -> None:
    result, _, memory = full
    (brake,) = strengths(result.found)
    far = memory.exit_m_s - memory.command_m_s > 6.0 * 0.15  # no error of the regulator is so large
    assert weak(brake)
    assert np.nansum(far) <= result.found.short.sum() <= (memory.exit_m_s > memory.command_m_s).sum()
    assert np.nansum(far) > 0.5 * brake.n
    limits = {limit.sentence.partition(":")[0]: limit for limit in trial_limits(result)}
    assert limits["couplings above 1.39 m/s"].kept is False
    assert "position 1 let" in limits["couplings above 1.39 m/s"].sentence
    table, warning, *_ = positions(result)
    assert isinstance(table, Table)
    assert isinstance(warning, Sentence)
    assert table.bad(table.rows[0])
    assert warning.brief
    assert "the hump is for cars of the weight category L, and trains have Т (T)" in " ".join(result.config.warnings)


def test_where_nothing_aims_the_verdict_says_so() -> None:
    result, _, _ = humped(f'{FULL}[[position]]\nnumber = 1\nrole = "spacing"\n')
    limits = [limit for limit in trial_limits(result) if limit.kept is False]
    assert any("on tracks 1 to 8 no position aims at the standing cars" in limit.sentence for limit in limits)
    judged = humped(f"{FULL}[acceptance]\ncatch_ups = 1\noverspeed = 1\n")[0]
    assert not list(trial_limits(judged))


def closest(routes: HumpRoutes, memory: TrainMemory, train: int) -> float:
    """The least interval of a train, cut by cut and element by element."""
    least = np.inf
    for cut in range(1, memory.route.shape[1]):
        ahead, own = memory.route[train, cut - 1], memory.route[train, cut]
        for column in range(routes.elements):
            if routes.vertex[own, column] < 0 or routes.vertex[own, column] != routes.vertex[ahead, column]:
                break
            if column >= min(memory.contact_at[train, cut - 1], memory.contact_at[train, cut]):
                break
            comes = memory.time_s[train, cut, column, Mark.FIRST_IN]
            leaves = memory.time_s[train, cut - 1, column, Mark.LAST_OUT]
            throw = routes.throw_s[own, column] if routes.points[own, column] != routes.points[ahead, column] else 0.0
            if np.isfinite(comes) and np.isfinite(leaves):
                least = min(least, comes - leaves - throw)
    return float(least)


def test_the_closest_cuts_are_those_of_a_plain_search(full: tuple[HumpedTrial, TrainCuts, TrainMemory]) -> None:
    result, trains, memory = full
    routes = result.config.routes
    plain = [closest(routes, memory, train) for train in range(TRAINS)]
    assert np.isfinite(plain).all()
    np.testing.assert_allclose(result.found.tightest_s, plain)
    assert (result.found.tightest_at >= 0).all()
    assert set(result.found.tightest_ahead) == set(trains.category)


def test_tiles_promise_no_more_than_the_figures(full: tuple[HumpedTrial, TrainCuts, TrainMemory]) -> None:
    for share in np.random.default_rng(1).uniform(1e-6, 1.0, 300) ** 2:
        assert float(one_in(share).replace(",", "")) <= 1.0 / share * (1.0 + 1e-12)
    result, _, _ = full
    tiles, *_, exits = first_screen(result)
    assert isinstance(tiles, Tiles)
    assert isinstance(exits, Table)
    caught = result.found.caught.sum() / result.found.cuts.sum()
    assert tiles.tiles[1].figure == f"one cut in {one_in(caught)}"
    over = result.found.overspeed.sum() / result.found.judged.sum()  # of cuts, whether they coupled or left a gap
    assert tiles.tiles[2].figure == f"{100.0 * over:.3g} %"
    assert tiles.tiles[2].of.startswith("of the cuts couple faster than 1.39 m/s")
    (row,) = exits.rows
    assert row["L_m_s"] is None
    assert row["T_m_s"].value == pytest.approx(result.found.commands_m_s.sum() / result.found.passes.sum())


def test_the_worst_train_is_shown_first_and_none_twice(full: tuple[HumpedTrial, TrainCuts, TrainMemory]) -> None:
    found: TrainOutcomes = full[0].found
    worst, *others = (each.number for each in chosen_trains(found))
    assert found.caught[worst] == found.caught.max()
    assert 0 in (worst, *others)
    assert len({worst, *others}) == 1 + len(others) <= 3


def test_a_category_that_contradicts_the_mass_is_told(full: tuple[HumpedTrial, TrainCuts, TrainMemory]) -> None:
    categories = full[0].config.categories
    for mass_t, told in ((85.0, 1), (23.0, 0)):
        cuts = [CutRecord(1, 1, 4, mass_t, categories.named("L").number, 3, 13.92)]
        assert len(list(list_warnings(cuts, categories))) == told
