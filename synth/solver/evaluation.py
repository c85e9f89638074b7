"""Where a policy of switching lines takes the cuts, and what it costs, exactly, with the gradient by every line value.

Nothing is sampled: the Chapman–Kolmogorov equation is followed forward for every hidden scenario, the cost backward.
The two recursions are each other's transpose, and agree to rounding.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from synth.kernels.sweep.commands import command_probabilities, command_slopes
from synth.kernels.sweep.pass_time import Costs, Prices
from synth.kernels.sweep.policy_density import forward
from synth.kernels.sweep.policy_value import backward
from synth.kernels.vector.packs import EIGHT
from synth.problem.problem import Aim
from synth.solver.chain.chain import Chain, chain_arrays, pass_times, scenario_arrays
from synth.solver.chain.decisions import Policy, steps_of
from synth.solver.exit_density import ExitDensity

CommandChances = Floats
"""Of each command at every decision, stage and true speed, (C, R, K + 1, E); or their slopes by the lines."""


def commands(chain: Chain, lines_m_s: Floats) -> CommandChances:
    """Probability of each command by `lines_m_s` (C, R, K + 1) under the chain's measurement."""
    return by_lines(command_probabilities, chain, lines_m_s)


def slopes_of_commands(chain: Chain, lines_m_s: Floats) -> CommandChances:
    """How fast the probability to go as far as each command or farther changes with its line."""
    slopes = by_lines(command_slopes, chain, lines_m_s)
    slopes *= chain.measurement.slopes(lines_m_s)[..., None]
    return slopes


def by_lines(kernel: Callable[..., None], chain: Chain, lines_m_s: Floats) -> CommandChances:
    """What `kernel` gives for the lines as the measurement has them."""
    lines, noise = chain.measurement.thresholds(lines_m_s)
    lines = np.array(lines)
    before = chain.decisions.node < chain.approach_nodes
    for command in range(1, len(lines), 2):  # before the entrance, no further
        lines[command, before, max(chain.plant.entrance_stage + 1 - steps_of(command), 0) :] = np.inf
    found = before_a_pack((*lines.shape, len(chain.grid.speed_m_s)))
    kernel(lines, chain.measurement.readings(chain.grid.speed_m_s), noise, found)
    found *= chain.epochs.heard
    return found


def commands_of(chain: Chain, policy: Policy) -> CommandChances:
    """Probability of each command of a policy."""
    return commands(chain, policy.at_decisions(chain.decisions))


def before_a_pack(shape: tuple[int, ...]) -> Floats:
    """An array of `shape`, all 0, behind which kernels may read a whole pack."""
    return np.zeros(math.prod(shape) + EIGHT)[: math.prod(shape)].reshape(shape)


@frozen_arrays
class Occupancy:
    """Where a policy takes the cut: `samples` (I, R, H, L, E) expected decisions in every hidden state, weighted
    by the scenarios; `band` (I, N, 2) range of energies met at a node."""

    samples: Floats
    band: Ints


def exit_density(chain: Chain, lines: Policy) -> ExitDensity:
    """Exit-speed density of the policy, all scenarios weighted."""
    nothing = np.empty((len(chain.scenarios.weight), 0, 0, 0, 0))
    return forward_pass(chain, commands_of(chain, lines), nothing)[0]


def density_and_occupancy(chain: Chain, lines: Policy) -> tuple[ExitDensity, Occupancy]:
    """Exit-speed density, and the occupancy of every hidden state, from one forward recursion."""
    c = chain
    shape = (len(c.decisions), len(c.actuator.mode_stage), len(c.path_noise.levels), len(c.grid.speed_m_s))
    samples = np.zeros((len(c.scenarios.weight), *shape))
    density, band = forward_pass(c, commands_of(c, lines), samples)
    return density, Occupancy(samples, band)


def scenario_densities(chain: Chain, lines: Policy) -> tuple[ExitDensity, ...]:
    """Exit-speed density in every scenario alone, in their order."""
    scenarios, nodes = len(chain.scenarios.weight), len(chain.drive_m_s2)
    nothing, band = np.empty((scenarios, 0, 0, 0, 0)), np.empty((scenarios, nodes, 2), dtype=np.int64)
    found = zip(*forward_all(chain, commands_of(chain, lines), slice(None), nothing, band), strict=True)
    return tuple(scenario_density(chain, exits, totals) for exits, totals in found)


def scenario_density(chain: Chain, exits: Floats, totals: Floats) -> ExitDensity:
    """The density of one scenario from what the recursion gives for it."""
    stalled, escaped = max(float(totals[0]), 0.0), float(totals[1])
    return ExitDensity(chain.grid.speed_m_s, exits, stalled, escaped, float(totals[2] + totals[3]))


def forward_pass(c: Chain, policy: CommandChances, samples: Floats) -> tuple[ExitDensity, Ints]:
    """Forward recursion over all scenarios; `samples` (I, R, H, L, E) is filled unless its length R is 0."""
    weights, points = c.scenarios.weight, len(c.grid.speed_m_s)
    band = np.empty((len(weights), len(c.drive_m_s2), 2), dtype=np.int64)
    exits_of, totals_of = forward_all(c, policy, slice(None), samples, band)
    exits, totals = np.zeros(points), np.zeros(4)
    for i, weight in enumerate(weights):
        samples[i] *= weight
        exits += weight * exits_of[i]
        totals += weight * totals_of[i]
    stalled = max(float(totals[0]), 0.0)  # where policies keep away from a stall, cubic weights leave −1e-8 or so
    total = ExitDensity(c.grid.speed_m_s, exits, stalled, float(totals[1]), float(totals[2] + totals[3]))
    return total, band


def forward_one(c: Chain, policy: CommandChances, i: int, density: Floats, band: Ints) -> tuple[Floats, Floats]:
    """Forward recursion in scenario `i`: exit probabilities (E,) and the kernel's totals (4,)."""
    exits, totals = forward_all(c, policy, slice(i, i + 1), density[None], band[None])
    return exits[0], totals[0]


def forward_all(
    c: Chain, policy: CommandChances, scenarios: slice, density: Floats, band: Ints
) -> tuple[Floats, Floats]:
    """Forward recursion in several scenarios: exit probabilities (I, E) and the kernel's totals (I, 4)."""
    hidden = scenario_arrays(c, scenarios)
    exits, totals = np.empty((len(hidden.factor), len(c.grid.speed_m_s))), np.empty((len(hidden.factor), 4))
    forward(policy, chain_arrays(c), hidden, density, band, exits, totals)
    return exits, totals


Gradient = tuple[float, Floats]
"""A cost, and its derivatives by what the policy consists of: by the lower and upper lines, (2, R, K + 1)."""


@frozen_arrays
class ScenarioCosts:
    """Cost of a policy in every hidden scenario (I,), and its derivatives as of `Gradient`, (I, ·)."""

    cost: Floats
    by_lines: Floats

    def weighted(self, weight: Floats) -> Gradient:
        """Sum over the scenarios."""
        cost, by_lines = 0.0, np.zeros(self.by_lines.shape[1:])
        for one, share in enumerate(weight):
            cost += share * self.cost[one]
            by_lines += share * self.by_lines[one]
        return float(cost), by_lines

    def grouped(self, weight: Floats) -> ScenarioCosts:
        """The mean over every group of scenarios that stand side by side, by the groups' own `weight` (G, members)."""
        groups, members = weight.shape

        def mean(values: Floats) -> Floats:
            apart = values.reshape(groups, members, *values.shape[1:])
            over_group: Floats = np.einsum("gm,gm...->g...", weight, apart)
            return over_group

        return ScenarioCosts(mean(self.cost), mean(self.by_lines))


@dataclass(frozen=True)
class Evaluation:
    """Exact figures of policies on one chain for one aim; the lines may have any nodes that the chain's path has."""

    chain: Chain
    aim: Aim

    def density(self, lines: Policy) -> ExitDensity:
        """Exit-speed density, all scenarios weighted."""
        return exit_density(self.chain, lines)

    def rms_m_s(self, lines: Policy) -> float:
        """Predicted rms error at the exit."""
        return self.density(lines).rms_m_s(self.aim.target_speed_m_s)

    def cost(self, lines: Policy) -> float:
        """Expected cost by the backward recursion, every state valued."""
        policy = commands(self.chain, lines.at_decisions(self.chain.decisions))
        nothing, no_band = np.empty((0, 0, 0, 0)), np.empty((0, 2), dtype=np.int64)
        slopes = np.empty((0, 0, 0, 0))
        weights = enumerate(self.chain.scenarios.weight)
        return float(sum(weight * self._backward(policy, slopes, i, nothing, no_band)[0] for i, weight in weights))

    def gradient(self, lines: Policy) -> Gradient:
        """Mean cost over all days of the chain, and its exact derivatives by every line value; a polish lowers it."""
        cost, by_lines = self.scenario_costs(lines).weighted(self.chain.scenarios.weight)
        usual = 1.0 - sum(share for share, _ in self.chain.other_days)
        cost, by_lines = usual * cost, usual * by_lines
        for share, day in self.chain.other_days:
            its_cost, its_slopes = Evaluation(day, self.aim).gradient(lines)
            cost, by_lines = cost + share * its_cost, by_lines + share * its_slopes
        return cost, by_lines

    def scenario_costs(self, lines: Policy) -> ScenarioCosts:
        """Cost and exact gradient in every scenario; their weights play no part."""
        c, at_decisions = self.chain, lines.at_decisions(self.chain.decisions)
        policy, slopes = commands(c, at_decisions), slopes_of_commands(c, at_decisions)
        modes, levels, points = len(c.actuator.mode_stage), len(c.path_noise.levels), policy.shape[3]
        density = before_a_pack((len(c.decisions), modes, levels, points))
        band = np.empty((len(c.drive_m_s2), 2), dtype=np.int64)
        found = []
        for i in range(len(c.scenarios.weight)):
            forward_one(c, policy, i, density, band)
            found.append(self._backward(policy, slopes, i, density, band))
        cost, by_command = (np.array(each) for each in zip(*found, strict=True))
        return ScenarioCosts(cost, lines.slopes(c.decisions, by_command))

    def _backward(
        self, policy: CommandChances, slopes: CommandChances, i: int, density: Floats, band: Ints
    ) -> Gradient:
        """Backward recursion in scenario `i`; with derivatives by command if `density`, `band` are its forward ones."""
        c, criterion = self.chain, self.aim.criterion
        by_lines = np.zeros(policy.shape[:3])
        of_change, of_second = np.full(1, criterion.switching_tolerance_m2_s2), np.full(1, criterion.time_price_m2_s3)
        terminal, stalled = criterion.exit_costs(c.grid.speed_m_s, self.aim.target_speed_m_s)
        costs = Costs(terminal, stalled, Prices(of_change, of_second, pass_times(c)))
        scenario = c.scenarios.factor[i], c.scenarios.extra_m_s2[i]
        return backward(policy, slopes, chain_arrays(c), *scenario, costs, density, band, by_lines), by_lines
