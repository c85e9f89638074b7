"""The on-line correction: its bound for every input, the recursion against one in double precision, what it learns."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.effort import sized
from tuning_tables import InvalidTable
from tuning_tables.correction import Correction, begun_correction
from tuning_tables.programs.correct import corrected_speed, learn_exit, usable_exit

CORRECTION = Correction()
WORDS = st.integers(0, 2**32 - 1)
NUMBERS = st.floats(width=32) | WORDS.map(lambda bits: float(np.array(bits, np.uint32).view(np.float32)))
"""Every float32 number: all NaN, infinities, denormals among them."""
CORRECTIONS = st.builds(
    Correction,
    st.floats(0.01, 0.5),
    st.floats(0.005, 0.5),
    st.floats(10.0, 1e4),
    st.floats(1e-4, 0.1),
)


def state_of(values: tuple[float, float, float]) -> npt.NDArray[np.float32]:
    with np.errstate(all="ignore"):
        return np.array(values, dtype=np.float32)


@pytest.mark.requirement("CORR-01", "CORR-03", "CORR-05")
@given(CORRECTIONS, st.lists(st.tuples(NUMBERS, st.booleans()), max_size=60), NUMBERS)
@settings(max_examples=sized(75, 300))
def test_whatever_comes_in_the_correction_is_bounded(
    correction: Correction, exits: list[tuple[float, bool]], speed: float
) -> None:
    state = begun_correction()
    limit, step = correction.setting.limit_m_s, float(correction.setting.step_m_s)
    for error, credible in exits:
        before = float(state[1])
        with np.errstate(all="raise", under="ignore"):  # a tiny number squared is 0, and meant to be
            learn_exit(correction.setting, state, error, credible)
        assert np.isfinite(state).all()
        assert abs(state[1]) <= limit
        # One step, and the rounding of a sum that is 0.6 at most.
        assert abs(float(state[1]) - before) <= step + 3e-8
        if not credible or not -1.0 <= error <= 1.0:
            assert float(state[1]) == before
    corrected = corrected_speed(correction.setting, state, speed)
    if 0.0 <= speed <= 40.0:
        assert max(speed - float(limit), 0.0) - 4e-6 <= float(corrected) <= speed + float(limit) + 4e-6
    else:
        assert corrected == speed or (np.isnan(corrected) and np.isnan(speed))


@pytest.mark.requirement("CORR-02")
@given(st.tuples(NUMBERS, NUMBERS, NUMBERS), NUMBERS, st.booleans(), st.floats(0.0, 40.0, width=32))
@settings(max_examples=sized(125, 500))
def test_from_any_state_one_pass_leads_back_into_the_bounds(
    words: tuple[float, float, float], error: float, credible: bool, speed: float
) -> None:
    """A memory that lost its content: no word of it is believed that cannot be, by either function."""
    state = state_of(words)
    assert abs(float(corrected_speed(CORRECTION.setting, state, speed)) - speed) <= 0.15 + 4e-6
    learn_exit(CORRECTION.setting, state, error, credible)
    assert np.isfinite(state).all()
    assert abs(state[1]) <= CORRECTION.setting.limit_m_s
    assert abs(state[0]) <= CORRECTION.setting.reach_m_s
    assert 0 <= int(state[2]) <= 2**24


def test_one_exit_moves_it_by_its_share_at_most() -> None:
    """Beyond the threshold c follows b at a slope of 2 at most, and b moves by gain times clip at most."""
    most = 2.0 * CORRECTION.gain * 3.0 * CORRECTION.spread_m_s
    for error in (1.0, -1.0):
        state = begun_correction()
        for number in range(400):
            learn_exit(CORRECTION.setting, state, 0.1 + 0.05 * np.sin(number), True)
        before = float(state[1])
        assert before > 0.05
        learn_exit(CORRECTION.setting, state, error, True)
        assert abs(float(state[1]) - before) <= 1.01 * most


def in_double_precision(correction: Correction, errors: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """c after each error, written from the page, from the Kalman filter's own quantities."""
    mean, c, found = 0.0, 0.0, []
    variance = correction.spread_m_s**2 * correction.gain
    reach = float(np.roots([1.0, -correction.limit_m_s, -4.0 * variance]).max())
    for error in errors:
        innovation = np.clip(error + c - mean, -3.0 * correction.spread_m_s, 3.0 * correction.spread_m_s)
        mean = np.clip(mean + innovation / correction.memory_passes, -reach, reach)
        wanted = mean * max(0.0, 1.0 - 4.0 * variance / mean**2)
        change = np.clip(wanted, -correction.limit_m_s, correction.limit_m_s) - c
        c += np.clip(change, -correction.step_m_s, correction.step_m_s)
        found.append(c)
    return np.array(found)


@pytest.mark.parametrize("bias_m_s", [0.0, 0.03, -0.08, 0.4])
def test_it_is_the_recursion_of_the_page(bias_m_s: float) -> None:
    rng = np.random.default_rng(4)
    errors = np.clip(bias_m_s + 0.05 * rng.standard_normal(3000), -0.99, 0.99)
    state, found = begun_correction(), []
    for error in errors:
        learn_exit(CORRECTION.setting, state, float(np.float32(error)), True)
        found.append(state[1])
    assert np.array(found) == pytest.approx(in_double_precision(CORRECTION, errors), abs=2e-5)


def test_the_gain_is_that_of_the_steady_kalman_filter() -> None:
    """Riccati's recursion of a mean that walks at random, with the walk that belongs to the memory."""
    k, r = CORRECTION.gain, CORRECTION.spread_m_s**2
    walk, p = k * k * r / (1.0 - k), 0.0
    for _ in range(5000):
        p += walk
        gain = p / (p + r)
        p *= 1.0 - gain
    assert gain == pytest.approx(k, rel=1e-6)
    assert 2.0 * np.sqrt(p) == pytest.approx(CORRECTION.threshold_m_s, rel=1e-6)


def closed(plant_bias_m_s: npt.NDArray[np.float64], seed: int) -> npt.NDArray[np.float64]:
    """Exits of a plant that obeys the correction: error = bias - c + noise."""
    rng = np.random.default_rng(seed)
    state, errors = begun_correction(), []
    for bias in plant_bias_m_s:
        errors.append(bias - float(state[1]) + CORRECTION.spread_m_s * rng.standard_normal())
        learn_exit(CORRECTION.setting, state, float(np.float32(errors[-1])), abs(errors[-1]) <= 1.0)
    return np.array(errors)


def test_a_bias_is_taken_off_and_none_costs_nothing() -> None:
    plain = np.random.default_rng(7).standard_normal(20_000) * CORRECTION.spread_m_s
    assert np.mean(closed(np.zeros(20_000), 7) ** 2) / np.mean(plain**2) < 1.001
    late = closed(np.full(5000, 0.1), 8)[1000:]
    # What stays is t²/b: 1 mm/s.
    assert abs(late.mean()) < 0.004
    assert np.sqrt(np.mean(late**2)) < 1.02 * CORRECTION.spread_m_s


@pytest.mark.requirement("CORR-04")
def test_a_bias_beyond_the_limit_does_not_wind_it_up() -> None:
    """After 3000 passes at the limit it comes back within three memories."""
    bias = np.concatenate([np.full(3000, 0.4), np.zeros(300)])
    errors = closed(bias, 9)
    assert errors[2000:3000].mean() == pytest.approx(0.25, abs=0.01)
    assert abs(errors[-50:].mean()) < 0.06


USABLE: dict[str, Any] = {
    "samples": 60, "missing": 0, "at_top": 10, "ends_at_top": False, "by_hand": False, "stalled": False,
    "error_m_s": 0.05,
}  # fmt: skip


@pytest.mark.requirement("CORR-03")
@pytest.mark.parametrize(
    "change",
    [
        {"by_hand": True}, {"stalled": True}, {"samples": 9, "at_top": 0}, {"missing": 4}, {"missing": -1},
        {"at_top": 31}, {"at_top": -1}, {"error_m_s": 1.1}, {"error_m_s": -1.1}, {"error_m_s": float("nan")},
        {"error_m_s": float("inf")}, {"ends_at_top": True, "error_m_s": 0.11},
    ],
    ids=str,
)  # fmt: skip
def test_each_condition_alone_makes_a_pass_unusable(change: dict[str, Any]) -> None:
    assert usable_exit(**USABLE)
    assert not usable_exit(**{**USABLE, **change})


def test_what_is_just_allowed_is_usable() -> None:
    for change in ({"missing": 3}, {"at_top": 30}, {"ends_at_top": True, "error_m_s": 0.1}, {"error_m_s": -1.0}):
        assert usable_exit(**{**USABLE, **change})


@pytest.mark.parametrize(
    ("key", "value"),
    [("limit_m_s", 0.0), ("limit_m_s", 0.6), ("spread_m_s", 0.0), ("memory_passes", 9.0), ("step_m_s", 0.2),
     ("limit_m_s", float("nan"))],
)  # fmt: skip
def test_numbers_out_of_range_are_refused(key: str, value: float) -> None:
    with pytest.raises(InvalidTable, match=f"correction.{key} is"):
        Correction(**{key: value})
