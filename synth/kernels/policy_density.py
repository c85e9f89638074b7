"""Forward density of a fixed policy in one scenario (Chapman–Kolmogorov equation).

The chain is embedded at the samples of the regulator. At a sample the cut stands at a path node with the
stage at rest; it is told to go down, to hold (then the next sample is v·T_c further, spread over the two
nodes around it) or to go up (then the next sample is at the end of the transient).
"""

from __future__ import annotations

import numpy as np
from numba import njit

from synth.kernels.flow import extent, push, quanta_to_next_sample, shifts
from synth.kernels.transient import put_transient

NEGLIGIBLE_MASS = 1e-11


@njit(cache=True, nogil=True, error_model="numpy")
def forward(
    down, up, entry, speed, stage, pressure, lower_chain, upper_chain, chain_mode,
    ends, factors, probability, mean, std, levels, transition, stationary,
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
        for q in range(size):
            heading[r, 0, q] = entry[r] * stationary[q]
    totals[:] = 0.0
    first, last = 0, points
    for n in range(nodes):
        here, mixed = arriving[n % ring], mixing[n % ring]
        first, last = mix_arrivals(here, mixed, transition, first, last)
        first, last = occupied(heading, here, first, last)
        band[n, 0], band[n, 1] = first, last
        shifts(n, factor, levels, drive, brake, pressure, extra, path_step, energy_step, shift)
        for h in range(modes):
            k = stage[h]
            for q in range(size):
                acceleration = shift[h, q] * energy_step / path_step
                totals[0] += here[h, q, 0] + heading[0, h, q, 0]
                for j in range(max(first, 1), last):
                    mass = here[h, q, j] + heading[0, h, q, j]
                    if density.shape[0] > 0:
                        density[n, h, q, j] = mass
                    if abs(mass) < NEGLIGIBLE_MASS:
                        continue
                    hold = 1.0 - down[n, k, j] - up[n, k, j]
                    f = quanta_to_next_sample(speed[j], acceleration, period, path_step)
                    step = min(int(f), reach - 2)
                    x = min(f - step, 1.0)
                    if step == 0:  # the next sample may be at this node again: sum the geometric series
                        mass /= 1.0 - hold * (1.0 - x)
                        if density.shape[0] > 0:
                            density[n, h, q, j] = mass
                        heading[1, h, q, j] += mass * hold * x
                    else:
                        heading[step, h, q, j] += mass * hold * (1.0 - x)
                        heading[step + 1, h, q, j] += mass * hold * x
                    for side in range(2):
                        share = mass * (up[n, k, j] if side == 1 else down[n, k, j])
                        c = upper_chain[h] if side == 1 else lower_chain[h]
                        if abs(share) < NEGLIGIBLE_MASS or c < 0:
                            continue
                        totals[2 + side] += share
                        totals[0] += put_transient(
                            share, n, nodes, c, q, j, factor, chain_mode[c], ends, factors, probability,
                            mean, std, drive, brake, pressure, levels, extra, path_step, energy_step,
                            arriving, mixing,
                        )  # fmt: skip
        clear(here, 0, points)
        clear(mixed, 0, points)
        for r in range(1, reach):
            clear(heading[r - 1], first, last)
            fallen, escaped = push(heading[r], transition, shift, first, last, heading[r - 1], moved)
            totals[0] += fallen
            totals[1] += escaped
        clear(heading[reach - 1], first, last)
        first = max(first + int(np.floor(shift.min())) - 1, 0)
        last = min(last + int(np.floor(shift.max())) + 3, points)
    collect(arriving[nodes % ring], mixing[nodes % ring], heading, exits)


@njit(cache=True, nogil=True, error_model="numpy")
def mix_arrivals(arriving, mixing, transition, first, last):
    """Mass that was deposited before the noise level changed joins `arriving` (H, L, E) after the change.

    Returns [first, last) widened to all energies at which anything arrives.
    """
    modes, levels, points = arriving.shape
    for h in range(modes):
        for q in range(levels):
            begin, end = extent(mixing[h, q], 0, points)
            for m in range(levels):
                for j in range(begin, end):
                    arriving[h, m, j] += transition[q, m] * mixing[h, q, j]
    for h in range(modes):
        for q in range(levels):
            begin, end = extent(arriving[h, q], 0, points)
            if begin < end:
                first, last = min(first, begin), max(last, end)
    return first, last


@njit(cache=True, nogil=True, error_model="numpy")
def clear(rows, first, last):
    """Set `rows` (H, L, E) to zero for first ≤ j < last (written out: a sliced assignment is slow in a kernel)."""
    for h in range(rows.shape[0]):
        for q in range(rows.shape[1]):
            for j in range(first, last):
                rows[h, q, j] = 0.0


@njit(cache=True, nogil=True, error_model="numpy")
def occupied(heading, arriving, first, last):
    """[first, last) narrowed to the energies at which mass that matters stands."""
    while first < last and column_is_empty(heading, arriving, first):
        first += 1
    while last > first and column_is_empty(heading, arriving, last - 1):
        last -= 1
    return first, last


@njit(cache=True, nogil=True, error_model="numpy")
def column_is_empty(heading, arriving, j):
    """Whether no mass that matters stands at energy `j`."""
    tiny = 1e-3 * NEGLIGIBLE_MASS
    for h in range(arriving.shape[0]):
        for q in range(arriving.shape[1]):
            if abs(arriving[h, q, j]) > tiny:
                return False
            for r in range(heading.shape[0]):
                if abs(heading[r, h, q, j]) > tiny:
                    return False
    return True


@njit(cache=True, nogil=True, error_model="numpy")
def collect(arriving, mixing, heading, exits):
    """Sum all mass at the exit over modes and levels into `exits` (E,)."""
    exits[:] = 0.0
    for h in range(arriving.shape[0]):
        for q in range(arriving.shape[1]):
            for j in range(arriving.shape[2]):
                exits[j] += arriving[h, q, j] + mixing[h, q, j]
                for r in range(heading.shape[0]):
                    exits[j] += heading[r, h, q, j]
