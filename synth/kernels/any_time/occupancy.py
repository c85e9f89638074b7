"""Forward density of a fixed policy that decides at every sample, in one scenario (Chapman–Kolmogorov equation).

At a sample the drive is in a mode, the cut at a path node with a level of the path noise. A command leads through a
period of known pressure to a *way*: the few modes that stand for the drive at its end.
"""

from __future__ import annotations

import numpy as np

from synth.kernels.any_time.period import ROOM, NodesAhead, look_ahead, push_period, push_row
from synth.kernels.compiling import kernel, part
from synth.kernels.sweep.flow import add_row, clear, extent, widen
from synth.kernels.vector.normal_packs import normal_cdf8
from synth.kernels.vector.packs import EIGHT, eight, load8, store

DOWN, HOLD, UP = 0, 1, 2
"""Commands at a sample, by their place among the periods of a mode."""

LEAST_CHANCE = 1e-300
"""Of a command that counts: any but 0."""


@kernel
def occupy(policy, chain, factor, extra, heading, here, negligible, keep, met, exits, totals):
    """One forward pass; returns the records of the states that were met if `keep`: those of `met`, or a longer array.

    `factor` (L,) of the friction by level; `extra` acceleration. `heading` (W, L, ring, E') and `here` (M, L, E') are
    zeros, and are left so. Energies of a state beyond which no mass is larger than `negligible` are left out. The rest
    as in `sampled_arrays`.
    Outputs: `met`; `exits` (E,) by energy; `totals` (4,): stalled, escaped, changes down, changes up.
    """
    (lines, reading, noise), (records, band, where, way_band) = policy, met
    (periods, kpa, way, target, share), mixing, motion = chain.periods, chain.mixing, chain.motion
    nodes, modes, levels = lines.shape[1], lines.shape[2], factor.shape[0]
    points, (ways, _, ring, row) = exits.shape[0], heading.shape
    spans = np.zeros((ways, levels, ring, 2), np.int64)
    spans[:, :, :, 0] = points
    moved, scratch = np.zeros((levels, row)), np.zeros((3, row + 2 * ROOM))
    span, chance = np.zeros((modes, 2), np.int64), np.zeros((3, row))
    reach = max(motion.bands.shape[0], chain.entry[0].shape[0])
    ahead = NodesAhead(np.zeros(reach, np.int64), np.zeros(reach), np.zeros(reach))
    used = 0
    totals[:], exits[:] = 0.0, 0.0
    look_ahead(0, extra, motion, ring, ahead)
    enter(chain, factor, ahead, scratch, heading, spans)
    for n in range(nodes):
        look_ahead(n, extra, motion, ring, ahead)
        gather_arrivals(n % ring, points, heading, spans, target, share, here, span, way_band[n], totals)
        for m in range(modes):
            band[n, m] = 0
            if span[m, 0] >= span[m, 1]:
                continue
            first, last = change_levels(here[m], span[m, 0], span[m, 1], points, mixing, negligible, moved)
            span[m] = 0
            band[n, m, 0], band[n, m, 1] = first, last
            chances(lines[0, n, m], lines[1, n, m], reading, 1.0 / noise[n], periods[m], first, last, chance)
            if keep:
                where[n, m], size = used, whole_packs(last - first) * (levels + 2)
                if used + size > records.shape[0]:
                    records = longer(records, used, size)
                keep_record(moved, chance, first, last, records, used)
                used += size
            for command in range(3):
                d = periods[m, command]
                begin, end = extent(chance[command], first, last, LEAST_CHANCE)
                if d < 0 or begin >= end:
                    continue
                for q in range(levels):
                    push_period(
                        ahead, kpa[d] * factor[q], motion, moved[q], chance[command], begin, end, heading[way[d], q],
                        spans[way[d], q], scratch,
                    )  # fmt: skip
                    if command != HOLD:
                        totals[2 + command // 2] += product(moved[q], chance[command], begin, end)
            for q in range(levels):
                totals[1] += abs(moved[q, points - 1]) if last == points else 0.0
    collect_exits(nodes % ring, heading, exits, totals)
    return records


@part
def enter(chain, factor, ahead, scratch, heading, spans):
    """What enters, by path node and energy, heads for its first sample."""
    (entry, entry_way, entry_kpa), points = chain.entry, chain.entry[0].shape[1]
    for r in range(entry.shape[0]):
        for q in range(factor.shape[0]):
            for j in range(points):
                scratch[0, j] = entry[r, j] * chain.stationary[q]
            shift = ahead.free[r] - entry_kpa * factor[q] * ahead.braking[r]
            push_row(scratch[0, 1:points], 1, shift, points, heading[entry_way, q, r], spans[entry_way, q, r])


@part
def collect_exits(slot, heading, exits, totals):
    """Bring what heads for the exit to `exits` (E,), and leave its rows empty."""
    for w in range(heading.shape[0]):
        for q in range(heading.shape[1]):
            row = heading[w, q, slot]
            totals[0] += row[0]
            for j in range(1, exits.shape[0]):
                exits[j] += row[j]
            row[:] = 0.0


@part
def gather_arrivals(slot, points, heading, spans, target, share, here, span, way_band, totals):
    """Bring what heads for this node from ways to modes, `here` (M, L, E'), and leave their rows empty."""
    for w in range(target.shape[0]):
        way_band[w, 0], way_band[w, 1] = points, 0
        for q in range(heading.shape[1]):
            begin, end = spans[w, q, slot]
            if begin >= end:
                continue
            row = heading[w, q, slot]
            totals[0] += row[0]
            row[0] = 0.0
            way_band[w, 0], way_band[w, 1] = min(way_band[w, 0], begin), max(way_band[w, 1], end)
            for b in range(4):
                if share[w, b] != 0.0:
                    m = target[w, b]
                    add_row(row, share[w, b], begin, end, here, (m * heading.shape[1] + q) * here.shape[2])
                    widen(span[m], begin, end)
            clear(row, begin, end + EIGHT)
            spans[w, q, slot, 0], spans[w, q, slot, 1] = points, 0


@part
def change_levels(arrived, begin, end, points, mixing, negligible, out):
    """`out` (L, E'): the mass `arrived` after the level's change at the end of a period, which is emptied.

    Returns the range of energies that matter.
    """
    levels, row = arrived.shape
    begin = max(begin, 1)
    first, last = points, 0
    for q in range(levels):
        for j in range(begin, end, EIGHT):
            found = load8(arrived, j) * load8(mixing, q * row + j)
            for k in range(1, levels):
                found = found + load8(arrived, k * row + j) * load8(mixing, (k * levels + q) * row + j)
            store(out, q * row + j, found)
        a, b = extent(out[q], begin, end, negligible)
        if a < b:
            first, last = min(first, a), max(last, b)
    for q in range(levels):
        clear(arrived[q], begin, end + EIGHT)
    return first, max(first, last)


@part
def chances(lower, upper, reading, scale, periods, first, last, out):
    """`out` (3, E'): probability of every command for first ≤ j < last; of a command that there is not, 0."""
    row = out.shape[1]
    for j in range(first, last, EIGHT):
        read = load8(reading, j)
        down = normal_cdf8((read * -1.0 + lower) * scale) if periods[DOWN] >= 0 else eight(0.0)
        up = normal_cdf8((read - upper) * scale) if periods[UP] >= 0 else eight(0.0)
        store(out, DOWN * row + j, down)
        store(out, HOLD * row + j, down * -1.0 + 1.0 - up)
        store(out, UP * row + j, up)


@part
def product(mass, chance, begin, end):
    """Σ mass·chance over begin ≤ j < end."""
    total = 0.0
    for j in range(begin, end):
        total += mass[j] * chance[j]
    return total


@part
def whole_packs(count):
    """So many numbers, filled up to whole packs."""
    return (count + EIGHT - 1) // EIGHT * EIGHT


@kernel
def longer(records, used, size):
    """The same with room for `size` numbers more."""
    found = np.empty(max(2 * records.shape[0], used + size))
    for j in range(used):
        found[j] = records[j]
    return found


@part
def keep_record(moved, chance, first, last, records, at):
    """Write density and chances from flat index `at` on; the density behind `last` is 0."""
    levels, width = moved.shape[0], whole_packs(last - first)
    for j in range(0, width, EIGHT):
        for q in range(levels):
            store(records, at + q * width + j, load8(moved[q], first + j))
        store(records, at + levels * width + j, load8(chance[DOWN], first + j))
        store(records, at + (levels + 1) * width + j, load8(chance[UP], first + j))
    for q in range(levels):
        for j in range(last - first, width):
            records[at + q * width + j] = 0.0
