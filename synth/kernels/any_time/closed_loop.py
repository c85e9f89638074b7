"""Kernel of the closed loop where a command may be given at every sample.

The lanes and how they move are those of the locked loop (`loop.closed_loop`). What the drive plays to them is
remembered (`played_periods`), and every lane is asked at every sample.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from synth.kernels.any_time.any_time_law import AnyTimeLaw, wanted_stage
from synth.kernels.any_time.driven_period import SampledDrive
from synth.kernels.any_time.played_periods import PlayedPeriods, begin_playing, first_piece
from synth.kernels.compiling import borrowing, part_inline
from synth.kernels.loop.closed_loop import begin_all, move, relieve
from synth.kernels.loop.lane_estimator import Observed, estimated
from synth.kernels.loop.lane_places import LANES, LEFT_S, PASS, PIECE, STAGE, SWITCHINGS, S, Work
from synth.kernels.loop.lane_regulator import foretold, measured, speaks_by_lines, speaks_by_table
from synth.kernels.loop.motion import Path
from synth.kernels.loop.passes import LONGEST_PASS_S, Draws, Exits
from synth.kernels.loop.regulator import Sensor, admitted
from synth.kernels.loop.trace import Trace, note_piece
from synth.kernels.vector import packs


@part_inline
def listen(
    work: Work, count: int, played: PlayedPeriods, sensor: Sensor, law: AnyTimeLaw, noise_z: NDArray[np.float32],
    observed: Observed,
) -> int:  # fmt: skip
    """As `lane_regulator.listen`; those in `told` have a command, or their next period has not been played yet."""
    x, n, rule = work.floats, work.ints, law.rule
    told = 0
    for k in range(0, count, packs.EIGHT):
        lane = packs.load8(work.waiting, k)
        s, stage, state = packs.gather(x, lane + S), packs.gather(n, lane + STAGE), packs.gather(n, lane + PIECE)
        speed = measured(x, n, lane, sensor, noise_z)
        there = lane < LANES
        if rule.table.breaks > 0:
            i = packs.gather(n, lane + PASS)
            speed = estimated(observed, rule.table, there, i, s, speed)
            packs.scatter(observed.passed_kpa, i, there, packs.gather(played.pieces.mean_kpa, state))
        packs.store(work.read, k, speed)
        unplayed = packs.gather(x, lane + LEFT_S) == 0.0
        if rule.table.stages > 0:
            at = state * 2
            rises = packs.gather(played.rises, at), packs.gather(played.rises, at + 1)
            speaks = there & (unplayed | speaks_by_table(rule.table, stage, s, speed, *rises))
        else:
            speed = foretold(x, lane, speed, speed, sensor, rule)
            speaks = there & (unplayed | speaks_by_lines(rule, stage, s, speed))
        packs.keep(work.heard, told, speaks, speed)
        told += packs.keep(work.told, told, speaks, lane)
    return told


@part_inline
def regulate(
    work: Work, lane: int, speed_m_s: float, played: PlayedPeriods, drive: SampledDrive, sensor: Sensor,
    law: AnyTimeLaw, observed: Observed,
) -> None:  # fmt: skip
    """What the regulator and the drive do at a sample."""
    x, n = work.floats, work.ints
    s, state, stage, top = x[S + lane], n[PIECE + lane], n[STAGE + lane], drive.stage_kpa.shape[0] - 1
    wanted = wanted_stage(law, stage, top, played.pressure_kpa[state], s, speed_m_s)
    wanted = admitted(stage, wanted, s, drive.entrance_stage)
    if wanted != stage:
        n[SWITCHINGS + lane] += 1
    first = first_piece(played, drive, law, sensor.period_s, lane, state, wanted)
    n[STAGE + lane], n[PIECE + lane], x[LEFT_S + lane] = wanted, first, played.pieces.duration_s[first]
    if law.rule.table.breaks > 0:
        observed.passed_kpa[n[PASS + lane]] = played.pieces.mean_kpa[first]


@borrowing
def run_any_time_passes(
    path: Path, drive: SampledDrive, sensor: Sensor, law: AnyTimeLaw, draws: Draws, exits: Exits, trace: Trace,
    work: Work, played: PlayedPeriods, observed: Observed,
) -> None:  # fmt: skip
    """Simulate all passes of `draws` into `exits`; `trace` and `observed` as of `loop.closed_loop.run_passes`."""
    pieces, brakes = played.pieces, draws.brake_m_s2_per_kpa.reshape(-1)
    longest, active = int(LONGEST_PASS_S / sensor.period_s), min(LANES, draws.cut_factor.shape[0])
    begin_playing(played, drive, law)
    begin_all(work, active, path, pieces, draws)
    following, waiting, traced = active, 0, trace.events.shape[0] > 0
    while active > 0:
        if traced:
            note_piece(trace, work, waiting, pieces, sensor)
        waiting, ended = move(work, active, path, brakes, pieces, pieces.sampled, longest)
        told = listen(work, waiting, played, sensor, law, draws.noise_z, observed)
        for k in range(told):
            regulate(work, work.told[k], work.heard[k], played, drive, sensor, law, observed)
        active, following = relieve(work, ended, active, following, longest, path, pieces, sensor, draws, exits, trace)
