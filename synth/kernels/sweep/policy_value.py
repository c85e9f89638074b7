"""Backward value of a fixed policy in one scenario, and the gradient of its cost by every line value.

The transpose of `policy_density`: same chain, same weights.
"""

from __future__ import annotations

import numpy as np

from synth.kernels.compiling import kernel, part
from synth.kernels.sweep.flow import in_every_state, mix_values, pull, shifts
from synth.kernels.sweep.landing_plan import landing_scratch, landing_tables
from synth.kernels.sweep.next_sample import quanta_to_next_sample
from synth.kernels.sweep.pass_time import add_change_times, add_quantum_times
from synth.kernels.sweep.policy_density import NEGLIGIBLE_MASS
from synth.kernels.sweep.transient import change_values

NEGLIGIBLE_PROBABILITY = 1e-9


@kernel
def backward(
    policy, slopes, decision_at, terminal, stalled, prices, entry, entry_mode, speed, stage, pressure,
    change_chain, chain_mode, ends, factors, probability, mean, std,
    levels, transition, stationary, drive, brake, factor, extra, path_step, energy_step, period,
    density, band, gradient,
):  # fmt: skip
    """Expected cost of the policy from the entry; with `density` of the same policy also the gradient.

    `terminal` (E,) cost by exit energy, `stalled` cost of a stall, `prices` as in `pass_time`;
    `policy` as in `forward`; `slopes` (C, R, K + 1, E): derivative by the line of the probability of a command to go
    so far or farther. `density` (R, H, L, E) and `band` (N, 2) from `forward`, or `density` of length 0: then every
    state is valued and no gradient taken. `gradient` (C, R, K + 1) is added to.
    """
    modes, size, points, row = pressure.shape[0], levels.shape[0], speed.shape[0], ends.shape[4]
    reach, ring, last = entry.shape[0], probability.shape[1] + 3, drive.shape[0]
    ahead = np.empty((reach, modes, size, row))
    values = np.full((ring, modes, size, row), stalled)
    mixed = np.full((ring, modes, size, row), stalled)
    in_every_state(terminal, points, ahead)
    for rows in (values, mixed):
        in_every_state(terminal, points, rows[last % ring : last % ring + 1])
    met, slope = landing_tables(
        np.array([factor]), np.array([extra]), factors, probability, mean, std, levels, pressure, drive, brake,
        path_step,
    )  # fmt: skip
    follow_back(
        ahead, values, mixed, np.zeros(row), np.full(1, stalled), np.empty(row),
        (
            np.zeros((change_chain.shape[0], row)), np.empty(change_chain.shape[0]),
            np.empty((change_chain.shape[0], 2), np.int64),
        ),
        np.empty((modes, size)), landing_scratch(row, size, speed.dtype),
        policy, slopes, decision_at, stalled, prices, speed, stage, pressure,
        change_chain, chain_mode, ends, factors, met[0], slope[0],
        levels, transition, drive, brake, factor, extra, path_step, energy_step, period,
        density, band, gradient,
    )  # fmt: skip
    cost = 0.0
    for r in range(reach):
        for q in range(size):
            for j in range(points):
                if entry[r, j] != 0.0:
                    cost += (
                        entry[r, j]
                        * stationary[q]
                        * (ahead[r, entry_mode, q, j] if r > 0 else values[0, entry_mode, q, j])
                    )
    return cost


@part
def follow_back(
    ahead, values, mixed, scratch, stop, quanta, commanded, shift, landing,
    policy, slopes, decision_at, stalled, prices, speed, stage, pressure,
    change_chain, chain_mode, ends, factors, met, slope,
    levels, transition, drive, brake, factor, extra, path_step, energy_step, period,
    density, band, gradient,
):  # fmt: skip
    """`backward` with its memory: values ahead at held stages, at samples, and before mixing (rings).

    `commanded`, by command: (C, E') values after it, (C,) those at one energy with its price, (C, 2) the range of
    energies at which they count.
    """
    changed, worth, told = commanded
    nodes, reach, ring = drive.shape[0], ahead.shape[0], values.shape[0]
    modes, size, points = pressure.shape[0], levels.shape[0], speed.shape[0]
    visited_only, least_ahead = density.shape[0] > 0, 0.0 if period > 0.0 else 1.0
    commands, decisions = gradient.shape[0], gradient.shape[1]
    for n in range(nodes - 1, -1, -1):
        decision, first, last = decision_at[n], 1, points
        if visited_only:
            first, last = max(band[n, 0], 1), band[n, 1]
        here = values[n % ring]
        shifts(n, factor, levels, drive, brake, pressure, extra, path_step, energy_step, shift)
        for r in range(reach - 2, 0, -1):
            pull(ahead[r], points, transition, shift, stop, first, last, ahead[r + 1], scratch)
        pull(values[(n + 1) % ring], points, transition, shift, stop, first, last, ahead[1], scratch)
        add_quantum_times(n, prices, speed, shift, energy_step, first, last, ahead, scratch)
        for h in range(modes):
            k = stage[h]
            for q in range(size):
                acceleration = shift[h, q] * energy_step / path_step
                quanta_to_next_sample(speed, first, last, acceleration, period, path_step, quanta)
                here[h, q, 0] = stalled
                if decision >= decisions:
                    for j in range(first, last):
                        here[h, q, j] = ahead[1, h, q, j]
                    continue
                for command in range(commands):
                    c, begin, end = change_chain[command, h], first, first
                    if c >= 0:
                        begin, end = decided(policy, slopes, density, command, decision, k, h, q, first, last)
                    told[command, 0], told[command, 1] = begin, end
                    if begin >= end:
                        continue
                    found = change_values(
                        n, decision, nodes, c, q, begin, end, factor, chain_mode[c], ends, factors, met, slope,
                        least_ahead, extra, path_step, energy_step, points,
                        values, mixed, stalled, landing, changed[command],
                    )  # fmt: skip
                    add_change_times(
                        n, decision, nodes, c, q, landing[1], found, chain_mode[c], ends, met, slope, least_ahead,
                        extra, path_step, prices, speed, scratch, changed[command],
                    )  # fmt: skip
                for j in range(first, last):
                    mass = density[decision, h, q, j] if visited_only else 1.0
                    if abs(mass) < NEGLIGIBLE_MASS:
                        here[h, q, j] = ahead[1, h, q, j]
                        continue
                    by_change, hold = 0.0, 1.0
                    for command in range(commands):
                        chance = policy[command, decision, k, j]
                        is_told = told[command, 0] <= j < told[command, 1]
                        worth[command] = prices[0][0] + changed[command, j] if is_told else np.nan
                        by_change += chance * (worth[command] if is_told else 0.0)
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
                        nearer = q_hold if command < 2 else worth[command - 2]
                        by_line = mass * slopes[command, decision, k, j]
                        if by_line != 0.0 and not np.isnan(worth[command]):
                            gradient[command, decision, k] += by_line * (worth[command] - nearer)
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
