"""Backward value of a fixed policy in one scenario, and the gradient of its cost by every line value.

The transpose of `policy_density`: same chain, same weights.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from plant_models.frozen_arrays import Floats, Ints
from synth.kernels.compiling import kernel, part, part_inline
from synth.kernels.sweep.chain_arrays import Scenario, change_at
from synth.kernels.sweep.flow import extent, in_every_state, mix_values, pull, shifts
from synth.kernels.sweep.landing_plan import Scratch, landing_scratch, landing_tables
from synth.kernels.sweep.next_sample import quanta_to_next_sample
from synth.kernels.sweep.pass_time import add_change_times, add_quantum_times
from synth.kernels.sweep.policy_density import NEGLIGIBLE_MASS
from synth.kernels.sweep.transient import change_values
from synth.kernels.vector.packs import (
    EIGHT,
    choose,
    eight,
    first_lane,
    fraction,
    holds_anywhere,
    last_lane,
    least,
    load8,
    magnitude,
    store,
    whole,
)

NEGLIGIBLE_PROBABILITY = 1e-9


class Worth(NamedTuple):
    """What states are worth in one scenario, and memory to work it out.

    `ahead` (M + 1, H, L, E') at held stages on the way to a sample; `values`, `mixed` (ring, H, L, E') at samples, and
    before the noise level changes; `stalled` (1,). By command: `changed` (C, E') values after it, `told` (C, 2) the
    range of energies at which they count. `held` (E',): of holding to the next sample; `place` (E',): 0, 1, 2 …
    """

    ahead: Floats
    values: Floats
    mixed: Floats
    stalled: Floats
    changed: Floats
    told: Ints
    held: Floats
    place: Floats
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
        ahead, values, mixed, np.full(1, stalled), np.zeros((commands, row)), np.empty((commands, 2), np.int64),
        np.empty(row), np.arange(row) * 1.0, np.zeros(row), np.empty(row), np.empty((modes, size)),
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
                begin, end = first, last if state.decision < decisions else first
                if begin < end and density.shape[0] > 0:
                    begin, end = extent(density[state.decision, h, q], first, last, NEGLIGIBLE_MASS)
                out[0] = worth.stalled[0]
                for j in range(first, last):
                    out[j] = ahead[j]
                if begin < end:
                    value_commands(policy, slopes, chain, scenario, prices, worth, density, n, state, begin, end)
                    value_decision(policy, slopes, chain, prices, worth, density, state, begin, end, out, gradient)
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
    grid, h, q = chain.grid, state.mode, state.level
    acceleration = worth.shift[h, q] * grid.energy_step / grid.path_step
    quanta_to_next_sample(grid.speed, first, last, acceleration, chain.period, grid.path_step, worth.quanta)
    at = ((state.decision * density.shape[1] + h) * density.shape[2] + q) * density.shape[3]
    for j in range(first, last, EIGHT):
        hold, given = commands_at(policy, prices, worth, state, j)
        at_once, value, held = held_or_given(hold, given, worth, h, q, j)
        if density.shape[0] > 0:
            value = choose(magnitude(load8(density, at + j)) < NEGLIGIBLE_MASS, at_once, value)
        store(worth.held, j, held)
        store(out, j, choose(load8(worth.place, j) < last, value, load8(out, j)))
    if density.shape[0] > 0:
        add_slopes(slopes, prices, worth, density, state, gradient)


@part_inline
def commands_at(policy, prices, worth, state, j):
    """(chance to hold, what the commands bring by their chances) of eight energies from `j` on."""
    price, place, row = prices.command[0], load8(worth.place, j), worth.changed.shape[1]
    _, decisions, stages, points = policy.shape
    at, hold, given = (state.decision * stages + state.stage) * points + j, eight(1.0), eight(0.0)
    for command in range(policy.shape[0]):
        begin, end = worth.told[command, 0], worth.told[command, 1]
        chance = load8(policy, command * decisions * stages * points + at)
        hold = hold - chance
        if begin < j + EIGHT and j < end:
            after = load8(worth.changed, command * row + j) + price
            given = given + choose((place >= begin) & (place < end), chance * after, 0.0)
    return hold, given


@part_inline
def held_or_given(hold, given, worth, h, q, j):
    """(worth of holding to the next node, of the decision, of holding to the next sample), for eight energies.

    Where the next sample may be at this node again, the geometric series is summed.
    """
    ahead, reach = worth.ahead, worth.ahead.shape[0]
    stride, at = ahead.shape[1] * ahead.shape[2] * ahead.shape[3], (h * ahead.shape[2] + q) * ahead.shape[3] + j
    f, at_once = load8(worth.quanta, j), load8(ahead, stride + at)
    step = least(whole(f), reach - 2)
    x = least(f - fraction(step), 1.0)
    value = (hold * x * at_once + given) / (1.0 - hold * (1.0 - x))
    held = (1.0 - x) * value + x * at_once
    for r in range(1, reach - 1):
        lanes = step == r
        if holds_anywhere(lanes):
            later = (1.0 - x) * load8(ahead, r * stride + at) + x * load8(ahead, (r + 1) * stride + at)
            held, value = choose(lanes, later, held), choose(lanes, hold * later + given, value)
    return at_once, value, held


@part
def add_slopes(slopes, prices, worth, density, state, gradient):
    """Add what a state costs more or less by every line to `gradient` (C, R, K + 1).

    Each command is compared with the one that goes a stage less far.
    """
    decision, k, h, q = state
    price, changed = prices.command[0], worth.changed
    for command in range(slopes.shape[0]):
        for j in range(worth.told[command, 0], worth.told[command, 1]):
            mass, slope = density[decision, h, q, j], slopes[command, decision, k, j]
            if slope != 0.0 and abs(mass) >= NEGLIGIBLE_MASS:
                nearer = worth.held[j] if command < 2 else price + changed[command - 2, j]
                gradient[command, decision, k] += mass * slope * (price + changed[command, j] - nearer)


@part
def decided(policy, slopes, density, command, state, first, last):
    """Range of energies within [first, last) that hold every state for which the value of a command counts."""
    found = EIGHT
    while first < last and found == EIGHT:
        found = first_lane(counts(policy, slopes, density, command, state, first))
        first += found
    first, found = min(first, last), -1
    while first < last and found < 0:
        count = min(last - first, EIGHT)
        found = last_lane(counts(policy, slopes, density, command, state, last - count), count)
        last -= count - 1 - found
    return first, last


@part_inline
def counts(policy, slopes, density, command, state, j):
    """Whether the value of a command counts at eight energies: it may be given there, or the gradient asks for it.

    The gradient compares each command with the one that goes a stage less far. `density` of length 0: every state is
    visited, and there is no gradient.
    """
    _, decisions, stages, points = policy.shape
    stride, at = decisions * stages * points, (state.decision * stages + state.stage) * points + j
    found = load8(policy, command * stride + at) > NEGLIGIBLE_PROBABILITY
    if density.shape[0] > 0:
        farther = min(command + 2, slopes.shape[0] - 2 + command % 2)
        asked = magnitude(load8(slopes, command * stride + at)) + magnitude(load8(slopes, farther * stride + at))
        mass = ((state.decision * density.shape[1] + state.mode) * density.shape[2] + state.level) * density.shape[3]
        found = (found | (asked > 0.0)) & (magnitude(load8(density, mass + j)) >= NEGLIGIBLE_MASS)
    return found
