"""The stationary shares of a Markov chain in continuous time, and a second opinion on them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from plant_models.errors import require

Floats = NDArray[np.float64]


def stationary_shares(generator_per_h: Floats) -> Floats:
    """Share of time (n,) in each state of a chain with this generator (n, n), whose diagonal is not read.

    One state after the other is taken out, without any subtraction: so a share of 1e-15 has all its digits, which the
    null space does not give. Grassmann, Taksar and Heyman, Operations Research 33 (1985). `PlantError` for a state that
    never leads back to those before it.
    """
    rates, n = np.array(generator_per_h, dtype=np.float64), len(generator_per_h)
    for k in range(n - 1, 0, -1):
        leaving = rates[k, :k].sum()
        require(leaving > 0.0, f"chain: state {k} never leads back to those before it; every state must")
        rates[:k, k] /= leaving
        rates[:k, :k] += np.outer(rates[:k, k], rates[k, :k])
    shares = np.ones(n)
    for k in range(1, n):
        shares[k] = shares[:k] @ rates[:k, k]
    return np.asarray(shares / shares.sum())


def null_space_shares(generator_per_h: Floats) -> Floats:
    """The same by the null space, pQ = 0: exact to about 1e-16 times the largest rate over the smallest.

    `PlantError` where the chain has several closed groups of states, for then its start decides.
    """
    from scipy.linalg import null_space

    basis = null_space(generator_per_h.T)
    require(
        basis.shape[1] == 1,
        f"chain: {basis.shape[1]} independent stationary vectors; every state must lead back to one group of states",
    )
    return np.asarray(basis[:, 0] / basis[:, 0].sum())
