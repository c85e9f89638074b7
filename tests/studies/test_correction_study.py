"""The study of the correction: its sequences are those of the closed loop, its ageing is what it says, its faults."""

from __future__ import annotations

import numpy as np
import pytest

from scripts.studies.cases import Case, named_cases
from scripts.studies.correction.ageing import FrictionFalls, SensorCreeps
from scripts.studies.correction.sequence import corrected, run_sequence
from scripts.studies.correction.study import rms_ratio
from scripts.studies.tuned_table import tuned_table
from synth.retarder.configuration.config_file import load_config
from synth.simulation.closed_loop import ClosedLoop, TableController, close_loop
from synth.simulation.random_passes import random_passes
from tuning_tables.active_table import ActiveTable, active
from tuning_tables.correction import Correction
from tuning_tables.programs.correct import corrected_speed
from tuning_tables.rule import decide_for

PASSES = 300
READINGS = 0.05 * np.random.default_rng(3).standard_normal(PASSES)


@pytest.fixture(scope="module")
def ready() -> tuple[Case, ActiveTable, ClosedLoop]:
    config = load_config(None)
    (case,) = named_cases(config, ("52:3",))
    table = active(tuned_table(config, case.plant, case.target_m_s))
    return case, table, close_loop(case.plant, TableController(table).stages)


def test_lower_lines_decide_as_the_rule_at_the_corrected_speed(ready: tuple[Case, ActiveTable, ClosedLoop]) -> None:
    _, table, _ = ready
    correction, rng, differ = Correction(), np.random.default_rng(1), 0
    for c in (0.15, -0.15, 0.0123):
        state = np.array([0.0, c, 1.0], np.float32)
        shifted = corrected(table, state[1])
        for _ in range(1000):
            s, v, stage = rng.uniform(0.0, 40.0), np.float32(rng.uniform(1.0, 8.0)), int(rng.integers(0, 4))
            asked = float(corrected_speed(correction.setting, state, float(v)))
            differ += decide_for(table, stage, s, asked) != decide_for(shifted, stage, s, float(v))
    # Only the last bit of a line or of a speed is another.
    assert differ <= 1


def test_a_correction_that_cannot_move_leaves_the_closed_loop_as_it_is(
    ready: tuple[Case, ActiveTable, ClosedLoop],
) -> None:
    case, table, loop = ready
    draws = loop.draws(random_passes(5, 0, PASSES))
    none = Correction(spread_m_s=0.5, memory_passes=10.0)  # its threshold is beyond every mean of these exits
    found = run_sequence(loop, table, draws, READINGS, none)
    plain = loop.run(TableController(table), draws).exit_speed_m_s - case.target_m_s
    assert not found.correction_m_s.any()
    assert found.error_m_s == pytest.approx(plain, abs=1e-9)
    assert found.usable.mean() > 0.9


def test_every_pass_runs_under_what_those_before_it_taught(ready: tuple[Case, ActiveTable, ClosedLoop]) -> None:
    """Each simulated again by itself, with all others: the direct simulation at its correction."""
    case, table, loop = ready
    passes = SensorCreeps(0.1)(random_passes(5, 0, PASSES), case.plant, np.full(PASSES, 1.0))
    draws = loop.draws(passes)
    found = run_sequence(loop, table, draws, READINGS, Correction(memory_passes=20.0))
    assert found.correction_m_s[0] == 0.0
    assert found.correction_m_s[-1] < -0.05
    for number in range(0, PASSES, 60):
        controller = TableController(corrected(table, np.float32(found.correction_m_s[number])))
        exits = loop.run(controller, draws).exit_speed_m_s - case.target_m_s
        assert exits[number] == pytest.approx(found.error_m_s[number], abs=1e-9)


def test_ageing_changes_what_it_says(ready: tuple[Case, ActiveTable, ClosedLoop]) -> None:
    case, _, loop = ready
    passes, share = random_passes(6, 0, PASSES), np.linspace(0.0, 1.0, PASSES)
    before, after = (loop.draws(each).cut_factor for each in (passes, FrictionFalls(0.2)(passes, case.plant, share)))
    there = before * (1.0 - 0.2 * share) > case.plant.friction.floor
    assert after[there] == pytest.approx((before * (1.0 - 0.2 * share))[there])
    crept = SensorCreeps(0.1)(passes, case.plant, share)
    shift = (crept.noise_z - passes.noise_z).mean(axis=1) * case.plant.sensor.noise_m_s
    assert shift == pytest.approx(0.1 * share, abs=1e-6)


def test_the_interval_of_a_ratio_holds_the_truth() -> None:
    """Paired sequences of known ratio 0.9, 400 times: at least 91 % of the intervals hold it."""
    rng, hits = np.random.default_rng(9), 0
    for _ in range(400):
        common = rng.standard_normal((10, 50)) * (1.0 + 0.2 * rng.random((10, 1)))
        _, (low, high) = rms_ratio(0.9 * (common + 0.3 * rng.standard_normal((10, 50))),
                                   common + 0.3 * rng.standard_normal((10, 50)))  # fmt: skip
        hits += low <= 0.9 <= high
    assert hits >= 364
