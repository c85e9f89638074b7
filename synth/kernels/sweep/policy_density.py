"""Forward density of a fixed policy, scenario by scenario (Chapman–Kolmogorov equation).

The chain is embedded at the samples of the regulator. At a sample the cut stands at a path node with the
stage at rest; it is told to go down, to hold (then the next sample is v·T_c further, spread over the two
nodes around it) or to go up (then the next sample is at the end of the transient).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from plant_models.frozen_arrays import Floats, Ints
from synth.kernels.compiling import kernel, part
from synth.kernels.sweep.chain_arrays import Scenario, change_at
from synth.kernels.sweep.flow import NO_MASS, add_row, clear, extent, push, shifts, widen
from synth.kernels.sweep.landing_plan import Scratch, landing_scratch, landing_tables
from synth.kernels.sweep.next_sample import quanta_to_next_sample
from synth.kernels.sweep.transient import spread_changes
from synth.kernels.vector.packs import (
    EIGHT,
    choose,
    eight,
    fraction,
    holds_anywhere,
    least,
    load8,
    magnitude,
    store,
    whole,
)

NEGLIGIBLE_MASS = 1e-11
"""A state with less mass is left out."""

BEGIN = np.int64(0)
"""A plain 0 would be a type of its own to numba, and `follow` compiled once more for it."""

MATTERS = 1e-3
"""Energies at which no state has this share of the negligible mass are not looked at."""


class Masses(NamedTuple):
    """Masses of one scenario, and memory to move them.

    `heading` (M + 1, H, L, E') is on its way to samples at this node and those ahead; `arriving`, `mixing`
    (ring, H, L, E') come from changes of stage, after and before the noise level changes. Most states are empty, and it
    is known which: `spans` (M + 1, H, L, 2) ranges of energies out of which `heading` is zero, `landed` (ring, H, 2)
    the same of the rings, `arrived` (H, L, 2) of what matters of the arrivals at this node.
    """

    heading: Floats
    spans: Ints
    arriving: Floats
    mixing: Floats
    landed: Ints
    arrived: Ints
    moved: Floats
    mass: Floats
    quanta: Floats
    chance: Floats
    shift: Floats
    scratch: Scratch


@kernel
def empty_masses(chain, commands):
    """Memory for policies of so many commands."""
    modes, size, row = chain.modes.stage.shape[0], chain.noise.levels.shape[0], chain.landings.ends.shape[4]
    reach, ring = chain.entry.shape[0], chain.transient_noise.mean.shape[1] + 3
    return Masses(
        np.zeros((reach, modes, size, row)), np.zeros((reach, modes, size, 2), np.int64),
        np.zeros((ring, modes, size, row)), np.zeros((ring, modes, size, row)), np.zeros((ring, modes, 2), np.int64),
        np.zeros((modes, size, 2), np.int64), np.zeros(row), np.zeros(row), np.ones(row), np.zeros((commands, row)),
        np.empty((modes, size)), landing_scratch(row, size, chain.grid.speed.dtype),
    )  # fmt: skip


@part
def without_mass(masses):
    """Nothing is on its way any more; the rings are left empty by every pass."""
    masses.heading[:], masses.spans[:], masses.landed[:] = 0.0, 0, 0


@part
def begin_pass(chain, masses):
    """All cuts stand where the pass begins."""
    without_mass(masses)
    entry, mode, stationary = chain.entry, chain.modes.entry, chain.noise.stationary
    for r in range(entry.shape[0]):
        for q in range(stationary.shape[0]):
            for j in range(entry.shape[1]):
                masses.heading[r, mode, q, j] = entry[r, j] * stationary[q]
            masses.spans[r, mode, q, 1] = entry.shape[1]


@kernel
def forward(policy, chain, scenarios, density, band, exits, totals):
    """Density of sampled states, and the distribution at the exit, in all `scenarios`.

    `policy` (C, R, K + 1, E) probability of each command, behind which a pack may be read; the rest as in
    `chain_arrays`.
    Outputs: `density` (I, R, H, L, E) expected number of samples at each decision and state, or (I, 0, 0, 0, 0); `band`
    (I, N, 2) range of energies that are met at a node; `exits` (I, E) exit probability by energy; `totals` (I, 4):
    stalled mass, escaped mass, changes down, changes up.
    """
    factor, extra = scenarios
    masses, nodes = empty_masses(chain, policy.shape[0]), chain.track.drive.shape[0]
    for i in range(factor.shape[0]):
        met, slope = landing_tables(chain, factor[i : i + 1], extra[i : i + 1])
        scenario = Scenario(factor[i], extra[i], met[0], slope[0])
        begin_pass(chain, masses)
        totals[i] = 0.0
        follow(BEGIN, nodes, NEGLIGIBLE_MASS, policy, chain, scenario, masses, density[i], band[i], totals[i])
        collect(masses, nodes, exits[i])


@part
def follow(start, stop, negligible, policy, chain, scenario, masses, density, band, totals):
    """One scenario from node `start`, where `masses` stand before, to node `stop`, where they stand after.

    The rings are zero behind the node that is reached. A state with less than `negligible` mass is left out. `totals`
    (4,) are added to.
    """
    heading, spans, arriving, mixing, landed, arrived, moved, mass, quanta, chance, shift, scratch = masses
    grid, landings, stage, transition = chain.grid, chain.landings, chain.modes.stage, chain.noise.transition
    reach, ring, points, period = heading.shape[0], arriving.shape[0], grid.speed.shape[0], chain.period
    modes, size, first, last = stage.shape[0], transition.shape[0], 0, points
    commands, decisions = policy.shape[0], policy.shape[1]
    for n in range(start, stop):
        decision = chain.decision_at[n]
        decides = decision < decisions
        here, mixed = arriving[n % ring], mixing[n % ring]
        find_arrivals(here, mixed, transition, landed[n % ring], MATTERS * negligible, arrived)
        first, last = occupied(heading, spans, arrived, points, MATTERS * negligible)
        band[n, 0], band[n, 1] = first, last
        shifts(n, chain, scenario.factor, scenario.extra, shift)
        lowest = max(first, 1)
        for h in range(modes):
            k = stage[h]
            for q in range(size):
                totals[0] += here[h, q, 0] + heading[0, h, q, 0]
                begin, end = masses_at_sample(
                    here[h, q], arrived[h, q], heading[0, h, q], spans[0, h, q], lowest, last, negligible, mass
                )
                acceleration = shift[h, q] * grid.energy_step / grid.path_step
                quanta_to_next_sample(grid.speed, begin, end, acceleration, period, grid.path_step, quanta)
                told = (decision * policy.shape[2] + k) * points if decides else -1
                go_on(mass, policy, told, chance, quanta, begin, end, negligible, heading, spans, h, q)
                if density.shape[0] > 0 and decides:
                    for j in range(lowest, last):
                        density[decision, h, q, j] = mass[j] if begin <= j < end else 0.0
                for command in range(commands if decides else 0):
                    c, side = landings.change_chain[command, h], command % 2
                    share = chance[command]
                    low, high = extent(share, begin, end, negligible)
                    if c < 0 or low >= high:
                        continue
                    changes = totals[2 + side]
                    for j in range(low, high):
                        changes += share[j]
                    totals[2 + side] = changes
                    totals[0] += spread_changes(
                        share, change_at(chain, n, decision, q, c), low, high, landings, grid, scenario, arriving,
                        mixing, landed, scratch,
                    )  # fmt: skip
        clear_landed(here, mixed, landed[n % ring])
        for r in range(1, reach):
            clear_spans(heading[r - 1], spans[r - 1])
            fallen, escaped = push(
                heading[r], spans[r], transition, shift, points, first, last, heading[r - 1], spans[r - 1], moved
            )
            totals[0] += fallen
            totals[1] += escaped
        clear_spans(heading[reach - 1], spans[reach - 1])


@part
def find_arrivals(here, mixed, transition, landed, matters, arrived):
    """Mass that was deposited before the noise level changed joins `here` (H, L, E') after the change.

    `landed` (H, 2): ranges of energies out of which both are zero; `arrived` (H, L, 2) becomes the ranges out of which
    no mass that `matters` has arrived.
    """
    modes, levels, row = here.shape
    for h in range(modes):
        low, high = landed[h, 0], landed[h, 1]
        for q in range(levels):
            begin, end = extent(mixed[h, q], low, high, NO_MASS)
            for m in range(levels):
                add_row(mixed[h, q], transition[q, m], begin, end, here, (h * levels + m) * row)
        for q in range(levels):
            arrived[h, q, 0], arrived[h, q, 1] = extent(here[h, q], low, high, matters)


@part
def clear_landed(here, mixed, landed):
    """Set a node's rows (H, L, E') to zero where `landed` (H, 2) says and mixing filled packs; then it says nowhere."""
    for h in range(here.shape[0]):
        for q in range(here.shape[1]):
            clear(here[h, q], landed[h, 0], landed[h, 1] + EIGHT)
            clear(mixed[h, q], landed[h, 0], landed[h, 1])
        landed[h, 0], landed[h, 1] = 0, 0


@part
def occupied(heading, spans, arrived, points, matters):
    """The range of energies at which mass that `matters` stands, has arrived or is on its way."""
    low, high = heading.shape[3], 0
    for h in range(arrived.shape[0]):
        for q in range(arrived.shape[1]):
            if arrived[h, q, 0] < arrived[h, q, 1]:
                low, high = min(low, arrived[h, q, 0]), max(high, arrived[h, q, 1])
            for r in range(heading.shape[0]):
                begin, end = extent(heading[r, h, q], spans[r, h, q, 0], min(spans[r, h, q, 1], points), matters)
                if begin < end:
                    low, high = min(low, begin), max(high, end)
    return min(low, high), high


@part
def masses_at_sample(here, arrived, heading, span, first, last, negligible, mass):
    """`mass` (E',) = `here` + `heading` where it is not `negligible`: the range returned, which zeros follow."""
    begin, end = span[0], span[1]
    if begin >= end:
        begin, end = arrived[0], arrived[1]
    elif arrived[0] < arrived[1]:
        begin, end = min(begin, arrived[0]), max(end, arrived[1])
    begin, end = max(begin, first), min(end, last)
    for j in range(begin, end, EIGHT):
        store(mass, j, load8(here, j) + load8(heading, j))
    begin, end = extent(mass, begin, end, negligible)
    store(mass, end, eight(0.0))
    return begin, end


@part
def go_on(mass, policy, told, chance, quanta, begin, end, negligible, heading, spans, h, q):
    """What holds is on its way to its next sample, in `heading` (M + 1, H, L, E') at mode `h` and level `q`.

    `mass` (E',) becomes the expected number of samples at this node: where the next sample may be at it again, the
    geometric series is summed. `chance` (C, E') becomes the masses that get the commands, whose probabilities stand in
    the first of `policy` from flat index `told` on, −1: all hold. What is `negligible` goes nowhere.
    """
    reach, row = heading.shape[0], mass.shape[0]
    size = heading.shape[2]
    commands, told_stride = chance.shape[0] if told >= 0 else 0, policy.shape[1] * policy.shape[2] * policy.shape[3]
    stride, state = heading.shape[1] * size * row, (h * size + q) * row
    for j in range(begin, end, EIGHT):
        found, f = load8(mass, j), load8(quanta, j)
        matters = magnitude(found) >= negligible
        step = least(whole(f), reach - 2)
        x = least(f - fraction(step), 1.0)
        hold, again = eight(1.0), step < 1
        for command in range(commands):
            hold = hold - load8(policy, command * told_stride + told + j)
        samples = choose(again, found / (1.0 - hold * (1.0 - x)), found)
        store(mass, j, choose(matters, samples, found))
        samples = choose(matters, samples, 0.0)
        far, near = samples * hold * x, choose(again, 0.0, samples * hold * (1.0 - x))
        for r in range(reach - 1):
            lanes = step == r
            if holds_anywhere(lanes):
                at = r * stride + state + j
                widen(spans[r, h, q], j, min(j + EIGHT, row))
                widen(spans[r + 1, h, q], j, min(j + EIGHT, row))
                store(heading, at, load8(heading, at) + choose(lanes, near, 0.0))
                store(heading, at + stride, load8(heading, at + stride) + choose(lanes, far, 0.0))
        for command in range(commands):
            share = samples * load8(policy, command * told_stride + told + j)
            store(chance, command * row + j, choose(magnitude(share) >= negligible, share, 0.0))


@part
def clear_spans(rows, spans):
    """Set `rows` (H, L, E') to zero in the ranges `spans` (H, L, 2), which become empty."""
    for h in range(rows.shape[0]):
        for q in range(rows.shape[1]):
            clear(rows[h, q], spans[h, q, 0], spans[h, q, 1])
            spans[h, q, 0], spans[h, q, 1] = 0, 0


@part
def collect(masses, nodes, exits):
    """Sum all mass at the exit, node `nodes`, over modes and levels into `exits` (E,), and leave the rings empty."""
    ring, heading = masses.arriving.shape[0], masses.heading
    arriving, mixing = masses.arriving[nodes % ring], masses.mixing[nodes % ring]
    exits[:] = 0.0
    for h in range(arriving.shape[0]):
        for q in range(arriving.shape[1]):
            for j in range(exits.shape[0]):
                exits[j] += arriving[h, q, j] + mixing[h, q, j]
                for r in range(heading.shape[0]):
                    exits[j] += heading[r, h, q, j]
    arriving[:] = 0.0
    mixing[:] = 0.0
