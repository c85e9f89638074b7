"""Backward value of a fixed policy in one scenario, and the gradient of its cost by every line value.

The transpose of `policy_density`: same chain, same weights.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from synth.kernels.compiling import kernel, part
from synth.kernels.sweep.chain_arrays import Floats, Ints, Scenario, change_at
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


class State(NamedTuple):
    """What the recursion is about: the resting `mode` of a `stage` at a `decision`, with a noise `level`."""

    decision: int
    stage: int
    mode: int
    level: int


@part
def follow_back(policy, slopes, chain, scenario, prices, worth, density, band, gradient):
    """What states are `worth` at the exit, brought back to where the pass begins."""
    stage, transition, decisions = chain.modes.stage, chain.noise.transition, gradient.shape[1]
    nodes, ring, points = chain.track.drive.shape[0], worth.values.shape[0], chain.grid.speed.shape[0]
    for n in range(nodes - 1, -1, -1):
        first, last = 1, points
        if density.shape[0] > 0:
            first, last = max(band[n, 0], 1), band[n, 1]
        here = worth.values[n % ring]
        roll_back(n, chain, scenario, prices, worth, first, last)
        for h in range(stage.shape[0]):
            for q in range(transition.shape[0]):
                out, ahead, state = here[h, q], worth.ahead[1, h, q], State(chain.decision_at[n], stage[h], h, q)
                out[0] = worth.stalled[0]
                if state.decision < decisions:
                    value_commands(policy, slopes, chain, scenario, prices, worth, density, n, state, first, last)
                    value_decision(policy, slopes, chain, prices, worth, density, state, first, last, out, gradient)
                    continue
                for j in range(first, last):
                    out[j] = ahead[j]
        mix_values(here, transition, first, last, worth.stalled, worth.mixed[n % ring])


@part
def roll_back(n, chain, scenario, prices, worth, first, last):
    """Bring what held stages are worth, `worth.ahead`, back to node `n`, for energies first ≤ j < last."""
    ahead, shift, transition, points = worth.ahead, worth.shift, chain.noise.transition, chain.grid.speed.shape[0]
    following = worth.values[(n + 1) % worth.values.shape[0]]
    shifts(n, chain, scenario.factor, scenario.extra, shift)
    for r in range(ahead.shape[0] - 2, 0, -1):
        pull(ahead[r], points, transition, shift, worth.stalled, first, last, ahead[r + 1], worth.moved)
    pull(following, points, transition, shift, worth.stalled, first, last, ahead[1], worth.moved)
    add_quantum_times(n, prices, chain.grid, shift, first, last, ahead, worth.moved)


@part
def value_commands(policy, slopes, chain, scenario, prices, worth, density, n, state, first, last):
    """What a state is worth after each command at node `n`, into `worth.changed` where `worth.told` says."""
    grid, landings, landing = chain.grid, chain.landings, worth.scratch
    for command in range(policy.shape[0]):
        c, begin, end = landings.change_chain[command, state.mode], first, first
        if c >= 0:
            begin, end = decided(policy, slopes, density, command, state, first, last)
        worth.told[command, 0], worth.told[command, 1] = begin, end
        if begin >= end:
            continue
        change, out = change_at(chain, n, state.decision, state.level, c), worth.changed[command]
        found = change_values(
            change, begin, end, landings, grid, scenario, worth.values, worth.mixed, worth.stalled[0], landing, out
        )
        add_change_times(change, found, landings.ends, grid, scenario, prices, landing.runs, worth.moved, out)


@part
def value_decision(policy, slopes, chain, prices, worth, density, state, first, last, out, gradient):
    """What a state is worth before its decision, `out` (E',), first ≤ j < last; with `density`, the gradient too."""
    grid, quanta, told, at_energy = chain.grid, worth.quanta, worth.told, worth.at_energy
    decision, k, h, q = state
    visited_only, reach, commands = density.shape[0] > 0, worth.ahead.shape[0], policy.shape[0]
    acceleration = worth.shift[h, q] * grid.energy_step / grid.path_step
    quanta_to_next_sample(grid.speed, first, last, acceleration, chain.period, grid.path_step, quanta)
    for j in range(first, last):
        mass, at_once = density[decision, h, q, j] if visited_only else 1.0, worth.ahead[1, h, q, j]
        if abs(mass) < NEGLIGIBLE_MASS:
            out[j] = at_once
            continue
        by_change, hold = 0.0, 1.0
        for command in range(commands):
            chance = policy[command, decision, k, j]
            is_told = told[command, 0] <= j < told[command, 1]
            at_energy[command] = prices.command[0] + worth.changed[command, j] if is_told else np.nan
            by_change += chance * (at_energy[command] if is_told else 0.0)
            hold -= chance
        step = min(int(quanta[j]), reach - 2)
        x = min(quanta[j] - step, 1.0)
        if step == 0:
            value = (hold * x * at_once + by_change) / (1.0 - hold * (1.0 - x))
            held = (1.0 - x) * value + x * at_once
        else:
            held = (1.0 - x) * worth.ahead[step, h, q, j] + x * worth.ahead[step + 1, h, q, j]
            value = hold * held + by_change
        out[j] = value
        for command in range(commands if visited_only else 0):
            nearer = held if command < 2 else at_energy[command - 2]
            by_line = mass * slopes[command, decision, k, j]
            if by_line != 0.0 and not np.isnan(at_energy[command]):
                gradient[command, decision, k] += by_line * (at_energy[command] - nearer)


@part
def decided(policy, slopes, density, command, state, first, last):
    """Range of energies within [first, last) that hold every state for which the value of a command counts."""
    while first < last and not counts(policy, slopes, density, command, state, first):
        first += 1
    while first < last and not counts(policy, slopes, density, command, state, last - 1):
        last -= 1
    return first, last


@part
def counts(policy, slopes, density, command, state, j):
    """Whether the value of a command counts in a state: it may be given there, or the gradient asks for it.

    The gradient compares each command with the one that goes a stage less far. `density` of length 0: every state is
    visited, and there is no gradient.
    """
    decision, k, h, q = state
    may_be_given = policy[command, decision, k, j] > NEGLIGIBLE_PROBABILITY
    if density.shape[0] == 0:
        return may_be_given
    if abs(density[decision, h, q, j]) < NEGLIGIBLE_MASS:
        return False
    farther = min(command + 2, slopes.shape[0] - 2 + command % 2)
    return may_be_given or slopes[command, decision, k, j] != 0.0 or slopes[farther, decision, k, j] != 0.0
