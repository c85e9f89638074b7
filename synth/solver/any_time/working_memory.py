"""The arrays that the passes over one chain work in, kept from one pass to the next.

Fresh memory costs the system more time than a pass takes.
"""

from __future__ import annotations

import numpy as np

from synth.kernels.any_time.period import ROOM
from synth.solver.any_time.sampled_chain import SampledChain


class WorkingMemory:
    """Memory of one pass at a time.

    `heading` (W, L, ring, E') of ways and `here` (M, L, E') of modes: zeros between passes. `records`: what a forward
    pass keeps for the backward one; a longer array takes its place where it does not suffice.
    """

    def __init__(self, chain: SampledChain) -> None:
        levels, row = len(chain.noise.levels), len(chain.grid.speed_m_s) + ROOM
        ring = 1 + max(len(chain.first_energy), len(chain.entry))
        self.heading = np.zeros((len(chain.periods.target), levels, ring, row))
        self.here = np.zeros((len(chain.modes.stage), levels, row))
        self.records = np.empty(0)
