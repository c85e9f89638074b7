"""What values in float32 save and cost, beside those in float64."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plant_models import Plant
from synth.configuration.resolved_config import ResolvedConfig
from synth.problem.aim import Aim
from synth.solver.backward_induction import Solution, solve_all
from synth.solver.chain.chain import Chain, persistent_chain
from synth.solver.evaluation import Evaluation
from synth.studies.timing.turns import Times, in_turns
from synth.studies.tuned_table import lines_of_solution

COUNTS = (1, 8, 16)
KINDS: tuple[type[np.floating[Any]], ...] = (np.float32, np.float64)


@dataclass(frozen=True)
class TwoTypes:
    """The times of one solve for so many targets."""

    targets: int
    single: Times
    double: Times


@dataclass(frozen=True)
class Changes:
    """Largest differences over a book: values over the largest value, lines, and relative costs, evaluated exactly.

    `cost` of the solver's lines, `polished_cost` of the polynomials made of them.
    """

    values: float
    lines_m_s: float
    cost: float
    polished_cost: float


def timed_types(chain: Chain, aims: Sequence[Aim], rounds: int) -> tuple[TwoTypes, ...]:
    """Solves for the first of `aims` in both types, all in turns."""
    counts = [count for count in COUNTS if count <= len(aims)]
    calls = {
        f"{count} {kind.__name__}": partial(solve_all, chain, aims[:count], nodes_kept=1, value_type=kind)
        for count in counts
        for kind in KINDS
    }
    times = in_turns(calls, rounds)
    return tuple(TwoTypes(count, times[f"{count} float32"], times[f"{count} float64"]) for count in counts)


def largest_changes(config: ResolvedConfig, plants: Sequence[Plant]) -> Changes:
    """Over all targets of these plants."""
    found = []
    for plant in plants:
        chain = persistent_chain(plant, config.resolution)
        aims = [Aim(target, config.criterion) for target in config.targets_m_s]
        singles, doubles = (solve_all(chain, aims, value_type=kind) for kind in KINDS)
        found += [changes(chain, *pair, config.fit.degree) for pair in zip(singles, doubles, strict=True)]
    columns = zip(*(vars(each).values() for each in found), strict=True)
    return Changes(*(max(column) for column in columns))


def changes(chain: Chain, single: Solution, double: Solution, degree: int) -> Changes:
    """What differs between the solutions of one problem in both types."""
    exact = Evaluation(chain, double.aim)
    polished = [lines_of_solution(each, degree).at(chain.grid.path_m) for each in (single, double)]
    return Changes(
        values=float(np.abs(single.values - double.values).max() / double.values.max()),
        lines_m_s=max(
            apart(single.lines.lower_m_s, double.lines.lower_m_s), apart(single.lines.upper_m_s, double.lines.upper_m_s)
        ),
        cost=abs(exact.cost(single.lines) / exact.cost(double.lines) - 1.0),
        polished_cost=abs(exact.cost(polished[0]) / exact.cost(polished[1]) - 1.0),
    )


def apart(one: NDArray[np.float64], other: NDArray[np.float64]) -> float:
    """Largest distance of two lines where both are finite, 0 where that is nowhere."""
    both = np.isfinite(one) & np.isfinite(other)
    return float(np.abs(one[both] - other[both]).max()) if both.any() else 0.0
