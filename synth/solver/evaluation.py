"""What a policy of switching lines costs, exactly, and the gradient of that cost by every line value.

The cost is followed backward through every hidden scenario; the forward recursion of `policy_density` is its
transpose, and the two agree to rounding.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from synth.kernels.sweep.pass_time import Costs, Prices
from synth.kernels.sweep.policy_value import backward
from synth.problem.aim import Aim
from synth.solver.chain.chain import Chain
from synth.solver.chain.epochs import Policy
from synth.solver.chain.kernel_arrays import chain_arrays, pass_times
from synth.solver.exit_density import ExitDensity
from synth.solver.policy_density import (
    CommandChances,
    before_a_pack,
    commands,
    exit_density,
    forward_one,
    slopes_of_commands,
)

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
