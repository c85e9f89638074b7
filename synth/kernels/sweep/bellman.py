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

from plant_models.frozen_arrays import Floats
from synth.kernels.compiling import kernel, part
from synth.kernels.sweep.chain_arrays import Scenario, change_at
from synth.kernels.sweep.drawn_lines import Drawing, Gains, add_gains, draw_lines
from synth.kernels.sweep.flow import in_every_state, mix_values, pull, shifts
from synth.kernels.sweep.landing_plan import find_runs, landing_scratch, landing_tables
from synth.kernels.sweep.next_sample import quanta_to_next_sample
from synth.kernels.sweep.pass_time import add_change_times, add_quantum_times
from synth.kernels.sweep.transient_sweep import add_transient_values
from synth.kernels.vector.packs import EIGHT, choose, load8, store


class Entrance(NamedTuple):
    """No node below `approach_nodes` raises beyond `stage`."""

    approach_nodes: int
    stage: int


class Rows(NamedTuple):
    """What the states of hidden scenarios are worth, a row of E·T to each mode and level of each scenario.

    `recent`, `mixed` (I, ring, H, L, E·T) at the samples of the last nodes, and before the noise level changes; `ahead`
    (I, M + 1, H, L, E·T) at held stages on the way to a sample; `holds` (I, H, L, E·T) if the stage is held, `changes`
    (I, H, L, C, E·T) by command. `quanta` (I, H, L, E): path to the next sample; `shift` (I, H, L) of energy, in cells.
    """

    recent: NDArray[Any]
    mixed: NDArray[Any]
    ahead: NDArray[Any]
    holds: NDArray[Any]
    changes: NDArray[Any]
    quanta: Floats
    shift: Floats


@kernel
def sweep(chain, scenarios, prior, costs, tolerance, rounding, readings, entrance, values, lines, gain):
    """One backward sweep over all path quanta.

    `costs` of T' ≥ T targets, whole packs of eight; values are computed in the type of the terminal cost. `prior`
    (I, H, L): weights of what is hidden. `tolerance`: an averaged gain of less is none; `rounding`: so is one of less
    than this part of the cost. The rest as in `chain_arrays`.
    Outputs: `values` (I, N + 1, H, L, E, T), or of the first nodes only, `lines` (C, R, K + 1, T) in readings, `gain`
    (C, R, K + 1, T, E): averaged cost saved by the change, by measured speed.
    """
    factor, extra = scenarios
    count, nodes = factor.shape[0], chain.track.drive.shape[0]
    width, kind = costs.stalled.shape[0], costs.terminal.dtype
    commands, decisions, stages, points = lines.shape[0], lines.shape[1], lines.shape[2], chain.grid.speed.shape[0]
    rows = rows_at_exit(chain, costs, count, commands)
    gains = Gains(np.empty((commands, stages, points * width), kind), np.empty((2, stages), np.int64))
    drawing = Drawing(
        np.empty(points + 1), np.empty((commands // 2, points + 1), np.int64),
        np.empty((commands, points * width), kind), np.empty(points, np.bool_),
    )  # fmt: skip
    spent = np.empty(points * width, kind)
    scratch = landing_scratch(chain.landings.ends.shape[4], chain.noise.levels.shape[0], kind)
    met, slope = landing_tables(chain, factor, extra)
    ring = rows.recent.shape[1]
    copy_out(rows.recent[:, nodes % ring], values, nodes, points)
    for n in range(nodes - 1, -1, -1):
        decision, here = chain.decision_at[n], rows.recent[:, n % ring]
        gains.saved[:], gains.possible[:] = 0.0, 0
        for i in range(count):
            scenario = Scenario(factor[i], extra[i], met[i], slope[i])
            hold_everywhere(n, chain, scenario, costs, rows, i, spent)
            if decision < decisions:
                value_changes(n, chain, scenario, costs, rows, i, prior[i], rounding, entrance, scratch, drawing, gains)
        for k in range(stages):
            drawing.undecided[:] = False
            if decision < decisions:
                draw_lines(decision, k, gains, readings, tolerance, spent, drawing, gain, lines)
            decide(k, chain.modes.stage, costs.stalled, drawing, rows, here)
        for i in range(count):
            mix_values(here[i], chain.noise.transition, 1, points, costs.stalled, rows.mixed[i, n % ring])
        copy_out(here, values, n, points)


@kernel
def rows_at_exit(chain, costs, count, commands):
    """What energies at the exit are worth, in every mode and level of `count` scenarios, and memory for all rows."""
    modes, size, points = chain.modes.stage.shape[0], chain.noise.levels.shape[0], chain.grid.speed.shape[0]
    ring, reach = chain.transient_noise.mean.shape[1] + 3, chain.entry.shape[0]
    row, kind, last = points * costs.stalled.shape[0], costs.terminal.dtype, chain.track.drive.shape[0] % ring
    rows = Rows(
        np.zeros((count, ring, modes, size, row), kind), np.zeros((count, ring, modes, size, row), kind),
        np.empty((count, reach, modes, size, row), kind), np.empty((count, modes, size, row), kind),
        np.zeros((count, modes, size, commands, row), kind), np.empty((count, modes, size, points)),
        np.empty((count, modes, size)),
    )  # fmt: skip
    in_every_state(costs.terminal, row, rows.recent[:, last])
    in_every_state(costs.terminal, row, rows.mixed[:, last])
    in_every_state(costs.terminal, row, rows.ahead.reshape(count * reach, modes, size, row))
    return rows


@part
def hold_everywhere(n, chain, scenario, costs, rows, i, scratch):
    """Values of scenario `i` that holds at node `n`, in all modes and levels, into `rows.holds`.

    `rows.ahead` is brought one node back; `rows.quanta` becomes the path to the next sample. `scratch` (E·T,).
    """
    grid, transition, stalled, points = chain.grid, chain.noise.transition, costs.stalled, chain.grid.speed.shape[0]
    ahead, shift, quanta, ring = rows.ahead[i], rows.shift[i], rows.quanta[i], rows.recent.shape[1]
    shifts(n, chain, scenario.factor, scenario.extra, shift)
    for r in range(ahead.shape[0] - 2, 0, -1):
        pull(ahead[r], points, transition, shift, stalled, 1, points, ahead[r + 1], scratch)
    pull(rows.recent[i, (n + 1) % ring], points, transition, shift, stalled, 1, points, ahead[1], scratch)
    add_quantum_times(n, costs.prices, grid, shift, 1, points, ahead, quanta[0, 0])
    for h in range(shift.shape[0]):
        for q in range(shift.shape[1]):
            a = shift[h, q] * grid.energy_step / grid.path_step
            quanta_to_next_sample(grid.speed, 0, points, a, chain.period, grid.path_step, quanta[h, q])
            hold_values(ahead, h * shift.shape[1] + q, quanta[h, q], stalled.shape[0], rows.holds[i, h, q])


@part
def value_changes(n, chain, scenario, costs, rows, i, prior, rounding, entrance, scratch, drawing, gains):
    """Values of scenario `i` after each change of stage at node `n`, into `rows.changes`; what they save, to `gains`.

    `prior` (H, L): weights of the scenario's states. A command that the entrance forbids has no gain, so no line, and
    what `rows.changes` holds of it plays no part.
    """
    grid, landings, stage, decision = chain.grid, chain.landings, chain.modes.stage, chain.decision_at[n]
    points, width = grid.speed.shape[0], costs.stalled.shape[0]
    for command in range(gains.saved.shape[0]):
        side, by = command % 2, command // 2 + 1
        for h in range(stage.shape[0]):
            c = landings.change_chain[command, h]
            if c < 0 or (side == 1 and n < entrance.approach_nodes and stage[h] + by > entrance.stage):
                continue
            gains.possible[side, stage[h]] = by
            found = find_runs(change_at(chain, n, decision, 0, c), 0, points, landings, grid, scenario, scratch)
            for q in range(prior.shape[1]):
                change, changed = change_at(chain, n, decision, q, c), rows.changes[i, h, q, command]
                value_change(
                    change, found, landings.ends, grid, scenario, rows.recent[i], rows.mixed[i], costs, scratch,
                    drawing.best, changed,
                )  # fmt: skip
                saved = gains.saved[command, stage[h]]
                add_gains(rows.holds[i, h, q], changed, prior[h, q], rounding, width, saved)


@part
def decide(k, stage, stalled, drawing, rows, here):
    """Values at a sample in all states of stage `k`, `here` (I, H, L, E·T)."""
    for i in range(here.shape[0]):
        for h in range(here.shape[1]):
            for q in range(here.shape[2] if stage[h] == k else 0):
                sampled_values(
                    drawing.chance, rows.changes[i, h, q], rows.ahead[i, 1, h, q], rows.holds[i, h, q],
                    rows.quanta[i, h, q], drawing.undecided, stalled, here[i, h, q],
                )  # fmt: skip


@part
def value_change(change, count, ends, grid, scenario, values, mixed, costs, scratch, spent, out):
    """`out` (E·T,) = value of a change of stage with what the command and its time cost.

    Arguments as in `transient_sweep` and `pass_time`.
    """
    in_every_cell(costs.prices.command, out)
    add_transient_values(change, count, ends, grid, scenario, values, mixed, costs.stalled, scratch, out)
    add_change_times(change, count, ends, grid, scenario, costs.prices, scratch.runs, spent, out)


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
