"""Replays of logs.

Replayed passes against simulated ones whose cuts are known: the other table is really run on the same cuts.
A log may begin before the regulator acts: replay asks nothing there, and takes each cut over where it did.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from plant_models import Plant
from plant_models.motion import path_coefficients
from plant_models.track_profile import AT_THE_ENTRANCE
from synth.logs.fitting_passes import FittingPasses, fitting_passes
from synth.logs.likelihood import likelihood_of
from synth.logs.replay.predicted_exits import KnownCuts, known_cuts
from synth.logs.replay.replay import STOPPED, Replay, ReplayOrder, replay
from synth.logs.replay.rule_agreement import logged_tables, rule_agreement
from synth.logs.unknowns import slope_of, unknowns_of, values_at
from synth.retarder.configuration.config_file import load_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.estimation.estimator_design import estimator_of
from synth.simulation.closed_loop import TableController, close_loop
from synth.simulation.random_passes import random_passes
from synth.simulation.sampled_pass import logged_passes
from tests.synth.logs.tables.conftest import Yard
from tests.synth.test_closed_loop_lanes import wavy_table
from tuning_tables import ControllerTable, ValidRange
from tuning_tables.decisions import Approach
from tuning_tables.pass_log.pass_log import PassLog, one_after_the_other

CASE = ("S-1", 3.0)
PASSES, REPETITIONS = 60, 12


def log_of(yard: Yard, table: ControllerTable, seed: int, count: int = PASSES) -> PassLog:
    plant = dict(yard.config.plants())[CASE[0]]
    return logged_passes(plant, TableController(table), CASE[1], seed, 0, count, None)


def fitted(yard: Yard, log: PassLog) -> FittingPasses:
    return fitting_passes(log, yard.config.plants(), "test")


def true_exits(yard: Yard, table: ControllerTable, seed: int) -> np.ndarray:
    loop = close_loop(dict(yard.config.plants())[CASE[0]], len(table.stages))
    cells = len(loop.path.gravity_m_s2) - loop.path.approach_cells
    return loop.run(TableController(table), loop.draws(random_passes(seed, 0, PASSES, cells))).exit_speed_m_s


@pytest.fixture(scope="module")
def replayed(assumed: Yard, worn: Yard) -> list[Replay]:
    own, other = assumed.tables[CASE], worn.tables[CASE]
    return [
        replay(
            fitted(assumed, log_of(assumed, own, seed)),
            assumed.config,
            ReplayOrder([own], [other], 32, 1000 + 10 * seed),
        )
        for seed in range(REPETITIONS)
    ]


@pytest.mark.requirement("LOG-04")
def test_the_table_that_drove_the_log_commands_the_same_everywhere(assumed: Yard, worn: Yard) -> None:
    passes = fitted(assumed, log_of(assumed, assumed.tables[CASE], 77, 200))
    own = rule_agreement(passes, logged_tables(passes, list(assumed.tables.values())))
    same, asked = own.rows
    assert same == asked > 5000
    assert own.commands[0] == own.commands[1] > 500
    assert np.all(own.first_differing == -1)
    other = rule_agreement(passes, logged_tables(passes, [worn.tables[CASE]]))
    assert other.rows[0] < other.rows[1]
    for number in np.flatnonzero(other.first_differing >= 0).tolist():
        rows, first = passes.log.rows(number), other.first_differing[number]
        assert other.wanted[first] != passes.log.stage[first]
        before = slice(rows.start, first)
        asked_before = other.asked[before]
        assert np.array_equal(other.wanted[before][asked_before], passes.log.stage[before][asked_before])


@pytest.mark.requirement("LOG-04")
def test_one_wrong_command_is_found_where_it_is(assumed: Yard) -> None:
    log = log_of(assumed, assumed.tables[CASE], 78, 10)
    stage = log.stage.copy()
    rows = log.rows(4)
    stage[rows] = np.where(np.arange(rows.stop - rows.start) == 0, 4, stage[rows])
    passes = fitted(assumed, replace(log, stage=stage))
    found = rule_agreement(passes, logged_tables(passes, [assumed.tables[CASE]]))
    assert found.first_differing[4] == rows.start
    assert np.all(np.delete(found.first_differing, 4) == -1)


@pytest.mark.long
@pytest.mark.parametrize("which", ["own", "other"])
def test_predicted_exits_are_those_that_the_same_cuts_really_get(
    which: str, replayed: list[Replay], assumed: Yard, worn: Yard
) -> None:
    """On the mean, within its 95 % interval in 90 % of the repetitions, and without bias over all of them."""
    table = (assumed if which == "own" else worn).tables[CASE]
    held, apart = 0, []
    for seed, found in enumerate(replayed):
        off = getattr(found, which).mean_m_s - true_exits(assumed, table, seed)
        held += abs(off.mean()) < 2.0 * off.std(ddof=1) / np.sqrt(PASSES)
        apart.append(off)
    assert held >= 0.9 * REPETITIONS - 1
    everything = np.concatenate(apart)
    assert abs(everything.mean()) < 3.0 * everything.std() / np.sqrt(len(everything)) + 0.001


def test_the_difference_of_the_tables_is_the_true_one(replayed: list[Replay], assumed: Yard, worn: Yard) -> None:
    truths = []
    for seed in range(REPETITIONS):
        own, other = (true_exits(assumed, yard.tables[CASE], seed) - CASE[1] for yard in (assumed, worn))
        truths.append(np.sqrt((other**2).mean()) - np.sqrt((own**2).mean()))
    told = [found.difference.rms_m_s.value for found in replayed]
    error = np.std(np.subtract(truths, told), ddof=1) / np.sqrt(REPETITIONS)
    assert abs(np.mean(truths) - np.mean(told)) < 3.0 * error
    assert np.mean(told) > 0.0  # tables for another plant are worse here


def test_measured_exits_are_the_true_ones(replayed: list[Replay], assumed: Yard) -> None:
    truth = np.concatenate([true_exits(assumed, assumed.tables[CASE], seed) for seed in range(REPETITIONS)])
    measured = np.concatenate([found.measured.speed_m_s for found in replayed])
    std = np.concatenate([found.measured.std_m_s for found in replayed])
    innovation = (measured - truth) / std
    assert abs(innovation.mean()) < 0.2
    assert 0.8 < innovation.std() < 1.3


def test_passes_whose_table_cannot_be_told_are_listed(assumed: Yard) -> None:
    log = log_of(assumed, assumed.tables[CASE], 3, 6)
    target, by_hand = log.target_m_s.copy(), log.stopped_by_hand.copy()
    target[1], target[2], by_hand[3] = np.nan, 9.0, True
    category = tuple("nobody" if i == 4 else each for i, each in enumerate(log.category))
    changed = replace(log, target_m_s=target, stopped_by_hand=by_hand, category=category)
    own = [assumed.tables[CASE]]
    found = replay(fitted(assumed, changed), assumed.config, ReplayOrder(own, own, 16))
    why = dict(found.left_out)
    assert list(why) == [log.cut_id[i] for i in (1, 2, 3, 4)]
    assert why[log.cut_id[1]] == "own book: no target is logged"
    assert "9 m/s" in why[log.cut_id[2]]
    assert why[log.cut_id[3]] == STOPPED
    assert "nobody" in why[log.cut_id[4]]
    assert found.difference.passes == 2
    assert found.difference.rms_m_s.value == 0.0


TARGET_M_S, BEFORE_M = 3.0, 8.0


@pytest.fixture(scope="module")
def config() -> ResolvedConfig:
    return load_config(None)


def plant_with(config: ResolvedConfig, approach_m: float) -> Plant:
    plant = dict(config.plants())["gondola-4-52t"]
    return replace(
        plant, approach=AT_THE_ENTRANCE if approach_m == 0.0 else replace(plant.approach, length_m=approach_m)
    )


def table_for(plant: Plant, estimates: bool) -> ControllerTable:
    """Lines that command often, over the approach too."""
    table = wavy_table(plant, TARGET_M_S)
    valid = ValidRange((plant.start_m, plant.exit_m), table.valid.v_m_s)
    approach = Approach(-plant.start_m, plant.entrance_stage) if plant.start_m < 0.0 else None
    return replace(table, valid=valid, approach=approach, estimator=estimator_of(plant) if estimates else None)


def begun_earlier(log: PassLog, plant: Plant) -> PassLog:
    """`log`, with rows ahead of each pass in which the cut rolls up to it from `BEFORE_M` before the entrance."""
    cells = path_coefficients(plant.position, plant.cut, plant.profile, np.array([-BEFORE_M, 0.0]))
    gain_m_s2, period_s = float(cells.free_m_s2(plant.resistance.mean_n_per_kn)[0]), plant.sensor.sample_period_s
    parts, counts = [], []
    for number in range(len(log)):
        rows = log.rows(number)
        path, speed = float(log.path_m[rows.start]), float(log.speed_m_s[rows.start])
        since = -period_s * np.arange(40, 0, -1)
        # The first speed is a noisy reading, and must not put a row onto the approach where there was none.
        before = np.minimum(path + speed * since + 0.5 * gain_m_s2 * since**2, plant.start_m - 1e-6)
        some = before >= -BEFORE_M
        n = int(some.sum())
        rolled = (since[some] + log.time_s[rows.start], before[some], (speed + gain_m_s2 * since)[some],
                  np.full(n, np.nan), np.full(n, plant.approach.initial_stage))  # fmt: skip
        whole = (log.time_s, log.path_m, log.speed_m_s, log.pressure_kpa, log.stage)
        parts.append([np.concatenate((ahead, column[rows])) for ahead, column in zip(rolled, whole, strict=True)])
        counts.append(len(parts[-1][0]))
    time, path_m, speed_m_s, pressure, stage = (np.concatenate(column) for column in zip(*parts, strict=True))
    ends = np.concatenate(([0], np.cumsum(counts)))
    early = replace(
        log, time_s=time, path_m=path_m, speed_m_s=speed_m_s, pressure_kpa=pressure, stage=stage.astype(np.int64),
        first_row=ends,
    )  # fmt: skip
    return one_after_the_other(early, 30.0)


@pytest.mark.parametrize("estimates", [False, True])
@pytest.mark.parametrize("approach_m", [0.0, 4.0])
def test_a_right_controller_differs_nowhere(config: ResolvedConfig, approach_m: float, estimates: bool) -> None:
    plant = plant_with(config, approach_m)
    table = table_for(plant, estimates)
    log = logged_passes(plant, TableController(table), TARGET_M_S, 5, 0, 50, None)
    early = begun_earlier(log, plant)
    assert early.path_m[early.first_row[:-1]].max() < -BEFORE_M + 1.0
    found = []
    for each in (log, early):
        passes = fitting_passes(each, [("S", plant)], "test")
        found.append(rule_agreement(passes, logged_tables(passes, [table])))
    plain, begun = found
    assert plain.rows[0] == plain.rows[1] > 1000
    assert plain.commands[0] == plain.commands[1] > 200
    assert (begun.rows, begun.commands) == (plain.rows, plain.commands)
    assert np.all(begun.first_differing == -1)
    assert not begun.asked[early.path_m < -approach_m].any()


def cuts_of(config: ResolvedConfig, passes: FittingPasses) -> KnownCuts:
    unknowns = unknowns_of(passes, config.parameters)
    values = values_at(unknowns, np.zeros(len(unknowns)))
    like = likelihood_of(passes, slope_of(unknowns))
    return known_cuts(like, like.at(values), values)


def test_a_cut_runs_again_with_its_speed_where_the_regulator_took_it_over(config: ResolvedConfig) -> None:
    """Not with that of 8 m before: the grade of the approach lies between."""
    plant = plant_with(config, 4.0)
    log = logged_passes(plant, TableController(table_for(plant, False)), TARGET_M_S, 5, 0, 20, None)
    plain, begun = (
        cuts_of(config, fitting_passes(each, [("S", plant)], "test")) for each in (log, begun_earlier(log, plant))
    )
    assert np.array_equal(begun.speed_m_s, plain.speed_m_s)
    assert np.array_equal(begun.path_m, plain.path_m)
