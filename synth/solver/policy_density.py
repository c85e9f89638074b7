"""Where a policy of switching lines takes the cuts: the exact exit-speed density, and what every state is visited.

Nothing is sampled: the Chapman–Kolmogorov equation is followed forward for every hidden scenario.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from synth.kernels.sweep.commands import command_probabilities, command_slopes
from synth.kernels.sweep.policy_density import forward
from synth.kernels.vector.packs import EIGHT
from synth.solver.chain.chain import Chain
from synth.solver.chain.decisions import steps_of
from synth.solver.chain.epochs import Policy
from synth.solver.chain.kernel_arrays import chain_arrays, scenario_arrays
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
