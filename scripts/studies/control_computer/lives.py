"""Simulated lives of computers: a Markov chain from cycle to cycle, and pairs from check to check."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from synth.computer.reliability.four_states import FourStates, State

Floats = NDArray[np.float64]
Interval = tuple[float, float]
"""Value, and half the width of its 95 % interval."""

NORMAL = 1.959963984540054


def chain_shares(chain: FourStates, cycles: int, seed: int) -> list[Interval]:
    """Share of time in each state over so many independent cycles, each from ready to ready.

    A ratio of two means: Σ hours / Σ all hours; its error from the residuals, which is right for many cycles.
    """
    hours = chain_cycles(chain, cycles, seed)
    total = hours.sum(axis=1)
    found = []
    for state in State:
        share = float(hours[:, state].sum() / total.sum())
        residual = hours[:, state] - share * total
        found.append((share, NORMAL * float(residual.std(ddof=1)) / (float(total.mean()) * float(np.sqrt(cycles)))))
    return found


def chain_cycles(chain: FourStates, cycles: int, seed: int) -> Floats:
    """Hours (cycles, 4) in each state from one entry into ready to the next; the earliest of competing clocks wins."""
    rng, hours = np.random.default_rng(seed), np.zeros((cycles, 4))
    fails, check = (rng.exponential(1.0 / rate, cycles) for rate in (chain.failure_per_h, chain.check_per_h))
    noticed, again = (rng.exponential(1.0 / rate, cycles) for rate in (chain.detection_per_h, chain.check_per_h))
    failed = fails < check
    hours[:, State.READY] = np.minimum(fails, check)
    hours[:, State.FAILED_UNNOTICED] = np.where(failed, np.minimum(noticed, again), 0.0)
    by_check = failed & (again < noticed) & (chain.failed_check_to is State.MAINTENANCE)
    maintained = ~failed | by_check
    hours[:, State.MAINTENANCE] = maintained * rng.exponential(1.0 / chain.maintenance_per_h, cycles)
    hours[:, State.REPAIR] = ~maintained * rng.exponential(1.0 / chain.repair_per_h, cycles)
    return hours


def duplex_ready(failure_per_h: float, period_h: float, check_h: float, periods: int, seed: int) -> Interval:
    """Share of a period with a computer that is ready: both together, then one alone while the other is checked."""
    lives = np.random.default_rng(seed).exponential(1.0 / failure_per_h, (2, periods))
    together = np.minimum(lives.max(axis=0), period_h - check_h)
    alone = np.clip(lives[0] - (period_h - check_h), 0.0, check_h)
    ready = (together + alone) / period_h
    return float(ready.mean()), NORMAL * float(ready.std(ddof=1)) / float(np.sqrt(periods))
