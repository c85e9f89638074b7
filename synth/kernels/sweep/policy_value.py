"""Backward value of a fixed policy in one scenario, and the gradient of its cost by every line value.

The transpose of `policy_density`: same chain, same weights.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from synth.kernels.sweep.flow import mix_values, pull, shifts
from synth.kernels.sweep.landing_plan import landing_scratch, landing_tables
from synth.kernels.sweep.next_sample import quanta_to_next_sample
from synth.kernels.sweep.policy_density import NEGLIGIBLE_MASS
from synth.kernels.sweep.transient import change_values
from synth.kernels.vector.borrowing import borrowing

NEGLIGIBLE_PROBABILITY = 1e-9


@njit(cache=True, nogil=True, error_model="numpy")
def backward(
    down, up, down_slope, up_slope, terminal, stalled, change_cost, entry, entry_mode, speed, stage, pressure,
    lower_chain, upper_chain, chain_mode, ends, factors, probability, mean, std,
    levels, transition, stationary, drive, brake, factor, extra, path_step, energy_step, period,
    density, band, lower_gradient, upper_gradient,
):  # fmt: skip
    """Expected cost of the policy from the entry; with `density` of the same policy also the gradient.

    `terminal` (E,) cost by exit energy, `stalled` cost of a stall, `change_cost` of each command;
    `density` (N, H, L, E) and `band` (N, 2) from `forward`, or `density` of length 0: then every state is
    valued and no gradient taken. `lower_gradient`, `upper_gradient` (N, K + 1) are added to.
    """
    modes, size, points, row = pressure.shape[0], levels.shape[0], speed.shape[0], ends.shape[4]
    reach, ring, last = entry.shape[0], probability.shape[1] + 3, drive.shape[0]
    ahead = np.empty((reach, modes, size, row))
    values = np.full((ring, modes, size, row), stalled)
    mixed = np.full((ring, modes, size, row), stalled)
    ahead[:, :, :, :points] = terminal
    values[last % ring, :, :, :points] = terminal
    mixed[last % ring, :, :, :points] = terminal
    met, slope = landing_tables(
        np.array([factor]), np.array([extra]), factors, probability, mean, std, levels, pressure, drive, brake,
        path_step,
    )  # fmt: skip
    follow_back(
        ahead, values, mixed, np.zeros(row), np.full(1, stalled), np.empty(row), np.zeros((2, row)),
        np.empty((modes, size)), landing_scratch(row, size, speed.dtype),
        down, up, down_slope, up_slope, stalled, change_cost, speed, stage, pressure,
        lower_chain, upper_chain, chain_mode, ends, factors, met[0], slope[0],
        levels, transition, drive, brake, factor, extra, path_step, energy_step, period,
        density, band, lower_gradient, upper_gradient,
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


@borrowing
def follow_back(
    ahead, values, mixed, scratch, stop, quanta, changed, shift, landing,
    down, up, down_slope, up_slope, stalled, change_cost, speed, stage, pressure,
    lower_chain, upper_chain, chain_mode, ends, factors, met, slope,
    levels, transition, drive, brake, factor, extra, path_step, energy_step, period,
    density, band, lower_gradient, upper_gradient,
):  # fmt: skip
    """`backward` with its memory: values ahead at held stages, at samples, and before mixing (rings)."""
    nodes, reach, ring = drive.shape[0], ahead.shape[0], values.shape[0]
    modes, size, points = pressure.shape[0], levels.shape[0], speed.shape[0]
    visited_only = density.shape[0] > 0
    for n in range(nodes - 1, -1, -1):
        first, last = 1, points
        if visited_only:
            first, last = max(band[n, 0], 1), band[n, 1]
        here = values[n % ring]
        shifts(n, factor, levels, drive, brake, pressure, extra, path_step, energy_step, shift)
        for r in range(reach - 2, 0, -1):
            pull(ahead[r], points, transition, shift, stop, first, last, ahead[r + 1], scratch)
        pull(values[(n + 1) % ring], points, transition, shift, stop, first, last, ahead[1], scratch)
        for h in range(modes):
            k = stage[h]
            for q in range(size):
                acceleration = shift[h, q] * energy_step / path_step
                quanta_to_next_sample(speed, first, last, acceleration, period, path_step, quanta)
                here[h, q, 0] = stalled
                for side in range(2):
                    c = upper_chain[h] if side == 1 else lower_chain[h]
                    chance = up[n, k] if side == 1 else down[n, k]
                    begin, end = decided(chance, density, n, h, q, first, last)
                    if c < 0 or begin >= end:
                        continue
                    change_values(
                        n, nodes, c, q, begin, end, factor, chain_mode[c], ends, factors, met, slope,
                        extra, path_step, energy_step, points,
                        values, mixed, stalled, landing, changed[side],
                    )  # fmt: skip
                for j in range(first, last):
                    mass = density[n, h, q, j] if visited_only else 1.0
                    if abs(mass) < NEGLIGIBLE_MASS:
                        here[h, q, j] = ahead[1, h, q, j]
                        continue
                    p_down, p_up = down[n, k, j], up[n, k, j]
                    lowers = lower_chain[h] >= 0 and p_down > NEGLIGIBLE_PROBABILITY
                    raises = upper_chain[h] >= 0 and p_up > NEGLIGIBLE_PROBABILITY
                    q_down = change_cost + changed[0, j] if lowers else 0.0
                    q_up = change_cost + changed[1, j] if raises else 0.0
                    by_change = p_down * q_down + p_up * q_up
                    hold = 1.0 - p_down - p_up
                    step = min(int(quanta[j]), reach - 2)
                    x = min(quanta[j] - step, 1.0)
                    if step == 0:
                        value = (hold * x * ahead[1, h, q, j] + by_change) / (1.0 - hold * (1.0 - x))
                        q_hold = (1.0 - x) * value + x * ahead[1, h, q, j]
                    else:
                        q_hold = (1.0 - x) * ahead[step, h, q, j] + x * ahead[step + 1, h, q, j]
                        value = hold * q_hold + by_change
                    here[h, q, j] = value
                    if visited_only and lowers:
                        lower_gradient[n, k] += mass * down_slope[n, k, j] * (q_down - q_hold)
                    if visited_only and raises:
                        upper_gradient[n, k] += mass * up_slope[n, k, j] * (q_up - q_hold)
        mix_values(here, transition, first, last, stop, mixed[n % ring])


@borrowing
def decided(chance, density, n, h, q, first, last):
    """Range of energies within [first, last) that hold every visited state in which a command has a `chance` (E,)."""
    while first < last and not is_decided(chance, density, n, h, q, first):
        first += 1
    while first < last and not is_decided(chance, density, n, h, q, last - 1):
        last -= 1
    return first, last


@borrowing
def is_decided(chance, density, n, h, q, j):
    """Whether a visited state may get the command of `chance`; `density` of length 0: every state is visited."""
    visited = density.shape[0] == 0 or abs(density[n, h, q, j]) >= NEGLIGIBLE_MASS
    return visited and chance[j] > NEGLIGIBLE_PROBABILITY
