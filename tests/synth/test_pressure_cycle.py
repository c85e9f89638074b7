"""Predicted limit cycles of the stage pressure regulator against a relay stepped in time."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from plant_models import Plant, PlantError, Pneumatics
from synth.retarder.comparison.pressure_cycle import pressure_hunting, pressure_limit_cycle
from tests.synth.test_limit_cycle import limit_cycle

TOUCH_KPA = 50.0


def drive(closing_delay_s: float, dead_band_kpa: float = 15.0) -> Pneumatics:
    """The pilot plant's drive with valves that shut late; filling slower than exhausting."""
    return Pneumatics(700.0, 0.0, 0.1, 0.2, 0.07, 0.4, 0.3, dead_band_kpa, closing_delay_s)


def stepped_pressure(air: Pneumatics, target: float, step: float = 1e-4) -> tuple[float, float, float]:
    """(bottom, top, period) of the relay played in small time steps, by rules and without closed forms."""
    pressure, time, valve, wait = 0.0, 0.0, 0, math.inf
    shuts, tops, bottoms = math.inf, list[float](), list[tuple[float, float]]()
    while len(bottoms) < 4 and time < 60.0:
        if valve == 0:
            wanted = int(pressure < target - air.dead_band_kpa) - int(pressure > target + air.dead_band_kpa)
            touch = air.touch_delay_s if pressure <= TOUCH_KPA else 0.0
            wait = (air.brake_delay_s + touch if wanted > 0 else air.release_delay_s) if wait == math.inf else wait
            wait -= step
            if wanted != 0 and wait <= 0.0:
                valve, wait, shuts = wanted, math.inf, math.inf
        elif valve > 0:
            pressure += step * (air.supply_pressure_kpa - pressure) / air.fill_time_constant_s
        else:
            pressure += step * (air.exhaust_pressure_kpa - pressure) / air.exhaust_time_constant_s
        reached = pressure * valve >= (target - valve * air.dead_band_kpa) * valve
        if valve != 0 and reached and shuts == math.inf:
            shuts = time + air.closing_delay_s
        if valve != 0 and time >= shuts:
            if valve > 0:
                tops.append(pressure)
            else:
                bottoms.append((time, pressure))
            valve = 0
        time += step
    return bottoms[-1][1], tops[-1], bottoms[-1][0] - bottoms[-2][0]


@pytest.mark.parametrize(("target", "delay"), [(150.0, 0.08), (300.0, 0.08), (450.0, 0.08), (55.0, 0.2)])
def test_pressure_cycle_is_the_relays(target: float, delay: float) -> None:
    cycle = pressure_limit_cycle(drive(delay), target, TOUCH_KPA)
    assert cycle is not None
    bottom, top, period = stepped_pressure(drive(delay), target)
    assert (cycle.bottom_kpa, cycle.top_kpa) == pytest.approx((bottom, top), abs=0.5)
    assert cycle.period_s == pytest.approx(period, rel=0.01)


def test_pressure_hunts_exactly_where_the_drive_finds_no_rest() -> None:
    hunting = set()
    for target in (0.0, 60.0, 150.0, 300.0, 450.0, 600.0):
        for delay in np.arange(0.0, 0.2, 0.005):
            air = drive(float(delay))
            predicted = pressure_limit_cycle(air, target, TOUCH_KPA) is not None
            hunting.add(predicted)
            start = target - 100.0 if target >= 100.0 else target + 100.0
            if predicted:
                with pytest.raises(PlantError, match="hunts"):
                    air.respond(start, target, TOUCH_KPA)
            else:
                air.respond(start, target, TOUCH_KPA)
    assert hunting == {True, False}


def test_pressure_threshold_is_two_dead_bands() -> None:
    """Equal rates r = 1000 kPa/s and a narrow band: it hunts from rτ = 2ε on."""

    def air(reach: float) -> Pneumatics:
        return Pneumatics(600.0, 0.0, 0.1, 0.2, 0.1, 0.3, 0.3, 0.5, reach * 0.5 / 1000.0)

    assert pressure_limit_cycle(air(1.99), 300.0, TOUCH_KPA) is None
    exact = pressure_limit_cycle(air(2.01), 300.0, TOUCH_KPA)
    assert exact is not None
    assert exact.top_kpa - exact.bottom_kpa == pytest.approx(2 * 0.5 * (2.01 - 1.0), rel=0.01)


def test_pilot_plant_hunts_in_pressure_only_with_late_valves(plant_52t: Plant) -> None:
    assert pressure_hunting(plant_52t) == ()
    late = replace(plant_52t.position.pneumatics, closing_delay_s=0.08)
    plant = replace(plant_52t, position=replace(plant_52t.position, pneumatics=late))
    assert [stage for stage, _ in pressure_hunting(plant)] == [1, 2, 3]  # at 0 and 600 kPa one rate is too small
    with pytest.raises(PlantError, match="hunts"):
        limit_cycle(plant, 0, 0.1)
