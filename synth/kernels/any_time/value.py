"""Cost of a fixed policy that decides at every sample, backward through one scenario, and its slopes by the lines.

The transpose of `occupancy.occupy`: both give the same cost to rounding. Only states that the forward density meets are
valued.
"""

from __future__ import annotations

import numpy as np

from synth.kernels.any_time.occupancy import DOWN, HOLD, LEAST_CHANCE, UP, whole_packs
from synth.kernels.any_time.period import NodesAhead, look_ahead, pull_period, pull_row
from synth.kernels.compiling import kernel, part, part_inline
from synth.kernels.sweep.flow import clear, extent, in_every_state
from synth.kernels.vector.normal_packs import normal_density8
from synth.kernels.vector.packs import EIGHT, eight, load8, store


@kernel
def value(policy, chain, factor, extra, costs, rows, values, met, slopes, bends):
    """The expected cost of a pass; `met` by `occupy`, whose arguments are the same.

    `rows` (W, L, ring, E') and `values` (M, L, E') are zeros, and are left so. Outputs (2, N, M): `slopes`, derivatives
    of the cost by the lines, and `bends`, its second derivatives by each line alone.
    """
    (lines, reading, noise), (records, band, where, way_band) = policy, met
    (periods, kpa, way, target, share), (entry, entry_way, entry_kpa) = chain.periods, chain.entry
    (terminal, stalled, change_cost, period_price), motion = costs, chain.motion
    nodes, modes, levels = lines.shape[1], lines.shape[2], factor.shape[0]
    points, (_, _, ring, row) = terminal.shape[0], rows.shape
    chance, commanded = np.zeros((3, row)), np.zeros((3, row))
    saved, scratch = np.zeros((2, row)), np.zeros((3, row))
    reach, ends = max(motion.bands.shape[0], entry.shape[0]), np.zeros((3, 2), np.int64)
    ahead = NodesAhead(np.zeros(reach, np.int64), np.zeros(reach), np.zeros(reach))
    in_every_state(terminal, points, rows[:, :, nodes % ring : nodes % ring + 1])
    rows[:, :, nodes % ring, 0] = stalled
    slopes[:], bends[:] = 0.0, 0.0
    for n in range(nodes - 1, -1, -1):
        look_ahead(n, extra, motion, ring, ahead)
        for m in range(modes):
            first, last = band[n, m]
            for q in range(levels if n + 1 < nodes else 0):
                clear(values[m, q], band[n + 1, m, 0], band[n + 1, m, 1])
            if first >= last:
                continue
            take_chances(records, where[n, m], levels, first, last, chance, ends)
            for q in range(levels):
                for command in range(3):
                    d = periods[m, command]
                    if d >= 0 and ends[command, 0] < ends[command, 1]:
                        pull_period(
                            ahead, kpa[d] * factor[q], motion, rows[way[d], q], ends[command, 0], ends[command, 1],
                            commanded[command], scratch,
                        )  # fmt: skip
                density = where[n, m] + q * whole_packs(last - first) - first
                decide(commanded, chance, ends, change_cost, records, density, values[m, q], saved, q == 0)
                if period_price > 0.0:
                    add_period_times(motion.quanta, nodes - n, period_price, first, last, values[m, q])
            for side in range(2):
                by_line(
                    saved[side], lines[side, n, m], reading, 1.0 / noise[n], ends[2 * side], scratch[0],
                    side, n, m, slopes, bends,
                )  # fmt: skip
            change_levels_back(values[m], first, last, chain.mixing, scratch)
        at_ways(n % ring, way_band[n], values, target, share, stalled, rows)
    cost = 0.0
    for r in range(entry.shape[0]):
        for q in range(levels):
            shift = ahead.free[r] - entry_kpa * factor[q] * ahead.braking[r]
            pull_row(rows[entry_way, q, r], shift, points, 1, points, scratch[0])
            for j in range(1, points):
                cost += entry[r, j] * chain.stationary[q] * (scratch[0, j] + period_price * r / motion.quanta[j])
    leave_zeros(band[0], way_band, rows, values)
    return cost


@part
def take_chances(records, at, levels, first, last, chance, ends):
    """The chances of down and up (3, E') of a mode's record, and the energies `ends` (3, 2) at which a command counts.

    What holding is worth counts everywhere, as what a command saves is counted from it.
    """
    width = whole_packs(last - first)
    ends[HOLD, 0], ends[HOLD, 1] = first, last
    for command in (DOWN, UP):
        kept = at + (levels + command // 2) * width
        for j in range(0, width, EIGHT):
            store(chance[command], first + j, load8(records, kept + j))
        begin, end = extent(chance[command], first, last, LEAST_CHANCE)
        ends[command] = end
        if begin < end:
            ends[command, 0] = begin - (begin - first) % EIGHT  # a record ends with a whole pack


@part
def decide(commanded, chance, ends, change_cost, records, density, out, saved, fresh):
    """Value `out` (E',) at a sample of a level under the chances of the commands; behind its energies it is 0.

    To `saved` (2, E'), what commands down and up cost less than holding, the level's share is added, by its density,
    which stands in `records` from flat index `density` on; `fresh`: it is put there.
    """
    first, last = ends[HOLD]
    for j in range(first, last, EIGHT):
        store(out, j, load8(commanded[HOLD], j))
    for command in (DOWN, UP):
        side = command // 2
        for j in range(ends[command, 0], ends[command, 1], EIGHT):
            less = load8(commanded[command], j) - load8(commanded[HOLD], j) + change_cost
            store(out, j, load8(out, j) + load8(chance[command], j) * less)
            weighted = load8(records, density + j) * less
            store(saved[side], j, weighted if fresh else load8(saved[side], j) + weighted)
    store(out, last, eight(0.0))


@part
def add_period_times(quanta, left, price, first, last, out):
    """Add the price of the period that begins at each energy to `out` (E',), `left` quanta before the exit.

    `quanta` (E',) path of a period. Where that is longer than the path left, the part until the exit counts; where it
    is less than a quantum, the time over that quantum, at whose end `period` puts it.
    """
    for j in range(max(first, 1), last):
        out[j] += price * min(max(1.0, 1.0 / quanta[j]), left / quanta[j])


@part
def by_line(saved, line, reading, scale, ends, scratch, side, n, m, slopes, bends):
    """Slope and bend of the cost by one line, of which commands cost `saved` (E',) less, times density, at `ends`."""
    slope, bend = eight(0.0), eight(0.0)
    for j in range(ends[0], ends[1], EIGHT):
        z = (load8(reading, j) * -1.0 + line) * scale
        weighted = normal_density8(z) * load8(saved, j)
        slope, bend = slope + weighted, bend + weighted * z
    sign = scale if side == 0 else -scale
    if ends[0] < ends[1]:
        slopes[side, n, m] = sign * lanes_together(slope, scratch)
        bends[side, n, m] = -sign * scale * lanes_together(bend, scratch)


@part_inline
def lanes_together(pack, scratch):
    """Sum of the lanes."""
    store(scratch, 0, pack)
    total = 0.0
    for j in range(EIGHT):
        total += scratch[j]
    return total


@part
def change_levels_back(values, first, last, mixing, scratch):
    """Values (L, E') before the level's change at the end of a period, of those after it, in place."""
    levels, row = values.shape
    for j in range(first, last, EIGHT):
        for q in range(levels):
            found = load8(values, j) * load8(mixing, q * levels * row + j)
            for k in range(1, levels):
                found = found + load8(values, k * row + j) * load8(mixing, (q * levels + k) * row + j)
            store(scratch, q * EIGHT, found)
        for q in range(levels):
            store(values, q * row + j, load8(scratch, q * EIGHT))


@part
def at_ways(slot, way_band, values, target, share, stalled, rows):
    """Values of modes as values of the ways that lead to them, where mass arrives."""
    levels, row = values.shape[1:]
    for w in range(target.shape[0]):
        begin, end = way_band[w]
        if begin >= end:
            continue
        for q in range(levels):
            to = rows[w, q, slot]
            a, b, c, d = target[w, 0], target[w, 1], target[w, 2], target[w, 3]
            a, b, c, d = (a * levels + q) * row, (b * levels + q) * row, (c * levels + q) * row, (d * levels + q) * row
            for j in range(begin, end, EIGHT):
                found = load8(values, a + j) * share[w, 0] + load8(values, b + j) * share[w, 1]
                store(to, j, found + load8(values, c + j) * share[w, 2] + load8(values, d + j) * share[w, 3])
            to[0] = stalled


@part
def leave_zeros(band, way_band, rows, values):
    """Zeros again wherever a pass has written; `band` (M, 2) of the first node."""
    nodes, (ways, levels, ring, _) = way_band.shape[0], rows.shape
    rows[:, :, nodes % ring] = 0.0
    for n in range(nodes):
        for w in range(ways):
            if way_band[n, w, 0] < way_band[n, w, 1]:
                for q in range(levels):
                    rows[w, q, n % ring, 0] = 0.0
                    clear(rows[w, q, n % ring], way_band[n, w, 0], way_band[n, w, 1] + EIGHT)
    for m in range(values.shape[0]):
        for q in range(levels):
            clear(values[m, q], band[m, 0], band[m, 1])
