"""Passes of the polynomial rule once more, in plain Python from the equations of plant and valves, in small steps."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from plant_models import Plant
from synth.simulation.closed_loop import close_loop
from synth.simulation.random_passes import random_passes
from synth.solver.any_time.polynomial_surfaces import CUBIC_AND_SLOPE, PolynomialSurfaces
from tests.synth.any_time.tabled import tabled

STEP_S = 5e-4
SAME_M_S = 0.003
"""Exit speeds of passes with the same commands are as near: the kernel takes the pressure in means of parts."""


class SlowPass:
    """One cut on its way: everything that the plant knows, moved by `go_on`."""

    def __init__(self, plant: Plant, friction: float, resistance: float, entry_m_s: float) -> None:
        self.plant, self.friction, self.resistance = plant, friction, resistance
        self.s, self.v, self.kpa = 0.0, entry_m_s, 15.0  # released: the upper edge of the dead band about 0 kPa
        self.wanted_kpa, self.flow, self.wait_s = 0.0, 0, 0.0

    def command(self, kpa: float) -> None:
        """A command on the wires: the valve that it needs opens after its delay, unless it is open or awaited."""
        valves = self.plant.position.pneumatics
        error = kpa - self.kpa
        flow = 0 if abs(error) <= valves.dead_band_kpa + 1e-9 else (1 if error > 0.0 else -1)
        if flow > 0 and flow != self.flow:
            touching = self.kpa > self.plant.position.force.touch_pressure_kpa
            self.wait_s = valves.brake_delay_s + (0.0 if touching else valves.touch_delay_s)
        elif flow < 0 and flow != self.flow:
            self.wait_s = valves.release_delay_s
        self.wanted_kpa, self.flow = kpa, flow

    def go_on(self, seconds: float) -> None:
        """Pressure and motion for so long, in small steps."""
        count = math.ceil(seconds / STEP_S)
        for _ in range(count):
            if self.s < self.plant.exit_m and self.v > 0.0:
                self.step(seconds / count)

    def step(self, dt: float) -> None:
        """One small step."""
        before, valves = self.kpa, self.plant.position.pneumatics
        flowing = dt - min(self.wait_s, dt) if self.flow else 0.0
        self.wait_s = max(0.0, self.wait_s - dt)
        if self.flow > 0:
            share = -math.expm1(-flowing / valves.fill_time_constant_s)
            filled = self.kpa + (valves.supply_pressure_kpa - self.kpa) * share
            self.kpa = min(filled, self.wanted_kpa - valves.dead_band_kpa)
        elif self.flow < 0:
            share = -math.expm1(-flowing / valves.exhaust_time_constant_s)
            emptied = self.kpa + (valves.exhaust_pressure_kpa - self.kpa) * share
            self.kpa = max(emptied, self.wanted_kpa + valves.dead_band_kpa)
        if abs(self.kpa - self.wanted_kpa) <= valves.dead_band_kpa + 1e-9:
            self.flow = 0
        cut, force = self.plant.cut, self.plant.position.force
        inside = sum(0.0 <= self.s - x <= 8.0 for x in cut.axle_offsets_m)
        pads_kn = inside * 20.0 / 550.0 * max(0.0, 0.5 * (before + self.kpa) - force.touch_pressure_kpa)
        heavy_t = cut.mass_t + 0.42 * len(cut.axle_offsets_m)
        drive = 9.81 * cut.mass_t / heavy_t * 1e-3 * (8.0 - self.resistance)
        a = drive - self.friction * pads_kn / heavy_t
        self.s += self.v * dt + 0.5 * a * dt * dt
        self.v += a * dt


def slow_exit(plant: Plant, surfaces: PolynomialSurfaces, cut: SlowPass, first_s: float, z: np.ndarray) -> list[float]:
    """Exit speed and number of commands of a pass; one command goes one stage."""
    sensor, stage, commands = plant.sensor, 0, 0
    cut.go_on(first_s)
    for sample in range(400):
        if cut.s >= plant.exit_m or cut.v <= 0.0:
            break
        measured = max(0.0, cut.v + sensor.noise_m_s * float(z[sample]))
        u = 2.0 * cut.s / plant.exit_m - 1.0
        x = (cut.kpa - plant.position.stage_pressures_kpa[stage]) / 100.0
        lines = (np.polynomial.legendre.legval(u, c[:4]) + x * c[4] for c in surfaces.coefficients[stage])
        lower, upper = map(float, lines)
        step = int(surfaces.has_line[stage, 1] and measured > upper)
        step -= int(surfaces.has_line[stage, 0] and measured < lower)
        stage, commands = stage + step, commands + abs(step)
        cut.go_on(sensor.computing_delay_s)
        cut.command(plant.position.stage_pressures_kpa[stage])
        cut.go_on(sensor.sample_period_s - sensor.computing_delay_s)
    return [cut.v, commands]


@pytest.fixture(scope="module")
def smooth(plant: Plant) -> Plant:
    """No path noise, and a sensor that does not round: a pass is then a few numbers."""
    sensor = replace(plant.sensor, resolution_m_s=0.0)
    return replace(plant, friction=replace(plant.friction, path_std=0.0), sensor=sensor)


@pytest.mark.requirement("PRED-03")
def test_slow_passes_are_those_of_the_kernel(smooth: Plant) -> None:
    coefficients = np.zeros((3, 2, 5))
    coefficients[:, :, 0] = 3.0 + np.array([0.15, 0.3])
    coefficients[:, :, 1], coefficients[:, :, 2], coefficients[:, :, 4] = -0.25, 0.05, 0.06
    has_line = np.array([[False, True], [True, True], [True, False]])
    stages = np.asarray(smooth.position.stage_pressures_kpa)
    surfaces = PolynomialSurfaces(0.0, smooth.exit_m, stages, CUBIC_AND_SLOPE, coefficients, has_line)
    loop = close_loop(smooth, smooth.position.top_stage + 1)
    draws = loop.draws(random_passes(31, 0, 40))
    found = loop.run(tabled(smooth, surfaces), draws)
    same = 0
    for i in range(40):
        cut = SlowPass(smooth, draws.cut_factor[i], draws.resistance_n_kn[i], draws.entry_m_s[i])
        speed, commands = slow_exit(smooth, surfaces, cut, float(draws.first_sample_s[i]), draws.noise_z[i])
        if commands == found.switchings[i]:
            same += 1
            assert speed == pytest.approx(found.exit_speed_m_s[i], abs=SAME_M_S)
    assert same >= 38  # a speed within a millimetre of a line may fall on either side
    assert found.switchings.mean() > 2.0
