"""Exact evaluation of a policy of switching lines: mean square, exit-speed density, gradient (prediction).

Nothing is sampled: the Chapman–Kolmogorov equation is followed forward for every hidden scenario, or the
expected cost backward; the two are transposes of one another and agree to rounding.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plant_models.speed_sensor import measured_speed_std
from synth.kernels.sweep.commands import command_probabilities
from synth.kernels.sweep.policy_density import forward
from synth.kernels.sweep.policy_value import backward
from synth.problem.criterion import Criterion
from synth.solver.chain.transitions import Transitions
from synth.solver.exit_density import ExitDensity
from synth.solver.switching_lines import SwitchingLines


@dataclass(frozen=True)
class Commands:
    """P(down), P(up) at every node, stage and true speed (N, K + 1, E), and their slopes by the line value."""

    down: NDArray[np.float64]
    up: NDArray[np.float64]
    down_slope: NDArray[np.float64]
    up_slope: NDArray[np.float64]


def commands(transitions: Transitions, lines: SwitchingLines, staircase: bool) -> Commands:
    """Command probabilities of `lines` under the sensor's noise.

    `staircase`: quantisation as it is (the effective threshold sits half a step off the multiples of the
    resolution); otherwise as an equivalent noise, which keeps the cost differentiable in the lines.
    """
    sensor = transitions.plant.sensor
    nodes, points = len(transitions.drive_m_s2), len(transitions.grid.speed_m_s)
    lower, upper = lines.lower_m_s[:, :nodes].T.copy(), lines.upper_m_s[:, :nodes].T.copy()
    noise = measured_speed_std(sensor.noise_m_s, sensor.resolution_m_s)
    if staircase and sensor.resolution_m_s > 0.0:
        q = sensor.resolution_m_s
        lower, upper = q * (np.ceil(lower / q) - 0.5), q * (np.floor(upper / q) + 0.5)
        noise = measured_speed_std(sensor.noise_m_s, 0.0)
    arrays = [np.empty((nodes, lines.stages, points)) for _ in range(4)]
    command_probabilities(lower, upper, transitions.grid.speed_m_s, noise, *arrays)
    return Commands(*arrays)


@dataclass(frozen=True)
class Occupancy:
    """Where a policy takes the cut: `samples` (I, N, H, L, E) expected samples in every hidden state, weighted
    by the scenarios; `band` (I, N, 2) range of energies met at a node."""

    samples: NDArray[np.float64]
    band: NDArray[np.int64]


def exit_density(transitions: Transitions, policy: Commands) -> ExitDensity:
    """Exit-speed density of the policy, all scenarios weighted."""
    return forward_pass(transitions, policy, np.empty((len(transitions.scenarios.weight), 0, 0, 0, 0)))[0]


def occupancy_of(transitions: Transitions, policy: Commands) -> tuple[ExitDensity, Occupancy]:
    """Exit-speed density and the occupancy of every hidden state."""
    t = transitions
    shape = (len(t.drive_m_s2), len(t.actuator.mode_stage), len(t.chain.levels), len(t.grid.speed_m_s))
    samples = np.zeros((len(t.scenarios.weight), *shape))
    density, band = forward_pass(t, policy, samples)
    return density, Occupancy(samples, band)


def forward_pass(
    t: Transitions, policy: Commands, samples: NDArray[np.float64]
) -> tuple[ExitDensity, NDArray[np.int64]]:
    """Forward recursion over all scenarios; `samples` (I, N, H, L, E) is filled unless its nodes are 0."""
    weights, points = t.scenarios.weight, len(t.grid.speed_m_s)
    band = np.empty((len(weights), len(t.drive_m_s2), 2), dtype=np.int64)
    exits_of, totals_of = forward_all(t, policy, slice(None), samples, band)
    exits, totals = np.zeros(points), np.zeros(4)
    for i, weight in enumerate(weights):
        samples[i] *= weight
        exits += weight * exits_of[i]
        totals += weight * totals_of[i]
    stalled = max(float(totals[0]), 0.0)  # cubic weights leave −1e-8 or so
    total = ExitDensity(t.grid.speed_m_s, exits, stalled, float(totals[1]), float(totals[2] + totals[3]))
    return total, band


def scenario_density(transitions: Transitions, policy: Commands, i: int) -> ExitDensity:
    """Exit-speed density in scenario `i` alone."""
    band = np.empty((len(transitions.drive_m_s2), 2), dtype=np.int64)
    exits, totals = forward_one(transitions, policy, i, np.empty((0, 0, 0, 0)), band)
    stalled, escaped = max(float(totals[0]), 0.0), float(totals[1])
    return ExitDensity(transitions.grid.speed_m_s, exits, stalled, escaped, float(totals[2] + totals[3]))


def forward_one(
    t: Transitions, policy: Commands, i: int, density: NDArray[np.float64], band: NDArray[np.int64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Forward recursion in scenario `i`: exit probabilities (E,) and the kernel's totals (4,)."""
    exits, totals = forward_all(t, policy, slice(i, i + 1), density[None], band[None])
    return exits[0], totals[0]


def forward_all(
    t: Transitions, policy: Commands, scenarios: slice, density: NDArray[np.float64], band: NDArray[np.int64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Forward recursion in several scenarios: exit probabilities (I, E) and the kernel's totals (I, 4)."""
    factor = t.scenarios.factor[scenarios]
    exits, totals = np.empty((len(factor), len(t.grid.speed_m_s))), np.empty((len(factor), 4))
    arguments = (
        policy.down, policy.up, t.entry, *shared_arguments(t), factor, t.scenarios.extra_m_s2[scenarios],
        t.grid.path_step_m, t.grid.energy_step_m2_s2, t.plant.sensor.sample_period_s, density, band, exits, totals,
    )  # fmt: skip
    forward(*arguments)
    return exits, totals


def expected_cost(transitions: Transitions, policy: Commands, target_speed_m_s: float, criterion: Criterion) -> float:
    """Expected cost of the policy by the backward recursion, every state valued."""
    t = transitions
    nothing, no_band = np.empty((0, 0, 0, 0)), np.empty((0, 2), dtype=np.int64)
    return float(
        sum(
            weight * backward_one(t, policy, i, target_speed_m_s, criterion, nothing, no_band)[0]
            for i, weight in enumerate(t.scenarios.weight)
        )
    )


@dataclass(frozen=True)
class ScenarioCosts:
    """Cost of a policy in every hidden scenario (I,), and its derivatives by the line values (I, K + 1, N)."""

    cost: NDArray[np.float64]
    by_lower: NDArray[np.float64]
    by_upper: NDArray[np.float64]

    def weighted(self, weight: NDArray[np.float64]) -> tuple[float, NDArray[np.float64], NDArray[np.float64]]:
        """Sum over the scenarios: (cost, by lower (K + 1, N), by upper (K + 1, N))."""
        cost, by_lower, by_upper = 0.0, np.zeros(self.by_lower.shape[1:]), np.zeros(self.by_upper.shape[1:])
        for one, share in enumerate(weight):
            cost += share * self.cost[one]
            by_lower += share * self.by_lower[one]
            by_upper += share * self.by_upper[one]
        return float(cost), by_lower, by_upper

    def grouped(self, weight: NDArray[np.float64]) -> ScenarioCosts:
        """The mean over every group of scenarios that stand side by side, by the groups' own `weight` (G, members)."""
        groups, members = weight.shape

        def mean(values: NDArray[np.float64]) -> NDArray[np.float64]:
            apart = values.reshape(groups, members, *values.shape[1:])
            over_group: NDArray[np.float64] = np.einsum("gm,gm...->g...", weight, apart)
            return over_group

        return ScenarioCosts(mean(self.cost), mean(self.by_lower), mean(self.by_upper))


def scenario_costs(
    transitions: Transitions, policy: Commands, target_speed_m_s: float, criterion: Criterion
) -> ScenarioCosts:
    """Cost and exact gradient in every scenario; their weights play no part."""
    t = transitions
    nodes, _, points = policy.down.shape
    density = np.empty((nodes, len(t.actuator.mode_stage), len(t.chain.levels), points))
    band = np.empty((nodes, 2), dtype=np.int64)
    found = []
    for i in range(len(t.scenarios.weight)):
        forward_one(t, policy, i, density, band)
        one, lower, upper = backward_one(t, policy, i, target_speed_m_s, criterion, density, band)
        found.append((one, lower.T, upper.T))
    return ScenarioCosts(*(np.array(each) for each in zip(*found, strict=True)))


def cost_and_gradient(
    transitions: Transitions, policy: Commands, target_speed_m_s: float, criterion: Criterion
) -> tuple[float, NDArray[np.float64], NDArray[np.float64]]:
    """Cost and its exact derivatives by every line value: (cost, by lower (K + 1, N), by upper (K + 1, N))."""
    costs = scenario_costs(transitions, policy, target_speed_m_s, criterion)
    return costs.weighted(transitions.scenarios.weight)


def evaluator(
    transitions: Transitions, target_speed_m_s: float, criterion: Criterion
) -> Callable[[SwitchingLines], tuple[float, NDArray[np.float64], NDArray[np.float64]]]:
    """Exact cost and gradient as a function of lines at the path nodes: what `polynomial_fit.polish` minimises."""

    def evaluate(lines: SwitchingLines) -> tuple[float, NDArray[np.float64], NDArray[np.float64]]:
        return cost_and_gradient(
            transitions, commands(transitions, lines, staircase=False), target_speed_m_s, criterion
        )

    return evaluate


def backward_one(
    t: Transitions,
    policy: Commands,
    i: int,
    target_speed_m_s: float,
    criterion: Criterion,
    density: NDArray[np.float64],
    band: NDArray[np.int64],
) -> tuple[float, NDArray[np.float64], NDArray[np.float64]]:
    """Backward recursion in scenario `i`: cost, and gradient (N, K + 1) if `density`, `band` are its forward ones."""
    nodes, stages, _ = policy.down.shape
    by_lower, by_upper = np.zeros((nodes, stages)), np.zeros((nodes, stages))
    arguments = (
        policy.down, policy.up, policy.down_slope, policy.up_slope,
        *criterion.exit_costs(t.grid.speed_m_s, target_speed_m_s),
        criterion.switching_tolerance_m2_s2, t.entry, *shared_arguments(t), t.scenarios.factor[i],
        t.scenarios.extra_m_s2[i], t.grid.path_step_m, t.grid.energy_step_m2_s2, t.plant.sensor.sample_period_s,
        density, band, by_lower, by_upper,
    )  # fmt: skip
    return backward(*arguments), by_lower, by_upper


def shared_arguments(t: Transitions) -> Any:
    """The plant's arrays, a tuple in the order in which `forward` and `backward` take them."""
    a = t.landings
    return (
        t.grid.speed_m_s, t.actuator.mode_stage, t.actuator.mode_overpressure_kpa,
        a.lower_chain, a.upper_chain, a.end_mode, a.ends, a.factors,
        t.noise.probability, t.noise.mean, t.noise.std, t.chain.levels, t.chain.transition, t.chain.stationary,
        t.drive_m_s2, t.brake_m_s2_per_kpa,
    )  # fmt: skip
