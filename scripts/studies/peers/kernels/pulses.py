"""Kernel of the PI regulator with pulse width: two neighbouring stages in turn make the overpressure it wants."""

from __future__ import annotations

import math
from typing import NamedTuple

from plant_models.frozen_arrays import Floats
from scripts.studies.peers.kernels.prediction import MeanPath, line_square
from synth.kernels.compiling import part

INTEGRAL, CLOCK, LOW, SHARE, HIGH_FIRST = range(5)
"""Places of the state: integral of the error, m/s; time in the pulse period, s (negative: none has begun); the lower of
the two stages; share of the upper one; whether that comes first."""

STATE = 5


class Pulses(NamedTuple):
    """Free numbers of the regulator.

    `held_kpa`: overpressure of even braking, on whose speed line to `aim_m_s` the PI acts and which it adds to;
    `gain_kpa_s_m`, `integral_s`: of the PI; `period_s`: of the pulses. `stage_kpa` (K + 1,): overpressures of the
    stages.
    """

    held_kpa: float
    aim_m_s: float
    gain_kpa_s_m: float
    integral_s: float
    period_s: float
    stage_kpa: Floats


@part
def begin_pulses(state: Floats) -> None:
    """The state (`STATE`,) before the first sample of a cut."""
    state[:] = 0.0
    state[CLOCK] = -1.0


@part
def output_kpa(law: Pulses, path: MeanPath, sample_s: float, cell: int, s: float, v: float, state: Floats) -> float:
    """The overpressure that the PI wants, within that of the stages; the integral stands still beyond them."""
    error = v - math.sqrt(max(line_square(path, law.aim_m_s, law.held_kpa, cell, s), 0.0))
    wanted = law.held_kpa + law.gain_kpa_s_m * (error + state[INTEGRAL])
    low, top = law.stage_kpa[0], law.stage_kpa[-1]
    if (wanted > low or error > 0.0) and (wanted < top or error < 0.0):
        state[INTEGRAL] += error * sample_s / law.integral_s
    clamped: float = min(max(wanted, low), top)
    return clamped


@part
def begin_period(law: Pulses, wanted_kpa: float, stage: int, state: Floats) -> None:
    """Two neighbouring stages and the share of the upper one; the one that is nearer to `stage` comes first."""
    low = 0
    while low < law.stage_kpa.shape[0] - 2 and law.stage_kpa[low + 1] <= wanted_kpa:
        low += 1
    state[LOW] = low
    state[SHARE] = (wanted_kpa - law.stage_kpa[low]) / (law.stage_kpa[low + 1] - law.stage_kpa[low])
    state[HIGH_FIRST] = 1.0 if stage > low else 0.0


@part
def stage_by_pulses(
    law: Pulses, path: MeanPath, sample_s: float, stage: int, cell: int, s: float, v: float, state: Floats
) -> int:
    """The stage that the pulses want until the next sample; to be asked at every sample, commanded or not."""
    wanted_kpa = output_kpa(law, path, sample_s, cell, s, v, state)
    if state[CLOCK] < 0.0 or state[CLOCK] >= law.period_s:
        begin_period(law, wanted_kpa, stage, state)
        state[CLOCK] = max(0.0, state[CLOCK] - law.period_s) if state[CLOCK] >= 0.0 else 0.0
    passed = (state[CLOCK] + 0.5 * sample_s) / law.period_s  # of a sample that lies across an edge the larger part
    state[CLOCK] += sample_s
    high = passed < state[SHARE] if state[HIGH_FIRST] != 0.0 else passed >= 1.0 - state[SHARE]
    return int(state[LOW]) + int(high)
