"""The exit-speed density of a table, resolved near its target: what a prediction prints and draws."""

from __future__ import annotations

import numpy as np

from synth.kernels.sweep.finer_end import HandOver, forward_to_finer_end
from synth.solver.chain.chain import Chain
from synth.solver.chain.epochs import Policy
from synth.solver.chain.finer_end import FinerEnd, finer_end, finer_length_m, times_as_fine
from synth.solver.chain.kernel_arrays import chain_arrays, scenario_arrays
from synth.solver.exit_density import ExitDensity, without_negative
from synth.solver.policy_density import commands, exit_density

NEGLIGIBLE = 3e-11
"""A state of less probability is left out; in all less than 2e-6 is lost."""


def resolved_density(chain: Chain, lines: Policy, target_speed_m_s: float) -> ExitDensity:
    """Exit-speed density of `lines`, all scenarios weighted, its last metres on energies that resolve it at the target.

    Nowhere negative; mass, mean and mean square are those of the recursion.
    """
    times = times_as_fine(chain, target_speed_m_s)
    if times == 1:
        return without_negative(exit_density(chain, lines))
    end = finer_end(chain, lines.at_decisions(chain.decisions), finer_length_m(target_speed_m_s), times)
    return without_negative(density_by_end(chain, lines, end))


def density_by_end(chain: Chain, lines: Policy, end: FinerEnd) -> ExitDensity:
    """The same with a given `end`, as the recursion leaves it; its energies are `end.times` as dense as the chain's."""
    c, last = chain, end.chain
    at_decisions = lines.at_decisions(c.decisions)
    late = at_decisions[:, len(c.decisions) - len(last.decisions) :]
    policy, late_policy = commands(c, at_decisions), commands(last, late)
    points, weight = end.times * len(c.grid.speed_m_s), c.scenarios.weight
    negligible = np.clip(NEGLIGIBLE / np.maximum(np.abs(weight), 1e-12), NEGLIGIBLE, 1e-7)
    exits, totals = np.empty((len(weight), points)), np.empty((len(weight), 4))
    forward_to_finer_end(
        HandOver(end.node, end.handed, end.times), policy, chain_arrays(c), late_policy, chain_arrays(last),
        scenario_arrays(c), negligible, exits, totals,
    )  # fmt: skip
    probability = (weight[:, None] * exits).sum(axis=0)
    stalled, escaped, lowered, raised = (float(each) for each in (weight[:, None] * totals).sum(axis=0))
    speed = np.sqrt(2.0 * c.grid.energy_step_m2_s2 / end.times * np.arange(points))
    return ExitDensity(speed, probability, max(stalled, 0.0), escaped, lowered + raised)
