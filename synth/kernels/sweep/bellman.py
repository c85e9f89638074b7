"""Backward induction: one common policy of switching lines for all hidden scenarios, for several targets at once.

At every path node and stage the gain of a change over holding is averaged over what the regulator does not
see (scenario, noise level, resting pressure) and over the error of the measured speed; the switching line is
the threshold with the largest total gain beyond it, so islands in the map of best commands cannot tear it.
Targets share the motion; they differ in the terminal cost and so in values and lines, and stand side by
side in memory.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from synth.kernels.sweep.commands import normal_cdf
from synth.kernels.sweep.flow import mix_values, pull, shifts
from synth.kernels.sweep.landing_plan import find_runs, landing_scratch, landing_tables
from synth.kernels.sweep.next_sample import quanta_to_next_sample
from synth.kernels.sweep.thresholds import lower_threshold, upper_threshold
from synth.kernels.sweep.transient_sweep import add_transient_values
from synth.kernels.vector.borrowing import borrowing
from synth.kernels.vector.packs import EIGHT, choose, load8, magnitude, store


@njit(cache=True, nogil=True, error_model="numpy")
def sweep(
    terminal, stalled, change_cost, tolerance, rounding, noise, smear_start, smear, prior,
    speed, stage, pressure, lower_chain, upper_chain, chain_mode,
    ends, factors, probability, mean, std, levels, transition,
    drive, brake, factor, extra, path_step, energy_step, period, reach, approach_nodes, entrance_stage,
    values, lower, upper, gain_down, gain_up,
):  # fmt: skip
    """One backward sweep over all path quanta.

    `terminal` (E·T',) cost by exit energy and target, `stalled` (T',) cost of a stall, `change_cost` (T',) of a
    command, where T' ≥ T are whole packs of eight; values are computed in the type of `terminal`. `tolerance`: an
    averaged gain of less is none; `rounding`: so is one of less than this part of the cost. I scenarios: `factor`,
    `extra` (I,); `prior` (I, H, L) weights of what is hidden; `smear_start` (E,), `smear` (E, W): probability of true
    speeds given a measured one. No node below `approach_nodes` raises beyond `entrance_stage`. Outputs: `values`
    (I, N + 1, H, L, E, T), or of the first nodes only, `lower`, `upper` (N, K + 1, T), `gain_down`, `gain_up`
    (N, K + 1, T, E): averaged cost saved by the change, by measured speed.
    """
    count, nodes, width = factor.shape[0], drive.shape[0], stalled.shape[0]
    modes, size, points = pressure.shape[0], levels.shape[0], speed.shape[0]
    ring = probability.shape[1] + 3
    row, kind = points * width, terminal.dtype
    recent = np.zeros((count, ring, modes, size, row), kind)
    mixed = np.zeros((count, ring, modes, size, row), kind)
    ahead = np.empty((count, reach, modes, size, row), kind)
    holds = np.empty((count, modes, size, row), kind)
    changes = np.zeros((2, count, modes, size, row), kind)
    quanta = np.empty((count, modes, size, points))
    shift = np.empty((count, modes, size))
    gains = np.empty((2, lower.shape[1], row), kind)
    chance = np.empty((2, row), kind)
    undecided = np.empty(points, np.bool_)
    scratch = np.empty(row, kind)
    crossed, runs, place, weight = landing_scratch(ends.shape[4], size, kind)
    met, slope = landing_tables(
        factor, extra, factors, probability, mean, std, levels, pressure, drive, brake, path_step
    )
    recent[:, nodes % ring] = terminal
    mixed[:, nodes % ring] = terminal
    ahead[:, 1:] = terminal
    copy_out(recent[:, nodes % ring], values, nodes, points)
    for n in range(nodes - 1, -1, -1):
        gains[:] = 0.0
        for i in range(count):
            shifts(n, factor[i], levels, drive, brake, pressure, extra[i], path_step, energy_step, shift[i])
            for r in range(reach - 2, 0, -1):
                pull(ahead[i, r], points, transition, shift[i], stalled, 1, points, ahead[i, r + 1], scratch)
            pull(recent[i, (n + 1) % ring], points, transition, shift[i], stalled, 1, points, ahead[i, 1], scratch)
            for h in range(modes):
                for q in range(size):
                    a = shift[i, h, q] * energy_step / path_step
                    quanta_to_next_sample(speed, 0, points, a, period, path_step, quanta[i, h, q])
                    hold_values(ahead[i], h * size + q, quanta[i, h, q], width, holds[i, h, q])
            for side in range(2):
                for h in range(modes):
                    c = upper_chain[h] if side == 1 else lower_chain[h]
                    if c < 0 or (side == 1 and n < approach_nodes and stage[h] >= entrance_stage):
                        continue  # no gain, so no line, and what `changes` holds plays no part
                    found = find_runs(
                        n, c, 0, points, factor[i], ends, factors, path_step, probability.shape[1] - 1, crossed, runs
                    )
                    for q in range(size):
                        changed = changes[side, i, h, q]
                        in_every_cell(change_cost, changed)
                        add_transient_values(
                            n, nodes, c, q, runs, found, chain_mode[c], ends, met[i], slope[i],
                            extra[i], path_step, energy_step,
                            recent[i], mixed[i], stalled, place, weight, changed,
                        )  # fmt: skip
                        add_gains(holds[i, h, q], changed, prior[i, h, q], rounding, width, gains[side, stage[h]])
        for k in range(lower.shape[1]):
            for side, each in ((0, gain_down), (1, gain_up)):
                spread(gains[side, k], smear_start, smear, width, scratch)
                apart(scratch, width, each[n, k])
            for t in range(lower.shape[2]):
                lower[n, k, t] = lower_threshold(gain_down[n, k, t], speed, tolerance)
                upper[n, k, t] = max(upper_threshold(gain_up[n, k, t], speed, tolerance), lower[n, k, t])
            command_chances(lower[n, k], upper[n, k], speed, noise, width, chance, undecided)
            for h in range(modes):
                if stage[h] != k:
                    continue
                for i in range(count):
                    for q in range(size):
                        sampled_values(
                            chance, changes[0, i, h, q], changes[1, i, h, q], ahead[i, 1, h, q], holds[i, h, q],
                            quanta[i, h, q], undecided, stalled, recent[i, n % ring, h, q],
                        )  # fmt: skip
        for i in range(count):
            mix_values(recent[i, n % ring], transition, 1, points, stalled, mixed[i, n % ring])
        copy_out(recent[:, n % ring], values, n, points)


@borrowing
def hold_values(ahead, state, quanta, width, out):
    """Value of holding until the next sample, `quanta` (E,) further, into `out` (E·T,).

    `ahead` (M + 1, H, L, E·T), of which the mode and level at flat index `state`. Where the next sample falls into the
    same quantum, holding means going on to the next node.
    """
    last = ahead.shape[0] - 2
    row = ahead.shape[3]
    stride = ahead.shape[1] * ahead.shape[2] * row
    for j in range(quanta.shape[0]):
        step = min(int(quanta[j]), last)
        near = max(step, 1) * stride + state * row
        x = min(quanta[j] - step, 1.0)
        for at in range(j * width, (j + 1) * width, EIGHT):
            if step == 0:
                store(out, at, load8(ahead, near + at))
            else:
                store(out, at, load8(ahead, near + at) * (1.0 - x) + load8(ahead, near + stride + at) * x)


@borrowing
def in_every_cell(numbers, out):
    """`out` (E·T,) = `numbers` (T,) at every energy."""
    width = numbers.shape[0]
    for at in range(0, out.shape[0], width):
        for t in range(0, width, EIGHT):
            store(out, at + t, load8(numbers, t))


@borrowing
def add_gains(hold, changed, weight, rounding, width, gain):
    """Add the cost saved by a change, times `weight`, to `gain` (E·T,).

    What is less than the part `rounding` of the cost itself may be saved by rounding alone, and is not added.
    """
    for at in range(width, gain.shape[0], EIGHT):
        cost = load8(hold, at)
        saved = cost - load8(changed, at)
        counted = choose(magnitude(saved) > cost * rounding, saved, 0.0)
        store(gain, at, load8(gain, at) + counted * weight)


@borrowing
def spread(gain, start, weights, width, out):
    """`out` (E·T,) = `gain` averaged over the true speeds behind every measured speed."""
    for j in range(start.shape[0]):
        for t in range(0, width, EIGHT):
            found = load8(gain, start[j] * width + t) * weights[j, 0]
            for m in range(1, weights.shape[1]):
                found = found + load8(gain, (start[j] + m) * width + t) * weights[j, m]
            store(out, j * width + t, found)


@borrowing
def apart(row, width, out):
    """`row` (E·T,), with targets padded, as `out` (T, E)."""
    for t in range(out.shape[0]):
        for j in range(out.shape[1]):
            out[t, j] = row[j * width + t]


@borrowing
def command_chances(lower, upper, speed, noise, width, out, undecided):
    """P(down), P(up) at every true speed and target, `out` (2, E·T); lines `lower`, `upper` (T,).

    `undecided` (E,): whether any target may get another command than holding.
    """
    out[:] = 0.0
    for j in range(speed.shape[0]):
        undecided[j] = False
        for t in range(lower.shape[0]):
            down = normal_cdf((lower[t] - speed[j]) / noise)
            up = normal_cdf((speed[j] - upper[t]) / noise)
            out[0, j * width + t], out[1, j * width + t] = down, up
            undecided[j] = undecided[j] or down > 0.0 or up > 0.0


@borrowing
def sampled_values(chance, down, up, value_next, value_hold, quanta, undecided, stalled, out):
    """Values at a sample (E·T,), of commands given with the chances (2, E·T) of `command_chances`.

    Where the next sample may be at this node again, the geometric series is summed. `undecided` (E,): elsewhere the
    command is to hold.
    """
    width, row = stalled.shape[0], out.shape[0]
    for t in range(0, width, EIGHT):
        store(out, t, load8(stalled, t))
    for j in range(1, quanta.shape[0]):
        f = quanta[j]
        for at in range(j * width, (j + 1) * width, EIGHT):
            if not undecided[j]:
                store(out, at, load8(value_hold, at))
                continue
            lowers, raises = load8(chance, at), load8(chance, row + at)
            changed = lowers * load8(down, at) + raises * load8(up, at)
            change, held = lowers + raises, load8(value_hold, at)
            hold = 1.0 - change
            if f < 1.0:
                sampled = (hold * f * load8(value_next, at) + changed) / (1.0 - hold * (1.0 - f))
            else:
                sampled = hold * held + changed
            # A target that is decided has the value of holding to the bit, whatever its neighbours have.
            store(out, at, choose(change > 0.0, sampled, held))


@borrowing
def copy_out(rows, values, n, points):
    """Node `n` of `values` (I, ·, H, L, E, T), if it is kept, from `rows` (I, H, L, E·T'), whose targets are padded."""
    if n >= values.shape[1]:
        return
    width = rows.shape[3] // points
    for i in range(rows.shape[0]):
        for h in range(rows.shape[1]):
            for q in range(rows.shape[2]):
                for j in range(points):
                    for t in range(values.shape[5]):
                        values[i, n, h, q, j, t] = rows[i, h, q, j * width + t]
