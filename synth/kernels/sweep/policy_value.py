"""Backward value of a fixed policy in one scenario, and the gradient of its cost by every line value.

The transpose of `policy_density`: same chain, same weights.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from plant_models.frozen_arrays import Floats, Ints
from synth.kernels.compiling import kernel, part
from synth.kernels.sweep.chain_arrays import Scenario, change_at
from synth.kernels.sweep.flow import in_every_state, mix_values, pull, shifts
from synth.kernels.sweep.landing_plan import Scratch, landing_scratch, landing_tables
from synth.kernels.sweep.next_sample import quanta_to_next_sample
from synth.kernels.sweep.pass_time import add_change_times, add_quantum_times
from synth.kernels.sweep.policy_density import NEGLIGIBLE_MASS
from synth.kernels.sweep.transient import change_values

NEGLIGIBLE_PROBABILITY = 1e-9


class Worth(NamedTuple):
    """What states are worth in one scenario, and memory to work it out.

    `ahead` (M + 1, H, L, E') at held stages on the way to a sample; `values`, `mixed` (ring, H, L, E') at samples, and
    before the noise level changes; `stalled` (1,). By command: `changed` (C, E') values after it, `at_energy` (C,)
    those at one energy with its price, `told` (C, 2) the range of energies at which they count.
    """

    ahead: Floats
    values: Floats
    mixed: Floats
    stalled: Floats
    changed: Floats
    at_energy: Floats
    told: Ints
    moved: Floats
    quanta: Floats
    shift: Floats
    scratch: Scratch


@kernel
def worth_at_exit(chain, costs, commands):
    """What energies at the exit are worth, in every mode and level, and memory for policies of so many commands."""
    terminal, stalled, last = costs.terminal, costs.stalled, chain.track.drive.shape[0]
    modes, size, row = chain.modes.stage.shape[0], chain.noise.levels.shape[0], chain.landings.ends.shape[4]
    ring, points = chain.transient_noise.mean.shape[1] + 3, chain.grid.speed.shape[0]
    ahead = np.empty((chain.entry.shape[0], modes, size, row))
    values, mixed = np.full((ring, modes, size, row), stalled), np.full((ring, modes, size, row), stalled)
    in_every_state(terminal, points, ahead)
    for rows in (values, mixed):
        in_every_state(terminal, points, rows[last % ring : last % ring + 1])
    return Worth(
        ahead, values, mixed, np.full(1, stalled), np.zeros((commands, row)), np.empty(commands),
        np.empty((commands, 2), np.int64), np.zeros(row), np.empty(row), np.empty((modes, size)),
        landing_scratch(row, size, chain.grid.speed.dtype),
    )  # fmt: skip


@kernel
def backward(policy, slopes, chain, factor, extra, costs, density, band, gradient):
    """Expected cost of the policy from the entry; with `density` of the same policy also the gradient.

    `policy` as in `forward`; `slopes` (C, R, K + 1, E): derivative by the line of the probability of a command to go
    so far or farther. `density` (R, H, L, E) and `band` (N, 2) from `forward`, or `density` of length 0: then every
    state is valued and no gradient taken. `gradient` (C, R, K + 1) is added to.
    """
    met, slope = landing_tables(chain, np.array([factor]), np.array([extra]))
    worth = worth_at_exit(chain, costs, policy.shape[0])
    follow_back(
        policy, slopes, chain, Scenario(factor, extra, met[0], slope[0]), costs.prices, worth, density, band, gradient
    )
    cost, entry, mode, stationary = 0.0, chain.entry, chain.modes.entry, chain.noise.stationary
    for r in range(entry.shape[0]):
        for q in range(stationary.shape[0]):
            found = worth.ahead[r, mode, q] if r > 0 else worth.values[0, mode, q]
            for j in range(entry.shape[1]):
                if entry[r, j] != 0.0:
                    cost += entry[r, j] * stationary[q] * found[j]
    return cost


@part
def follow_back(policy, slopes, chain, scenario, prices, worth, density, band, gradient):
    """What states are `worth` at the exit, brought back to where the pass begins."""
    ahead, values, mixed, stop, changed, at_energy, told, scratch, quanta, shift, landing = worth
    grid, landings, stage, transition = chain.grid, chain.landings, chain.modes.stage, chain.noise.transition
    nodes, reach, ring = chain.track.drive.shape[0], ahead.shape[0], values.shape[0]
    modes, size, points, stalled = stage.shape[0], transition.shape[0], grid.speed.shape[0], stop[0]
    commands, decisions, visited_only = gradient.shape[0], gradient.shape[1], density.shape[0] > 0
    for n in range(nodes - 1, -1, -1):
        decision, first, last = chain.decision_at[n], 1, points
        if visited_only:
            first, last = max(band[n, 0], 1), band[n, 1]
        here = values[n % ring]
        shifts(n, chain, scenario.factor, scenario.extra, shift)
        for r in range(reach - 2, 0, -1):
            pull(ahead[r], points, transition, shift, stop, first, last, ahead[r + 1], scratch)
        pull(values[(n + 1) % ring], points, transition, shift, stop, first, last, ahead[1], scratch)
        add_quantum_times(n, prices, grid, shift, first, last, ahead, scratch)
        for h in range(modes):
            k = stage[h]
            for q in range(size):
                acceleration = shift[h, q] * grid.energy_step / grid.path_step
                quanta_to_next_sample(grid.speed, first, last, acceleration, chain.period, grid.path_step, quanta)
                here[h, q, 0] = stalled
                if decision >= decisions:
                    for j in range(first, last):
                        here[h, q, j] = ahead[1, h, q, j]
                    continue
                for command in range(commands):
                    c, begin, end = landings.change_chain[command, h], first, first
                    if c >= 0:
                        begin, end = decided(policy, slopes, density, command, decision, k, h, q, first, last)
                    told[command, 0], told[command, 1] = begin, end
                    if begin >= end:
                        continue
                    change, out = change_at(chain, n, decision, q, c), changed[command]
                    found = change_values(
                        change, begin, end, landings, grid, scenario, values, mixed, stalled, landing, out
                    )
                    add_change_times(change, found, landings.ends, grid, scenario, prices, landing.runs, scratch, out)
                for j in range(first, last):
                    mass = density[decision, h, q, j] if visited_only else 1.0
                    if abs(mass) < NEGLIGIBLE_MASS:
                        here[h, q, j] = ahead[1, h, q, j]
                        continue
                    by_change, hold = 0.0, 1.0
                    for command in range(commands):
                        chance = policy[command, decision, k, j]
                        is_told = told[command, 0] <= j < told[command, 1]
                        at_energy[command] = prices.command[0] + changed[command, j] if is_told else np.nan
                        by_change += chance * (at_energy[command] if is_told else 0.0)
                        hold -= chance
                    step = min(int(quanta[j]), reach - 2)
                    x = min(quanta[j] - step, 1.0)
                    if step == 0:
                        value = (hold * x * ahead[1, h, q, j] + by_change) / (1.0 - hold * (1.0 - x))
                        q_hold = (1.0 - x) * value + x * ahead[1, h, q, j]
                    else:
                        q_hold = (1.0 - x) * ahead[step, h, q, j] + x * ahead[step + 1, h, q, j]
                        value = hold * q_hold + by_change
                    here[h, q, j] = value
                    for command in range(commands if visited_only else 0):
                        nearer = q_hold if command < 2 else at_energy[command - 2]
                        by_line = mass * slopes[command, decision, k, j]
                        if by_line != 0.0 and not np.isnan(at_energy[command]):
                            gradient[command, decision, k] += by_line * (at_energy[command] - nearer)
        mix_values(here, transition, first, last, stop, mixed[n % ring])


@part
def decided(policy, slopes, density, command, decision, k, h, q, first, last):
    """Range of energies within [first, last) that hold every state for which the value of a command counts."""
    while first < last and not counts(policy, slopes, density, command, decision, k, h, q, first):
        first += 1
    while first < last and not counts(policy, slopes, density, command, decision, k, h, q, last - 1):
        last -= 1
    return first, last


@part
def counts(policy, slopes, density, command, decision, k, h, q, j):
    """Whether the value of a command counts in a state: it may be given there, or the gradient asks for it.

    The gradient compares each command with the one that goes a stage less far. `density` of length 0: every state is
    visited, and there is no gradient.
    """
    may_be_given = policy[command, decision, k, j] > NEGLIGIBLE_PROBABILITY
    if density.shape[0] == 0:
        return may_be_given
    if abs(density[decision, h, q, j]) < NEGLIGIBLE_MASS:
        return False
    farther = min(command + 2, slopes.shape[0] - 2 + command % 2)
    return may_be_given or slopes[command, decision, k, j] != 0.0 or slopes[farther, decision, k, j] != 0.0
