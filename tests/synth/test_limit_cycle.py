"""Limit cycles of the speed.

Hunting between two stages by the steps of the product, with the gap of the lines told.
Predicted limit cycles against time-stepped relays, the simulator and python-control's own analysis.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from plant_models import Cut, DopplerSensor, EntrySpeed, Friction, Plant, RollingResistance, TrackProfile
from synth.retarder.comparison.limit_cycle import (
    LimitCycle,
    StagePair,
    accelerations,
    cycle_wave,
    first_harmonic,
    hunting_report,
    relay_cycle,
    stage_pair,
)
from synth.retarder.loops.pictures import describing_function_analysis
from synth.simulation.closed_loop import LineController, trace
from synth.simulation.random_passes import random_passes
from synth.solver.switching_lines import SwitchingLines


def limit_cycle(
    plant: Plant,
    lower_stage: int,
    gap_m_s: float,
    stretch_m: tuple[float, float] | None = None,
    line_rate_m_s2: float = 0.0,
) -> LimitCycle | None:
    """Hunting between `lower_stage` and the next, or None if both stages leave the lines to one side.

    `gap_m_s`: raising line minus lowering line; `stretch_m`: part of the path whose means count, None: all of it;
    `line_rate_m_s2`: dV/ds·v, at which the lines themselves rise.
    """
    free, brake = accelerations(plant, np.array(stretch_m or (0.0, plant.exit_m)))
    return relay_cycle(stage_pair(plant, lower_stage), gap_m_s, float(free[0]) - line_rate_m_s2, float(brake[0]))


def long_plant(plant: Plant, grade_permille: float, period_s: float, computing_s: float) -> Plant:
    """A bogie in one zone of 480 m, without chance: the acceleration at a stage does not depend on the path."""
    return replace(
        plant,
        position=replace(plant.position, zones_m=((0.0, 480.0),)),
        profile=TrackProfile.uniform(grade_permille),
        cut=Cut("С", 52.0, (0.0, 1.85), 4),
        friction=Friction(0.0, 0.0, 0.0, 2.0),
        resistance=RollingResistance(plant.resistance.mean_n_per_kn, 0.0),
        sensor=DopplerSensor(0.0, 0.0, period_s, computing_s),
        entry=EntrySpeed(4.0, 4.0),
    )


def pair_of_lines(plant: Plant, lower_stage: int, lower_m_s: list[float], upper_m_s: list[float]) -> SwitchingLines:
    """Lines, given at entrance and exit, that let the regulator climb to `lower_stage` and hunt above it."""
    lower, upper = np.full((5, 2), -np.inf), np.full((5, 2), np.inf)
    upper[:lower_stage], upper[lower_stage], lower[lower_stage + 1] = 0.0, upper_m_s, lower_m_s
    return SwitchingLines(np.array([0.0, plant.exit_m]), lower, upper)


def simulated(plant: Plant, lower_stage: int, lines: SwitchingLines, from_m: float, to_m: float) -> tuple[float, float]:
    """(half swing, mean period) of the simulator's pass, counted from raise to raise inside a part of the path."""
    events = trace(plant, LineController(lines), random_passes(1, 0, 1), 0)
    raises = np.flatnonzero((events.stage[1:] == lower_stage + 1) & (events.stage[:-1] == lower_stage)) + 1
    raises = raises[(events.path_m[raises] > from_m) & (events.path_m[raises] < to_m)]
    assert raises.size > 7
    at = events.path_m[raises[0] : raises[-1]]
    middle = 0.5 * (lines.lower_m_s[lower_stage + 1] + lines.upper_m_s[lower_stage])
    relative = events.speed_m_s[raises[0] : raises[-1]] - np.interp(at, lines.nodes_m, middle)
    duration = float(events.time_s[raises[-1]] - events.time_s[raises[0]])
    return 0.5 * float(np.ptp(relative)), duration / (raises.size - 1)


def test_symmetric_relay_by_hand() -> None:
    """Acceleration ±a, dead time τ, lines ±c: amplitude c + aτ, period 4(c + aτ)/a."""
    low, high = np.full(25, 0.0), np.full(25, 100.0)
    pair = StagePair(1, 0.0, 100.0, np.concatenate([low, high[:15]]), np.concatenate([high, low[:15]]), 0.1)
    cycle = relay_cycle(pair, 0.1, free=0.2, brake=0.004)
    assert cycle is not None
    a, delay = 0.2, 25 * 0.005 + 0.05  # half a sampling period is the mean wait
    assert (cycle.rise_m_s2, cycle.fall_m_s2) == pytest.approx((a, a))
    assert (cycle.brake_delay_s, cycle.release_delay_s) == pytest.approx((delay, delay))
    assert cycle.amplitude_m_s == pytest.approx(0.05 + a * delay)
    assert cycle.top_m_s == pytest.approx(-cycle.bottom_m_s)
    assert cycle.period_s == pytest.approx(4 * (0.05 + a * delay) / a)
    assert relay_cycle(pair, 0.1, free=0.5, brake=0.004) is None
    assert relay_cycle(pair, 0.1, free=-0.1, brake=0.004) is None

    response = describing_function_analysis(cycle)
    [(amplitude, omega)] = response.intersections
    assert cycle.harmonic_amplitude_m_s == pytest.approx(amplitude, rel=1e-3)
    assert cycle.harmonic_period_s == pytest.approx(2 * math.pi / omega, rel=1e-3)


@pytest.mark.parametrize(("rise", "fall", "brake_s", "release_s"), [(0.1, 0.3, 0.2, 0.5), (0.4, 0.05, 0.6, 0.2)])
def test_first_harmonic_of_unequal_slopes_is_that_of_the_wave(
    rise: float, fall: float, brake_s: float, release_s: float
) -> None:
    """Fourier coefficient of the rectangular acceleration, and the line crossings of the sine that it makes."""
    gap = 0.05
    amplitude, period = first_harmonic(gap, rise, fall, brake_s, release_s)
    phase = np.linspace(-math.pi, math.pi, 200_001)
    share = math.pi * fall / (rise + fall)
    acceleration = np.where(np.abs(phase) < share, rise, -fall)
    omega = 2 * math.pi / period
    wave = np.trapezoid(acceleration * np.cos(phase), phase) / math.pi / omega
    assert amplitude == pytest.approx(wave, rel=1e-3)
    raised = amplitude * math.sin(share - omega * brake_s)
    lowered = amplitude * math.sin(-share - omega * release_s)
    assert raised - lowered == pytest.approx(gap, rel=1e-6)


@pytest.mark.parametrize(
    ("grade", "stage", "gap", "period_s", "computing_s"),
    [
        (8.0, 0, 0.2, 0.1, 0.02),
        (10.0, 0, 0.1, 0.1, 0.3),
        (25.0, 1, 0.2, 0.1, 0.02),
        (25.0, 1, 0.05, 0.3, 0.02),
        (50.0, 2, 0.1, 0.1, 0.02),
        (10.0, 0, -0.5, 0.1, 0.02),  # only the lock ends each stay in the lower stage
        (20.0, 1, -0.3, 0.1, 0.02),  # only the lock ends each stay in the upper stage
    ],
)
def test_speed_cycle_is_the_simulators(
    plant_52t: Plant, grade: float, stage: int, gap: float, period_s: float, computing_s: float
) -> None:
    plant = long_plant(plant_52t, grade, period_s, computing_s)
    cycle = limit_cycle(plant, stage, gap, (10.0, 470.0))
    assert cycle is not None
    lines = pair_of_lines(plant, stage, [4.0, 4.0], [4.0 + gap, 4.0 + gap])
    amplitude, period = simulated(plant, stage, lines, 40.0, 475.0)
    assert cycle.sampled_period_s == pytest.approx(period, rel=0.005)
    assert cycle.sampled_amplitude_m_s == pytest.approx(amplitude, abs=0.001)
    assert cycle.period_s == pytest.approx(period, rel=0.06)
    # The closed form is the mean; one swing may start up to half a sample later or earlier at each end.
    spread = 0.25 * (cycle.rise_m_s2 + cycle.fall_m_s2) * period_s + 0.001
    assert cycle.amplitude_m_s == pytest.approx(amplitude, abs=spread)
    if gap >= 0.0:
        assert cycle.harmonic_period_s == pytest.approx(period, rel=0.25)
        assert cycle.harmonic_amplitude_m_s == pytest.approx(amplitude, rel=0.4)
    else:
        assert math.isnan(cycle.harmonic_period_s)


def test_falling_lines_are_followed_by_two_braking_stages(plant_52t: Plant) -> None:
    """Lines V² = 144 − 0.4·s fall by 0.2 m/s²; around level ones these stages, which both brake, cannot hunt."""
    still = long_plant(plant_52t, 25.0, 0.02, 0.02)
    position = replace(still.position, max_entry_speed_m_s=12.0)
    plant = replace(still, position=position, entry=EntrySpeed(12.0, 12.0))
    nodes = np.linspace(0.0, plant.exit_m, 601)
    speed = np.sqrt(np.maximum(144.0 - 0.4 * nodes, 9.0))
    lower, upper = np.full((5, 601), -np.inf), np.full((5, 601), np.inf)
    upper[:2], upper[2], lower[3] = 0.0, speed + 0.03, speed - 0.03
    lines = SwitchingLines(nodes, lower, upper)
    cycle = limit_cycle(plant, 2, 0.06, (40.0, 300.0), -0.2)
    assert cycle is not None
    amplitude, period = simulated(plant, 2, lines, 40.0, 300.0)
    assert cycle.sampled_period_s == pytest.approx(period, rel=0.01)
    assert cycle.sampled_amplitude_m_s == pytest.approx(amplitude, abs=0.002)
    assert limit_cycle(plant, 2, 0.06, (40.0, 300.0)) is None
    [hunting] = [found for found in hunting_report(plant, lines) if found.cycle.lower_stage == 2]
    assert hunting.to_m == pytest.approx(135.0 / 0.4, abs=1.0)  # where the lines become level
    assert hunting.cycle.period_s == pytest.approx(cycle.period_s, rel=0.01)


def test_report_counts_the_periods_that_the_simulator_plays(plant_52t: Plant) -> None:
    plant = long_plant(plant_52t, 25.0, 0.1, 0.02)
    lines = pair_of_lines(plant, 1, [4.0, 4.0], [4.2, 4.2])
    nodes = np.linspace(0.0, plant.exit_m, 97)
    fine = SwitchingLines(nodes, np.repeat(lines.lower_m_s[:, :1], 97, 1), np.repeat(lines.upper_m_s[:, :1], 97, 1))
    [hunting] = hunting_report(plant, fine)
    assert hunting.cycle.lower_stage == 1
    assert hunting.from_m < 10.0
    assert hunting.to_m > 470.0
    events = trace(plant, LineController(fine), random_passes(1, 0, 1), 0)
    raises = np.count_nonzero((events.stage[1:] == 2) & (events.stage[:-1] == 1))
    assert hunting.periods == pytest.approx(raises, abs=1.5)


def test_report_is_empty_where_nothing_can_hunt(plant_52t: Plant) -> None:
    """Stages 2 and 3 both brake; or the position is left before one period is over."""
    nodes = np.linspace(0.0, plant_52t.exit_m, 65)
    lower, upper = np.full((5, 65), -np.inf), np.full((5, 65), np.inf)
    upper[2], lower[3] = 4.2, 4.0
    assert hunting_report(plant_52t, SwitchingLines(nodes, lower.copy(), upper.copy())) == ()
    upper[0], lower[1] = 6.0, 4.0  # 2 m/s at 0.07 m/s² take half a minute
    assert hunting_report(plant_52t, SwitchingLines(nodes, lower.copy(), upper.copy())) == ()


@pytest.mark.parametrize(("mass_t", "gap"), [(22.0, 0.02), (52.0, 0.02), (52.0, 0.1), (85.0, 0.1)])
def test_report_holds_on_the_pilot_position(plant_of: Callable[[float], Plant], mass_t: float, gap: float) -> None:
    """Two retarders, 1 to 4 braked axles: the report's means against a pass that meets them one by one."""
    pilot = plant_of(mass_t)
    plant = replace(
        pilot,
        friction=Friction(0.0, 0.0, 0.0, 2.0),
        resistance=RollingResistance(pilot.resistance.mean_n_per_kn, 0.0),
        sensor=DopplerSensor(0.0, 0.0, 0.1, 0.02),
        entry=EntrySpeed(4.0, 4.0),
    )
    nodes = np.linspace(0.0, plant.exit_m, 65)
    lower, upper = np.full((plant.top_stage + 1, 65), -np.inf), np.full((plant.top_stage + 1, 65), np.inf)
    upper[0], lower[1] = 4.0 + gap, 4.0
    lines = SwitchingLines(nodes, lower, upper)
    [hunting] = hunting_report(plant, lines)
    assert hunting.cycle.lower_stage == 0
    events = trace(plant, LineController(lines), random_passes(1, 0, 1), 0)
    raises = np.flatnonzero((events.stage[1:] == 1) & (events.stage[:-1] == 0)) + 1
    assert hunting.periods == pytest.approx(raises.size, abs=1.0)
    swing = float(np.ptp(events.speed_m_s[raises[0] : raises[-1]]))
    assert hunting.cycle.amplitude_m_s == pytest.approx(0.5 * swing, abs=0.012)


def test_a_pair_beyond_the_allowed_stages_is_refused(plant_22t: Plant) -> None:
    with pytest.raises(ValueError, match="stages 0 to 2"):
        limit_cycle(plant_22t, 2, 0.1)


@pytest.mark.parametrize(("mass_t", "gap"), [(22.0, 0.02), (52.0, 0.1), (85.0, 0.1), (52.0, -0.03)])
def test_the_wave_closes_and_reaches_the_extremes(
    plant_of: Callable[[float], Plant], mass_t: float, gap: float
) -> None:
    """Stepped through its transients it comes back to where it began after one period, between bottom and top."""
    plant = plant_of(mass_t)
    cycle = limit_cycle(plant, 0, gap)
    assert cycle is not None
    wave = cycle_wave(plant, cycle)
    assert wave.speed_m_s[-1] == pytest.approx(wave.speed_m_s[0], abs=1e-12)
    assert wave.time_s[-1] == pytest.approx(cycle.period_s, abs=1e-9)
    assert np.all(np.diff(wave.time_s) > -1e-12)
    assert wave.speed_m_s.max() == pytest.approx(cycle.top_m_s, abs=1e-9)
    assert wave.speed_m_s.min() == pytest.approx(cycle.bottom_m_s, abs=1e-9)
    slope = np.diff(wave.speed_m_s) / np.maximum(np.diff(wave.time_s), 1e-12)
    assert -cycle.fall_m_s2 - 1e-9 <= slope.min() < 0.0 < slope.max() <= cycle.rise_m_s2 + 1e-9
