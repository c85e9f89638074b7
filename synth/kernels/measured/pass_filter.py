"""Kernel: the Kalman filter of a pass, whose innovations are its likelihood.

It is the estimator of the tables (`tuning_tables.estimator`) written for identification: in kinetic energy per mass,
where the law of motion is linear in the unknown numbers of a cut, with the rolling resistance and the friction along
the path as states of their own, in float64.

    state    e = v²/2,  ξ of the cut,  w of the cut,  η along the path
    predict  e' = e + ΔG − w·ΔR − ξ (1 + η)·ΔW,   η' = ρ η + noise,   the noises of e' and η' belong together
             where a law beyond the model is tried, ΔW and ΔR times 1 + b (v − 4 m/s), with the v that is expected
    correct  by the measured speed: v_m = √(2e) + bias + noise
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from plant_models.frozen_arrays import Floats, Ints
from synth.kernels.compiling import kernel, kernel_inline

SLOWEST_M_S = 0.4
"""A slower reading tells nothing: the law of the noise is another near standstill."""

LEAST_ENERGY = 0.5 * 0.3**2

USUAL_M_S = 4.0
"""Where a law beyond the model is that of the model."""


class Spread(NamedTuple):
    """What differs from cut to cut and from reading to reading; (m,) where it differs from pass to pass.

    `friction_cv` of ξ around 1; `resistance_n_per_kn` mean of w and `resistance_std_n_per_kn`; σ_η and ℓ of the
    friction along the path; standard deviation of a reading and what the sensor shows too much.
    """

    friction_cv: Floats
    resistance_n_per_kn: Floats
    resistance_std_n_per_kn: Floats
    path_std: float
    correlation_length_m: float
    reading_std_m_s: float
    bias_m_s: float


class Rows(NamedTuple):
    """Of n rows: `speed_m_s` measured; from each row to the next one: `step_m`, `gained_m2_s2` ΔG of the grade,
    `drag_m2_s2` ΔR for each N/kN, `braked_m2_s2` ΔW at ξ = 1."""

    speed_m_s: Floats
    step_m: Floats
    gained_m2_s2: Floats
    drag_m2_s2: Floats
    braked_m2_s2: Floats


class BySpeed(NamedTuple):
    """Laws that the model has not: relative change by each m/s above `USUAL_M_S`; the model is at 0.

    The speed is the one that the filter expects, from the readings so far. Path by time must not stand here: it knows
    of friction that no reading has told yet. A cut that brakes better than expected is slower than expected, so
    friction would seem to fall with speed where it does not.
    """

    friction: float
    resistance: float


class Cuts(NamedTuple):
    """What is known of the cuts at the end of their passes, (m,): ξ and w with their variances."""

    friction: Floats
    friction_variance: Floats
    resistance_n_per_kn: Floats
    resistance_variance: Floats


@kernel
def filter_passes(
    rows: Rows,
    spread: Spread,
    by_speed: BySpeed,
    first_row: Ints,
    first: int,
    last: int,
    innovation: Floats,
    variance: Floats,
    cuts: Cuts,
) -> None:
    """Filter the passes `first` … `last` − 1. `innovation`, `variance` (n,): reading less prediction and the variance
    of that, NaN at rows without a usable reading and at the first one of a pass, from which the filter starts."""
    x, f = np.empty(4), np.empty(4)
    p, q = np.empty((4, 4)), np.empty((4, 4))
    reading_var = spread.reading_std_m_s**2
    for number in range(first, last):
        begun = False
        x[0], x[1], x[2], x[3] = 0.0, 1.0, spread.resistance_n_per_kn[number], 0.0
        p[:] = 0.0
        p[1, 1] = spread.friction_cv[number] ** 2
        p[2, 2] = spread.resistance_std_n_per_kn[number] ** 2
        p[3, 3] = spread.path_std**2
        begin, end = first_row[number], first_row[number + 1]
        for row in range(begin, end):
            innovation[row], variance[row] = math.nan, math.nan
            v = rows.speed_m_s[row] - spread.bias_m_s
            if rows.speed_m_s[row] > SLOWEST_M_S:  # NaN is not; as read, so that the same readings count at all numbers
                if begun:
                    correct(x, p, v, reading_var, row, innovation, variance)
                else:
                    begun = True
                    x[0] = max(0.5 * (v * v - reading_var), LEAST_ENERGY)
                    p[0, 0] = v * v * reading_var
            if begun and row < end - 1:
                predict(x, p, f, q, rows, row, spread, by_speed)
        cuts.friction[number], cuts.friction_variance[number] = x[1], p[1, 1]
        cuts.resistance_n_per_kn[number], cuts.resistance_variance[number] = x[2], p[2, 2]


@kernel_inline
def correct(x, p, v, reading_var, row, innovation, variance):
    """By one reading; the mean of √(2e) is a little below the root of the mean."""
    expected = math.sqrt(2.0 * x[0])
    slope = 1.0 / expected
    expected -= 0.5 * p[0, 0] * slope**3
    total = p[0, 0] * slope * slope + reading_var
    innovation[row], variance[row] = v - expected, total
    gain = slope / total
    e0, e1, e2, e3 = p[0, 0], p[0, 1], p[0, 2], p[0, 3]
    row0 = (e0, e1, e2, e3)
    for i in range(4):
        x[i] += row0[i] * gain * innovation[row]
        for j in range(4):
            p[i, j] -= row0[i] * gain * slope * row0[j]
    x[0] = max(x[0], LEAST_ENERGY)


@kernel_inline
def predict(x, p, f, q, rows, row, spread, by_speed):
    """Over one step of path, with η as an Ornstein–Uhlenbeck process whose mean over the step does the work."""
    step = max(rows.step_m[row], 1e-9)
    middle = 0.5 * (rows.gained_m2_s2[row] - x[2] * rows.drag_m2_s2[row] - x[1] * rows.braked_m2_s2[row])
    speed = math.sqrt(2.0 * max(x[0] + middle, LEAST_ENERGY))
    work = rows.braked_m2_s2[row] * (1.0 + by_speed.friction * (speed - USUAL_M_S))
    drag = rows.drag_m2_s2[row] * (1.0 + by_speed.resistance * (speed - USUAL_M_S))
    length = spread.correlation_length_m
    ratio = step / length
    memory = math.exp(-ratio)
    # The mean of η over the step is `held` times its first value, plus noise.
    held = -math.expm1(-ratio) / ratio
    sigma2 = spread.path_std**2
    mean_var = sigma2 * mean_variance(ratio)
    end_var = -sigma2 * math.expm1(-2.0 * ratio)
    both_var = sigma2 * math.expm1(-ratio) ** 2 / ratio
    force = x[1] * work
    by_energy = by_speed.friction * x[1] * rows.braked_m2_s2[row] + by_speed.resistance * x[2] * rows.drag_m2_s2[row]
    f[0] = 1.0 - by_energy / speed
    f[1] = -(1.0 + held * x[3]) * work
    f[2] = -drag
    f[3] = -force * held
    # ξ and η are told by the same readings, so their errors go against each other: the mean of ξη is not ξ̂·η̂.
    x[0] += rows.gained_m2_s2[row] + f[2] * x[2] + f[1] * x[1] - held * work * p[1, 3]
    x[0] = max(x[0], LEAST_ENERGY)
    x[3] *= memory
    for j in range(4):
        q[0, j] = f[0] * p[0, j] + f[1] * p[1, j] + f[2] * p[2, j] + f[3] * p[3, j]
        q[1, j], q[2, j], q[3, j] = p[1, j], p[2, j], memory * p[3, j]
    for i in range(4):
        p[i, 0] = f[0] * q[i, 0] + f[1] * q[i, 1] + f[2] * q[i, 2] + f[3] * q[i, 3]
        p[i, 1], p[i, 2], p[i, 3] = q[i, 1], q[i, 2], memory * q[i, 3]
    p[0, 0] += force * force * mean_var
    p[0, 3] -= force * both_var
    p[3, 0] -= force * both_var
    p[3, 3] += end_var


@kernel_inline
def mean_variance(ratio):
    """Variance of the mean of a unit Ornstein–Uhlenbeck process over `ratio` lengths, given its first value:
    (2r − 3 + 4e^(−r) − e^(−2r))/r²; its series where the difference would lose digits."""
    if ratio < 0.05:
        return ratio * (2.0 / 3.0 - 0.5 * ratio + 7.0 / 30.0 * ratio * ratio)
    return (2.0 * ratio - 3.0 + 4.0 * math.exp(-ratio) - math.exp(-2.0 * ratio)) / (ratio * ratio)
