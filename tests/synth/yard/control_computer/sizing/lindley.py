"""Waits of one queue, first come, first served, by Lindley's recursion: a third way, without events or transforms."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def lindley_waits(arrival_s: Floats, service_s: Floats) -> Floats:
    """W_1 = 0, W_{n+1} = max(0, W_n + S_n − (A_{n+1} − A_n)): a walk above its running minimum. (n,) → (n,)."""
    walk = np.concatenate(([0.0], np.cumsum(service_s[:-1] - np.diff(arrival_s))))
    waits: Floats = walk - np.minimum.accumulate(walk)
    return waits
