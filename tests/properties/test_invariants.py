"""What must hold of solutions whatever the plant: information helps, noise hurts, thrift saves, bytes repeat."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from plant_models import DopplerSensor, Friction, Plant, RollingResistance
from scripts.studies.point_sensors.told import with_known_friction
from synth.problem.aim import Aim
from synth.problem.criterion import Criterion
from synth.problem.resolution import Resolution
from synth.solver.backward_induction import Solution, solve
from synth.solver.chain.chain import Chain, persistent_chain
from synth.solver.evaluation import Evaluation
from synth.solver.policy_density import exit_density

TARGET_M_S = 2.5

CRITERION = Criterion(1.0, 1e-5)


def solved_cost(t: Chain, criterion: Criterion = CRITERION) -> float:
    """Cost of the solver's own lines, evaluated exactly."""
    lines = solve(t, Aim(TARGET_M_S, criterion)).lines
    return Evaluation(t, Aim(TARGET_M_S, criterion)).cost(lines)


def test_information_cannot_hurt(small: Callable[[], Chain]) -> None:
    """Told ξ, each scenario with its own lines costs on average less than one set of lines for all."""
    t = small()
    lines = solve(t, Aim(TARGET_M_S, CRITERION)).lines
    common, known = [], []
    for factor in t.scenarios.factor:
        told = with_known_friction(t, float(factor))
        common.append(Evaluation(told, Aim(TARGET_M_S, CRITERION)).cost(lines))
        known.append(solved_cost(told))
    weight = t.scenarios.weight
    assert weight @ common == pytest.approx(solved_cost(t), rel=1e-9)  # one resistance: the same three scenarios
    print("information", common, known, weight @ common, weight @ known)
    assert all(k <= 1.02 * c + 1e-5 for k, c in zip(known, common, strict=True))  # lines are not quite optimal
    assert weight @ known < weight @ common


@pytest.mark.parametrize("source", ["persistent", "path", "sensor"])
def test_less_noise_costs_less(plant_with: Callable[..., Plant], coarse: Resolution, source: str) -> None:
    """Halving a source of noise, twice and then to zero, lowers the cost of the solution each time."""
    costs = []
    for share in (2.0, 1.0, 0.5, 0.0):
        plant = plant_with(
            friction=Friction(
                0.12 * share if source == "persistent" else 0.05, 0.0, 0.15 * share if source == "path" else 0.05, 2.0
            ),
            sensor=DopplerSensor(0.15 * share if source == "sensor" else 0.03, 0.0, 0.1, 0.02),
            resistance=RollingResistance(1.5, 0.0),
        )
        costs.append(solved_cost(persistent_chain(plant, coarse)))
    print("noise", source, costs)
    assert all(a > b for a, b in pairwise(costs))


def test_dearer_commands_are_fewer(small: Callable[[], Chain]) -> None:
    """The switchings per pass fall with the switching tolerance, and the mean square hardly gains by switching less."""
    t = small()
    switchings, squares = [], []
    for tolerance in (0.0, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1.0):
        criterion = replace(CRITERION, switching_tolerance_m2_s2=tolerance)
        lines = solve(t, Aim(TARGET_M_S, criterion)).lines
        density = exit_density(t, lines)
        switchings.append(density.switchings)
        squares.append(density.rms_m_s(TARGET_M_S) ** 2)
    print("tolerance", switchings, squares)
    assert all(b <= a * 1.01 for a, b in pairwise(switchings))
    assert switchings[0] > 1.5 * switchings[-1]


def test_dearer_seconds_are_fewer(small: Callable[[], Chain]) -> None:
    """The mean time falls with its price, and the mean square hardly gains by it."""
    t = small()
    times, squares = [], []
    for price in (0.0, 1e-4, 1e-3, 1e-2, 1e-1):
        lines = solve(t, Aim(TARGET_M_S, replace(CRITERION, time_price_m2_s3=price))).lines
        free, second = (Aim(TARGET_M_S, replace(CRITERION, time_price_m2_s3=each)) for each in (0.0, 1.0))
        times.append(Evaluation(t, second).cost(lines) - Evaluation(t, free).cost(lines))
        squares.append(exit_density(t, lines).rms_m_s(TARGET_M_S) ** 2)
    print("price", times, squares)
    assert all(b < a for a, b in pairwise(times))
    assert squares[-1] > 1.1 * squares[0]
    assert all(b > 0.99 * squares[0] for b in squares)


def bytes_of(solution: Solution) -> tuple[bytes, ...]:
    """Everything a solution holds."""
    arrays = (solution.values, solution.lines.lower_m_s, solution.lines.upper_m_s, solution.gain_down, solution.gain_up)
    return tuple(np.ascontiguousarray(a).tobytes() for a in arrays)


def test_same_bytes_twice_and_from_two_threads(plant_with: Callable[..., Plant], coarse: Resolution) -> None:
    """Nothing depends on memory left over, on the order of threads, or on what ran before."""
    t = persistent_chain(plant_with(), coarse)
    first = bytes_of(solve(t, Aim(TARGET_M_S, CRITERION)))
    again = persistent_chain(plant_with(), coarse)
    assert again.landings.energy_m2_s2.tobytes() == t.landings.energy_m2_s2.tobytes()
    assert bytes_of(solve(again, Aim(TARGET_M_S, CRITERION))) == first
    with ThreadPoolExecutor(2) as pool:
        runs = [pool.submit(solve, t, Aim(target, CRITERION)) for target in (TARGET_M_S, 2.0, TARGET_M_S, 2.0)]
        assert bytes_of(runs[0].result()) == bytes_of(runs[2].result()) == first
        assert bytes_of(runs[1].result()) == bytes_of(runs[3].result())
