"""With which speed measured passes left, by the filter of the likelihood."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from plant_models.speed_sensor import measured_speed_std
from synth.kernels.measured.pass_filter import SLOWEST_M_S
from synth.logs import unknowns as asked
from synth.logs.fitting_passes import FittingPasses
from synth.logs.likelihood import Innovations, Likelihood
from synth.logs.pass_rows import on, scales, way_of

LONGEST_GAP_S = 0.6
"""A pass whose last reading is longer before the exit has no measured exit."""


@frozen_arrays
class MeasuredExits:
    """(m,) of the passes: exit speed and its standard error, NaN if the log ends too early; 0 if the cut stood."""

    speed_m_s: Floats
    std_m_s: Floats


def measured_exits(like: Likelihood, found: Innovations, values: Mapping[str, float]) -> MeasuredExits:
    """The filtered speed at the last reading before the exit, taken on to the exit by the law of motion.

    `found`: the innovations of `like` at `values`.
    """
    passes, log = like.passes, like.passes.log
    speed, std = np.full(len(log), np.nan), np.full(len(log), np.nan)
    reading_var = measured_speed_std(values[asked.NOISE], passes.plant.sensor.resolution_m_s) ** 2
    rows, index = last_readings(passes, values.get(asked.BIAS, 0.0))
    there = np.flatnonzero(rows >= 0)
    innovation, variance = found.innovation[index[there]], found.variance[index[there]]
    bias = values.get(asked.BIAS, 0.0)
    filtered = log.speed_m_s[rows[there]] - bias - innovation * reading_var / variance
    error = np.sqrt(reading_var * np.maximum(variance - reading_var, 0.0) / variance)
    left_m, gained = to_the_exit(like, found, values, rows)
    left_m, gained = left_m[there], gained[there]
    at_exit = np.sqrt(np.maximum(filtered**2 + 2.0 * gained, 0.0))
    leaves = left_m <= LONGEST_GAP_S * filtered
    speed[there] = np.where(leaves, at_exit, np.nan)
    std[there] = np.where(leaves, error * filtered / np.maximum(at_exit, SLOWEST_M_S), np.nan)
    last = log.speed_m_s[log.first_row[1:] - 1]
    stood = np.isnan(speed) & (last - bias < SLOWEST_M_S)
    return MeasuredExits(np.where(stood, 0.0, speed), np.where(stood, 0.0, std))


def last_readings(passes: FittingPasses, bias: float) -> tuple[Ints, Ints]:
    """Row of the last usable reading before the exit of each pass, and its number among the innovations, (m,); −1 for
    none. The first usable reading of a pass has no innovation."""
    log = passes.log
    usable = log.speed_m_s - bias > SLOWEST_M_S  # NaN is not
    of_row = log.pass_of_row
    rank = np.cumsum(usable) - 1
    first = np.searchsorted(np.flatnonzero(usable), log.first_row[:-1])
    seen = usable & (rank > first[of_row])
    number = np.cumsum(seen) - 1
    exit_m = np.array([plant.exit_m for _, plant in passes.plants])[passes.class_of]
    wanted = np.flatnonzero(seen & (log.path_m <= exit_m[of_row]))
    rows = np.full(len(log), -1, dtype=np.int64)
    rows[of_row[wanted]] = wanted  # the last one of a pass stays
    return rows, np.where(rows >= 0, number[rows], -1)


def to_the_exit(like: Likelihood, found: Innovations, values: Mapping[str, float], rows: Ints) -> tuple[Floats, Floats]:
    """Metres from `rows` (m,) to the exit, and energy per mass that is gained on them, by what is known of the cuts."""
    passes, log = like.passes, like.passes.log
    left, gained = np.zeros(len(log)), np.zeros(len(log))
    over = np.maximum(found.pressure_kpa[rows] - values[asked.TOUCH_PRESSURE], 0.0)
    share = values[like.slope_key] / getattr(passes.plant.position.force, like.slope_field)
    cuts = [passes.cut(number) for number in range(len(log))]
    for number, (_, plant) in enumerate(passes.plants):
        mine = np.flatnonzero((passes.class_of == number) & (rows >= 0))
        if len(mine) == 0:
            continue
        at = log.path_m[rows[mine]]
        gravity, force = scales(plant, passes, cuts)
        edges, ground, brake, by_axles = way_of(plant, float(at.min()), like.rows.mean_axles)
        ends = np.stack([at, np.full(len(mine), plant.exit_m)], axis=1)
        left[mine] = plant.exit_m - at
        slope = np.diff(np.interp(ends, edges, brake), axis=1)[:, 0]
        slope += values[asked.SLOPE_BY_AXLES] * np.diff(np.interp(ends, edges, by_axles), axis=1)[:, 0]
        gained[mine] = gravity[mine] * (
            np.diff(on(edges, ground, ends), axis=1)[:, 0]
            - found.cuts.resistance_n_per_kn[mine] * plant.cut.reduced_gravity_m_s2 * 1e-3 * left[mine]
        )
        gained[mine] -= found.cuts.friction[mine] * share * force[mine] * slope * over[mine]
    return left, gained
