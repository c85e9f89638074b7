"""Kernel of the predictive controller: every stage is held over the horizon in the mean plant, the cheapest is taken.

Drive and motion are those of the closed loop (`play_period`, `advance`); what differs is what is known: the friction
factor is the estimated one, running resistance is the mean, and friction along the path has no noise.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from plant_models.frozen_arrays import Floats
from synth.kernels.any_time.driven_period import SampledDrive, play_period
from synth.kernels.compiling import part
from synth.kernels.loop.motion import MOVING, advance
from synth.kernels.loop.regulator import admitted


class MeanPath(NamedTuple):
    """The path with mean resistance and ξ = 1, as a regulator knows it.

    `edges_m` (C + 1,) as in the closed loop, `free_m_s2`, `brake_m_s2_per_kpa` (C,): acceleration without brake, and
    deceleration by one kPa. `drive_left_m2_s2`, `brake_left_m2_s2_per_kpa` (C + 1,): their integrals from each edge to
    the exit.
    """

    edges_m: Floats
    free_m_s2: Floats
    brake_m_s2_per_kpa: Floats
    drive_left_m2_s2: Floats
    brake_left_m2_s2_per_kpa: Floats


class Prediction(NamedTuple):
    """Free numbers of the predictive controller.

    `horizon_s`; `held_kpa`: the overpressure that, held from the energy line on, leads to `aim_m_s` at the exit;
    `price_m2_s2`: a command costs as much as an error of so much in v². `parts`: of a sampling period, each with its
    mean overpressure.
    """

    horizon_s: float
    held_kpa: float
    aim_m_s: float
    price_m2_s2: float
    parts: int


@part
def line_square(path: MeanPath, aim_m_s: float, slowing_kpa: float, cell: int, s: float) -> float:
    """v² at `s` in `cell`, from which so much overpressure at ξ = 1 leads to `aim_m_s` at the exit; may be negative."""
    square = aim_m_s * aim_m_s
    if cell == path.free_m_s2.shape[0]:
        return square
    left = path.edges_m[cell + 1] - s
    drive = path.drive_left_m2_s2[cell + 1] + left * path.free_m_s2[cell]
    brake = path.brake_left_m2_s2_per_kpa[cell + 1] + left * path.brake_m_s2_per_kpa[cell]
    line: float = square + 2.0 * (slowing_kpa * brake - drive)
    return line


@part
def held(
    path: MeanPath, drive: SampledDrive, period_s: float, horizon_s: float, old: int, new: int, pressure: float,
    wait: float, factor: float, place: Any, over: Floats,
) -> Any:  # fmt: skip
    """(cell, s, v, status) after stage `new`, commanded now in place of `old`, was held for `horizon_s`.

    Ends early at the exit or at a standstill. `place`: (cell, s, v) before; `over` (parts,) is memory.
    """
    cell, s, v = place
    left, part, status, first = horizon_s, period_s / over.shape[0], MOVING, drive.stage_kpa[old]
    kpa = drive.stage_kpa[new]
    while status == MOVING and left > 0.0:
        pressure, wait = play_period(pressure, wait, first, kpa, drive.computing_delay_s, period_s, drive.valves, over)
        first, i = kpa, 0
        while i < over.shape[0] and status == MOVING and left > 0.0:
            step = min(part, left)
            cell, s, v, _, status = advance(
                path.edges_m, path.free_m_s2, path.brake_m_s2_per_kpa, factor * over[i], step, cell, s, v
            )
            left -= step
            i += 1
    return cell, s, v, status


@part
def stage_by_prediction(
    law: Prediction, path: MeanPath, drive: SampledDrive, period_s: float, stage: int, pressure: float, wait: float,
    factor: float, cell: int, s: float, v: float, over: Floats,
) -> int:  # fmt: skip
    """The stage of least cost: (v² at the end of the horizon − that of the energy line there)² + price² of a command.

    Of equals the present one is kept. `factor`: ξ as estimated; the energy line is that of this ξ.
    """
    best, least, count = stage, np.inf, drive.stage_kpa.shape[0]
    for turn in range(count):
        candidate = (stage + turn) % count
        if admitted(stage, candidate, s, drive.entrance_stage) != candidate:
            continue
        end, place, speed, _ = held(
            path, drive, period_s, law.horizon_s, stage, candidate, pressure, wait, factor, (cell, s, v), over
        )
        missed = speed * speed - line_square(path, law.aim_m_s, factor * law.held_kpa, end, place)
        cost = missed * missed
        if candidate != stage:
            cost += law.price_m2_s2 * law.price_m2_s2
        if cost < least:
            best, least = candidate, cost
    return best
