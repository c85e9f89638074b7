"""What the recursions must know of a chain to count the time of a pass."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from synth.solver.chain.chain import Chain

PassTimes = tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]
"""Widths of the quanta and path from each node to the exit (N,), m; time of a transient (C,), s; path from a decision
to where its command leaves (R,), m."""


def pass_times(c: Chain) -> PassTimes:
    """The same as `kernels.sweep.pass_time` takes it."""
    path = c.grid.path_m
    duration = np.asarray(c.landings.samples * c.epochs.clock.sample_period_s, dtype=np.float64)
    return np.diff(path), path[-1] - path[:-1], duration, np.array(c.decisions.lead_m)
