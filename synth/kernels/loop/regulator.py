"""Kernel of the regulator in the closed loop: what it measures, what it estimates, which stage it wants.

The tables' own rule and estimator are compiled here unchanged, so that the loop is driven by what a controller runs:
the one import that is neither numpy nor numba. Numba does not notice that an imported function has changed: the cache
directory must be named by a hash that covers `tuning_tables/rule.py` and `estimator.py` too.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from synth.kernels.vector.borrowing import borrowing_inline
from tuning_tables import estimator, rule

Floats = NDArray[np.float64]


class Sensor(NamedTuple):
    """Sampling period, noise and resolution of the speed sensor."""

    period_s: float
    noise_m_s: float
    resolution_m_s: float


class Rule(NamedTuple):
    """Switching rule: a polynomial table, or lines if the table has no stage (`coefficients` of size 0).

    Table: `coefficients` float32 (K + 1, 2, r + 1), NaN where there is no line, `has_line` (K + 1, 2), `valid`
    float32 (4,), `entrance_stage` the highest stage that may be commanded at s < 0. Lines: `lower`, `upper`
    (K + 1, N + 1) over nodes `spacing_m` apart from `start_m` on. Either is asked again at the stage reached, as long
    as it answers the same, until the command has gone `farthest` stages. The speed compared with lines is measured +
    `lead_s`·slope, the slope filtered over `filter_s`. With `estimator_work` (3, B), B > 0, the speed compared is that
    of `tuning_tables.estimator`.
    """

    coefficients: NDArray[np.float32]
    has_line: NDArray[np.bool_]
    valid: NDArray[np.float32]
    entrance_stage: int
    farthest: int
    lower: Floats
    upper: Floats
    start_m: float
    spacing_m: float
    lead_s: float
    filter_s: float
    estimator_parameters: NDArray[np.float32]
    estimator_work: NDArray[np.float32]


stage_by_table = njit(cache=True, nogil=True)(rule.decide)
pressure_rises = njit(cache=True, nogil=True)(rule.rises)
estimated_speed = njit(cache=True, nogil=True)(estimator.observe)


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


@borrowing_inline
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
