"""The speed over one period of a predicted limit cycle, to draw it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models import Plant
from plant_models.frozen_arrays import frozen_arrays
from synth.retarder.comparison.limit_cycle import SUBSTEPS, LimitCycle, change, stage_pair, turning_speeds


@frozen_arrays
@dataclass(frozen=True, eq=False)
class CycleWave:
    """Speeds `speed_m_s` (n,) relative to the middle of the lines at `time_s` (n,), from one raise to the next.

    Between the points the speed is linear, but for the transients, of which `SUBSTEPS` points a sampling period are
    given.
    """

    time_s: NDArray[np.float64]
    speed_m_s: NDArray[np.float64]


def cycle_wave(plant: Plant, cycle: LimitCycle) -> CycleWave:
    """The closed form of `cycle`, a limit cycle of `plant`, point by point."""
    pair = stage_pair(plant, cycle.lower_stage)
    part_s, wait_s = pair.sample_period_s / SUBSTEPS, 0.5 * pair.sample_period_s
    brake = (cycle.rise_m_s2 + cycle.fall_m_s2) / (pair.high_kpa - pair.low_kpa)
    free = cycle.rise_m_s2 + brake * pair.low_kpa
    up, down = change(pair, True, free, brake), change(pair, False, free, brake)
    slopes = cycle.rise_m_s2 * wait_s, cycle.fall_m_s2 * wait_s
    raised, lowered = turning_speeds(cycle.gap_m_s, *slopes, up, down)
    times, speeds = [np.zeros(1)], [np.array([raised])]
    for profile_kpa, after, until, rate in (
        (pair.braking_kpa, up, lowered, -cycle.fall_m_s2),
        (pair.releasing_kpa, down, raised, cycle.rise_m_s2),
    ):
        begun, start = times[-1][-1], speeds[-1][-1]
        times.append(begun + part_s * np.arange(1, profile_kpa.size + 1))
        speeds.append(start + np.cumsum((free - brake * profile_kpa) * part_s))
        times.append(np.array([begun + after.duration_s + (until - start - after.speed_m_s) / rate]))
        speeds.append(np.array([until]))
    return CycleWave(np.concatenate(times), np.concatenate(speeds) - 0.5 * cycle.gap_m_s)
