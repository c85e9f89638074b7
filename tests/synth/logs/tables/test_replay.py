"""Replayed passes against simulated ones whose cuts are known: the other table is really run on the same cuts."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from synth.logs.fitting_passes import FittingPasses, fitting_passes
from synth.logs.replay.logged_tables import logged_tables
from synth.logs.replay.replay import STOPPED, Replay, ReplayOrder, replay
from synth.logs.replay.rule_agreement import rule_agreement
from synth.simulation.closed_loop import TableController, close_loop
from synth.simulation.logged_passes import logged_passes
from synth.simulation.random_passes import random_passes
from tuning_tables import ControllerTable
from tuning_tables.pass_log.pass_log import PassLog

from .conftest import Yard

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
