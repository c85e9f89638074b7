"""Backward value of a fixed policy in one scenario, and the gradient of its cost by every line value.

The transpose of `policy_density`: same chain, same weights.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from synth.kernels.flow import mix_values, pull, quanta_to_next_sample, shifts
from synth.kernels.policy_density import NEGLIGIBLE_MASS
from synth.kernels.transient import transient_value

NEGLIGIBLE_PROBABILITY = 1e-9


@njit(cache=True, nogil=True, error_model="numpy")
def backward(
    down, up, down_slope, up_slope, terminal, stalled, change_cost, entry, speed, stage, pressure,
    lower_chain, upper_chain, chain_mode, ends, factors, probability, mean, std,
    levels, transition, stationary, drive, brake, factor, extra, path_step, energy_step, period,
    density, band, lower_gradient, upper_gradient,
):  # fmt: skip
    """Expected cost of the policy from the entry; with `density` of the same policy also the gradient.

    `terminal` (E,) cost by exit energy, `stalled` cost of a stall, `change_cost` of each command;
    `density` (N, H, L, E) and `band` (N, 2) from `forward`, or `density` of length 0: then every state is
    valued and no gradient taken. `lower_gradient`, `upper_gradient` (N, K + 1) are added to.
    """
    nodes = drive.shape[0]
    modes, size, points = pressure.shape[0], levels.shape[0], speed.shape[0]
    reach = entry.shape[0]
    ring = probability.shape[1] + 3
    visited_only = density.shape[0] > 0
    ahead = np.empty((reach, modes, size, points))
    values = np.full((ring, modes, size, points), stalled)
    mixed = np.full((ring, modes, size, points), stalled)
    scratch = np.zeros(points)
    stop = np.full(1, stalled)
    shift = np.empty((modes, size))
    ahead[:] = terminal
    values[nodes % ring] = terminal
    mixed[nodes % ring] = terminal
    for n in range(nodes - 1, -1, -1):
        first, last = 1, points
        if visited_only:
            first, last = max(band[n, 0], 1), band[n, 1]
        here = values[n % ring]
        shifts(n, factor, levels, drive, brake, pressure, extra, path_step, energy_step, shift)
        for r in range(reach - 2, -1, -1):
            pull(ahead[r], transition, shift, stop, first, last, ahead[r + 1], scratch)
        for h in range(modes):
            k = stage[h]
            for q in range(size):
                acceleration = shift[h, q] * energy_step / path_step
                here[h, q, 0] = stalled
                for j in range(first, last):
                    mass = density[n, h, q, j] if visited_only else 1.0
                    if abs(mass) < NEGLIGIBLE_MASS:
                        here[h, q, j] = ahead[1, h, q, j]
                        continue
                    p_down, p_up = down[n, k, j], up[n, k, j]
                    q_down, q_up = 0.0, 0.0
                    if lower_chain[h] >= 0 and p_down > NEGLIGIBLE_PROBABILITY:
                        c = lower_chain[h]
                        q_down = change_cost + transient_value(
                            n, nodes, c, q, j, factor, chain_mode[c], ends, factors, probability, mean,
                            std, drive, brake, pressure, levels, extra, path_step, energy_step,
                            values, mixed, stalled,
                        )  # fmt: skip
                    if upper_chain[h] >= 0 and p_up > NEGLIGIBLE_PROBABILITY:
                        c = upper_chain[h]
                        q_up = change_cost + transient_value(
                            n, nodes, c, q, j, factor, chain_mode[c], ends, factors, probability, mean,
                            std, drive, brake, pressure, levels, extra, path_step, energy_step,
                            values, mixed, stalled,
                        )  # fmt: skip
                    changed = p_down * q_down + p_up * q_up
                    hold = 1.0 - p_down - p_up
                    f = quanta_to_next_sample(speed[j], acceleration, period, path_step)
                    step = min(int(f), reach - 2)
                    x = min(f - step, 1.0)
                    if step == 0:
                        value = (hold * x * ahead[1, h, q, j] + changed) / (1.0 - hold * (1.0 - x))
                        q_hold = (1.0 - x) * value + x * ahead[1, h, q, j]
                    else:
                        q_hold = (1.0 - x) * ahead[step, h, q, j] + x * ahead[step + 1, h, q, j]
                        value = hold * q_hold + changed
                    here[h, q, j] = value
                    if visited_only and p_down > NEGLIGIBLE_PROBABILITY and lower_chain[h] >= 0:
                        lower_gradient[n, k] += mass * down_slope[n, k, j] * (q_down - q_hold)
                    if visited_only and p_up > NEGLIGIBLE_PROBABILITY and upper_chain[h] >= 0:
                        upper_gradient[n, k] += mass * up_slope[n, k, j] * (q_up - q_hold)
        mix_values(here, transition, first, last, stop, mixed[n % ring])
        ahead[0] = here
    cost = 0.0
    for r in range(reach):
        for q in range(size):
            for j in range(points):
                if entry[r, j] != 0.0:
                    cost += entry[r, j] * stationary[q] * ahead[r, 0, q, j]
    return cost
