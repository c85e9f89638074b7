"""Posterior weights: a law at every place, without effect where nothing is hidden, and guarded."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from plant_models import Friction, Plant
from synth.problem.criterion import Criterion
from synth.problem.resolution import Resolution
from synth.simulation.closed_loop import LineController, trace
from synth.simulation.random_passes import random_passes
from synth.solver.backward_induction import hidden_prior, solve, solve_all
from synth.solver.chain.transitions import Transitions, persistent_transitions
from synth.solver.policy_evaluation import commands, occupancy_of
from synth.solver.posterior_weights import CONVERGED, posterior_weights, solve_by_posterior

CRITERION = Criterion(switching_tolerance_m2_s2=0.0)


@pytest.fixture(scope="module")
def design(plant_of: Callable[[float], Plant]) -> Transitions:
    return persistent_transitions(plant_of(36.0), Resolution(path_step_m=1.0, speed_step_m_s=0.05))


def test_the_prior_given_as_weights_changes_nothing(design: Transitions) -> None:
    plain = solve(design, 3.0, CRITERION)
    prior = hidden_prior(design)
    shape = (len(design.drive_m_s2), *prior.shape, len(design.grid.speed_m_s))
    full = np.ascontiguousarray(np.broadcast_to(prior[None, ..., None], shape))
    (given,) = solve_all(design, [(3.0, CRITERION)], full)
    assert np.array_equal(plain.lines.lower_m_s, given.lines.lower_m_s)
    assert np.array_equal(plain.lines.upper_m_s, given.lines.upper_m_s)


def test_they_are_a_law_at_every_place(design: Transitions) -> None:
    weights = posterior_weights(design, solve(design, 3.0, CRITERION).lines)
    assert weights.min() >= 0.0
    for k in np.unique(design.actuator.mode_stage):
        assert np.allclose(weights[:, :, design.actuator.mode_stage == k].sum(axis=(1, 2, 3)), 1.0)


def test_they_tell_the_friction_of_the_cuts_that_are_simulated_there(design: Transitions) -> None:
    """Mean ξ of the cuts at rest in each stage on a stretch of the path: by the weights, and by passes."""
    lines, plant = solve(design, 3.0, CRITERION).lines, design.plant
    weights, stage = posterior_weights(design, lines), design.actuator.mode_stage
    _, occupancy = occupancy_of(design, commands(design, lines, staircase=False))
    passes = random_passes(21, 0, 1500)
    factors = plant.friction.cut_factor(passes.cut_z, plant.friction_cv)
    stretch = slice(15, 21)  # nodes 1 m apart
    seen: dict[int, list[float]] = {int(k): [] for k in np.unique(stage)}
    for index, factor in enumerate(factors):
        followed = trace(plant, LineController(lines), passes, index)
        there = (followed.path_m >= 14.5) & (followed.path_m < 20.5) & ~np.isnan(followed.measured_m_s)
        for k in followed.stage[there]:
            seen[int(k)].append(float(factor))
    compared = 0
    for k, found in seen.items():
        if len(found) < 1000:
            continue
        mass = occupancy.samples[:, stretch][:, :, stage == k].sum(axis=(0, 2, 3))
        mean = np.einsum("nihlj,i->nj", weights[stretch][:, :, stage == k], design.scenarios.factor)
        # Samples of one pass are alike: some 15 in a stretch, so n/15 cuts; four standard errors and the grid's 0.01.
        error = 4.0 * np.std(found) / np.sqrt(len(found) / 15.0) + 0.01
        assert float((mass * mean).sum() / mass.sum()) == pytest.approx(np.mean(found), abs=error)
        compared += 1
    assert compared >= 2


def test_where_nothing_is_hidden_nothing_changes(plant_of: Callable[[float], Plant]) -> None:
    open_plant = replace(plant_of(36.0), friction=Friction(0.0, 0.0, 0.0, 2.0))
    open_plant = replace(open_plant, resistance=replace(open_plant.resistance, std_n_per_kn=0.0))
    sure = Resolution(path_step_m=1.0, speed_step_m_s=0.05, friction_nodes=1, resistance_nodes=1, path_levels=1)
    design = persistent_transitions(open_plant, sure)
    found = solve_by_posterior(design, 3.0, CRITERION)
    assert found.converged
    # One scenario and level: what is left is from which side a stage was entered, which the prior guesses.
    assert found.costs_m2_s2[-1] == pytest.approx(found.costs_m2_s2[0], rel=0.05)


def test_the_guard_keeps_the_best_round(design: Transitions) -> None:
    found = solve_by_posterior(design, 3.0, CRITERION)
    policy_cost = min(found.costs_m2_s2)
    assert policy_cost <= found.costs_m2_s2[0]
    assert f"round {1 + int(np.argmin(found.costs_m2_s2))}" in found.status
    if found.converged:
        assert abs(found.costs_m2_s2[-1] - found.costs_m2_s2[-2]) <= CONVERGED * found.costs_m2_s2[-2]
