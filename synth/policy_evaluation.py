"""Exact evaluation of a policy of switching lines: mean square, exit-speed density, gradient (prediction).

Nothing is sampled: the Chapman–Kolmogorov equation is followed forward for every hidden scenario, or the
expected cost backward; the two are transposes of one another and agree to rounding.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from synth.backward_induction import measured_speed_std
from synth.exit_density import ExitDensity
from synth.kernels.commands import command_probabilities
from synth.kernels.policy_density import forward
from synth.kernels.policy_value import backward
from synth.problem import Criterion
from synth.switching_lines import SwitchingLines
from synth.transitions import Transitions


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
    points = len(t.grid.speed_m_s)
    exits, totals = np.zeros(points), np.zeros(4)
    band = np.empty((len(t.scenarios.weight), len(t.drive_m_s2), 2), dtype=np.int64)
    for i, weight in enumerate(t.scenarios.weight):
        one, sums = np.empty(points), np.empty(4)
        arguments = (
            policy.down, policy.up, t.entry, *shared_arguments(t), t.scenarios.factor[i], t.scenarios.extra_m_s2[i],
            t.grid.path_step_m, t.grid.energy_step_m2_s2, t.plant.sensor.sample_period_s,
            samples[i], band[i], one, sums,
        )  # fmt: skip
        forward(*arguments)
        samples[i] *= weight
        exits += weight * one
        totals += weight * sums
    stalled = max(float(totals[0]), 0.0)  # cubic weights leave −1e-8 or so
    total = ExitDensity(t.grid.speed_m_s, exits, stalled, float(totals[1]), float(totals[2] + totals[3]))
    return total, band


def expected_cost(transitions: Transitions, policy: Commands, target_speed_m_s: float, criterion: Criterion) -> float:
    """Expected cost of the policy by the backward recursion, every state valued."""
    return backward_pass(transitions, policy, target_speed_m_s, criterion, None)[0]


def cost_and_gradient(
    transitions: Transitions, policy: Commands, target_speed_m_s: float, criterion: Criterion
) -> tuple[float, NDArray[np.float64], NDArray[np.float64]]:
    """Cost and its exact derivatives by every line value: (cost, by lower (K + 1, N), by upper (K + 1, N))."""
    _, occupancy = occupancy_of(transitions, policy)
    return backward_pass(transitions, policy, target_speed_m_s, criterion, occupancy)


def backward_pass(
    t: Transitions, policy: Commands, target_speed_m_s: float, criterion: Criterion, occupancy: Occupancy | None
) -> tuple[float, NDArray[np.float64], NDArray[np.float64]]:
    """Backward recursion over all scenarios; see `cost_and_gradient`."""
    nodes, stages = policy.down.shape[:2]
    by_lower, by_upper = np.zeros((nodes, stages)), np.zeros((nodes, stages))
    terminal = (t.grid.speed_m_s - target_speed_m_s) ** 2
    stalled = target_speed_m_s**2 + criterion.stall_cost_m2_s2
    nothing, no_band = np.empty((0, 0, 0, 0)), np.empty((0, 2), dtype=np.int64)
    cost = 0.0
    for i, weight in enumerate(t.scenarios.weight):
        arguments = (
            policy.down, policy.up, policy.down_slope, policy.up_slope, terminal, stalled,
            criterion.switching_tolerance_m2_s2, t.entry,
            *shared_arguments(t), t.scenarios.factor[i], t.scenarios.extra_m_s2[i], t.grid.path_step_m,
            t.grid.energy_step_m2_s2, t.plant.sensor.sample_period_s,
            nothing if occupancy is None else occupancy.samples[i],
            no_band if occupancy is None else occupancy.band[i], by_lower, by_upper,
        )  # fmt: skip
        cost += weight * backward(*arguments)
    return float(cost), by_lower.T.copy(), by_upper.T.copy()


def shared_arguments(t: Transitions) -> Any:
    """The plant's arrays, a tuple in the order in which `forward` and `backward` take them."""
    a = t.landings
    return (
        t.grid.speed_m_s, t.actuator.mode_stage, t.actuator.mode_overpressure_kpa,
        a.lower_chain, a.upper_chain, a.end_mode, a.ends, a.factors,
        t.noise.probability, t.noise.mean, t.noise.std, t.chain.levels, t.chain.transition, t.chain.stationary,
        t.drive_m_s2, t.brake_m_s2_per_kpa,
    )  # fmt: skip
