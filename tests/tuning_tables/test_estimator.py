"""The estimator against a Kalman filter in matrix form, against cuts whose friction is known, and bit by bit."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from synth.kernels.compiled_rules import compiled_rule
from tuning_tables import ControllerTable, InvalidTable, Predicted, Status, TableBook, speed_for, unseen_samples
from tuning_tables.active_table import active
from tuning_tables.estimator import Estimator, begin
from tuning_tables.held_table import lines_apart
from tuning_tables.programs.held import UNSEEN
from tuning_tables.programs.observe import observe

PERIOD_S = 0.1
BREAKS = (0.0, 1.85, 8.0, 12.5, 20.0, 30.0)
DRIVE = tuple(0.066 * s for s in BREAKS)
BRAKE = (0.0, 0.0008, 0.008, 0.018, 0.031, 0.031)


@pytest.fixture(scope="module")
def estimator() -> Estimator:
    return Estimator(0.05, 0.15, 0.006, 0.1, 2.0, 7, 20, 0.2, 0.5, 60.0, BREAKS, DRIVE, BRAKE)


def passes_of(seed: int, factor: float, noise_m_s: float, kpa: float = 250.0, excess: float = 0.0) -> np.ndarray:
    """Samples (s, true v, measured v, overpressure) of a cut with constant friction and excess resistance, m/s²."""
    rng = np.random.default_rng(seed)
    s, v, rows = 0.0, 6.0, []
    while s < 30.0:
        rows.append((s, v, v + noise_m_s * rng.standard_normal(), kpa))
        for _ in range(20):
            ahead = s + v * PERIOD_S / 20
            gained = np.interp(ahead, BREAKS, DRIVE) - np.interp(s, BREAKS, DRIVE) - excess * (ahead - s)
            lost = factor * kpa * (np.interp(ahead, BREAKS, BRAKE) - np.interp(s, BREAKS, BRAKE))
            s, v = ahead, np.sqrt(max(v * v + 2.0 * (gained - lost), 0.04))
    return np.array(rows)


def run(
    estimator: Estimator, samples: np.ndarray, step: Callable[..., float] = observe
) -> tuple[np.ndarray, np.ndarray]:
    """Estimates and states after every sample; the overpressure before the first counts for nothing."""
    state, speeds, states = begin(), [], []
    for s, _, v, p in samples:
        speeds.append(step(lines_apart(estimator), state, s, v, p))
        states.append(state.copy())
    return np.array(speeds), np.array(states)


@pytest.mark.requirement("EST-02")
def test_it_is_the_kalman_filter(estimator: Estimator) -> None:
    """The same recursion in double precision, with matrices and the exact square root."""
    samples = passes_of(1, 1.15, 0.05, excess=0.01)
    speeds, states = run(estimator, samples)
    x, P = np.array([samples[0, 2], 1.0, 0.0]), np.diag([0.05**2, 0.15**2, 0.006**2])
    for (s0, *_), (s, _, v, p), speed, state in zip(samples, samples[1:], speeds[1:], states[1:], strict=False):
        w = p * (np.interp(s, BREAKS, BRAKE) - np.interp(s0, BREAKS, BRAKE))
        de = np.interp(s, BREAKS, DRIVE) - np.interp(s0, BREAKS, DRIVE) - x[1] * w - x[2] * (s - s0)
        ahead = np.sqrt(x[0] ** 2 + 2.0 * de)
        mean = 0.5 * (x[0] + ahead)
        F = np.array([[x[0] / ahead, -w / mean, -(s - s0) / mean], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
        P = F @ P @ F.T + np.diag([(w / mean) ** 2 * 2.0 * 0.1**2 * 2.0 / (s - s0), 0.0, 0.0])
        K = P[:, 0] / (P[0, 0] + 0.05**2)
        x = np.array([ahead, x[1], x[2]]) + K * (v - ahead)
        P = P - np.outer(K, P[0])
        assert speed == pytest.approx(x[0], abs=2e-4)
        assert state[3:5] == pytest.approx(x[1:], abs=2e-3)
        assert state[5:11] == pytest.approx(P[np.triu_indices(3)], rel=3e-2, abs=1e-6)


def test_it_learns_the_resistance_of_a_cut(estimator: Estimator) -> None:
    """Without the brake nothing else slows a cut down otherwise than the mean one."""
    exact = replace(estimator, path_std=0.0, resistance_std_m_s2=0.03)
    samples = passes_of(2, 1.0, 1e-3, 0.0, excess=0.02)
    _, states = run(exact, samples)
    left = states[-1, 10] / 0.03**2
    assert left < 0.7
    assert states[-1, 4] == pytest.approx(0.02 * (1.0 - left), abs=4e-3)
    assert states[-1, 3] == pytest.approx(1.0, abs=1e-4)


@pytest.mark.parametrize("factor", [0.7, 1.0, 1.3])
def test_it_finds_the_friction_of_a_cut(estimator: Estimator, factor: float) -> None:
    exact = replace(estimator, path_std=0.0, resistance_std_m_s2=0.0)
    samples = passes_of(2, factor, 1e-6)
    speeds, states = run(exact, samples)
    assert np.abs(speeds[-10:] - samples[-10:, 1]).max() < 0.005
    # Shrunk towards 1 by what it does not know yet: the variance that is left of that before.
    left = states[-1, 8] / 0.15**2
    assert left < 0.1
    assert states[-1, 3] == pytest.approx(factor + left * (1.0 - factor), abs=0.01)


@pytest.mark.requirement("EST-02")
def test_its_errors_are_as_large_as_it_says(estimator: Estimator) -> None:
    exact = replace(estimator, path_std=0.0)
    rng = np.random.default_rng(3)
    errors, stated = [], []
    for seed in range(200):
        samples = passes_of(seed, 1.0 + 0.15 * rng.standard_normal(), 0.05)[:40]
        speeds, states = run(exact, samples)
        errors.append([speeds[-1] - samples[-1, 1], states[-1, 3]])
        stated.append(np.sqrt(states[-1, 5]))
    spread = np.array(errors)[:, 0].std()
    assert spread < 0.03  # of 0.05 measured
    # 200 samples: the standard deviation is known to 5 %, so 20 % is four standard errors.
    assert spread == pytest.approx(np.mean(stated), rel=0.2)


def test_a_drop_out_is_bridged_by_the_model(estimator: Estimator) -> None:
    samples = passes_of(4, 1.2, 0.05)
    seen, _ = run(estimator, samples)
    samples[15:25, 2] = np.nan
    bridged, _ = run(estimator, samples)
    assert np.array_equal(seen[:15], bridged[:15])
    assert np.abs(bridged[15:25] - samples[15:25, 1]).max() < 0.15
    # Without the model the last reading would be off by what the cut has lost since.
    assert samples[14, 1] - samples[24, 1] > 0.4


def test_nothing_is_estimated_before_a_speed_was_measured(estimator: Estimator) -> None:
    state = begin()
    for v in (np.nan, np.inf, -1.0):
        assert observe(lines_apart(estimator), state, 0.1, v, 0.0) == -1.0
        assert np.array_equal(state[:11], begin()[:11])
    assert unseen_samples(state) == 3
    assert observe(lines_apart(estimator), state, 0.2, 5.5, 0.0) == np.float32(5.5)


@pytest.mark.requirement("EST-03")
@pytest.mark.parametrize("estimating", [True, False])
def test_samples_without_a_reading_that_is_believed_are_counted(
    estimated_table: ControllerTable, estimating: bool
) -> None:
    """0 after one that is, before the first from the beginning on; a leap is believed where nothing is estimated."""
    table = estimated_table
    if not estimating:
        table = replace(table, estimator=None, predicted=Predicted(0, 0, 0, 0))
    state, counts = begin(), []
    for sample, v in enumerate((np.nan, -1.0, 5.0, 5.02, 5.01, np.inf, -0.5, 40.1, 5.0, 5.01, 9.0, np.nan)):
        speed_for(table, state, 0.1 * sample, v, 0.0)
        counts.append(unseen_samples(state))
    assert counts == [1, 2, 0, 0, 0, 1, 2, 3, 0, 0, *((1, 2) if estimating else (0, 1))]


def test_the_count_of_unseen_samples_stays_at_its_end(estimator: Estimator) -> None:
    state = begin()
    observe(lines_apart(estimator), state, 0.0, 5.0, 0.0)
    state[UNSEEN] = 2**24 - 1
    for _ in range(3):
        observe(lines_apart(estimator), state, 0.0, np.nan, 0.0)
        assert unseen_samples(state) == 2**24


def test_compiled_it_gives_the_same_bits(estimator: Estimator) -> None:
    compiled = compiled_rule(observe)
    rng = np.random.default_rng(6)
    special = np.array([np.nan, np.inf, -np.inf, 0.0, -0.0, -1.0, 1e-45, 3e38, 1e39])
    for trial in range(60):
        samples = passes_of(trial, rng.uniform(0.4, 1.8), 0.05, rng.uniform(0.0, 600.0))
        wild = rng.random(samples.shape) < 0.05 * (trial % 3)
        samples = np.where(wild, rng.choice(special, samples.shape), samples)
        with np.errstate(over="ignore", invalid="ignore"):
            plain, states = run(estimator, samples)
        fast, fast_states = run(estimator, samples, compiled)
        assert np.array_equal(plain.astype(np.float32).view(np.uint32), fast.astype(np.float32).view(np.uint32))
        assert np.array_equal(states.view(np.uint32), fast_states.view(np.uint32))
        assert np.isfinite(states).all()
        assert ((plain == -1.0) | (plain >= 0.0)).all()


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"path_std": np.nan}, "estimator.path_std"),
        ({"unlikely_deviation": np.inf}, "estimator.unlikely_deviation"),
        ({"s_m": (0.0,)}, "1 entries"),
        ({"s_m": (0.0, 1.0, 1.0, 3.0, 4.0, 5.0)}, "must rise by 0.001 m"),
        ({"s_m": (0.0, 1.0, 2.0, 3.0, 4.0, 2e4)}, r"estimator.s_m\[5\] is 20000"),
        ({"drive_m2_s2": (0.0, np.nan, 0.0, 0.0, 0.0, 0.0)}, r"estimator.drive_m2_s2\[1\]"),
        ({"drive_m2_s2": (0.0, 1.0)}, "estimator.drive_m2_s2 .* 6 entries"),
        ({"brake_m2_s2_per_kpa": (0.0, 0.1, 0.05, 0.2, 0.3, 0.4)}, "only takes energy away"),
    ],
)
def test_what_makes_no_estimator_is_refused(estimator: Estimator, changes: dict[str, Any], said: str) -> None:
    with pytest.raises(InvalidTable, match=said):
        replace(estimator, **changes)


def test_the_rule_is_asked_with_the_estimated_speed(estimated_table: ControllerTable) -> None:
    """Through the table, sample by sample, as a controller does it; without an estimator nothing is changed."""
    rng, estimator = np.random.default_rng(8), estimated_table.estimator
    assert estimator is not None
    state, direct = begin(), begin()
    for s in np.linspace(0.0, 9.0, 40):
        reading = (float(s), 5.0 + 0.05 * rng.standard_normal(), 120.0)
        speed = speed_for(estimated_table, state, *reading)
        assert speed == float(observe(lines_apart(estimator), direct, *reading))
        assert speed == speed_for(active(estimated_table), state.copy(), reading[0] - 30.0, np.nan, 0.0)
        assert speed_for(
            replace(estimated_table, estimator=None, predicted=Predicted(0, 0, 0, 0)), state, *reading
        ) == np.float32(reading[1])


@pytest.mark.requirement("CHOICE-04")
def test_lines_are_taken_between_tables_of_one_estimator_only(estimated_table: ControllerTable) -> None:
    faster = replace(estimated_table, id="faster", target_speed_m_s=estimated_table.target_speed_m_s + 1.0)
    assert estimated_table.estimator is not None
    other = replace(faster, estimator=replace(estimated_table.estimator, friction_cv=0.2))
    plain = replace(faster, estimator=None, predicted=Predicted(0.0, 0.0, 0.0, 0.0))
    asked = ("medium", 4, estimated_table.target_speed_m_s + 0.5)
    choice = TableBook((estimated_table, faster)).choose(*asked)
    assert choice.status is Status.BETWEEN
    assert choice.table is not None
    assert choice.table.estimator == estimated_table.estimator
    touching = replace(faster, estimator=replace(estimated_table.estimator, touch_pressure_kpa=75.0))
    for unlike in (other, plain, touching):
        assert TableBook((estimated_table, unlike)).choose(*asked).status is Status.SLOWER
