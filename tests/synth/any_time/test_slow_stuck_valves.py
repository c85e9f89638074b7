"""Passes with stuck valves once more, in plain Python and in small steps, under all three regulators."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from plant_models import Plant
from scripts.studies.any_time.findings import Ways
from scripts.studies.any_time.stuck_valves import STUCK, StuckLoop, StuckValves
from synth.kernels.loop.passes import Draws
from synth.simulation.closed_loop import close_loop
from synth.simulation.random_passes import random_passes
from synth.solver.any_time.polynomial_surfaces import PolynomialSurfaces
from tests.synth.any_time.tabled import tabled
from tests.synth.any_time.test_slow_passes import SAME_M_S, SlowPass
from tests.synth.any_time.test_stuck_valves import surfaces


class SlowStuckPass(SlowPass):
    """The slow pass with valves that do not open between two times of its own clock."""

    def __init__(self, plant: Plant, draws: Draws, i: int, stuck: StuckValves, start_s: float) -> None:
        super().__init__(plant, draws.cut_factor[i], draws.resistance_n_kn[i], draws.entry_m_s[i])
        self.stuck, self.start_s, self.begun = stuck, start_s, False

    def at_sample(self, time_s: float) -> None:
        """Valves get stuck, or free, at samples alone."""
        begun = self.start_s <= time_s < self.start_s + self.stuck.duration_s
        if self.begun and not begun and self.shut():
            self.flow = 0
            self.command(self.wanted_kpa)  # from rest: the whole delay
        self.begun = begun

    def shut(self) -> bool:
        """Whether the valve that is wanted does not open."""
        return (self.flow > 0 and self.stuck.filling) or (self.flow < 0 and self.stuck.release)

    def step(self, dt: float) -> None:
        """As for sound valves, unless the valve wanted is stuck: the motion goes on alone."""
        if self.begun and self.shut():
            flow, wait_s, self.flow = self.flow, self.wait_s, 0
            super().step(dt)
            self.flow, self.wait_s = flow, wait_s
        else:
            super().step(dt)


def sound_samples(plant: Plant, believed_kpa: float, wanted_kpa: float) -> int:
    """Sampling periods that sound valves need from a pressure at rest to a stage."""
    history = plant.position.pneumatics.respond(believed_kpa, wanted_kpa, plant.position.force.touch_pressure_kpa)
    return max(1, math.ceil((plant.sensor.computing_delay_s + history.duration_s) / 0.1 - 1e-9))


def slow_exit(
    cut: SlowStuckPass, lines: PolynomialSurfaces, way: Ways, first_s: float, z: np.ndarray
) -> tuple[float, int]:
    """Exit speed and number of commands of a pass."""
    plant, stage, commands, rests_at, believed_kpa = cut.plant, 0, 0, 0, 15.0
    stages, band = plant.position.stage_pressures_kpa, plant.position.pneumatics.dead_band_kpa
    cut.go_on(first_s)
    for sample in range(400):
        if cut.s >= plant.exit_m or cut.v <= 0.0:
            break
        cut.at_sample(first_s + 0.1 * sample)
        waits = abs(cut.kpa - stages[stage]) > band + 1e-9 if way is Ways.GAUGE else sample < rests_at
        if not waits or way is Ways.ANY_TIME:
            measured = max(0.0, cut.v + plant.sensor.noise_m_s * float(z[sample]))
            u, x = 2.0 * cut.s / plant.exit_m - 1.0, (cut.kpa - stages[stage]) / 100.0
            lower, upper = (
                float(np.polynomial.legendre.legval(u, a[:4]) + x * a[4]) for a in lines.coefficients[stage]
            )
            step = int(lines.has_line[stage, 1] and measured > upper) - int(
                lines.has_line[stage, 0] and measured < lower
            )
            stage, commands = stage + step, commands + abs(step)
            if step:
                rests_at = sample + sound_samples(plant, believed_kpa, stages[stage])
                believed_kpa = stages[stage] - step * band
        cut.go_on(plant.sensor.computing_delay_s)
        cut.command(stages[stage])
        cut.go_on(plant.sensor.sample_period_s - plant.sensor.computing_delay_s)
    return max(cut.v, 0.0), commands


@pytest.mark.long
@pytest.mark.parametrize("way", Ways)
@pytest.mark.parametrize("stuck", STUCK, ids=lambda stuck: stuck.name)
def test_slow_passes_are_those_of_the_kernel(plant: Plant, stuck: StuckValves, way: Ways) -> None:
    smooth = replace(
        plant,
        friction=replace(plant.friction, path_std=0.0),
        sensor=replace(plant.sensor, resolution_m_s=0.0),
    )
    loop, lines = close_loop(smooth, 3), surfaces(smooth, 0.06)
    draws = loop.draws(random_passes(31, 0, 10))
    starts_s = np.linspace(0.2, 3.0, 10)
    found = StuckLoop(loop, tabled(smooth, lines), way).run(draws, stuck, starts_s)
    same = 0
    for i in range(10):
        cut = SlowStuckPass(smooth, draws, i, stuck, starts_s[i])
        speed, commands = slow_exit(cut, lines, way, float(draws.first_sample_s[i]), draws.noise_z[i])
        if commands == found.switchings[i]:
            same += 1
            # Energies, as a cut that has almost stopped makes any error of them a large one of its speed.
            assert speed**2 == pytest.approx(found.exit_speed_m_s[i] ** 2, abs=2.0 * 3.0 * SAME_M_S)
    assert same >= 9  # a speed within a millimetre of a line may fall on either side
