"""Hunting between two stages by the steps of the product, with the gap of the lines told."""

from __future__ import annotations

import numpy as np

from plant_models import Plant
from synth.retarder.comparison.limit_cycle import LimitCycle, accelerations, relay_cycle, stage_pair


def limit_cycle(
    plant: Plant,
    lower_stage: int,
    gap_m_s: float,
    stretch_m: tuple[float, float] | None = None,
    line_rate_m_s2: float = 0.0,
) -> LimitCycle | None:
    """Hunting between `lower_stage` and the next, or None if both stages leave the lines to one side.

    `gap_m_s`: raising line minus lowering line; `stretch_m`: part of the path whose means count, None: all of it;
    `line_rate_m_s2`: dV/ds·v, at which the lines themselves rise.
    """
    free, brake = accelerations(plant, np.array(stretch_m or (0.0, plant.exit_m)))
    return relay_cycle(stage_pair(plant, lower_stage), gap_m_s, float(free[0]) - line_rate_m_s2, float(brake[0]))
