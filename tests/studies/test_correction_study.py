"""The study of the correction, and what the studies of limits and wrong estimators change."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import fields, is_dataclass, replace
from typing import Any

import numpy as np
import pytest

from plant_models import Plant
from scripts.studies.any_time.study import quicker
from scripts.studies.cases import Case, named_cases, tuned_table
from scripts.studies.changed_plants import no_fault
from scripts.studies.correction import rms_ratio
from scripts.studies.correction_sequence import FrictionFalls, SensorCreeps, corrected, run_sequence
from scripts.studies.estimator.wrong_study import wrongs
from scripts.studies.limits import FREE_DEGREE, QUIET_M_S, changes
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


def differences(one: Any, other: Any, name: str = "") -> Iterator[tuple[str, Any, Any]]:
    """(dotted name, value in one, value in the other) of every leaf that differs."""
    if is_dataclass(one) and type(one) is type(other):
        for field in fields(one):
            yield from differences(getattr(one, field.name), getattr(other, field.name), f"{name}.{field.name}")
    elif one != other:
        yield name.lstrip("."), one, other


VALVES = [
    f"position.pneumatics.{name}"
    for name in ("brake_delay_s", "touch_delay_s", "release_delay_s", "fill_time_constant_s", "exhaust_time_constant_s")
]

CHANGED = {
    "as it is": {},
    f"lines of degree {FREE_DEGREE}": {},
    "no spread of friction between cuts": {"friction.common_cv": 0.01},
    "no friction noise along the path": {"friction.path_std": 0.0},
    "no spread of rolling resistance": {"resistance.std_n_per_kn": 0.0},
    "sampled twice as often": {"sensor.sample_period_s": 0.05},
    "no computing delay": {"sensor.computing_delay_s": 0.0},
    "measured speed with 0.02 m/s of noise": {"sensor.noise_m_s": 0.02, "sensor.resolution_m_s": 0.0},
    "valves four times as fast": dict(zip(VALVES, (0.025, 0.05, 0.025, 0.075, 0.075), strict=True)),
}


def test_limits_switch_off_one_source_at_a_time(plant_52t: Plant) -> None:
    found = {each.name: each for each in changes(plant_52t, 3)}
    assert set(found) == set(CHANGED)
    for name, expected in CHANGED.items():
        changed = {leaf: new for leaf, _, new in differences(plant_52t, found[name].plant)}
        assert changed == pytest.approx(expected), name
        assert found[name].degree == (FREE_DEGREE if name.startswith("lines") else 3)
        assert (found[name].speed_step_m_s is None) == ("measured" not in name)
    quiet = found[f"measured speed with {QUIET_M_S:g} m/s of noise"]
    assert quiet.speed_step_m_s is not None
    assert quiet.speed_step_m_s < QUIET_M_S


SLOPE = "position.force.slope_kn_per_kpa_per_pair"

WRONG: dict[str, tuple[str, float]] = {
    "friction × 0.7": (SLOPE, 0.7),
    "friction × 0.8": (SLOPE, 0.8),
    "friction × 0.9": (SLOPE, 0.9),
    "friction × 1.1": (SLOPE, 1.1),
    "friction × 1.2": (SLOPE, 1.2),
    "friction × 1.3": (SLOPE, 1.3),
    "friction CV × 1.7": ("friction.common_cv", 1.7),
    "path noise × 2": ("friction.path_std", 2.0),
    "mass + 15 %": ("cut.mass_t", 1.15),
    "mass − 15 %": ("cut.mass_t", 0.85),
    "sensor noise × 2": ("sensor.noise_m_s", 2.0),
}


def test_an_estimator_is_wrong_about_one_thing_at_a_time(plant_52t: Plant) -> None:
    found = {each.name: each for each in wrongs(plant_52t, 1)}
    for name, wrong in found.items():
        changed = [(leaf, new / old) for leaf, old, new in differences(plant_52t, wrong.plant)]
        assert changed == ([(WRONG[name][0], pytest.approx(WRONG[name][1]))] if name in WRONG else []), name
        assert (wrong.fault is not no_fault) == ("lost" in name)
        assert wrong.gauge == {"gauge + 15 %": 1.15, "gauge − 15 %": 0.85}.get(name, 1.0)
    assert len(found) == len(WRONG) + 4


def test_quicker_valves_are_the_same_but_for_their_times(plant_of: Callable[[float], Plant]) -> None:
    plant = plant_of(22.0)
    changed = {leaf: old / new for leaf, old, new in differences(plant, quicker(plant, 4.0))}
    assert changed == dict.fromkeys(VALVES, pytest.approx(4.0))
    slow = replace(plant.position.pneumatics, closing_delay_s=0.02)
    closing = replace(plant, position=replace(plant.position, pneumatics=slow))
    assert quicker(closing, 2.0).position.pneumatics.closing_delay_s == 0.01
