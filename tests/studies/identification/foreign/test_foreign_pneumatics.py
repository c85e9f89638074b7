"""The drive of the foreign plant: choked and unchoked flow against hand integrations, valves, band."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad

from tests.studies.identification.foreign.foreign_draws import foreign_draw
from tests.studies.identification.foreign.foreign_motion import flow_kpa
from tests.studies.identification.foreign.foreign_pass import pressure_after_command
from tests.studies.identification.foreign.foreign_plant import ForeignPlant, neighbour_of_knp5

PLANT = neighbour_of_knp5(22.0, "Л", (0.0, 1.85, 8.65, 10.5))


def with_drive(**changes: float) -> ForeignPlant:
    """The plant with another drive, no jitter, and a supply line that cannot sink."""
    steady = {"line_litres": 1e9, "line_orifice_mm2": 1e9, "delay_jitter_s": 0.0}
    return replace(PLANT, drive=replace(PLANT.drive, **(steady | changes)))


def mass_flow_kg_s(plant: ForeignPlant, area_mm2: float, up_kpa: float, down_kpa: float) -> float:
    """The textbook's isentropic flow of air through an orifice (St. Venant and Wantzel), pressures absolute."""
    drive, gamma = plant.drive, 1.4
    ratio = max(down_kpa / up_kpa, (2.0 / (gamma + 1.0)) ** (gamma / (gamma - 1.0)))
    speed = math.sqrt(2.0 * 1005.0 * drive.temperature_k * (1.0 - ratio ** ((gamma - 1.0) / gamma)))
    density = up_kpa * 1e3 / (287.0 * drive.temperature_k) * ratio ** (1.0 / gamma)
    return float(drive.discharge * area_mm2 * 1e-6 * density * speed)


def pressure_rate(plant: ForeignPlant, area_mm2: float, up_kpa: float, down_kpa: float) -> float:
    """dp/dt of the isothermal cylinder by that flow, kPa/s: R T / V times it."""
    drive = plant.drive
    flow = mass_flow_kg_s(plant, area_mm2, up_kpa, down_kpa)
    return 1e-3 * 287.0 * drive.temperature_k * flow / (drive.cylinder_litres * 1e-3)


@pytest.mark.parametrize("ratio", [0.0, 0.2, 0.52, 0.54, 0.7, 0.9, 0.985])
def test_the_flow_is_that_of_the_textbook(ratio: float) -> None:
    drive = PLANT.drive
    ours = drive.rate_per_s(drive.fill_orifice_mm2, drive.cylinder_litres) * flow_kpa(800.0, 800.0 * ratio)
    # 1005 J/kg/K and 287 J/kg/K give gamma = 1.3997, not 1.4.
    assert ours == pytest.approx(pressure_rate(PLANT, drive.fill_orifice_mm2, 800.0, 800.0 * ratio), rel=1e-3)


def test_the_flow_is_continuous_and_ends_at_equal_pressures() -> None:
    ratios = np.linspace(0.9, 1.05, 30001)
    flows = np.array([flow_kpa(500.0, 500.0 * ratio) for ratio in ratios])
    assert flows[ratios >= 1.0].max() == 0.0
    assert np.abs(np.diff(flows)).max() < 0.05
    assert (np.diff(flows) <= 0.0).all()


def open_from_s(plant: ForeignPlant, delay_s: float) -> float:
    """The time from which a valve that opens at once would have let through the same: ahead of it the ramp counts half.

    Exact while the flow does not depend on the pressure that it changes, or depends on it as a factor.
    """
    return delay_s + 0.5 * plant.drive.opening_s


def test_choked_filling_is_a_straight_line() -> None:
    plant = with_drive()
    times = np.linspace(0.21, 0.38, 8)
    pressure = pressure_after_command(plant, foreign_draw(plant, 1, 0), 0.0, 4, times)
    drive = plant.drive
    slope = pressure_rate(plant, drive.fill_orifice_mm2, 801.3, 101.3)
    expected = slope * (times - open_from_s(plant, drive.fill_delay_s))
    assert pressure[-1] + 101.3 < 0.528 * 801.3  # choked to the end
    assert pressure == pytest.approx(expected, rel=1e-3)


def test_choked_exhausting_is_an_exponential() -> None:
    plant = with_drive()
    times = np.linspace(0.16, 0.6, 8)
    pressure = pressure_after_command(plant, foreign_draw(plant, 1, 0), 600.0, 0, times)
    drive = plant.drive
    constant_s = 500.0 / pressure_rate(plant, drive.exhaust_orifice_mm2, 500.0, 101.3)
    expected = 701.3 * np.exp(-(times - open_from_s(plant, drive.exhaust_delay_s)) / constant_s)
    assert pressure[-1] + 101.3 > 101.3 / 0.528
    assert pressure + 101.3 == pytest.approx(expected, rel=1e-3)


def test_unchoked_filling_takes_the_time_of_the_quadrature() -> None:
    plant = with_drive()
    drive, times = plant.drive, np.linspace(0.28, 0.36, 3)  # from 400 kPa on the flow is never choked
    pressure = pressure_after_command(plant, foreign_draw(plant, 1, 0), 400.0, 4, times)
    assert pressure[-1] < 600.0 - drive.band_kpa
    for before, after in pairwise(pressure):
        needed, _ = quad(
            lambda p: 1.0 / pressure_rate(plant, drive.fill_orifice_mm2, 801.3, p), before + 101.3, after + 101.3
        )
        assert needed == pytest.approx(times[1] - times[0], rel=1e-3)


def test_an_adiabatic_cylinder_is_faster_by_its_exponent() -> None:
    times = np.linspace(0.22, 0.3, 5)
    slow, fast = (
        pressure_after_command(plant, foreign_draw(plant, 1, 0), 0.0, 4, times)
        for plant in (with_drive(), with_drive(exponent=1.4))
    )
    assert fast == pytest.approx(1.4 * slow, rel=1e-9)


def test_a_filling_brake_lets_the_supply_line_sink_and_is_slower_for_it() -> None:
    times, small = np.array([0.3]), {"line_litres": 40.0, "line_orifice_mm2": 60.0}
    steady, sinking, closed = (
        float(pressure_after_command(plant, foreign_draw(plant, 1, 0), 0.0, 4, times)[0])
        for plant in (with_drive(), with_drive(**small), with_drive(**small | {"line_orifice_mm2": 0.0}))
    )
    assert closed < sinking < 0.98 * steady
    # What leaves a line that nothing refills is in the cylinder: 12 litres of 40.
    line_kpa = 801.3 - closed * 12.0 / 40.0
    flow = pressure_rate(PLANT, PLANT.drive.fill_orifice_mm2, 1.0, 0.0)
    falling = 801.3 * math.exp(-flow * 12.0 / 40.0 * (0.3 - open_from_s(PLANT, PLANT.drive.fill_delay_s)))
    assert line_kpa == pytest.approx(falling, rel=1e-3)


def test_nothing_moves_before_the_delay_and_jitter_shifts_it() -> None:
    plant, moments = PLANT, []
    for number in range(40):
        draw = foreign_draw(plant, 1, number)
        moment = plant.drive.fill_delay_s + float(draw.valve_jitter_s[0])
        before, after = pressure_after_command(plant, draw, 0.0, 2, np.array([moment - 1e-6, moment + 1e-3]))
        assert before == 0.0
        assert after > 0.0
        moments.append(moment)
    assert 0.6 * plant.drive.delay_jitter_s < np.std(moments) * math.sqrt(3.0) < 1.4 * plant.drive.delay_jitter_s


@pytest.mark.parametrize(("start_kpa", "stage"), [(0.0, 1), (0.0, 2), (285.0, 3), (600.0, 3), (600.0, 0), (150.0, 0)])
def test_a_stage_rests_inside_its_band_and_beyond_the_edge(start_kpa: float, stage: int) -> None:
    rested = pressure_after_command(PLANT, foreign_draw(PLANT, 1, 0), start_kpa, stage, np.array([3.0, 9.0]))
    stage_kpa, band = PLANT.stage_pressures_kpa[stage], PLANT.drive.band_kpa
    assert rested[0] == rested[1]
    assert 0.01 < band - abs(rested[0] - stage_kpa) < band  # the closing valve let a little more through


def test_a_valve_that_shuts_half_open_lets_nothing_back() -> None:
    start_kpa, times = 150.0 - PLANT.drive.band_kpa - 2.0, np.linspace(0.1, 0.4, 301)
    pressure = pressure_after_command(PLANT, foreign_draw(PLANT, 1, 0), start_kpa, 1, times)
    assert start_kpa + 2.0 < pressure[-1] < 150.0  # reached within the 60 ms in which the valve opens
    assert (np.diff(pressure) >= 0.0).all()


def test_the_plant_is_a_neighbour_of_the_library() -> None:
    slope = PLANT.brake.mean_slope_kn_per_kpa(4.0)
    assert 0.80 < slope / (20.0 / 550.0) < 0.85
    assert PLANT.brake.friction_at(2.0) > 1.2 * PLANT.brake.friction_at(6.0)
    times = np.linspace(0.0, 1.0, 501)
    pressure = pressure_after_command(PLANT, foreign_draw(PLANT, 1, 0), 0.0, 2, times)
    assert 0.4 < times[np.argmax(pressure >= 285.0)] < 0.6
