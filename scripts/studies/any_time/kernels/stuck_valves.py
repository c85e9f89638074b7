"""Kernel of the closed loop with valves that do not open for some time, at rest or at any time.

Drive, regulator and motion are those of `kernels.any_time.closed_loop`. A valve that does not open is one with an
infinite delay: the drive's own functions then leave the pressure where it is, whatever is commanded.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import Floats, Ints
from scripts.studies.any_time.kernels.rolled_period import roll_period
from synth.kernels.any_time.any_time_law import AnyTimeLaw, wanted_stage
from synth.kernels.any_time.driven_period import SampledDrive, play_period, wait_after_command
from synth.kernels.compiling import kernel
from synth.kernels.loop.motion import LEFT, MOVING, Cells, Path, advance
from synth.kernels.loop.passes import LONGEST_PASS_S, Draws, Exits
from synth.kernels.loop.regulator import Sensor, admitted, measure
from synth.kernels.loop.trace import note


class Stuck(NamedTuple):
    """What does not open, and when: in pass i from the first sample at or after `starts_s[i]` on, for `duration_s`.

    `valves`: the drive meanwhile, `plant_models.valve_drive.ValveDrive` with infinite delays of the stuck valves.
    """

    valves: Any
    starts_s: Floats
    duration_s: float


class Asking(NamedTuple):
    """When the law is asked: at every sample, unless `by_gauge` or `by_times`.

    `by_gauge`: only where the gauge shows that the pressure commanded is reached. `by_times`: only where a drive
    without fault would have reached it, by `command`, `chain_mode`, `chain_samples`, `initial_mode` of
    `kernels.loop.drive.Drive`.
    """

    by_gauge: bool
    by_times: bool
    command: Ints
    chain_mode: Ints
    chain_samples: Ints
    initial_mode: int


@kernel
def reached(pressure: float, stage_kpa: float, valves: Any) -> bool:
    """Whether `pressure` lies in the dead band of the stage, edges included, so that its drive rests."""
    return bool(abs(stage_kpa - pressure) <= valves.band_kpa * (1.0 + 1e-12))


@kernel
def wait_at_turn(pressure: float, wait: float, stage_kpa: float, begins: bool, stuck: Any, free: Any) -> float:
    """The wait of the drive where valves get stuck (`begins`), or are free again.

    A valve that is needed and gets stuck is waited for in vain. When it is free again its whole delay begins.
    """
    if begins:
        needed: float = wait_after_command(pressure, 0.0, pressure, stage_kpa, stuck)
        return needed if math.isinf(needed) else wait
    anew: float = wait_after_command(pressure, 0.0, pressure, stage_kpa, free)
    return anew if math.isinf(wait) else wait


@kernel
def run_stuck_pass(
    cells: Cells, drive: SampledDrive, stuck: Any, sensor: Sensor, law: AnyTimeLaw, asking: Asking, begin_s: float,
    end_s: float, entry_m_s: float, first_sample_s: float, noise_z: NDArray[np.float32], events: Floats,
) -> Any:  # fmt: skip
    """One pass; returns (v, time, status, switchings, events). Valves are stuck at samples in [`begin_s`, `end_s`).

    The law has neither an estimator nor a lead.
    """
    edges_m, free, brake = cells
    stage_kpa, touch = drive.stage_kpa, drive.valves.touch_kpa
    period, top, longest = sensor.period_s, stage_kpa.shape[0] - 1, int(LONGEST_PASS_S / sensor.period_s)
    over = np.empty(drive.parts)
    part = period / drive.parts
    pressure, wait, stage, sample, switchings = drive.initial_kpa, 0.0, drive.initial_stage, 0, 0
    valves, held, mode, rests_at = drive.valves, False, asking.initial_mode, 0
    kpa = max(0.0, pressure - touch)
    count = note(events, 0, 0.0, edges_m[0], entry_m_s, kpa, stage, math.nan)
    cell, s, v, time, status = advance(edges_m, free, brake, kpa, first_sample_s, 0, edges_m[0], entry_m_s)
    while status == MOVING and sample < longest:
        if (begin_s <= time < end_s) != held:
            held = not held
            valves = stuck if held else drive.valves
            wait = wait_at_turn(pressure, wait, stage_kpa[stage], held, stuck, drive.valves)
        measured, before = math.nan, stage
        waits = asking.by_gauge and not reached(pressure, stage_kpa[stage], drive.valves)
        if not waits and not (asking.by_times and sample < rests_at):
            measured = measure(v, noise_z[sample % noise_z.shape[0]], sensor)
            wanted = wanted_stage(law, stage, top, pressure, s, measured)
            stage = admitted(stage, wanted, s, drive.entrance_stage)
        if stage != before:
            switchings += 1
            if asking.by_times:
                chain = asking.command[mode, stage]
                mode, rests_at = asking.chain_mode[chain], sample + asking.chain_samples[chain]
        pressure, wait = play_period(
            pressure, wait, stage_kpa[before], stage_kpa[stage], drive.computing_delay_s, period, valves, over
        )
        cell, s, v, kpa, time, used, status, count = roll_period(
            cells, over, part, first_sample_s + sample * period, stage, measured, cell, s, v, events, count
        )  # fmt: skip
        sample += 1
        if status == MOVING:
            time = first_sample_s + sample * period  # not by summing up: the clock must not drift
        else:
            time += used
    count = note(events, count, time, s, v, kpa, stage, math.nan)
    return v, time, status, switchings, count


@kernel
def run_stuck_passes(
    path: Path, drive: SampledDrive, sensor: Sensor, law: AnyTimeLaw, asking: Asking, stuck: Stuck, draws: Draws,
    exits: Exits, events: Floats,
) -> int:  # fmt: skip
    """Simulate all passes of `draws` into `exits`; returns the number of events of the last pass."""
    free, count = np.empty(path.gravity_m_s2.shape[0]), 0
    for i in range(draws.cut_factor.shape[0]):
        drag = path.drag_m_s2_per_n_kn * draws.resistance_n_kn[i]
        for j in range(free.shape[0]):
            free[j] = path.gravity_m_s2[j] - drag
        v, time, status, switchings, count = run_stuck_pass(
            Cells(path.edges_m, free, draws.brake_m_s2_per_kpa[i]), drive, stuck.valves, sensor, law, asking,
            stuck.starts_s[i], stuck.starts_s[i] + stuck.duration_s, draws.entry_m_s[i], draws.first_sample_s[i],
            draws.noise_z[i], events,
        )  # fmt: skip
        exits.stalled[i] = status != LEFT
        exits.speed_m_s[i] = v if status == LEFT else 0.0
        exits.time_s[i] = time
        exits.switchings[i] = switchings
    return count
