"""Forward density of a fixed policy whose last metres are followed on a finer energy grid.

Before the exit cuts are slow, and in e = v²/2 the same spread of speeds covers fewer cells the slower they are. So at
one node of the path what stands below a ceiling is handed over to a grid whose steps are a whole fraction of the coarse
ones, and the rest goes on as before. The equation is linear in the masses: both are added up at the exit.
"""

from __future__ import annotations

import numpy as np

from synth.kernels.compiling import borrowing, kernel, part
from synth.kernels.sweep.flow import NO_MASS, extent, stencil, widen
from synth.kernels.sweep.landing_plan import landing_scratch, landing_tables
from synth.kernels.sweep.policy_density import BEGIN, collect, follow
from synth.kernels.vector.packs import EIGHT, load8, scatter

LINEAR_BELOW = 2
"""Cells next to the stall whose mass is refined linearly: a cubic would reach below it."""


@kernel
def forward_to_finer_end(
    node, handed, times, fine_policy, fine_decision_at, fine_speed, fine_ends, negligible,
    policy, decision_at, entry, entry_mode, speed, stage, pressure, change_chain, chain_mode,
    ends, factors, probability, mean, std, levels, transition, stationary,
    drive, brake, factor, extra, path_step, energy_step, period, exits, totals,
):  # fmt: skip
    """Distribution at the exit in the scenarios `factor`, `extra` (I,).

    At `node` the share `handed` (E,) of every energy goes over to the finer grid, whose energies are `times` as dense:
    `fine_policy` (C, R_f, K + 1, E_f), `fine_decision_at` (N − node,), `fine_speed` (E_f,), `fine_ends` (R_f, ·, F, 2,
    E_f') belong to it. `negligible` (I,): a state of a scenario with less mass is left out. The rest as in
    `policy_density.forward`, but for `exits` (I, times·E), by energy of the finer grid.
    """
    modes, size, nodes, points, row = pressure.shape[0], levels.shape[0], drive.shape[0], speed.shape[0], ends.shape[4]
    reach, ring, fine_row = entry.shape[0], probability.shape[1] + 3, fine_ends.shape[4]
    heading, fine_heading = np.empty((reach, modes, size, row)), np.empty((reach, modes, size, fine_row))
    arriving, fine_arriving = np.zeros((ring, modes, size, row)), np.zeros((ring, modes, size, fine_row))
    mixing, fine_mixing = np.zeros((ring, modes, size, row)), np.zeros((ring, modes, size, fine_row))
    chance, fine_chance = np.zeros((policy.shape[0], row)), np.zeros((policy.shape[0], fine_row))
    memory = np.zeros(row), np.zeros(row), np.ones(row), chance, np.empty((modes, size))
    fine_memory = np.zeros(fine_row), np.zeros(fine_row), np.ones(fine_row), fine_chance, memory[4]
    spans, fine_spans = np.empty((reach, modes, size, 2), np.int64), np.empty((reach, modes, size, 2), np.int64)
    landed, fine_landed = np.empty((ring, modes, 2), np.int64), np.empty((ring, modes, 2), np.int64)
    arrived = np.zeros((modes, size, 2), np.int64)
    scratch, fine_scratch = landing_scratch(row, size, speed.dtype), landing_scratch(fine_row, size, speed.dtype)
    basis, rest, late = refinement(times), np.empty(points), np.empty(fine_speed.shape[0])
    unkept, bands = np.empty((0, 0, 0, 0)), np.empty((nodes, 2), np.int64)
    fine_drive, fine_brake = drive[node:], brake[node:]
    for i in range(factor.shape[0]):
        met, slope = landing_tables(
            factor[i : i + 1], extra[i : i + 1], factors, probability, mean, std,
            levels, pressure, drive, brake, path_step,
        )  # fmt: skip
        heading[:], spans[:], landed[:], totals[i] = 0.0, 0, 0, 0.0
        fine_heading[:], fine_spans[:], fine_landed[:] = 0.0, 0, 0
        for r in range(reach):
            for q in range(size):
                for j in range(points):
                    heading[r, entry_mode, q, j] = entry[r, j] * stationary[q]
                spans[r, entry_mode, q, 1] = points
        for start, stop in ((0, node), (node, nodes)):
            follow(
                start, stop, negligible[i], heading, arriving, mixing, memory, scratch, spans, arrived, landed,
                policy, decision_at, speed, stage, pressure, change_chain, chain_mode,
                ends, factors, met[0], slope[0], levels, transition,
                drive, brake, factor[i], extra[i], path_step, energy_step, period, unkept, bands, totals[i],
            )  # fmt: skip
            if start == 0:
                hand_over(heading, spans, handed, basis, fine_heading, fine_spans)
                for n in range(node, min(node + ring, nodes + 1)):
                    at, to = n % ring, (n - node) % ring
                    hand_over_landed(arriving[at], landed[at], handed, basis, fine_arriving[to], fine_landed[to])
                    hand_over_landed(mixing[at], landed[at], handed, basis, fine_mixing[to], fine_landed[to])
        collect(arriving[nodes % ring], mixing[nodes % ring], heading, rest)
        follow(
            BEGIN, nodes - node, negligible[i], fine_heading, fine_arriving, fine_mixing, fine_memory, fine_scratch,
            fine_spans, arrived, fine_landed, fine_policy, fine_decision_at, fine_speed, stage, pressure,
            change_chain, chain_mode, fine_ends, factors, met[0],
            np.ascontiguousarray(slope[0, :, :, node:]), levels, transition, fine_drive, fine_brake,
            factor[i], extra[i], path_step, energy_step / times, period, unkept, bands, totals[i],
        )  # fmt: skip
        collect(fine_arriving[(nodes - node) % ring], fine_mixing[(nodes - node) % ring], fine_heading, late)
        exits[i] = 0.0
        for j in range(late.shape[0]):
            exits[i, j] = late[j]
        refine(rest, 0, points, np.ones(points), basis, exits[i])


@kernel
def refine_landings(ends, points, first, times, fine_ends):
    """`fine_ends` (R − first, C, F, 2, E_f'): `ends` (R, C, F, 2, E') from decision `first` on, `times` as dense.

    A landing is smooth in the energy, so four of `points` E energies are interpolated; next to a stall and at the top
    the nearest counts.
    """
    row, fine_row = ends.shape[4], fine_ends.shape[4]
    apart = times * np.arange(EIGHT)
    for n, c, f in np.ndindex(fine_ends.shape[:3]):
        path = ends[first + n, c, f, 0]
        begin = 0
        for j in range(points):
            if path[j] < 0.0:
                begin = j + 1
        begin, end = min(begin + 1, points), min((fine_row - 1) // times, points - 2)
        for side in range(2):
            found, out = ends[first + n, c, f, side], fine_ends[n, c, f, side]
            for i in range(min(times * begin, fine_row)):
                out[i] = found[(2 * i + times) // (2 * times)]
            for d in range(times):
                between(found, begin, end, stencil(d / times), apart, out, d)
            for i in range(times * max(begin, end), fine_row):
                out[i] = found[min((2 * i + times) // (2 * times), row - 1)]


@part
def between(row, begin, end, weights, apart, finer, first):
    """`finer`[`first` + times·j] = the four of `row` around j by their `weights`, begin ≤ j < end.

    `apart` (8,): where a pack of results lies, times·(0 … 7).
    """
    c0, c1, c2, c3 = weights
    times, places, stop = apart[1], load8(apart, 0), begin + (end - begin) // EIGHT * EIGHT
    for j in range(begin, stop, EIGHT):
        found = load8(row, j - 1) * c0 + load8(row, j) * c1 + load8(row, j + 1) * c2 + load8(row, j + 2) * c3
        scatter(finer, places + (times * j + first), places >= 0, found)
    for j in range(stop, end):
        finer[times * j + first] = c0 * row[j - 1] + c1 * row[j] + c2 * row[j + 1] + c3 * row[j + 2]


@kernel
def refinement(times):
    """What a mass on a grid becomes on one `times` as dense: cubic Lagrange functions, (4·times − 1,), sum 1.

    Mass, mean and second moment of any row are kept, and a smooth row becomes a smooth one.
    """
    basis = np.empty(4 * times - 1)
    for d in range(-2 * times + 1, 2 * times):
        x = abs(d) / times
        c = stencil(x % 1.0)
        basis[d + 2 * times - 1] = (c[1] if x < 1.0 else c[0]) / times
    return basis


@part
def hand_over(rows, spans, handed, basis, finer, finer_spans):
    """Take the share `handed` (E,) out of `rows` (M, H, L, E') and put it, refined, into `finer` (M, H, L, E_f')."""
    for r in range(rows.shape[0]):
        for h in range(rows.shape[1]):
            for q in range(rows.shape[2]):
                begin, end = spans[r, h, q, 0], min(spans[r, h, q, 1], handed.shape[0])
                refine_span(rows[r, h, q], begin, end, handed, basis, finer[r, h, q], finer_spans[r, h, q])


@part
def hand_over_landed(rows, landed, handed, basis, finer, finer_landed):
    """The same for what has landed at a node: `rows` (H, L, E'), `landed` (H, 2) for all levels."""
    for h in range(rows.shape[0]):
        for q in range(rows.shape[1]):
            begin, end = landed[h, 0], min(landed[h, 1], handed.shape[0])
            refine_span(rows[h, q], begin, end, handed, basis, finer[h, q], finer_landed[h])


@part
def refine_span(row, begin, end, handed, basis, finer, span):
    """`refine` within the range in which there is mass; `span` (2,), the range of `finer`, is widened."""
    begin, end = extent(row, begin, end, NO_MASS)
    while begin < end and handed[end - 1] == 0.0:
        end -= 1
    if begin < end:
        times = (basis.shape[0] + 1) // 4
        refine(row, begin, end, handed, basis, finer)
        widen(span, max(times * (begin - 2), 0), min(times * (end + 1), finer.shape[0]))


@borrowing
def refine(row, begin, end, share, basis, finer):
    """Move `share` (E,) of `row`[begin:end] to `finer`, added, and out of `row`."""
    times = (basis.shape[0] + 1) // 4
    for j in range(begin, end):
        mass = share[j] * row[j]
        row[j] -= mass
        if j == 0 or times * (j + 2) > finer.shape[0]:
            finer[times * j] += mass
        elif j < LINEAR_BELOW:
            for d in range(-times + 1, times):
                finer[times * j + d] += mass * (times - abs(d)) / (times * times)
        else:
            for d in range(-2 * times + 1, 2 * times):
                finer[times * j + d] += mass * basis[d + 2 * times - 1]
