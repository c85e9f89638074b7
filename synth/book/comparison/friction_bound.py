"""What the same plant reaches when the friction of every cut is known: the reference, and feasibility."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from synth.book.comparison.measured import Feasibility, Measured
from synth.problem.aim import Aim
from synth.simulation.closed_loop import LineController, close_loop
from synth.simulation.exit_statistics import exit_statistics
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses
from synth.simulation.replicates import Interval
from synth.solver.backward_induction import solve_all
from synth.solver.chain.chain import Chain, with_known_friction
from synth.solver.chain.scenarios import equally_spaced_normal

ENTRY_POINTS = 41

FRICTION_NODES = 6
"""Nodes of ξ_cut, from −4 to 4 standard deviations; the highest, where no brake power is missing, is left out."""


def friction_known_bounds(
    chain: Chain, aims: Sequence[Aim], passes: RandomPasses, limit_m_s: float
) -> tuple[tuple[Measured, Feasibility], ...]:
    """For every aim: solved and simulated for each of several known ξ_cut, with full switching lines.

    All else is equal: sensor, sampling, valves, path noise, resistance; the squared error counts, and switchings have
    no price. The position is feasible for a target if the interval of this reference reaches `limit_m_s`. It is no
    strict lower bound: its lines are the solver's, one stage a command, and not polished as the table's are.
    """
    plant = chain.plant
    free = [Aim(a.target_speed_m_s, replace(a.criterion.squared(), switching_tolerance_m2_s2=0.0)) for a in aims]
    z, weights = (nodes[:-1] for nodes in equally_spaced_normal(FRICTION_NODES))
    weights = weights / weights.sum()
    factors = plant.friction.cut_factor(z, plant.friction_cv)
    strata: list[list[ExitSample]] = [[] for _ in aims]
    squares = np.zeros((len(aims), len(chain.grid.speed_m_s)))
    loop = close_loop(plant, plant.top_stage + 1)
    for i, (factor, weight) in enumerate(zip(factors, weights, strict=True)):
        draws = loop.draws(passes.every(len(z), i), float(factor))
        known = with_known_friction(chain, float(factor))
        for t, solution in enumerate(solve_all(known, free, nodes_kept=1)):
            strata[t].append(loop.run(LineController(solution.lines), draws))
            squares[t] += weight * (solution.values[0, 0, 0] * chain.path_noise.stationary[:, None]).sum(axis=0)
    bounds = []
    for aim, samples, square in zip(aims, strata, squares, strict=True):
        told = Measured("friction known", exit_statistics(interleaved(samples, weights), aim.target_speed_m_s))
        reached = told.statistics.rms_ci95_m_s
        bounds.append((told, feasibility_of(chain, aim.target_speed_m_s, square, reached, limit_m_s)))
    return tuple(bounds)


def interleaved(samples: Sequence[ExitSample], weights: NDArray[np.float64]) -> ExitSample:
    """One sample of n: pass j of `samples`[i] becomes pass j·len(samples) + i, with the weight of its friction.

    So every replicate has passes of all frictions alike.
    """
    size, count = len(samples), sum(map(len, samples))

    def woven(arrays: Sequence[NDArray[Any]]) -> NDArray[Any]:
        whole = np.empty(count, dtype=arrays[0].dtype)
        for i, array in enumerate(arrays):
            whole[i::size] = array
        return whole

    weighted = [replace(sample, weight=sample.weight * weight) for sample, weight in zip(samples, weights, strict=True)]
    names = [field.name for field in fields(ExitSample)]
    return ExitSample(**{name: woven([getattr(sample, name) for sample in weighted]) for name in names})


def feasibility_of(
    chain: Chain, target_speed_m_s: float, square: np.ndarray, rms_ci95_m_s: Interval, limit_m_s: float
) -> Feasibility:
    """Range of entry speeds that the position can serve; `square` (E,): bound's mean square by entry energy.

    `rms_ci95_m_s`: interval of the simulated bound.
    """
    plant, speed = chain.plant, chain.grid.speed_m_s
    entry = np.linspace(
        max(target_speed_m_s, 0.5), min(plant.position.max_entry_speed_m_s, float(speed[-1])), ENTRY_POINTS
    )
    configured = (speed >= plant.entry.low_m_s) & (speed <= plant.entry.high_m_s)
    # Slower than configured is never called better than the best configured speed: the values of the grid become
    # optimistic there.
    best = square[configured].min() if configured.any() else 0.0
    rms = np.sqrt(np.interp(entry, speed, np.maximum(square, best)).clip(0.0))
    served = entry[rms <= limit_m_s]
    return Feasibility(
        entry_m_s=entry,
        bound_rms_m_s=rms,
        limit_m_s=limit_m_s,
        served_m_s=(float(served.min()), float(served.max())) if len(served) else None,
        feasible=rms_ci95_m_s[0] <= limit_m_s,
        undecided=rms_ci95_m_s[0] <= limit_m_s < rms_ci95_m_s[1],
    )
