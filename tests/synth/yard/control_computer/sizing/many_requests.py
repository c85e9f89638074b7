"""By hand: every queue formula against many simulated requests, and how often an interval holds the true mean.

`PYTHONPATH=. python -m tests.synth.yard.control_computer.sizing.many_requests 1200000` takes some ten minutes.
"""

from __future__ import annotations

import math
import sys

import numpy as np

from synth.yard.control_computer.sizing.batch_means import sampled_mean
from synth.yard.control_computer.sizing.demand_service import Discipline, mean_waits
from synth.yard.control_computer.sizing.queue_simulation import SimulatedWait, simulated_waits
from synth.yard.control_computer.sizing.service_law import Constant, Exponential
from synth.yard.control_computer.sizing.task import Stream
from synth.yard.control_computer.sizing.waiting_tail import start_tail
from tests.synth.yard.control_computer.sizing.lindley import lindley_waits
from tests.synth.yard.control_computer.sizing.mixes import EXPONENTIAL, MIXED

LONG_S = 3.0


def compared(streams: tuple[Stream, ...], discipline: Discipline, requests: int, long_s: float) -> float:
    """Print a row a task; the largest distance of a formula from its simulation, in half widths of the interval."""
    worst = 0.0
    simulated = simulated_waits(streams, discipline, requests, 20261122, long_s)
    for told, found in zip(mean_waits(streams, discipline), simulated, strict=True):
        tail = start_tail(streams, discipline, told.task, long_s).value
        rows = ((told.start_s, found.start_s), (told.wait_s, found.wait_s), (tail, found.long_share))
        print(discipline.name, told.task, f"n = {found.start_s.count}", *shown(told.wait_s, tail, found), sep=", ")
        worst = max(worst, *(abs(value - mean.mean) / mean.half_width for value, mean in rows if mean.half_width > 0))
    return worst


def shown(wait_s: float, tail: float, found: SimulatedWait) -> tuple[str, str]:
    """The formula, and what was simulated."""
    wait, share = found.wait_s, found.long_share
    return (
        f"wait {wait_s:.5g}, simulated {wait.mean:.5g} ± {wait.half_width:.2g}",
        f"P(start > {found.long_s:g} s) {tail:.4g}, simulated {share.mean:.4g} ± {share.half_width:.2g}",
    )


def coverage(load: float, requests: int, runs: int, seed: int) -> float:
    """How often the interval holds the mean wait of M/M/1, mean service 1; the first tenth of each run is cut away."""
    rng = np.random.default_rng(seed)
    right, held = load / (1.0 - load), 0
    for _ in range(runs):
        arrival_s = np.cumsum(rng.exponential(1.0 / load, requests))
        waits = lindley_waits(arrival_s, rng.exponential(1.0, requests))
        found = sampled_mean(waits[requests // 10 :])
        held += abs(found.mean - right) <= found.half_width
    return held / runs


def main(requests: int) -> None:
    """Print everything."""
    worst = 0.0
    for title, streams in (("exponential", EXPONENTIAL), ("mixed", MIXED)):
        print(title)
        worst = max(worst, *(compared(streams, each, requests, LONG_S) for each in Discipline))
    print("[hump-computer-1970s], 120 000 op/s, 8 000 operations")
    for law in (Constant(8000 / 120_000), Exponential(8000 / 120_000)):
        worst = max(worst, compared((Stream("all", 0.825, law, 1),), Discipline.FIRST_COME, requests, 0.1))
    print(f"largest distance: {worst:.2f} half widths")
    for load in (0.3, 0.5, 0.8, 0.9):
        runs = 2000
        share = coverage(load, 50_000, runs, 20261122)
        print(f"M/M/1, load {load}: {share:.4f} ± {1.96 * math.sqrt(share * (1 - share) / runs):.4f} of {runs} runs")


if __name__ == "__main__":
    main(int(sys.argv[1]))
