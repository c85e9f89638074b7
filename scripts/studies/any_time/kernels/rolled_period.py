"""Kernel of the motion over one sampling period, for passes that are followed one by one."""

from __future__ import annotations

import math
from typing import Any

from plant_models.frozen_arrays import Floats
from synth.kernels.any_time.played_periods import joined_until
from synth.kernels.compiling import part_inline
from synth.kernels.loop.motion import MOVING, Cells, advance
from synth.kernels.loop.trace import note


@part_inline
def roll_period(
    cells: Cells, over: Floats, part_s: float, begins_s: float, stage: int, measured: float, cell: int, s: float,
    v: float, events: Floats, count: int,
) -> Any:  # fmt: skip
    """Roll on for a period under `over` (parts,), and note it.

    Returns (cell, s, v, overpressure and time of the last step, what of that was used, status, events).
    """
    edges_m, free, brake = cells
    i, kpa, used, status, time = 0, 0.0, 0.0, MOVING, begins_s
    while i < over.shape[0] and status == MOVING:
        begun, kpa, i = i, over[i], joined_until(over, i)
        time = begins_s + begun * part_s
        count = note(events, count, time, s, v, kpa, stage, measured)
        measured = math.nan
        cell, s, v, used, status = advance(edges_m, free, brake, kpa, (i - begun) * part_s, cell, s, v)
    return cell, s, v, kpa, time, used, status, count
