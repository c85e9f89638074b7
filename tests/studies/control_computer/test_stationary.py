"""Stationary shares of chains that are not those of the computer, and chains that have none."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import expm

from plant_models import PlantError
from scripts.studies.control_computer.stationary import null_space_shares, stationary_shares


@pytest.mark.parametrize("seed", range(5))
def test_random_chains_end_in_their_shares(seed: int) -> None:
    """After a long time, from every state; the null space agrees."""
    rates = np.random.default_rng(seed).exponential(1.0, (6, 6))
    np.fill_diagonal(rates, 0.0)
    q = rates - np.diag(rates.sum(axis=1))
    shares = stationary_shares(q)
    np.testing.assert_allclose(expm(200.0 * q), np.tile(shares, (6, 1)), rtol=1e-10)
    np.testing.assert_allclose(null_space_shares(q), shares, rtol=1e-10)


def test_a_small_share_keeps_its_digits() -> None:
    """Birth and death with the ratio 1e-6: p_j = 1e-6ʲ, which the null space cannot tell."""
    q = np.diag([1e-6] * 4, 1) + np.diag([1.0] * 4, -1)
    weights = 1e-6 ** np.arange(5)
    np.testing.assert_allclose(stationary_shares(q), weights / weights.sum(), rtol=1e-14)


def test_chains_without_one_answer_are_refused() -> None:
    with pytest.raises(PlantError, match="2 independent"):
        null_space_shares(np.zeros((2, 2)))
    with pytest.raises(PlantError, match="state 1 never leads back"):
        stationary_shares(np.array([[-1.0, 1.0], [0.0, 0.0]]))
