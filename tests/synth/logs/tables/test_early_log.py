"""A log may begin before the regulator acts: replay asks nothing there, and takes each cut over where it did."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from plant_models import Plant
from plant_models.approach import AT_THE_ENTRANCE
from plant_models.motion import path_coefficients
from synth.logs.fitting_passes import FittingPasses, fitting_passes
from synth.logs.likelihood import likelihood_of
from synth.logs.replay.known_cuts import KnownCuts, known_cuts
from synth.logs.replay.logged_tables import logged_tables
from synth.logs.replay.rule_agreement import rule_agreement
from synth.logs.unknowns import slope_of, unknowns_of, values_at
from synth.retarder.configuration.config_file import load_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.estimation.estimator_design import estimator_of
from synth.simulation.closed_loop import TableController
from synth.simulation.logged_passes import logged_passes
from tests.synth.test_closed_loop_lanes import wavy_table
from tuning_tables import ControllerTable, ValidRange
from tuning_tables.approach import Approach
from tuning_tables.pass_log.join_logs import one_after_the_other
from tuning_tables.pass_log.pass_log import PassLog

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
