"""How simulated exit speeds are set beside the predicted density, in pictures and in what is said under them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from plant_models.frozen_arrays import Floats
from synth.problem.aim import OVERSPEED_M_S
from synth.retarder.tuned_case import TunedCase
from synth.solver.exit_density import ExitDensity

NARROW_M_S: Final = 0.01
"""Width of the bins of simulated passes near the target, within `OVERSPEED_M_S` of it."""

WIDE_M_S: Final = 0.1
"""The same beyond."""

EXACT: Final = "predicted by the forward equation"


def prediction_origin(cases: Sequence[TunedCase]) -> str:
    """What the predicted densities come from, in a legend or a caption."""
    estimated = [case.table.predicted.passes is not None for case in cases]
    if all(estimated):
        return "predicted from other simulated passes"
    return f"{EXACT}; with an estimator from other simulated passes" if any(estimated) else EXACT


def predicted_density(exits: ExitDensity) -> tuple[Floats, Floats]:
    """Speeds, and the density there in 1/(m/s); the grid's first energy stands for cuts next to a stall."""
    speed, probability = exits.speed_m_s[1:], exits.probability[1:]
    return speed, probability * speed / (0.5 * exits.speed_m_s[1] ** 2)


def bin_edges_m_s(target_m_s: float, highest_m_s: float) -> Floats:
    """Edges of the bins from 0 to beyond `highest_m_s`; the target is one of them."""
    half = round(OVERSPEED_M_S / NARROW_M_S)
    narrow = NARROW_M_S * np.arange(-half, half + 1)
    wide = np.arange(OVERSPEED_M_S + WIDE_M_S, max(target_m_s, highest_m_s - target_m_s) + 1.5 * WIDE_M_S, WIDE_M_S)
    edges = target_m_s + np.concatenate((-wide[::-1], narrow, wide))
    return np.append(0.0, edges[edges > 1e-9])
