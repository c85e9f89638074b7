"""All solves of a book on several threads: how long they take, and whether the bytes are the same."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from synth.configuration.resolved_config import ResolvedConfig
from synth.problem.aim import Aim
from synth.solver.backward_induction import Solution, solve_all
from synth.solver.chain.chain import Chain, persistent_chain
from synth.studies.timing.turns import Times, in_turns

TIMED, COMPARED = (1, 2), (1, 2, 4)


@dataclass(frozen=True)
class BookTimes:
    """Solves of all classes for so many targets, chains made before; `one` and `two` threads."""

    classes: int
    targets: int
    friction_scenarios: int
    one: Times
    two: Times
    same_bytes: bool


def book_times(config: ResolvedConfig, aims: Sequence[Aim], friction_scenarios: int, rounds: int) -> BookTimes:
    """Time them, and compare the bytes on one, two and four threads."""
    resolution = replace(config.resolution, friction_nodes=friction_scenarios)
    chains = [persistent_chain(plant, resolution) for _, plant in config.plants()]
    times = in_turns({str(n): partial(solved_on, n, chains, aims) for n in TIMED}, rounds)
    digests = {digest(solved_on(n, chains, aims)) for n in COMPARED}
    return BookTimes(len(chains), len(aims), friction_scenarios, times["1"], times["2"], len(digests) == 1)


def solved_on(threads: int, chains: Sequence[Chain], aims: Sequence[Aim]) -> list[Solution]:
    """All solutions, class by class."""
    with ThreadPoolExecutor(max_workers=threads) as pool:
        classes = pool.map(partial(solve_all, aims=aims, nodes_kept=1), chains)
        return [solution for solutions in classes for solution in solutions]


def digest(solutions: Sequence[Solution]) -> str:
    """Of lines, gains and values at entry."""
    found = hashlib.sha256()
    for one in solutions:
        for array in (one.lines.lower_m_s, one.lines.upper_m_s, one.gain_down, one.gain_up, one.values[:, 0]):
            found.update(np.ascontiguousarray(array).tobytes())
    return found.hexdigest()
