"""Waits of one queue, first come, first served, by Lindley's recursion: no events, no transforms, much faster."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from synth.computer.sizing.batch_means import sampled_mean

Floats = NDArray[np.float64]

WARM_UP = 10
"""The first of so many parts of a run is cut away."""


def lindley_waits(arrival_s: Floats, service_s: Floats) -> Floats:
    """W_1 = 0, W_{n+1} = max(0, W_n + S_n − (A_{n+1} − A_n)): a walk above its running minimum. (n,) → (n,)."""
    walk = np.concatenate(([0.0], np.cumsum(service_s[:-1] - np.diff(arrival_s))))
    waits: Floats = walk - np.minimum.accumulate(walk)
    return waits


@dataclass(frozen=True)
class Coverage:
    """How often the intervals of `runs` runs with `requests` each held the mean wait of M/M/1 at a load."""

    load: float
    requests: int
    runs: int
    held: float

    @property
    def half_width(self) -> float:
        """Half the width of the 95 % interval of `held`."""
        return 1.96 * math.sqrt(self.held * (1.0 - self.held) / self.runs)


def coverage(load: float, requests: int, runs: int, seed: int) -> Coverage:
    """That, with a mean service of 1 s."""
    rng = np.random.default_rng(seed)
    right, held = load / (1.0 - load), 0
    for _ in range(runs):
        arrival_s = np.cumsum(rng.exponential(1.0 / load, requests))
        found = sampled_mean(lindley_waits(arrival_s, rng.exponential(1.0, requests))[requests // WARM_UP :])
        held += abs(found.value - right) <= found.half_width
    return Coverage(load, requests, runs, held / runs)
