"""Kernel of the closed loop: passes that move side by side, on lanes, in step.

One pass is a chain of roots and divisions, each waiting for the one before, with branches that no processor foretells.
So `LANES` passes move side by side, one piece of motion a turn: to the edge of the path cell or to the end of a piece
of constant overpressure, whichever comes first. A lane whose pass has ended takes the next one. What each pass does
does not depend on its neighbours; a pass alone, of which a trace may be wanted, has one lane.

What the regulator measures and wants is in `lane_regulator`.
"""

from __future__ import annotations

import math
from typing import Any

from plant_models.frozen_arrays import Floats, Ints
from synth.kernels.compiling import borrowing, part_inline
from synth.kernels.loop.drive import Pieces
from synth.kernels.loop.lane_estimator import Observed
from synth.kernels.loop.lane_places import (
    BEFORE,
    CELL,
    DRAG,
    FIRST_S,
    FLOATS,
    INTS,
    LANES,
    LEFT_S,
    NUMBER,
    PASS,
    PIECE,
    PLACES,
    ROW,
    SAMPLE,
    SLOPE,
    STAGE,
    SWITCHINGS,
    S,
    V,
    Work,
)
from synth.kernels.loop.lane_regulator import listen, regulate
from synth.kernels.loop.motion import Path
from synth.kernels.loop.passes import LONGEST_PASS_S, Draws, Exits
from synth.kernels.loop.regulator import Rule, Sensor
from synth.kernels.loop.trace import Trace, note_end, note_piece, piece_begins_s
from synth.kernels.vector import packs

LINE_BYTES = 64
"""What the memory delivers at once."""

SAMPLES_FETCHED = 128
"""Noise of a pass that is worth asking for in advance; most passes need less."""


@part_inline
def move(work: Work, active: int, path: Path, brakes: Floats, pieces: Pieces, looked_at: int, longest: int) -> Any:
    """Move each lane by one turn of `motion.advance`, and on to the next cell or piece; one that stalls stays.

    Returns how many lanes wait for the regulator (at pieces below `looked_at`), those in `waiting`, and how many passes
    are over, at the exit, by a stall or by taking too long, those in `ended`.
    """
    x, n = work.floats, work.ints
    cells, waiting, ended = path.gravity_m_s2.shape[0], 0, 0
    for lane in range(0, active, packs.EIGHT):
        s, v, left = packs.load8(x, S + lane), packs.load8(x, V + lane), packs.load8(x, LEFT_S + lane)
        cell, piece = packs.load8(n, CELL + lane), packs.load8(n, PIECE + lane)
        brake = packs.gather(brakes, packs.load8(n, ROW + lane) + cell)
        free = packs.gather(path.gravity_m_s2, cell) - packs.load8(x, DRAG + lane)
        edge = packs.gather(path.edges_m, cell + 1)
        a = free - brake * packs.gather(pieces.kpa, piece)
        gap = edge - s
        v_end = v + a * left
        way = 0.5 * (v + v_end) * left
        ends = (v_end > 0.0) & (way < gap)
        square = v * v + 2.0 * a * gap
        crosses = packs.opposite(ends) & (square > 0.0)
        v_edge = packs.root(packs.greatest(square, 0.0))
        later = packs.greatest(0.0, left - 2.0 * gap / (v + v_edge))
        packs.store(x, S + lane, packs.choose(ends, s + way, packs.choose(crosses, edge, s)))
        packs.store(x, V + lane, packs.choose(ends, v_end, packs.choose(crosses, v_edge, v)))
        cell = packs.choose(crosses, cell + 1, cell)
        packs.store(n, CELL + lane, cell)
        piece = packs.choose(ends, packs.gather(pieces.after, piece), piece)
        packs.store(n, PIECE + lane, piece)
        lasts = packs.gather(pieces.duration_s, piece)
        packs.store(x, LEFT_S + lane, packs.choose(ends, lasts, packs.choose(crosses, later, left)))
        sample = packs.load8(n, SAMPLE + lane)
        sample = packs.choose(ends & (piece < pieces.sampled), sample + 1, sample)
        packs.store(n, SAMPLE + lane, sample)
        stalls = packs.opposite(ends) & (square <= 0.0)
        over = (cell == cells) | stalls | (ends & (piece < pieces.resting) & (sample >= longest))
        looks = ends & (piece < looked_at) & packs.opposite(over)
        number = packs.load8(n, NUMBER + lane)
        waiting += packs.keep(work.waiting, waiting, looks, number)
        if packs.holds_anywhere(over):
            ended += packs.keep(work.ended, ended, over, number)
    packs.store(work.waiting, waiting, packs.load8(n, NUMBER + LANES))  # fill up the last pack
    return waiting, ended


@part_inline
def begin(x: Floats, n: Ints, lane: int, i: int, path: Path, pieces: Pieces, draws: Draws) -> None:
    """Pass `i` begins on `lane`; its sample −1 lasts until the first."""
    x[S + lane], x[V + lane] = path.edges_m[0], draws.entry_m_s[i]
    x[LEFT_S + lane], x[FIRST_S + lane] = draws.first_sample_s[i], draws.first_sample_s[i]
    x[DRAG + lane] = path.drag_m_s2_per_n_kn * draws.resistance_n_kn[i]
    x[SLOPE + lane], x[BEFORE + lane] = 0.0, math.nan
    n[CELL + lane], n[ROW + lane], n[PASS + lane] = 0, i * path.gravity_m_s2.shape[0], i
    n[PIECE + lane], n[SAMPLE + lane], n[STAGE + lane], n[SWITCHINGS + lane] = 0, -1, pieces.initial_stage, 0


@part_inline
def fetch_ahead(i: int, path: Path, draws: Draws) -> None:
    """Ask the memory for the rows of pass `i`, which is to begin soon: gathers do not tell it what comes next."""
    for cell in range(0, path.gravity_m_s2.shape[0], LINE_BYTES // 8):
        packs.fetch(draws.brake_m_s2_per_kpa, i * path.gravity_m_s2.shape[0] + cell)
    for sample in range(0, SAMPLES_FETCHED, LINE_BYTES // 4):
        packs.fetch(draws.noise_z, i * draws.noise_z.shape[1] + sample)


@part_inline
def record(
    work: Work, lane: int, longest: int, path: Path, pieces: Pieces, sensor: Sensor, draws: Draws, exits: Exits,
    trace: Trace,
) -> None:  # fmt: skip
    """Write down how the pass on `lane` has ended: at the exit, by a stall, or by taking too long."""
    x, n = work.floats, work.ints
    i, cell, piece, sample = n[PASS + lane], n[CELL + lane], n[PIECE + lane], n[SAMPLE + lane]
    s, v = x[S + lane], x[V + lane]
    used = (pieces.duration_s[piece] if piece > 0 else x[FIRST_S + lane]) - x[LEFT_S + lane]
    leaves = cell == path.gravity_m_s2.shape[0]
    if not leaves and not (piece < pieces.resting and sample >= longest):
        a = path.gravity_m_s2[cell] - x[DRAG + lane] - draws.brake_m_s2_per_kpa[i, cell] * pieces.kpa[piece]
        s, v, used = s - 0.5 * v * v / a, 0.0, used - v / a
    exits.speed_m_s[i] = v if leaves else 0.0
    exits.time_s[i] = piece_begins_s(x, n, lane, pieces, sensor) + used
    exits.stalled[i] = not leaves
    exits.switchings[i] = n[SWITCHINGS + lane]
    if trace.events.shape[0] > 0:
        note_end(trace, exits.time_s[i], s, v, n[STAGE + lane])


@part_inline
def clear(work: Work) -> None:
    """No pass anywhere."""
    work.floats[:], work.ints[:] = 0.0, 0
    for place in range(PLACES):
        work.floats[V + place], work.ints[NUMBER + place] = math.nan, min(place, LANES)


@part_inline
def leave(x: Floats, n: Ints, lane: int, last: int) -> None:
    """Lane `lane` takes over the pass of lane `last`, which falls idle."""
    for field in range(FLOATS):
        x[field * PLACES + lane] = x[field * PLACES + last]
    for field in range(INTS - 1):  # the number is the lane's own
        n[field * PLACES + lane] = n[field * PLACES + last]
    x[V + last], n[CELL + last] = math.nan, 0


@part_inline
def begin_all(work: Work, active: int, path: Path, pieces: Pieces, draws: Draws) -> None:
    """The first passes begin, one on each lane."""
    clear(work)
    for lane in range(active):
        begin(work.floats, work.ints, lane, lane, path, pieces, draws)


@part_inline
def relieve(
    work: Work, ended: int, active: int, following: int, longest: int, path: Path, pieces: Pieces, sensor: Sensor,
    draws: Draws, exits: Exits, trace: Trace,
) -> Any:  # fmt: skip
    """Have the lanes whose pass has ended, the first `ended` of that list, take the next passes; returns both counts.

    `active`: how many lanes have a pass; `following`: the pass that begins next.
    """
    # From the last lane down: it may be moved into one that falls idle.
    for k in range(ended - 1, -1, -1):
        lane = work.ended[k]
        record(work, lane, longest, path, pieces, sensor, draws, exits, trace)
        if following < draws.cut_factor.shape[0]:
            begin(work.floats, work.ints, lane, following, path, pieces, draws)
            fetch_ahead(following + 2, path, draws)
            following += 1
        else:
            active -= 1
            leave(work.floats, work.ints, lane, active)
    return active, following


@borrowing
def run_passes(
    path: Path, pieces: Pieces, sensor: Sensor, law: Rule, draws: Draws, exits: Exits, trace: Trace, work: Work,
    observed: Observed,
) -> None:  # fmt: skip
    """Simulate all passes of `draws` into `exits`; `observed` for as many, none of which has begun.

    A `trace` that is not empty is for one pass alone.
    """
    x, n = work.floats, work.ints
    brakes, longest = draws.brake_m_s2_per_kpa.reshape(-1), int(LONGEST_PASS_S / sensor.period_s)
    active = min(LANES, draws.cut_factor.shape[0])
    filters = law.lead_s != 0.0 or law.table.breaks > 0
    looked_at = pieces.sampled if filters else pieces.resting
    begin_all(work, active, path, pieces, draws)
    following, waiting, traced = active, 0, trace.events.shape[0] > 0
    while active > 0:
        if traced:
            note_piece(trace, work, waiting, pieces, sensor)
        waiting, ended = move(work, active, path, brakes, pieces, looked_at, longest)
        told = listen(work, waiting, pieces, sensor, law, draws.noise_z, observed)
        for k in range(told):
            regulate(x, n, work.told[k], work.heard[k], pieces, law, observed)
        active, following = relieve(work, ended, active, following, longest, path, pieces, sensor, draws, exits, trace)
