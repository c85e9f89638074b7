"""Kernel of the regulator in the closed loop: what it measures, what it estimates, which stage it wants.

The tables' own rule and estimator are compiled unchanged (`compiled_rules`).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from plant_models.frozen_arrays import Floats
from synth.kernels.compiled_rules import compiled_rule
from synth.kernels.compiling import borrowing_inline, part_inline
from tuning_tables.programs.decide import decide, pressure_above
from tuning_tables.programs.held import LineTable
from tuning_tables.programs.observe import observe


class Sensor(NamedTuple):
    """Sampling period, noise and resolution of the speed sensor."""

    period_s: float
    noise_m_s: float
    resolution_m_s: float


class Rule(NamedTuple):
    """Switching rule: a table, or lines if the table has no stage.

    `table`: coefficients are NaN where there is no line; with breaks the speed compared is that of its estimator.
    Lines: `lower`, `upper` (K + 1, N + 1) over nodes `spacing_m` apart from `start_m` on. They are asked again at the
    stage reached, as long as they answer the same, until the command has gone `farthest` stages. The speed compared
    with lines is measured + `lead_s`·slope, the slope filtered over `filter_s`.
    """

    table: LineTable
    lower: Floats
    upper: Floats
    start_m: float
    spacing_m: float
    farthest: int
    lead_s: float
    filter_s: float


stage_by_table = compiled_rule(decide)
estimated_speed = compiled_rule(observe)
pressure_above_stage = compiled_rule(pressure_above)


@borrowing_inline
def impulse_time_s(first_s: float, sample: int, period_s: float) -> float:
    """Impulse element of a radar: when it reads; not by summing up periods, for the clock must not drift."""
    return first_s + sample * period_s


@borrowing_inline
def measure(v: float, z: float, sensor: Sensor) -> float:
    """Speed that the sensor reports; it has no sign. A missing reading, z = NaN, stays NaN: the rule holds."""
    value: float = v + sensor.noise_m_s * z
    if sensor.resolution_m_s > 0.0:
        value = np.rint(value / sensor.resolution_m_s) * sensor.resolution_m_s
    return 0.0 if value < 0.0 else value  # not max(0, value): it would report a standstill for NaN


@part_inline
def line_decision(
    lower: Floats, upper: Floats, start_m: float, spacing_m: float, stage: int, s: float, v: float
) -> int:
    """−1, 0 or +1 stage by the switching lines; beside an infinite node there is no command.

    Without branches: which way they go could not be foretold, and that would cost more than all the arithmetic.
    Beside an infinite node a line is infinite or NaN, and no speed is beyond either.
    """
    place = (s - start_m) / spacing_m
    node = np.uint64(min(int(place), lower.shape[1] - 2))
    row, after = np.uint64(stage), node + np.uint64(1)
    part = place - node
    below = v < lower[row, node] + part * (lower[row, after] - lower[row, node])
    above = v > upper[row, node] + part * (upper[row, after] - upper[row, node])
    return int(above and not below) - int(below)


@borrowing_inline
def stage_by_lines(
    lower: Floats,
    upper: Floats,
    start_m: float,
    spacing_m: float,
    farthest: int,
    stage: int,
    top: int,
    s: float,
    v: float,
) -> int:
    """Stage that switching lines want at (s, v) while `stage` rests, within 0 … `top`."""
    step = line_decision(lower, upper, start_m, spacing_m, stage, s, v)
    wanted: int = min(max(stage + step, 0), top)
    while step != 0 and 0 < wanted < top and abs(wanted - stage) < farthest:
        if line_decision(lower, upper, start_m, spacing_m, wanted, s, v) != step:
            break
        wanted += step
    return wanted


@borrowing_inline
def admitted(stage: int, wanted: int, s: float, entrance_stage: int) -> int:
    """The stage that the position lets a regulator command at `s`: before the entrance none above `entrance_stage`."""
    return min(wanted, max(stage, entrance_stage)) if s < 0.0 else wanted
