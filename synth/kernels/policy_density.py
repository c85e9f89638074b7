"""Forward density of a fixed policy in one scenario (Chapman–Kolmogorov equation).

The chain is embedded at the samples of the regulator. At a sample the cut stands at a path node with the
stage at rest; it is told to go down, to hold (then the next sample is v·T_c further, spread over the two
nodes around it) or to go up (then the next sample is at the end of the transient).
"""

from __future__ import annotations

import numpy as np
from numba import njit

from synth.kernels.flow import push, quanta_to_next_sample, shifts
from synth.kernels.transient import put_transient

NEGLIGIBLE_MASS = 1e-12


@njit(cache=True, nogil=True)
def forward(
    down, up, entry, speed, stage, pressure, lower_chain, upper_chain, chain_mode,
    travel, energy, factors, probability, mean, std, levels, transition, stationary,
    drive, brake, factor, extra, path_step, energy_step, period, density, band, exits, totals,
):  # fmt: skip
    """Density of sampled states, and the distribution at the exit.

    `down`, `up` (N, K + 1, E) command probabilities; `entry` (M + 1, E): probability of entering with speed j
    and having the first sample at node r; the rest as in `flow` and `transient`. Outputs: `density`
    (N, H, L, E) expected number of samples at each node and state, or length 0; `band` (N, 2) range of
    energies that are met at a node; `exits` (E,) exit probability by energy; `totals` (4,): stalled mass,
    escaped mass, changes down, changes up.
    """
    nodes = drive.shape[0]
    modes, size, points = pressure.shape[0], levels.shape[0], speed.shape[0]
    reach = entry.shape[0]
    ring = probability.shape[1] + 3
    heading = np.zeros((reach + 1, modes, size, points))
    moved = np.empty(points)
    shift = np.empty((modes, size))
    arriving = np.zeros((ring, modes, size, points))
    mixing = np.zeros((ring, modes, size, points))
    for r in range(reach):
        for l in range(size):
            heading[r, 0, l] = entry[r] * stationary[l]
    totals[:] = 0.0
    for n in range(nodes):
        here, mixed = arriving[n % ring], mixing[n % ring]
        mix_arrivals(here, mixed, transition)
        first, last = occupied(heading, here)
        band[n, 0], band[n, 1] = first, last
        shifts(n, factor, levels, drive, brake, pressure, extra, path_step, energy_step, shift)
        for h in range(modes):
            k = stage[h]
            for l in range(size):
                acceleration = shift[h, l] * energy_step / path_step
                totals[0] += here[h, l, 0] + heading[0, h, l, 0]
                for j in range(max(first, 1), last):
                    mass = here[h, l, j] + heading[0, h, l, j]
                    if density.shape[0] > 0:
                        density[n, h, l, j] = mass
                    if abs(mass) < NEGLIGIBLE_MASS:
                        continue
                    hold = 1.0 - down[n, k, j] - up[n, k, j]
                    f = quanta_to_next_sample(speed[j], acceleration, period, path_step)
                    step = min(int(f), reach - 2)
                    x = min(f - step, 1.0)
                    if step == 0:  # the next sample may be at this node again: sum the geometric series
                        mass /= 1.0 - hold * (1.0 - x)
                        if density.shape[0] > 0:
                            density[n, h, l, j] = mass
                        heading[1, h, l, j] += mass * hold * x
                    else:
                        heading[step, h, l, j] += mass * hold * (1.0 - x)
                        heading[step + 1, h, l, j] += mass * hold * x
                    for side in range(2):
                        share = mass * (up[n, k, j] if side == 1 else down[n, k, j])
                        c = upper_chain[h] if side == 1 else lower_chain[h]
                        if abs(share) < NEGLIGIBLE_MASS or c < 0:
                            continue
                        totals[2 + side] += share
                        totals[0] += put_transient(
                            share, n, nodes, c, l, j, factor, chain_mode[c], travel, energy, factors, probability,
                            mean, std, drive, brake, pressure, levels, extra, path_step, energy_step,
                            arriving, mixing,
                        )  # fmt: skip
        here[:] = 0.0
        mixed[:] = 0.0
        for r in range(1, reach):
            heading[r - 1] = 0.0
            fallen, escaped = push(heading[r], transition, shift, first, last, heading[r - 1], moved)
            totals[0] += fallen
            totals[1] += escaped
        heading[reach - 1] = 0.0
    collect(arriving[nodes % ring], mixing[nodes % ring], heading, exits)


@njit(cache=True, nogil=True)
def mix_arrivals(arriving, mixing, transition):
    """Mass that was deposited before the noise level changed joins `arriving` (H, L, E) after the change."""
    modes, levels, points = arriving.shape
    for h in range(modes):
        for l in range(levels):
            for m in range(levels):
                for j in range(points):
                    arriving[h, m, j] += transition[l, m] * mixing[h, l, j]


@njit(cache=True, nogil=True)
def occupied(heading, arriving):
    """Range of energy indices in which any mass stands."""
    points = arriving.shape[2]
    first, last = points, 0
    for h in range(arriving.shape[0]):
        for l in range(arriving.shape[1]):
            for r in range(heading.shape[0]):
                first, last = widened(heading[r, h, l], first, last)
            first, last = widened(arriving[h, l], first, last)
    return min(first, last), last


@njit(cache=True, nogil=True)
def widened(row, first, last):
    """[first, last) extended to all entries of `row` that matter."""
    for j in range(first):
        if abs(row[j]) > 1e-3 * NEGLIGIBLE_MASS:
            first = j
            break
    for j in range(row.shape[0] - 1, last - 1, -1):
        if abs(row[j]) > 1e-3 * NEGLIGIBLE_MASS:
            last = j + 1
            break
    return first, last


@njit(cache=True, nogil=True)
def collect(arriving, mixing, heading, exits):
    """Sum all mass at the exit over modes and levels into `exits` (E,)."""
    exits[:] = 0.0
    for h in range(arriving.shape[0]):
        for l in range(arriving.shape[1]):
            for j in range(arriving.shape[2]):
                exits[j] += arriving[h, l, j] + mixing[h, l, j]
                for r in range(heading.shape[0]):
                    exits[j] += heading[r, h, l, j]
