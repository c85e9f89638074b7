"""Pneumatics against closed forms and quadrature; the delays of zhukovitsky-2012; the hunting regulator."""

import math
from dataclasses import asdict, replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from plant_models import DopplerSensor, PlantError, Pneumatics, PressingForce, PressureHistory, RetarderPosition
from plant_models.stage_regulator import stage_locked_actuator
from tests.effort import sized

DRIVE = Pneumatics(
    supply_pressure_kpa=700.0,
    exhaust_pressure_kpa=0.0,
    brake_delay_s=0.1,
    touch_delay_s=0.2,
    release_delay_s=0.15,
    fill_time_constant_s=0.3,
    exhaust_time_constant_s=0.4,
    dead_band_kpa=15.0,
)
TOUCH_KPA = 50.0


def at(history: PressureHistory, t_s: float) -> float:
    return float(history.pressure_kpa(np.array([t_s]))[0])


def test_filling_follows_the_exponential_to_the_edge_of_the_dead_band() -> None:
    history = DRIVE.respond(150.0, 450.0, TOUCH_KPA)
    fill_s = 0.3 * math.log((700 - 150) / (700 - 435))
    assert history.duration_s == pytest.approx(0.1 + fill_s, rel=1e-12)
    assert history.end_kpa == 435.0
    assert at(history, 0.099) == 150.0
    assert at(history, 0.2) == pytest.approx(700 - 550 * math.exp(-0.1 / 0.3), rel=1e-12)
    assert at(history, 99.0) == 435.0


def test_exhausting_follows_the_exponential_to_the_edge_of_the_dead_band() -> None:
    history = DRIVE.respond(600.0, 300.0, TOUCH_KPA)
    assert history.duration_s == pytest.approx(0.15 + 0.4 * math.log(600 / 315), rel=1e-12)
    assert history.end_kpa == 315.0
    assert at(history, 0.25) == pytest.approx(600 * math.exp(-0.1 / 0.4), rel=1e-12)


@pytest.mark.parametrize(("start_kpa", "delay_s"), [(0.0, 0.3), (50.0, 0.3), (50.001, 0.1), (135.0, 0.1)])
def test_extra_dead_time_only_while_the_pads_do_not_touch(start_kpa: float, delay_s: float) -> None:
    history = DRIVE.respond(start_kpa, 300.0, TOUCH_KPA)
    assert at(history, delay_s - 1e-9) == pytest.approx(start_kpa, abs=1e-9)
    assert at(history, delay_s + 1e-3) > start_kpa + 1.0


@pytest.mark.parametrize(
    ("constant_s", "stop_kpa", "fill_s"), [(0.2, 300, 0.11), (0.3, 600, 0.58), (0.4, 600, 0.78), (0.5, 300, 0.28)]
)
def test_fill_times_of_the_facts(constant_s: float, stop_kpa: float, fill_s: float) -> None:
    drive = replace(DRIVE, fill_time_constant_s=constant_s, dead_band_kpa=0.1, touch_delay_s=0.0)
    history = drive.respond(0.0, stop_kpa + 0.1, TOUCH_KPA)
    assert history.duration_s - 0.1 == pytest.approx(fill_s, abs=0.006)


def test_inside_the_dead_band_nothing_moves() -> None:
    history = DRIVE.respond(290.0, 300.0, TOUCH_KPA)
    assert (history.duration_s, history.end_kpa) == (0.0, 290.0)


@pytest.mark.parametrize(("start", "target"), [(0.0, 150.0), (0.0, 600.0), (600.0, 0.0), (165.0, 0.0), (450.0, 150.0)])
@pytest.mark.parametrize("closing_s", [0.0, 0.005])
def test_overpressure_integral_equals_quadrature(start: float, target: float, closing_s: float) -> None:
    history = replace(DRIVE, closing_delay_s=closing_s).respond(start, target, TOUCH_KPA)
    touch_s = np.interp(TOUCH_KPA, *sorted_curve(history))
    for t_end in (0.05, 0.31, 0.5, 0.9, 2.5):
        kinks = sorted({float(s) for s in history.starts_s if 0 < s < t_end} | {min(float(touch_s), t_end)})
        expected, _ = quad(lambda t: max(0.0, at(history, t) - TOUCH_KPA), 0.0, t_end, points=kinks, limit=200)
        got = float(history.overpressure_integral(np.array([t_end]), TOUCH_KPA)[0])
        assert got == pytest.approx(expected, rel=1e-6, abs=1e-6)


def sorted_curve(history: PressureHistory) -> tuple[np.ndarray, np.ndarray]:
    """Pressure ascending and its times: where the touch pressure is crossed, for the quadrature's sake."""
    t = np.linspace(0.0, 3.0, 30_001)
    p = history.pressure_kpa(t)
    return (p, t) if p[-1] >= p[0] else (p[::-1], t[::-1])


@settings(max_examples=sized(15, 60), deadline=None, derandomize=True)
@given(
    start=st.floats(0.0, 650.0),
    target=st.floats(0.0, 650.0),
    touch=st.floats(0.0, 200.0),
    t_end=st.floats(0.01, 3.0),
)
def test_mean_overpressure_is_between_the_extremes_and_additive(
    start: float, target: float, touch: float, t_end: float
) -> None:
    history = DRIVE.respond(start, target, touch)
    edges = np.linspace(0.0, t_end, 8)
    means = np.diff(history.overpressure_integral(edges, touch)) / np.diff(edges)
    assert means.min() >= -1e-9
    assert means.max() <= max(0.0, max(start, history.end_kpa) - touch) + 1e-9
    total = history.overpressure_integral(edges[-1:], touch)[0]
    assert (means * np.diff(edges)).sum() == pytest.approx(total, rel=1e-9, abs=1e-9)


@given(period_s=st.floats(0.02, 0.1), samples=st.integers(2, 40))
def test_a_change_that_ends_at_a_sample_is_over_there_however_it_rounds(period_s: float, samples: int) -> None:
    fill_s = samples * period_s / math.log((700.0 - 15.0) / (700.0 - 285.0))
    drive = replace(DRIVE, brake_delay_s=0.0, touch_delay_s=0.0, fill_time_constant_s=fill_s)
    position = RetarderPosition("x", ((0.0, 3.0),), (0.0, 300.0), PressingForce(0.03, 50.0), drive, 6.0)
    actuator = stage_locked_actuator(position, DopplerSensor(0.05, 0.0, period_s, 0.0), 1, 1)
    assert actuator.change(0, 1) == (1, samples)


def test_a_slow_day_makes_every_time_longer_and_nothing_else() -> None:
    drive = replace(DRIVE, closing_delay_s=0.01, day_spread=0.5)
    slower = {name: value * math.exp(0.5 * 2.0) for name, value in asdict(drive).items() if name.endswith("_s")}
    assert drive.on_day(2.0) == replace(drive, **slower, day_spread=0.0)
    assert drive.on_day(0.0) == replace(drive, day_spread=0.0)


def test_a_closing_delay_overshoots_by_delay_times_slope() -> None:
    history = replace(DRIVE, closing_delay_s=0.01).respond(150.0, 450.0, TOUCH_KPA)
    assert history.end_kpa == pytest.approx(700 - (700 - 435) * math.exp(-0.01 / 0.3), rel=1e-12)
    assert 435 < history.end_kpa <= 465


def test_a_long_closing_delay_hunts_and_is_refused() -> None:
    with pytest.raises(PlantError, match=r"closing_delay_s is 0.1; .* hunts around 450 kPa"):
        replace(DRIVE, closing_delay_s=0.1).respond(150.0, 450.0, TOUCH_KPA)


@pytest.mark.parametrize(
    ("stages", "message"),
    [((0.0, 720.0), "cannot reach it"), ((0.0, 20.0), "dead bands|overlap|dead band"), ((0.0, 700.0), None)],
)
def test_unreachable_stages_are_refused(stages: tuple[float, ...], message: str | None) -> None:
    if message is None:
        DRIVE.require_reachable(stages)
        return
    with pytest.raises(PlantError, match=message):
        DRIVE.require_reachable(stages)


def test_impossible_constants_are_refused() -> None:
    with pytest.raises(PlantError, match=r"fill_time_constant_s is 0.0"):
        replace(DRIVE, fill_time_constant_s=0.0)
    with pytest.raises(PlantError, match=r"exhaust_pressure_kpa is 700.0"):
        replace(DRIVE, exhaust_pressure_kpa=700.0)
    with pytest.raises(PlantError, match=r"brake_delay_s is -0.1"):
        replace(DRIVE, brake_delay_s=-0.1)
