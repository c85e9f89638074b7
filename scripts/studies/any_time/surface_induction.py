"""Switching surfaces by backward induction: a pair of lines for every mode of the drive, whatever is hidden."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from scripts.studies.any_time.kernels.induction import induce
from scripts.studies.any_time.switching_surfaces import SwitchingSurfaces, surfaces_at
from synth.kernels.any_time.period import ROOM
from synth.problem.aim import Aim
from synth.solver.any_time.sampled_chain import SampledChain, motion_arguments
from synth.solver.backward_induction import TIE_M2_S2, true_speed_weights

ROUGH = 1e-3
"""Of the cost of a stall; values that bend by more within three cells of energy are not smooth."""


def solve_surfaces(chain: SampledChain, aim: Aim, rough: float = ROUGH) -> SwitchingSurfaces:
    """The common policy; ∓inf where no speed gets a command.

    Up to the highest energy at which values bend by more than `rough` of the cost of a stall, they are interpolated
    without leaving the range of what they are interpolated from.
    """
    c, p = chain, chain.periods
    lines = np.empty((2, len(c.drive_m2_s2) - 1, len(c.modes.stage)))
    readings, noise = c.measurement.readings(c.grid.speed_m_s), max(c.measurement.std, 1e-6)
    terminal, stalled = aim.criterion.exit_costs(c.grid.speed_m_s, aim.target_speed_m_s)
    arguments: tuple[Any, ...] = (
        np.pad(readings, (0, ROOM), mode="edge"), noise,
        *true_speed_weights(c.grid.speed_m_s, readings, noise), TIE_M2_S2,
        p.of_mode, p.overpressure_kpa, p.way, p.target, p.share,
        np.multiply.outer(c.scenarios.weight, c.noise.stationary), c.mixing,
        np.multiply.outer(c.scenarios.factor, 1.0 + c.noise.levels), c.scenarios.extra_m_s2, *motion_arguments(c),
        terminal, stalled, aim.criterion.switching_tolerance_m2_s2, rough * stalled, may_leave(c), lines,
    )  # fmt: skip
    induce(*arguments)
    return surfaces_at(c.modes, c.grid.path_m, c.measurement.speeds(lines))


def may_leave(c: SampledChain) -> NDArray[np.bool_]:
    """Whether a mode may be left downward and upward at each node, (2, N, M): before the entrance, no further."""
    allowed = np.stack([c.periods.of_mode[:, 0] >= 0, c.periods.of_mode[:, 2] >= 0])
    at_nodes = np.repeat(allowed[:, None], len(c.drive_m2_s2) - 1, axis=1)
    at_nodes[1, : c.approach_nodes] &= c.modes.stage < c.plant.entrance_stage
    return at_nodes
