"""Backward induction: one common policy of switching lines for all hidden scenarios, for several targets at once.

At every path node and stage the gain of a change over holding is averaged over what the regulator does not
see (scenario, noise level, resting pressure) and over the error of the measured speed; the switching line is
the threshold with the largest total gain beyond it, so islands in the map of best commands cannot tear it.
Targets share the motion; they differ in the terminal cost and so in values and lines, and stand side by
side in memory.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import Floats, Ints
from synth.kernels.compiling import kernel, part
from synth.kernels.sweep.chain_arrays import Scenario, change_at
from synth.kernels.sweep.commands import normal_cdf
from synth.kernels.sweep.flow import in_every_state, mix_values, pull, shifts
from synth.kernels.sweep.landing_plan import find_runs, landing_scratch, landing_tables
from synth.kernels.sweep.next_sample import quanta_to_next_sample
from synth.kernels.sweep.pass_time import add_change_times, add_quantum_times
from synth.kernels.sweep.thresholds import find_lines
from synth.kernels.sweep.transient_sweep import add_transient_values
from synth.kernels.vector.packs import EIGHT, choose, load8, magnitude, store


class Readings(NamedTuple):
    """`reading` (E,): what is measured of the speeds, with errors of std `noise`; `heard` (R, T): probability that
    there is one at a decision, else the stage is held.

    `smear_start` (E,), `smear` (E, W): probability of true speeds given a measured one.
    """

    reading: Floats
    noise: float
    heard: Floats
    smear_start: Ints
    smear: NDArray[Any]


class Entrance(NamedTuple):
    """No node below `approach_nodes` raises beyond `stage`."""

    approach_nodes: int
    stage: int


@kernel
def sweep(chain, scenarios, prior, costs, tolerance, rounding, readings, entrance, values, lines, gain):
    """One backward sweep over all path quanta.

    `costs` of T' ≥ T targets, whole packs of eight; values are computed in the type of the terminal cost. `prior`
    (I, H, L): weights of what is hidden. `tolerance`: an averaged gain of less is none; `rounding`: so is one of less
    than this part of the cost. The rest as in `chain_arrays`.
    Outputs: `values` (I, N + 1, H, L, E, T), or of the first nodes only, `lines` (C, R, K + 1, T) in readings, `gain`
    (C, R, K + 1, T, E): averaged cost saved by the change, by measured speed.
    """
    terminal, stalled, prices = costs
    factor, extra = scenarios
    grid, landings, stage, transition = chain.grid, chain.landings, chain.modes.stage, chain.noise.transition
    count, nodes, width = factor.shape[0], chain.track.drive.shape[0], stalled.shape[0]
    modes, size, points = stage.shape[0], transition.shape[0], grid.speed.shape[0]
    commands, decisions, stages, reach = lines.shape[0], lines.shape[1], lines.shape[2], chain.entry.shape[0]
    ring, row, kind = chain.transient_noise.mean.shape[1] + 3, points * width, terminal.dtype
    recent, mixed = np.zeros((count, ring, modes, size, row), kind), np.zeros((count, ring, modes, size, row), kind)
    ahead, holds = np.empty((count, reach, modes, size, row), kind), np.empty((count, modes, size, row), kind)
    changes = np.zeros((count, modes, size, commands, row), kind)
    quanta, shift = np.empty((count, modes, size, points)), np.empty((count, modes, size))
    gains, chance = np.empty((commands, stages, row), kind), np.empty((commands, row), kind)
    best, chosen = np.empty(points + 1), np.empty((commands // 2, points + 1), np.int64)
    possible, undecided = np.empty((2, stages), np.int64), np.empty(points, np.bool_)
    spent, scratch = np.empty(row, kind), landing_scratch(landings.ends.shape[4], size, kind)
    met, slope = landing_tables(chain, factor, extra)
    in_every_state(terminal, row, recent[:, nodes % ring])
    in_every_state(terminal, row, mixed[:, nodes % ring])
    in_every_state(terminal, row, ahead.reshape(count * reach, modes, size, row))
    copy_out(recent[:, nodes % ring], values, nodes, points)
    for n in range(nodes - 1, -1, -1):
        decision = chain.decision_at[n]
        gains[:], possible[:] = 0.0, 0
        for i in range(count):
            scenario = Scenario(factor[i], extra[i], met[i], slope[i])
            shifts(n, chain, factor[i], extra[i], shift[i])
            following = recent[i, (n + 1) % ring]
            hold_everywhere(n, chain, stalled, prices, following, shift[i], ahead[i], quanta[i], holds[i], spent)
            for command in range(commands if decision < decisions else 0):
                side, by = command % 2, command // 2 + 1
                for h in range(modes):
                    c = landings.change_chain[command, h]
                    if c < 0 or (side == 1 and n < entrance.approach_nodes and stage[h] + by > entrance.stage):
                        continue  # no gain, so no line, and what `changes` holds plays no part
                    possible[side, stage[h]] = by
                    found = find_runs(change_at(chain, n, decision, 0, c), 0, points, landings, grid, scenario, scratch)
                    for q in range(size):
                        change, changed = change_at(chain, n, decision, q, c), changes[i, h, q, command]
                        value_change(
                            change, found, landings.ends, grid, scenario, recent[i], mixed[i], stalled, prices,
                            scratch, best, changed,
                        )  # fmt: skip
                        add_gains(holds[i, h, q], changed, prior[i, h, q], rounding, width, gains[command, stage[h]])
        for k in range(stages):
            undecided[:] = False
            if decision < decisions:
                for command in range(commands):
                    spread(gains[command, k], readings.smear_start, readings.smear, width, spent)
                    apart(spent, width, gain[command, decision, k])
                find_lines(
                    gain[:, decision, k], possible[:, k], readings.reading, tolerance, best, chosen,
                    lines[:, decision, k],
                )  # fmt: skip
                command_chances(lines[:, decision, k], readings, decision, width, chance, undecided)
            for i in range(count):
                for h in range(modes):
                    for q in range(size if stage[h] == k else 0):
                        sampled_values(
                            chance, changes[i, h, q], ahead[i, 1, h, q], holds[i, h, q],
                            quanta[i, h, q], undecided, stalled, recent[i, n % ring, h, q],
                        )  # fmt: skip
        for i in range(count):
            mix_values(recent[i, n % ring], transition, 1, points, stalled, mixed[i, n % ring])
        copy_out(recent[:, n % ring], values, n, points)


@part
def hold_everywhere(n, chain, stalled, prices, following, shift, ahead, quanta, holds, scratch):
    """Values of one scenario that holds at a node, in all modes and levels, into `holds` (H, L, E·T).

    `following` (H, L, E·T): at the next node; `ahead` (M + 1, H, L, E·T) on the way to later samples is brought one
    node back; `quanta` (H, L, E) becomes the path to the next sample.
    """
    modes, size, points = quanta.shape
    grid, transition = chain.grid, chain.noise.transition
    for r in range(ahead.shape[0] - 2, 0, -1):
        pull(ahead[r], points, transition, shift, stalled, 1, points, ahead[r + 1], scratch)
    pull(following, points, transition, shift, stalled, 1, points, ahead[1], scratch)
    add_quantum_times(n, prices, grid, shift, 1, points, ahead, quanta[0, 0])
    for h in range(modes):
        for q in range(size):
            a = shift[h, q] * grid.energy_step / grid.path_step
            quanta_to_next_sample(grid.speed, 0, points, a, chain.period, grid.path_step, quanta[h, q])
            hold_values(ahead, h * size + q, quanta[h, q], stalled.shape[0], holds[h, q])


@part
def value_change(change, count, ends, grid, scenario, values, mixed, stalled, prices, scratch, spent, out):
    """`out` (E·T,) = value of a change of stage with what the command and its time cost.

    Arguments as in `transient_sweep` and `pass_time`.
    """
    in_every_cell(prices.command, out)
    add_transient_values(change, count, ends, grid, scenario, values, mixed, stalled, scratch, out)
    add_change_times(change, count, ends, grid, scenario, prices, scratch.runs, spent, out)


@part
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


@part
def in_every_cell(numbers, out):
    """`out` (E·T,) = `numbers` (T,) at every energy."""
    width = numbers.shape[0]
    for at in range(0, out.shape[0], width):
        for t in range(0, width, EIGHT):
            store(out, at + t, load8(numbers, t))


@part
def add_gains(hold, changed, weight, rounding, width, gain):
    """Add the cost saved by a change, times `weight`, to `gain` (E·T,).

    What is less than the part `rounding` of the cost itself may be saved by rounding alone, and is not added.
    """
    for at in range(width, gain.shape[0], EIGHT):
        cost = load8(hold, at)
        saved = cost - load8(changed, at)
        counted = choose(magnitude(saved) > cost * rounding, saved, 0.0)
        store(gain, at, load8(gain, at) + counted * weight)


@part
def spread(gain, start, weights, width, out):
    """`out` (E·T,) = `gain` averaged over the true speeds behind every measured speed."""
    for j in range(start.shape[0]):
        for t in range(0, width, EIGHT):
            found = load8(gain, start[j] * width + t) * weights[j, 0]
            for m in range(1, weights.shape[1]):
                found = found + load8(gain, (start[j] + m) * width + t) * weights[j, m]
            store(out, j * width + t, found)


@part
def apart(row, width, out):
    """`row` (E·T,), with targets padded, as `out` (T, E)."""
    for t in range(out.shape[0]):
        for j in range(out.shape[1]):
            out[t, j] = row[j * width + t]


@part
def command_chances(lines, readings, decision, width, out, undecided):
    """Probability of each command at every true speed and target, `out` (C, E·T); `lines` (C, T) in readings.

    `undecided` (E,): whether any target may get another command than holding.
    """
    reading, noise, heard = readings.reading, readings.noise, readings.heard[decision]
    out[:] = 0.0
    for j in range(reading.shape[0]):
        undecided[j] = False
        for t in range(lines.shape[1]):
            further_down, further_up = 0.0, 0.0
            for command in range(lines.shape[0] - 2, -1, -2):
                down = normal_cdf((lines[command, t] - reading[j]) / noise)
                up = normal_cdf((reading[j] - lines[command + 1, t]) / noise)
                out[command, j * width + t] = (down - further_down) * heard[t]
                out[command + 1, j * width + t] = (up - further_up) * heard[t]
                further_down, further_up = down, up
            undecided[j] = undecided[j] or (heard[t] > 0.0 and (further_down > 0.0 or further_up > 0.0))


@part
def sampled_values(chance, changes, value_next, value_hold, quanta, undecided, stalled, out):
    """Values at a sample (E·T,), of `changes` (C, E·T) commanded with the chances of `command_chances`.

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
            change = load8(chance, at)
            changed, held = change * load8(changes, at), load8(value_hold, at)
            for other in range(at + row, chance.shape[0] * row, row):
                changed = changed + load8(chance, other) * load8(changes, other)
                change = change + load8(chance, other)
            hold = 1.0 - change
            if f < 1.0:
                sampled = (hold * f * load8(value_next, at) + changed) / (1.0 - hold * (1.0 - f))
            else:
                sampled = hold * held + changed
            # A target that is decided has the value of holding to the bit, whatever its neighbours have.
            store(out, at, choose(change > 0.0, sampled, held))


@part
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
