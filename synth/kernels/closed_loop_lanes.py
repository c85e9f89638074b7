"""Kernel of the closed loop for many passes: lanes that move in step, bit for bit what `kernels.closed_loop` computes.

One pass is a chain of roots and divisions, each waiting for the one before, with branches that no processor foretells.
So `LANES` passes move side by side, one piece of motion a turn: to the edge of the path cell or to the end of a piece
of constant overpressure, whichever comes first. A lane whose pass has ended takes the next one. What each pass does
does not depend on its neighbours.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from synth.kernels.borrowing import borrowing, borrowing_inline
from synth.kernels.closed_loop import LONGEST_PASS_S, Draws, Exits, Path
from synth.kernels.regulator import Rule, Sensor, measure, speaks, stage_by_lines, table_decision

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Orders = NDArray[np.int32]

LANES = 64
"""Passes side by side: enough to hide what one waits for."""

FLOATS, INTS = 10, 8
# Where a lane keeps what, in flat arrays: constant distances let the compiler see that lanes do not overlap.
S, V, LEFT_S, ACCELERATION, EDGE_M, DRAG, KPA, FIRST_S, OUTCOME, MEASURED = range(0, FLOATS * LANES, LANES)
CELL, ROW, PIECE, SAMPLE, NEXT, STAGE, SWITCHINGS, PASS = range(0, INTS * LANES, LANES)

STALLS, ENDS, CROSSES = 0, 1, 2
"""Outcomes of a turn: the cut stops, the piece is over, or the cell is."""

MOTION_FIELDS, ORDER_FIELDS = 2, 3
AHEAD, REST, OFFSET = range(ORDER_FIELDS)


class Pieces(NamedTuple):
    """Pieces of constant overpressure, one after the other: what the drive plays (P of them, tables flat, by piece).

    Piece 0 is before the first sample; a resting mode is one piece of a sampling period that is followed by itself, a
    chain several that end in a resting mode. `motion` (P · 2): overpressure and duration, that of piece 0 noted as 0;
    `start_s` (P,) since the sample that it begins in. `order` (P · 3): what to add for the piece that follows; 1 + mode
    at rest, 0 within a chain; samples since the chain began.
    `command` and `samples` (modes, K + 1): first piece and length of the chain to a stage.
    """

    motion: Floats
    start_s: Floats
    order: Orders
    command: Ints
    samples: Ints


class Work(NamedTuple):
    """Memory of the lanes: `floats` (FLOATS · LANES,), `ints` (INTS · LANES,), `waiting` (LANES + 1,)."""

    floats: Floats
    ints: Ints
    waiting: Ints


@borrowing_inline
def accelerate(
    x: Floats, n: Ints, active: int, edges_m: Floats, gravity_m_s2: Floats, brake_m_s2_per_kpa: Floats
) -> None:
    """Acceleration and end of the cell that each lane is in; the brake's row begins at ROW."""
    for lane in range(active):
        cell = n[CELL + lane]
        brake = brake_m_s2_per_kpa[np.uint64(n[ROW + lane] + cell)]
        x[ACCELERATION + lane] = (gravity_m_s2[np.uint64(cell)] - x[DRAG + lane]) - brake * x[KPA + lane]
        x[EDGE_M + lane] = edges_m[np.uint64(cell + 1)]


@borrowing_inline
def move(x: Floats, active: int) -> None:
    """Move each lane by one turn of `closed_loop.advance`; one that stalls is left as it is.

    Without a branch, so that it runs in vector registers.
    """
    for lane in range(active):
        s, v, left, a = x[S + lane], x[V + lane], x[LEFT_S + lane], x[ACCELERATION + lane]
        gap = x[EDGE_M + lane] - s
        v_end = v + a * left
        path = 0.5 * (v + v_end) * left
        ends = (v_end > 0.0) & (path < gap)
        square = v * v + 2.0 * a * gap
        crosses = (not ends) & (square > 0.0)
        v_edge = math.sqrt(square if square > 0.0 else 0.0)
        later = left - 2.0 * gap / (v + v_edge)
        later = later if later > 0.0 else 0.0
        x[S + lane] = (s + path) if ends else (x[EDGE_M + lane] if crosses else s)
        x[V + lane] = v_end if ends else (v_edge if crosses else v)
        x[LEFT_S + lane] = 0.0 if ends else (later if crosses else left)
        x[OUTCOME + lane] = ENDS if ends else (CROSSES if crosses else STALLS)


@borrowing_inline
def follow_on(x: Floats, n: Ints, active: int, cells: int, motion: Floats, order: Orders, waiting: Ints) -> int:
    """Next cell or next piece of each lane; returns how many lanes wait, those in `waiting`, to be looked at.

    A lane waits at a sample at rest, at the exit and where it stalls. By arithmetic, for the
    processor could not foretell the branches.
    """
    count = 0
    for lane in range(active):
        outcome = int(x[OUTCOME + lane])
        ended, cell, piece = outcome & ENDS, n[CELL + lane] + (outcome >> 1), n[PIECE + lane]
        piece += ended * order[np.uint64(piece * ORDER_FIELDS + AHEAD)]
        n[CELL + lane], n[PIECE + lane] = cell, piece
        x[KPA + lane] = motion[np.uint64(piece * MOTION_FIELDS)]
        x[LEFT_S + lane] += motion[np.uint64(ended * piece * MOTION_FIELDS + 1)]  # of piece 0 unless ended
        decides = ended * order[np.uint64(piece * ORDER_FIELDS + REST)] != 0
        waiting[np.uint64(count)] = lane
        count += int(decides) | int(outcome == STALLS) | int(cell == cells)
    return count


@borrowing_inline
def observe(x: Floats, n: Ints, waiting: Ints, count: int, sensor: Sensor, noise_z: NDArray[np.float32]) -> None:
    """Number of the sample and measured speed of each lane that waits; harmless where a pass has ended.

    Apart from the decision, so that one lane's division need not wait for another's branch.
    """
    for k in range(count):
        lane = waiting[np.uint64(k)]
        rests = int(x[OUTCOME + lane] == ENDS)
        n[SAMPLE + lane] += rests * (n[NEXT + lane] - n[SAMPLE + lane])
        n[NEXT + lane] += rests
        sample = max(n[SAMPLE + lane], 0)
        if sample >= noise_z.shape[1]:
            sample %= noise_z.shape[1]
        z = noise_z[np.uint64(n[PASS + lane]), np.uint64(sample)]
        x[MEASURED + lane] = measure(x[V + lane], z, sensor)


@borrowing_inline
def regulate(x: Floats, n: Ints, lane: int, pieces: Pieces, law: Rule) -> None:
    """What the regulator does with a measured speed at rest (as in `closed_loop.run_pass`)."""
    s, measured, stage = x[S + lane], x[MEASURED + lane], n[STAGE + lane]
    wanted, top = stage, pieces.command.shape[1] - 1
    if law.coefficients.shape[0] > 0:
        # The rule itself is only asked where it has a command to give: its branches are dear.
        if speaks(law.coefficients, law.has_line, law.valid, stage, s, measured):
            decision = table_decision(law.coefficients, law.has_line, law.valid, stage, s, measured)
            wanted = min(max(stage + decision, 0), top)
    else:
        wanted = stage_by_lines(law.lower, law.upper, law.spacing_m, law.multi_step, stage, top, s, measured)
    if wanted != stage:
        rest = pieces.order[np.uint64(n[PIECE + lane] * ORDER_FIELDS + REST)]
        mode, to = np.uint64(rest - 1), np.uint64(wanted)
        first = pieces.command[mode, to]
        n[NEXT + lane] = n[SAMPLE + lane] + pieces.samples[mode, to]
        n[STAGE + lane], n[PIECE + lane] = wanted, first
        n[SWITCHINGS + lane] += 1
        x[KPA + lane] = pieces.motion[first * MOTION_FIELDS]
        x[LEFT_S + lane] = pieces.motion[first * MOTION_FIELDS + 1]


@borrowing_inline
def begin(x: Floats, n: Ints, lane: int, i: int, path: Path, pieces: Pieces, draws: Draws) -> None:
    """Pass `i` enters, released, on `lane`; its sample −1 lasts until the first."""
    x[S + lane], x[V + lane] = 0.0, draws.entry_m_s[i]
    x[LEFT_S + lane], x[FIRST_S + lane] = draws.first_sample_s[i], draws.first_sample_s[i]
    x[DRAG + lane] = path.drag_m_s2_per_n_kn * draws.resistance_n_kn[i]
    x[KPA + lane] = pieces.motion[0]
    n[CELL + lane], n[ROW + lane], n[PASS + lane] = 0, i * path.gravity_m_s2.shape[0], i
    n[PIECE + lane], n[SAMPLE + lane], n[NEXT + lane], n[STAGE + lane], n[SWITCHINGS + lane] = 0, -1, 0, 0, 0


@borrowing_inline
def record(x: Floats, n: Ints, lane: int, cells: int, period_s: float, pieces: Pieces, exits: Exits) -> None:
    """Write down how the pass on `lane` has ended: at the exit, by a stall, or by taking too long."""
    i, piece, left = n[PASS + lane], n[PIECE + lane], x[LEFT_S + lane]
    started, lasts = 0.0, x[FIRST_S + lane]
    if piece > 0:
        sample = n[SAMPLE + lane] + pieces.order[piece * ORDER_FIELDS + OFFSET]
        started = x[FIRST_S + lane] + sample * period_s + pieces.start_s[piece]
        lasts = pieces.motion[piece * MOTION_FIELDS + 1]
    leaves = n[CELL + lane] == cells
    used = lasts - left
    if x[OUTCOME + lane] == STALLS:
        used = lasts - left - x[V + lane] / x[ACCELERATION + lane]
    exits.speed_m_s[i] = x[V + lane] if leaves else 0.0
    exits.time_s[i] = started + used
    exits.stalled[i] = not leaves
    exits.switchings[i] = n[SWITCHINGS + lane]


@borrowing
def run_lanes(path: Path, pieces: Pieces, sensor: Sensor, law: Rule, draws: Draws, exits: Exits, work: Work) -> None:
    """Simulate all passes of `draws` into `exits`; the law must be without estimator and lead."""
    x, n, waiting = work
    edges_m, gravity, brake = path.edges_m, path.gravity_m_s2, draws.brake_m_s2_per_kpa.reshape(-1)
    cells, passes = gravity.shape[0], draws.cut_factor.shape[0]
    active, longest = min(LANES, passes), int(LONGEST_PASS_S / sensor.period_s)
    for lane in range(active):
        begin(x, n, lane, lane, path, pieces, draws)
    following = active
    while active > 0:
        accelerate(x, n, active, edges_m, gravity, brake)
        move(x, active)
        count = follow_on(x, n, active, cells, pieces.motion, pieces.order, waiting)
        observe(x, n, waiting, count, sensor, draws.noise_z)
        # From the last lane down: it may be moved into one that falls idle.
        for k in range(count - 1, -1, -1):
            lane = waiting[np.uint64(k)]
            if x[OUTCOME + lane] == ENDS and n[SAMPLE + lane] < longest:
                regulate(x, n, lane, pieces, law)
                continue
            record(x, n, lane, cells, sensor.period_s, pieces, exits)
            if following < passes:
                begin(x, n, lane, following, path, pieces, draws)
                following += 1
            else:
                active -= 1
                for field in range(FLOATS):
                    x[field * LANES + lane] = x[field * LANES + active]
                for field in range(INTS):
                    n[field * LANES + lane] = n[field * LANES + active]
