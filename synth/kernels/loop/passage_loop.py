"""Kernel of the closed loop with point sensors: cut, valves, sensors and rule, from event to event.

Motion is as exact as in `motion`: a transient is played as its mean overpressure over equal parts, all
else is closed form. The cut rolls to whatever comes first: a coil, the end of a piece of constant overpressure, or a
pulse pair that is heard later than it was given. Coils lie anywhere in a path cell, so cells and η are those of the
loop with a radar, number for number.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import Floats, Ints
from synth.kernels.compiling import borrowing_inline, kernel, part, part_inline
from synth.kernels.loop.motion import LEFT, MOVING, STALLED, Cells, Path
from synth.kernels.loop.passage_pulses import (
    Heard,
    Memory,
    Pair,
    Pulses,
    cover_coil,
    next_row,
    place_coils,
    pulses_before,
    rows_by_the_clock,
    take_pair,
)
from synth.kernels.loop.passage_regulator import NOT_HEARD, begin_cut, outcome_of, stage_after_pair
from synth.kernels.loop.passes import LONGEST_PASS_S, Draws, Exits
from synth.kernels.loop.trace import note
from tuning_tables.programs.held import HeldPassages

Outcomes = NDArray[np.uint8]

ON_COIL = 3
"""Besides `MOVING`, `LEFT` and `STALLED`: the place has come that the cut was to be followed to."""

WATCHED_FROM_S = -60.0
"""The regulator expects the cut from then on, time 0 being where the pass begins."""

READING_FIELDS = 8
"""Columns of the pulse pairs heard: time, middle of the reading, sensor told, true passage, passage that it was taken
for (−1: none), speed told, what came of it, stage in force afterwards; passages by their number among those heard."""


class PieceDrive(NamedTuple):
    """What the drive plays: pieces of constant overpressure, first the H resting modes, then those of all chains.

    `end_s`: since the second pulse, infinite for resting modes; `after`: the next piece; `command` (H, K + 1): first
    piece of the chain from a mode to a stage, −1 to the stage itself.
    """

    kpa: Floats
    end_s: Floats
    after: Ints
    command: Ints
    initial_mode: int
    initial_stage: int


@borrowing_inline
def roll(
    edges_m: Floats, free: Floats, brake: Floats, overpressure: float, duration_s: float, to_m: float,
    cell: int, s: float, v: float,
) -> Any:  # fmt: skip
    """Move for `duration_s` under constant overpressure, but no farther than `to_m`.

    Returns (cell, s, v, time used, status): `motion.advance` with one more end, `ON_COIL`.
    """
    left = duration_s
    while True:
        a = free[cell] - brake[cell] * overpressure
        edge = edges_m[cell + 1]
        goal = min(edge, to_m)
        gap = max(0.0, goal - s)
        v_end = v + a * left
        x = 0.5 * (v + v_end) * left
        if v_end > 0.0 and x < gap:
            return cell, s + x, v_end, duration_s, MOVING
        square = v * v + 2.0 * a * gap
        if square <= 0.0:
            return cell, s - 0.5 * v * v / a, 0.0, duration_s - left - v / a, STALLED
        v_goal = math.sqrt(square)
        left = max(0.0, left - 2.0 * gap / (v + v_goal))
        v = v_goal
        s = max(s, goal)
        if edge <= to_m:
            cell += 1
            if cell == free.shape[0]:
                return cell, s, v, duration_s - left, LEFT
        if to_m <= edge:
            return cell, s, v, duration_s - left, ON_COIL


@part_inline
def note_pair(seen: Floats, count: int, time_s: float, pair: Pair, taken_for: int, outcome: int, stage: int) -> int:
    """Write one pulse pair, if that is wanted (`seen` not empty); returns the number of pairs."""
    if count < seen.shape[0]:
        seen[count, 0], seen[count, 1] = time_s, time_s - pair.half_s
        seen[count, 2], seen[count, 3], seen[count, 4] = pair.sensor, pair.passage, taken_for
        seen[count, 5], seen[count, 6], seen[count, 7] = pair.read_m_s, outcome, stage
        return count + 1
    return count


@part_inline
def note_outcome(pulses: Pulses, source: int, outcome: int, outcomes: Outcomes) -> None:
    """Keep what came of the first pair heard from a source at which is decided."""
    if source >= 0 and pulses.decides[source] >= 0 and outcomes[pulses.decides[source]] == NOT_HEARD:
        outcomes[pulses.decides[source]] = outcome


@part
def run_passage_pass(
    cells: Cells, drive: PieceDrive, pulses: Pulses, heard: Heard, law: HeldPassages, tracks: bool, start_m_s: float,
    noise_z: NDArray[np.float32], memory: Memory, outcomes: Outcomes, events: Floats, seen: Floats,
) -> Any:  # fmt: skip
    """One pass from where the regulator acts to the exit; returns (v, time, status, switchings, events, pairs).

    `heard`: what of the pulses, (R,) each; `outcomes` (M,): what came of the first pair heard from each source at which
    is decided.
    """
    edges_m, free, brake = cells
    sources, resting = pulses.path_m.shape[0], drive.command.shape[0]
    place_coils(pulses, noise_z, memory)
    begin_cut(memory.state)
    outcomes[:] = NOT_HEARD
    waiting = rows_by_the_clock(pulses, heard, memory)
    coil = pulses_before(edges_m[0], free[0], start_m_s, memory)
    cell, s, v, time, status = 0, edges_m[0], start_m_s, 0.0, MOVING
    piece, stage, begun_s, rests_from_s = drive.initial_mode, drive.initial_stage, 0.0, -math.inf
    switchings, pairs, heard_s = 0, 0, WATCHED_FROM_S
    count = note(events, 0, time, s, v, drive.kpa[piece], stage, math.nan)
    while status == MOVING:
        due_s, at = next_row(waiting, memory)
        piece_ends_s = begun_s + drive.end_s[piece]
        until_s = min(min(piece_ends_s, due_s), LONGEST_PASS_S)
        to_m = memory.place_m[memory.order[coil]] if coil < 2 * sources else math.inf
        # A pair may be told from before the pass began: then the cut does not move until the clock has caught up.
        lasts_s = max(0.0, until_s - time)
        cell, s, v, used, status = roll(edges_m, free, brake, drive.kpa[piece], lasts_s, to_m, cell, s, v)
        if status == LEFT or status == STALLED:
            time += used
        elif status == ON_COIL:
            time, status = time + used, MOVING
            waiting = cover_coil(memory.order[coil], time, noise_z, pulses, heard, waiting, memory)
            coil += 1
        elif until_s == LONGEST_PASS_S:
            time, status = max(time, until_s), STALLED  # it creeps
        elif until_s == piece_ends_s:
            time, piece = max(time, until_s), drive.after[piece]
            if piece < resting:
                rests_from_s = until_s
            count = note(events, count, until_s, s, v, drive.kpa[piece], stage, math.nan)
        else:
            time = max(time, until_s)
            pair, waiting = take_pair(at, waiting, pulses, memory)
            ended = due_s - pair.half_s >= rests_from_s
            wanted, taken_for = stage_after_pair(law, tracks, memory.state, pair, due_s - heard_s, stage, ended)
            heard_s, outcome = due_s, outcome_of(law, taken_for, ended)
            note_outcome(pulses, pair.source, outcome, outcomes)
            if wanted != stage:
                piece, stage, begun_s, rests_from_s = drive.command[piece, wanted], wanted, due_s, math.inf
                switchings += 1
            count = note(events, count, due_s, s, v, drive.kpa[piece], stage, pair.read_m_s)
            pairs = note_pair(seen, pairs, due_s, pair, taken_for, outcome, stage)
    count = note(events, count, time, s, v, drive.kpa[piece], stage, math.nan)
    return v, time, status, switchings, count, pairs


@kernel
def run_passage_passes(
    path: Path, drive: PieceDrive, pulses: Pulses, heard: Heard, law: HeldPassages, tracks: bool, draws: Draws,
    memory: Memory, exits: Exits, outcomes: Outcomes, events: Floats, seen: Floats,
) -> Any:  # fmt: skip
    """Simulate all passes of `draws` into `exits` and `outcomes` (n, M); returns (events, pairs) of the last pass."""
    free, count, pairs = np.empty(path.gravity_m_s2.shape[0]), 0, 0
    alike = heard.after_s.shape[0] == 1
    for i in range(draws.cut_factor.shape[0]):
        drag = path.drag_m_s2_per_n_kn * draws.resistance_n_kn[i]
        for j in range(free.shape[0]):
            free[j] = path.gravity_m_s2[j] - drag
        row = 0 if alike else i
        v, time, status, switchings, count, pairs = run_passage_pass(
            Cells(path.edges_m, free, draws.brake_m_s2_per_kpa[i]), drive, pulses,
            Heard(heard.after_s[row], heard.told_m_s[row]), law, tracks, draws.entry_m_s[i], draws.noise_z[i], memory,
            outcomes[i], events, seen,
        )  # fmt: skip
        exits.stalled[i] = status != LEFT
        exits.speed_m_s[i] = v if status == LEFT else 0.0
        exits.time_s[i] = time
        exits.switchings[i] = switchings
    return count, pairs
