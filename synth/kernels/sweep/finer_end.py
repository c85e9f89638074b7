"""Forward density of a fixed policy whose last metres are followed on a finer energy grid.

Before the exit cuts are slow, and in e = v²/2 the same spread of speeds covers fewer cells the slower they are. So at
one node of the path what stands below a ceiling is handed over to a grid whose steps are a whole fraction of the coarse
ones, and the rest goes on as before. The equation is linear in the masses: both are added up at the exit.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from plant_models.frozen_arrays import Floats
from synth.kernels.compiling import borrowing, kernel, part
from synth.kernels.sweep.chain_arrays import Scenario
from synth.kernels.sweep.flow import NO_MASS, extent, stencil, widen
from synth.kernels.sweep.landing_plan import landing_tables
from synth.kernels.sweep.policy_density import BEGIN, begin_pass, collect, empty_masses, follow, without_mass
from synth.kernels.vector.packs import EIGHT, load8, scatter

LINEAR_BELOW = 2
"""Cells next to the stall whose mass is refined linearly: a cubic would reach below it."""


class HandOver(NamedTuple):
    """At path node `node` the share `handed` (E,) of every energy goes over to a grid `times` as dense."""

    node: int
    handed: Floats
    times: int


@kernel
def forward_to_finer_end(over, policy, chain, fine_policy, fine_chain, scenarios, negligible, exits, totals):
    """Distribution at the exit in all `scenarios`.

    `fine_policy` and `fine_chain` belong to the finer grid and to the path from `over.node` on; the entry of that chain
    means nothing. `negligible` (I,): a state of a scenario with less mass is left out. The rest as in
    `policy_density.forward`, but for `exits` (I, times·E), by energy of the finer grid.
    """
    (node, handed, times), (factor, extra) = over, scenarios
    masses, fine = empty_masses(chain, policy.shape[0]), empty_masses(fine_chain, policy.shape[0])
    nodes, points, ring = chain.track.drive.shape[0], chain.grid.speed.shape[0], masses.arriving.shape[0]
    basis, rest, late = refinement(times), np.empty(points), np.empty(fine_chain.grid.speed.shape[0])
    unkept, bands = np.empty((0, 0, 0, 0)), np.empty((nodes, 2), np.int64)
    for i in range(factor.shape[0]):
        met, slope = landing_tables(chain, factor[i : i + 1], extra[i : i + 1])
        scenario = Scenario(factor[i], extra[i], met[0], slope[0])
        to_exit = Scenario(factor[i], extra[i], met[0], np.ascontiguousarray(slope[0, :, :, node:]))
        begin_pass(chain, masses)
        without_mass(fine)
        totals[i] = 0.0
        for start, stop in ((0, node), (node, nodes)):
            follow(start, stop, negligible[i], policy, chain, scenario, masses, unkept, bands, totals[i])
            if start == 0:
                hand_over(masses.heading, masses.spans, handed, basis, fine.heading, fine.spans)
                for n in range(node, min(node + ring, nodes + 1)):
                    hand_over_landed(masses, n % ring, handed, basis, fine, (n - node) % ring)
        collect(masses, nodes, rest)
        follow(BEGIN, nodes - node, negligible[i], fine_policy, fine_chain, to_exit, fine, unkept, bands, totals[i])
        collect(fine, nodes - node, late)
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
def hand_over_landed(masses, at, handed, basis, fine, to):
    """The same for what has landed at a node, number `at` in the rings of `masses` and `to` in those of `fine`."""
    landed = masses.landed[at]
    for rows, finer in ((masses.arriving[at], fine.arriving[to]), (masses.mixing[at], fine.mixing[to])):
        for h in range(rows.shape[0]):
            for q in range(rows.shape[1]):
                begin, end = landed[h, 0], min(landed[h, 1], handed.shape[0])
                refine_span(rows[h, q], begin, end, handed, basis, finer[h, q], fine.landed[to, h])


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
