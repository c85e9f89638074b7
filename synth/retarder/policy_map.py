"""Best command and the region of indifferent control on the solver's grid."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import Bools, Floats, frozen_arrays
from synth.solver.backward_induction import TIE_M2_S2, Solution


@frozen_arrays
class PolicyMap:
    """Best command and indifferent region on the solver's grid, by stage.

    `path_m` (N,), `speed_m_s` (E,); `command` (K + 1, N, E) int8: −1 down, 0 hold, +1 up; `indifferent`
    (K + 1, N, E): several commands cost the same within the tolerance.
    """

    path_m: Floats
    speed_m_s: Floats
    command: NDArray[np.int8]
    indifferent: Bools


def policy_map(solution: Solution, tolerance_m2_s2: float) -> PolicyMap:
    """The solver's map by measured speed.

    The cost of holding is taken as 0, of a change as minus its gain; the best command is the cheapest, hold in
    a tie; a state is indifferent if a second command costs at most `tolerance_m2_s2` more than the best.
    """
    grid, (down, up) = solution.chain.grid, gains(solution)
    best = np.maximum(0.0, np.maximum(down, up))
    command = np.zeros(down.shape, dtype=np.int8)
    command[(down > 0.0) & (down >= up)] = -1
    command[(up > 0.0) & (up > down)] = 1
    near = np.stack([best - gain <= tolerance_m2_s2 for gain in (np.zeros_like(best), down, up)])
    return PolicyMap(grid.path_m[:-1], grid.speed_m_s, command, near.sum(axis=0) >= 2)


def share_of_ties(solution: Solution) -> float:
    """Share of the states with a change at hand where hold wins because the best change gains nothing."""
    changes = np.maximum(*gains(solution))
    tied = np.abs(changes[np.isfinite(changes)]) <= TIE_M2_S2
    return float(tied.mean())


def gains(solution: Solution) -> tuple[Floats, Floats]:
    """What a change down and one up gain, (K + 1, N, E) each; −inf where there is none."""
    down, up = (np.moveaxis(gain, 1, 0) for gain in (solution.gain_down, solution.gain_up))
    down, up = np.where(available(down), down, -np.inf), np.where(available(up), up, -np.inf)
    up[solution.chain.plant.entrance_stage :, : solution.chain.approach_nodes] = -np.inf
    return down, up


def available(gain: Floats) -> Bools:
    """Which commands a stage has at all: the sweep leaves the gain of a missing one exactly zero everywhere."""
    exists: Bools = np.any(gain != 0.0, axis=(1, 2), keepdims=True)
    return np.broadcast_to(exists, gain.shape)
