"""One pass, sample by sample, under whoever commands from outside: the simulator's own pass, not a second model."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass
from functools import partial

import numpy as np

from synth.kernels.any_time.driven_period import play_period
from synth.kernels.loop.motion import LEFT, MOVING, advance
from synth.kernels.loop.passes import LONGEST_PASS_S, Draws
from synth.kernels.loop.regulator import impulse_time_s, measure
from synth.simulation.closed_loop import ClosedLoop

AT_REST = 1.0 + 1e-12
"""Of the dead band: at its edge the pressure is reached, whatever rounding brought it there."""


@dataclass(frozen=True)
class Reading:
    """What radar, gauge and valves tell at a sample, and `speed_m_s`, the true speed, which no controller is told.

    `measured_m_s`: NaN for a lost reading; `mean_overpressure_kpa`: since the sample before; `at_rest`: whether the
    pressure of `stage`, commanded last, is reached.
    """

    path_m: float
    measured_m_s: float
    mean_overpressure_kpa: float
    pressure_kpa: float
    at_rest: bool
    stage: int
    speed_m_s: float


@dataclass(frozen=True)
class PassEnd:
    """How a pass ended; a cut that stands has speed 0."""

    exit_speed_m_s: float
    time_s: float
    stalled: bool


SampledPass = Generator[Reading, int, PassEnd]
"""It yields the reading of each sample, is sent the stage commanded there, and returns the end."""


def sampled_pass(loop: ClosedLoop, draws: Draws) -> SampledPass:
    """The only pass of `draws`, with commands at any moment; `PlantError` where the drive of `loop` takes none.

    With the stages that a regulator of `ClosedLoop.run` commands it ends as there, but for the order of sums. What the
    position admits before the entrance (`regulator.admitted`) is left to who commands.
    """
    drive, period_s = loop.sampled, loop.sensor.period_s
    first_s, noise = float(draws.first_sample_s[0]), draws.noise_z[0]
    free = loop.path.gravity_m_s2 - loop.path.drag_m_s2_per_n_kn * draws.resistance_n_kn[0]
    roll = partial(advance, loop.path.edges_m, free, draws.brake_m_s2_per_kpa[0])
    band_kpa = loop.plant.position.pneumatics.dead_band_kpa * AT_REST
    stage, pressure, wait, sample = drive.initial_stage, drive.initial_kpa, 0.0, 0
    over, part_s = np.full(drive.parts, max(0.0, pressure - drive.valves.touch_kpa)), period_s / drive.parts
    cell, s, v, time_s, status = roll(over[0], first_s, 0, loop.path.edges_m[0], draws.entry_m_s[0])
    while status == MOVING and sample < int(LONGEST_PASS_S / period_s):
        rests = abs(drive.stage_kpa[stage] - pressure) <= band_kpa
        told_m_s = measure(v, noise[sample % noise.size], loop.sensor)
        before, stage = stage, (yield Reading(s, told_m_s, over.mean(), pressure, bool(rests), stage, v))
        pressures_kpa = drive.stage_kpa[before], drive.stage_kpa[stage]
        pressure, wait = play_period(
            pressure, wait, *pressures_kpa, drive.computing_delay_s, period_s, drive.valves, over
        )
        begun_s = impulse_time_s(first_s, sample, period_s)
        for part in range(drive.parts):
            cell, s, v, used_s, status = roll(over[part], part_s, cell, s, v)
            time_s = begun_s + part * part_s + used_s
            if status != MOVING:
                break
        sample += 1
    has_left = status == LEFT
    return PassEnd(float(v) if has_left else 0.0, float(time_s), not has_left)
