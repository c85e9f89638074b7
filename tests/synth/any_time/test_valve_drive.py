"""The drive commanded at any moment: against the drive commanded at rest, and against valves played in tiny steps."""

from __future__ import annotations

from dataclasses import replace
from itertools import permutations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plant_models import PlantError, Pneumatics
from plant_models.valve_drive import drive_on, wait_after_command

VALVES = Pneumatics(700.0, 5.0, 0.11, 0.2, 0.07, 0.31, 0.4, 15.0)
TOUCH_KPA = 50.0
STAGES_KPA = (0.0, 150.0, 300.0, 450.0, 600.0)
DRIVE = VALVES.valves_shutting_at_once(TOUCH_KPA)


@pytest.mark.parametrize(("begin", "end"), list(permutations((0.0, 150.0, 600.0), 2)))
def test_a_command_at_rest_is_that_of_the_pressure_history(begin: float, end: float) -> None:
    start = begin + 15.0 if begin < end else begin - 15.0
    history = VALVES.respond(start, end, TOUCH_KPA)
    times = np.linspace(0.0, 1.5 * history.duration_s, 83)
    wait = wait_after_command(start, 0.0, begin, end, DRIVE)
    played = [drive_on(start, wait, end, float(t), DRIVE) for t in times]
    assert [p for p, _, _ in played] == pytest.approx(history.pressure_kpa(times), abs=1e-9)
    assert [i for _, _, i in played] == pytest.approx(history.overpressure_integral(times, TOUCH_KPA), abs=1e-9)


ORDERS = st.lists(st.tuples(st.sampled_from(STAGES_KPA), st.floats(0.0, 0.5)), min_size=1, max_size=8)


@given(orders=ORDERS, cut=st.floats(0.0, 1.0))
def test_where_a_time_is_cut_does_not_matter(orders: list[tuple[float, float]], cut: float) -> None:
    once = twice = (15.0, 0.0)
    stage = 0.0
    for wanted, duration in orders:
        once = (once[0], wait_after_command(*once, stage, wanted, DRIVE))
        twice = (twice[0], wait_after_command(*twice, stage, wanted, DRIVE))
        stage = wanted
        pressure, wait, whole = drive_on(*once, stage, duration, DRIVE)
        once = (pressure, wait)
        pressure, wait, first = drive_on(*twice, stage, cut * duration, DRIVE)
        pressure, wait, second = drive_on(pressure, wait, stage, duration - cut * duration, DRIVE)
        twice = (pressure, wait)
        assert once == pytest.approx(twice, abs=1e-8)
        assert whole == pytest.approx(first + second, abs=1e-8)


def played_in_tiny_steps(orders: list[tuple[float, float]], step_s: float) -> tuple[float, float]:
    """(pressure, ∫overpressure) with two valves as machines of their own, each with the time at which it may open."""
    pressure, total, now = 15.0, 0.0, 0.0
    opens = {1: np.inf, -1: np.inf}  # supply, exhaust; inf: no current on its wire
    for stage, duration in orders:
        begun = now
        while now < begun + duration - 0.5 * step_s:
            error = stage - pressure
            wanted = 0 if abs(error) <= 15.0 else (1 if error > 0 else -1)
            for valve in (1, -1):
                if wanted != valve:
                    opens[valve] = np.inf
                elif np.isinf(opens[valve]):
                    extra = 0.2 if pressure <= TOUCH_KPA else 0.0
                    opens[valve] = now + (0.11 + extra if valve == 1 else 0.07)
            before = pressure
            if now >= opens[1] - 1e-9:
                pressure = min(pressure + step_s * (700.0 - pressure) / 0.31, max(stage - 15.0, pressure))
            elif now >= opens[-1] - 1e-9:
                pressure = max(pressure + step_s * (5.0 - pressure) / 0.4, min(stage + 15.0, pressure))
            total += step_s * max(0.0, 0.5 * (before + pressure) - TOUCH_KPA)
            now += step_s
    return pressure, total


REVERSALS = {
    "reversed while waiting": [(150.0, 0.05), (0.0, 0.3)],
    "reversed while filling": [(300.0, 0.45), (0.0, 0.05), (150.0, 0.4)],
    "one stage further while filling": [(150.0, 0.4), (300.0, 0.1), (450.0, 0.3)],
    "one stage further while waiting": [(150.0, 0.1), (300.0, 0.1), (450.0, 0.1), (600.0, 0.5)],
    "back while exhausting": [(450.0, 1.0), (0.0, 0.3), (300.0, 0.25), (150.0, 0.2)],
    "into the band of a stage and out": [(300.0, 0.49), (150.0, 0.02), (300.0, 0.6)],
}


@pytest.mark.parametrize("orders", list(REVERSALS.values()), ids=list(REVERSALS))
def test_commands_in_a_transient_as_two_valves_would_take_them(orders: list[tuple[float, float]]) -> None:
    pressure, wait, total, stage = 15.0, 0.0, 0.0, 0.0
    for wanted, duration in orders:
        wait = wait_after_command(pressure, wait, stage, wanted, DRIVE)
        stage = wanted
        pressure, wait, done = drive_on(pressure, wait, stage, duration, DRIVE)
        total += done
    assert (pressure, total) == pytest.approx(played_in_tiny_steps(orders, 2e-5), abs=0.1)


def test_valves_that_close_late_are_refused() -> None:
    with pytest.raises(PlantError, match="closing_delay_s"):
        replace(VALVES, closing_delay_s=0.01).valves_shutting_at_once(TOUCH_KPA)
