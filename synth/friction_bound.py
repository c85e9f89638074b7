"""What the same plant could reach if the friction of every cut were known: the bound, and feasibility."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from synth.backward_induction import solve_all
from synth.case_result import Feasibility, Measured
from synth.closed_loop import ExitSample, LineController, simulate
from synth.exit_statistics import pooled_statistics
from synth.problem import Criterion
from synth.random_passes import RandomPasses
from synth.transitions import Transitions, equally_spaced_normal, with_known_friction

FRICTION_NODES = 9
"""Nodes of ξ_cut, four standard deviations to both sides."""


def friction_known_bounds(
    transitions: Transitions,
    targets_m_s: Sequence[float],
    criterion: Criterion,
    passes: RandomPasses,
    limit_m_s: float,
) -> tuple[tuple[Measured, Feasibility], ...]:
    """For every target: solved and simulated for each of several known ξ_cut, with full switching lines (model §3).

    All else is equal: sensor, sampling, valves, path noise, resistance. The switching price is dropped. The
    position is feasible for a target if this bound meets `limit_m_s`.
    """
    plant = transitions.plant
    free = replace(criterion, switching_tolerance_m2_s2=0.0)
    z, weights = equally_spaced_normal(FRICTION_NODES)
    factors = plant.friction.cut_factor(z, plant.friction_cv)
    samples: list[list[ExitSample]] = [[] for _ in targets_m_s]
    squares = np.zeros((len(targets_m_s), len(transitions.grid.speed_m_s)))
    share = len(passes) // FRICTION_NODES
    for i, (factor, weight) in enumerate(zip(factors, weights, strict=True)):
        some = passes.part(i * share, (i + 1) * share)
        known = with_known_friction(transitions, float(factor))
        for t, solution in enumerate(solve_all(known, [(target, free) for target in targets_m_s])):
            samples[t].append(simulate(plant, LineController(solution.lines), some, cut_factor=float(factor)))
            squares[t] += weight * (solution.values[0, 0, 0] * transitions.chain.stationary[:, None]).sum(axis=0)
    bounds = []
    for target, strata, square in zip(targets_m_s, samples, squares, strict=True):
        told = Measured("friction known", pooled_statistics(strata, list(weights), target))
        bounds.append((told, feasibility_of(transitions, target, square, told.statistics.rms_m_s, limit_m_s)))
    return tuple(bounds)


def feasibility_of(
    transitions: Transitions, target_speed_m_s: float, square: np.ndarray, rms_m_s: float, limit_m_s: float
) -> Feasibility:
    """Range of entry speeds that the position can serve; `square` (E,): bound's mean square by entry energy."""
    speed = transitions.grid.speed_m_s
    top = min(transitions.plant.position.max_entry_speed_m_s, float(speed[-1]))
    entry = np.linspace(max(target_speed_m_s, 0.5), top, 41)
    rms = np.sqrt(np.interp(entry, speed, square).clip(0.0))
    served = entry[rms <= limit_m_s]
    return Feasibility(
        entry_m_s=entry,
        bound_rms_m_s=rms,
        limit_m_s=limit_m_s,
        served_m_s=(float(served.min()), float(served.max())) if len(served) else None,
        feasible=rms_m_s <= limit_m_s,
    )
