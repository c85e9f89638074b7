"""The study of convergence: levels, observed orders, and how far apart lines are."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest

from plant_models import Plant
from synth.problem.aim import Aim
from synth.problem.resolution import Resolution
from synth.solver.backward_induction import solve
from synth.solver.chain.chain import persistent_chain
from synth.studies.convergence.findings import orders
from synth.studies.convergence.study import at_level, halved, lines_apart

BASE = Resolution(path_step_m=0.5, speed_step_m_s=0.04, transient_substeps=2, friction_nodes=4, resistance_nodes=1)


def test_a_level_halves_the_step_of_its_kind_alone() -> None:
    assert at_level(BASE, "path step", 0) == replace(BASE, path_step_m=1.0)
    assert at_level(BASE, "speed step", 1) == BASE
    assert at_level(BASE, "speed step", 3) == replace(BASE, speed_step_m_s=0.01)
    assert at_level(BASE, "transient step", 2) == replace(BASE, transient_substeps=4)
    everything = replace(BASE, path_step_m=0.25, speed_step_m_s=0.02, transient_substeps=4)
    assert at_level(BASE, "all together", 2) == everything


def test_halved_nodes_hold_the_old_ones() -> None:
    found = halved(replace(BASE, friction_nodes=13, path_levels=3, resistance_nodes=2))
    assert (found.friction_nodes, found.path_levels, found.resistance_nodes) == (25, 5, 3)
    assert found.path_step_m == 0.5 * BASE.path_step_m


def test_observed_orders_of_a_known_error() -> None:
    for order in (1.0, 2.0, 3.5):
        assert orders([5.0 + 0.3 * 2.0 ** (-order * level) for level in range(4)]) == pytest.approx([order, order])
    assert orders([1.0, 1.0, 2.0]) == [None]


def test_lines_that_are_shifted_are_so_far_apart(plant_of: Callable[[float], Plant]) -> None:
    chain = persistent_chain(
        plant_of(22.0), Resolution(path_step_m=1.0, speed_step_m_s=0.1, friction_nodes=4, resistance_nodes=1)
    )
    solution = solve(chain, Aim(3.0))
    assert lines_apart(solution, solution) == 0.0
    assert lines_apart(solution, replace(solution, lines_m_s=solution.lines_m_s - 0.07)) == pytest.approx(0.07)
