"""Cuts that arrive at a position."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from synth.hump.rolling.hump_position import Arrivals


def arriving(
    n: int,
    mass_t: float = 60.0,
    commanded_m_s: float = 3.0,
    entry_m_s: float = 6.0,
    unbraked_m_s: float = 6.5,
    position: int = 1,
    seed: int = 5,
    category: int = 2,
) -> Arrivals:
    """One gondola of each of n trains, cut 4 of it."""
    return Arrivals(
        rows=np.arange(n),
        retarder=np.full(n, 401),
        entry_m_s=np.full(n, entry_m_s),
        unbraked_exit_m_s=np.full(n, unbraked_m_s),
        path_m=np.full(n, 37.45),
        commanded_m_s=np.full(n, commanded_m_s),
        mass_t=np.full(n, mass_t),
        axles=np.full(n, 4),
        category=np.full(n, category),
        resistance_n_per_kn=np.full(n, 1.5),
        unbraked_resistance_n_per_kn=np.full(n, 1.5),
        train=np.arange(n),
        cut=np.full(n, 4),
        seed=seed,
        position=position,
    )


@pytest.fixture(scope="session")
def arrivals() -> Callable[..., Arrivals]:
    """`arriving`."""
    return arriving
