"""Kernel that remembers what the drive has played: sampling periods as pieces of constant overpressure.

What a drive does in a period follows from its state at the sample (pressure, time that a valve still waits, stage) and
from the command alone. Cuts and noise differ from pass to pass, yet thousands of passes meet but some hundreds of
states. So each period is played once, by `play_period`, and kept as pieces that any pass may follow.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import Floats, Ints
from synth.kernels.any_time.any_time_law import AnyTimeLaw
from synth.kernels.any_time.driven_period import SampledDrive, play_period
from synth.kernels.compiling import part, part_inline
from synth.kernels.loop.drive import Pieces
from synth.kernels.loop.lane_places import LANES
from synth.kernels.loop.regulator import pressure_above_stage

STATES, PIECES = 0, 1
"""Places in `PlayedPeriods.taken`."""


class PlayedPeriods(NamedTuple):
    """Memory for N states of the drive and the periods that begin in them, P pieces in all.

    State i begins a period without a command, and piece i is the first of it; it lasts 0 s until it is played. Piece 0
    is before the first sample, so there is no state 0. Pieces of a period that are no state have numbers from N on.
    `pieces.command` (M, K + 1), M = N − `LANES`: first piece of the period with this stage commanded, 0 until it is
    played. The last `LANES` states, and the last `LANES` rows of pieces, belong to one lane each: where the memory is
    full, it plays there, and remembers nothing.

    `pressure_kpa`, `wait_s`, `stage` (N,); `rises` (N, 2): what the pressure adds to both lines of the stage; `slots`,
    a power of two of them: the states by their numbers, 0 for none; `taken` (2,): how many states and pieces there are;
    `over`: room for one period.
    """

    pieces: Pieces
    pressure_kpa: Floats
    wait_s: Floats
    stage: Ints
    rises: NDArray[np.float32]
    slots: Ints
    taken: Ints
    over: Floats


@part_inline
def joined_until(over: Floats, begun: int) -> int:
    """The part behind those that are played as one step with part `begun`: dead times and rests are one step."""
    i = begun
    while i < over.shape[0] and abs(over[i] - over[begun]) < 1e-9:
        i += 1
    return i


@part_inline
def slot_of(played: PlayedPeriods, pressure: float, wait: float, stage: int) -> Any:
    """Where in `slots` this state stands, or the free place where it belongs."""
    p, w = np.float64(pressure).view(np.int64), np.float64(wait).view(np.int64)
    last = played.slots.shape[0] - 1
    slot = (p ^ (p >> 19) ^ (p >> 41) ^ (w >> 7) ^ (w >> 37) ^ stage) & last
    while True:
        state = played.slots[slot]
        if state == 0:
            return slot
        if played.pressure_kpa[state] == pressure and played.wait_s[state] == wait and played.stage[state] == stage:
            return slot
        slot = (slot + 1) & last


@part
def state_at(played: PlayedPeriods, law: AnyTimeLaw, lane: int, pressure: float, wait: float, stage: int) -> Any:
    """Number of this state, noted if it is new; that of the lane where there is no room for it."""
    pieces = played.pieces
    slot = slot_of(played, pressure, wait, stage)
    if played.slots[slot] > 0:
        return played.slots[slot]
    state = played.taken[STATES]
    if state < pieces.command.shape[0]:
        played.slots[slot] = state
        played.taken[STATES] += 1
        pieces.command[state, :] = 0
    else:
        state = pieces.command.shape[0] + lane
    played.pressure_kpa[state], played.wait_s[state], played.stage[state] = pressure, wait, stage
    table = law.rule.table
    played.rises[state, 0], played.rises[state, 1] = 0.0, 0.0
    if table.has_gauge == 1:
        above = pressure_above_stage(table, stage, pressure * law.gauge_factor)
        played.rises[state, 0] = table.slope[stage, 0] * above
        played.rises[state, 1] = table.slope[stage, 1] * above
    pieces.duration_s[state] = 0.0
    return state


@part
def play(
    played: PlayedPeriods, drive: SampledDrive, law: AnyTimeLaw, period_s: float, lane: int, state: int, stage: int
) -> Any:
    """Play the period that begins in `state` with `stage` commanded; returns the number of its first piece."""
    pieces, over, old, parts = played.pieces, played.over, played.stage[state], played.over.shape[0]
    pressure, wait = play_period(
        played.pressure_kpa[state], played.wait_s[state], drive.stage_kpa[old], drive.stage_kpa[stage],
        drive.computing_delay_s, period_s, drive.valves, over,
    )  # fmt: skip
    after = state_at(played, law, lane, pressure, wait, stage)
    shared, own = pieces.command.shape[0], pieces.kpa.shape[0] - (LANES - lane) * parts
    first, place = own, own + 1
    # What others may follow must not end in a state that is this lane's own.
    kept = state < shared and after < shared and played.taken[PIECES] + parts <= pieces.kpa.shape[0] - LANES * parts
    if kept and stage == old:
        first, place = state, played.taken[PIECES]
    elif kept:
        first, place = played.taken[PIECES], played.taken[PIECES] + 1
    i, last = 0, first
    while i < parts:
        begun, at = i, first if i == 0 else place
        i = joined_until(over, begun)
        pieces.kpa[at], pieces.start_s[at] = over[begun], begun * (period_s / parts)
        pieces.duration_s[at] = (i - begun) * (period_s / parts)
        pieces.after[last], last = at, at
        place += begun > 0
    pieces.after[last] = after
    pieces.mean_kpa[first] = over.mean()
    if kept:
        pieces.command[state, stage], played.taken[PIECES] = first, place
    return first


@part_inline
def first_piece(
    played: PlayedPeriods, drive: SampledDrive, law: AnyTimeLaw, period_s: float, lane: int, state: int, stage: int
) -> Any:
    """First piece of the period that begins in `state` with `stage` commanded, played now if it never was."""
    command = played.pieces.command
    if state < command.shape[0] and command[state, stage] > 0:
        return command[state, stage]
    return play(played, drive, law, period_s, lane, state, stage)


@part_inline
def begin_playing(played: PlayedPeriods, drive: SampledDrive, law: AnyTimeLaw) -> None:
    """Nothing is remembered but the state that every pass begins in."""
    pieces = played.pieces
    played.slots[:] = 0
    played.taken[STATES], played.taken[PIECES] = 1, pieces.sampled
    pieces.kpa[0] = max(0.0, drive.initial_kpa - drive.valves.touch_kpa)
    pieces.duration_s[0], pieces.start_s[0] = 0.0, 0.0
    pieces.after[0] = state_at(played, law, 0, drive.initial_kpa, 0.0, drive.initial_stage)
