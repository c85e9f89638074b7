"""The formulation as published (zhukovitsky-2002), on a chain of the solver."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from synth.kernels.sweep.chain_arrays import PathNoise
from synth.solver.chain.chain import Chain, noise_on_landings
from synth.solver.chain.scenarios import Scenarios


def as_published(chain: Chain, levels: int = 5) -> Chain:
    """The same plant, grid and landings, with friction noise that is independent in every quantum.

    The whole spread of friction, persistent or not, is drawn anew in every quantum and not scaled to its length.
    Sampling, delays and measurement noise are those of the plant, so that only the friction is told apart, and that a
    command goes one stage far. `levels`: Gauss–Hermite nodes of the noise in a quantum.
    """
    std = math.hypot(chain.plant.friction_cv, chain.plant.friction.path_std)
    nodes, weights = np.polynomial.hermite_e.hermegauss(levels)
    weights = weights / weights.sum()
    noise = PathNoise(np.maximum(std * nodes, -1.0), np.tile(weights, (levels, 1)), weights)
    return replace(
        chain,
        decisions=replace(chain.decisions, farthest=1),
        path_noise=noise,
        transient_noise=noise_on_landings(noise, chain.landings, chain.grid),
        scenarios=Scenarios(np.ones(1), np.zeros(1), np.ones(1)),
    )
