"""Passes sample by sample, the simulator's own and no second model: one under whoever commands from outside, and
many as a controller would log them: what the regulator saw, commanded, and a gauge on the drive.
"""

from __future__ import annotations

from collections.abc import Generator, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from plant_models import Plant
from plant_models.frozen_arrays import Floats, Ints
from plant_models.pressure_regulator import PressureGauge
from plant_models.stage_regulator import stage_locked_actuator
from synth.kernels.any_time.driven_period import play_period
from synth.kernels.loop.motion import LEFT, MOVING, advance
from synth.kernels.loop.passes import LONGEST_PASS_S, Draws
from synth.kernels.loop.regulator import impulse_time_s, measure
from synth.simulation.closed_loop import ClosedLoop, close_loop
from synth.simulation.controllers import Controller
from synth.simulation.random_passes import random_passes
from tuning_tables.pass_log.pass_log import PassLog, join_logs, one_after_the_other

AT_REST = 1.0 + 1e-12
"""Of the dead band: at its edge the pressure is reached, whatever rounding brought it there."""


@dataclass(frozen=True)
class Reading:
    """What radar, gauge and valves tell at a sample, and `speed_m_s`, the true speed, which no controller is told.

    `measured_m_s`: NaN for a lost reading; `mean_overpressure_kpa`: since the sample before; `at_rest`: whether the
    pressure of `stage`, commanded last, is reached.
    """

    path_m: float
    measured_m_s: float
    mean_overpressure_kpa: float
    pressure_kpa: float
    at_rest: bool
    stage: int
    speed_m_s: float


@dataclass(frozen=True)
class PassEnd:
    """How a pass ended; a cut that stands has speed 0."""

    exit_speed_m_s: float
    time_s: float
    stalled: bool


SampledPass = Generator[Reading, int, PassEnd]
"""It yields the reading of each sample, is sent the stage commanded there, and returns the end."""


def sampled_pass(loop: ClosedLoop, draws: Draws) -> SampledPass:
    """The only pass of `draws`, with commands at any moment; `PlantError` where the drive of `loop` takes none.

    With the stages that a regulator of `ClosedLoop.run` commands it ends as there, but for the order of sums. What the
    position admits before the entrance (`regulator.admitted`) is left to who commands.
    """
    drive, period_s = loop.sampled, loop.sensor.period_s
    first_s, noise = float(draws.first_sample_s[0]), draws.noise_z[0]
    free = loop.path.gravity_m_s2 - loop.path.drag_m_s2_per_n_kn * draws.resistance_n_kn[0]
    roll = partial(advance, loop.path.edges_m, free, draws.brake_m_s2_per_kpa[0])
    band_kpa = loop.plant.position.pneumatics.dead_band_kpa * AT_REST
    stage, pressure, wait, sample = drive.initial_stage, drive.initial_kpa, 0.0, 0
    over, part_s = np.full(drive.parts, max(0.0, pressure - drive.valves.touch_kpa)), period_s / drive.parts
    cell, s, v, time_s, status = roll(over[0], first_s, 0, loop.path.edges_m[0], draws.entry_m_s[0])
    while status == MOVING and sample < int(LONGEST_PASS_S / period_s):
        rests = abs(drive.stage_kpa[stage] - pressure) <= band_kpa
        told_m_s = measure(v, noise[sample % noise.size], loop.sensor)
        before, stage = stage, (yield Reading(s, told_m_s, over.mean(), pressure, bool(rests), stage, v))
        pressures_kpa = drive.stage_kpa[before], drive.stage_kpa[stage]
        pressure, wait = play_period(
            pressure, wait, *pressures_kpa, drive.computing_delay_s, period_s, drive.valves, over
        )
        begun_s = impulse_time_s(first_s, sample, period_s)
        for part in range(drive.parts):
            cell, s, v, used_s, status = roll(over[part], part_s, cell, s, v)
            time_s = begun_s + part * part_s + used_s
            if status != MOVING:
                break
        sample += 1
    has_left = status == LEFT
    return PassEnd(float(v) if has_left else 0.0, float(time_s), not has_left)


GAP_S = 30.0
"""From the last row of a pass to the first of the next."""

GAUGE, CLASSES = 3, 4
"""Numbers of child streams: 0 to 2 are those of blocks of passes (`random_passes`, `stratified_passes`)."""


@dataclass(frozen=True)
class LoggedClass:
    """Passes that are alike: of `plant` under `controller`, which is to let cuts go at `target_m_s`."""

    plant: Plant
    controller: Controller
    target_m_s: float


def logged_passes(
    plant: Plant,
    controller: Controller,
    target_m_s: float,
    seed: int,
    first: int,
    count: int,
    gauge: PressureGauge | None,
) -> PassLog:
    """Passes `first` … `first + count − 1` of the row of `seed`, as cuts come; cut_id is 'cut-' and their number.

    A row at every sample of the regulator, also while the pressure changes, until the cut has left or stands: the path
    is the true one, the speed that of the sensor, the stage what is commanded from this sample on, the pressure what
    `gauge` shows at the sample, NaN without one. A pass has the same rows, but for their time, whatever `first` and
    `count`. `ValueError` where the controller has stages that the position lacks, or `count` is not positive.
    """
    if count < 1:
        raise ValueError(f"logged passes: {count} passes; at least one is needed")
    loop = close_loop(plant, controller.stages)
    draws = loop.draws(random_passes(seed, first, count, loop.cells))
    passes = [rows_of_pass(loop, controller, draws, number) for number in range(count)]
    time, path, speed, stage = (np.concatenate([each[column] for each in passes]) for column in range(4))
    counts = np.array([each.shape[1] for each in passes])
    ends = np.concatenate(([0], np.cumsum(counts)))
    stage = stage.astype(np.int64)
    pressure = np.full(len(time), np.nan)
    if gauge is not None:
        true = drive_pressures_kpa(plant, controller.stages, stage, ends)
        z = [gauge_noise(seed, first + number, rows) for number, rows in enumerate(counts)]
        pressure = gauge.reading_kpa(true, np.concatenate(z))
    log = PassLog(
        time, path, speed, pressure, stage, ends,
        cut_id=tuple(f"cut-{number:06d}" for number in range(first, first + count)),
        mass_t=np.full(count, plant.cut.mass_t),
        axles=np.full(count, plant.cut.axles),
        category=(plant.cut.category,) * count,
        target_m_s=np.full(count, target_m_s),
        stopped_by_hand=np.zeros(count, dtype=np.bool_),
    )  # fmt: skip
    return one_after_the_other(log, GAP_S)


def rows_of_pass(loop: ClosedLoop, controller: Controller, draws: Draws, number: int) -> Floats:
    """Time, path, measured speed and stage at the samples of pass `number` of `draws`, (4, samples)."""
    one = Draws._make(part[number : number + 1] for part in draws)
    events = loop.follow(controller, one)
    period, first = loop.sensor.period_s, float(one.first_sample_s[0])
    # The first event is where the pass begins, the last where it ends; the kernel makes the times of samples like this.
    sample = np.rint((events.time_s - first) / period)
    sampled = np.flatnonzero(first + sample * period == events.time_s)
    sampled = sampled[(sampled > 0) & (sampled < len(events.time_s) - 1)]
    noise = one.noise_z[0]
    seen = [
        measure(speed, noise[at % len(noise)], loop.sensor)
        for speed, at in zip(events.speed_m_s[sampled].tolist(), sample[sampled].astype(int).tolist(), strict=True)
    ]
    return np.array([sample[sampled] * period, events.path_m[sampled], seen, events.stage[sampled]])


def drive_pressures_kpa(plant: Plant, stages: int, stage: Ints, ends: Ints) -> Floats:
    """True pressure at each row, a sample apart, of passes whose rows begin at `ends` and command `stage`.

    A command finds the drive at rest, and none is given before it rests again (`stage_regulator`). So the pressure is a
    known function of the resting pressure before, the stage wanted, and the samples since.
    """
    actuator = stage_locked_actuator(plant.position, plant.sensor, stages - 1, 1)
    after, longest = responses_kpa(plant, stages), int(actuator.chain_samples.max())
    pressure = np.empty(len(stage))
    for begin, end in zip(ends[:-1].tolist(), ends[1:].tolist(), strict=True):
        mode = actuator.mode_of(plant.approach.initial_stage)
        before = np.concatenate(([plant.approach.initial_stage], stage[begin : end - 1]))
        pressure[begin:end] = actuator.mode_pressure_kpa[mode]
        for row in (begin + np.flatnonzero(stage[begin:end] != before)).tolist():
            chain = actuator.command[mode, stage[row]]
            mode = int(actuator.chain_mode[chain])
            pressure[row:end] = actuator.mode_pressure_kpa[mode]
            moving = min(int(actuator.chain_samples[chain]), longest, end - row)
            pressure[row : row + moving] = after[chain][:moving]
    return pressure


def responses_kpa(plant: Plant, stages: int) -> list[Floats]:
    """Pressure at the samples from each command of the actuator on, until the last of its chain."""
    position, sensor = plant.position, plant.sensor
    actuator = stage_locked_actuator(position, sensor, stages - 1, 1)
    found: list[Floats] = [np.empty(0)] * len(actuator.chain_mode)
    for mode, wanted in np.argwhere(actuator.command >= 0).tolist():
        chain, resting = actuator.command[mode, wanted], float(actuator.mode_pressure_kpa[mode])
        history = position.pneumatics.respond(
            resting, position.stage_pressures_kpa[wanted], position.force.touch_pressure_kpa
        )
        since = np.arange(actuator.chain_samples[chain]) * sensor.sample_period_s - sensor.computing_delay_s
        found[chain] = np.where(since < 0.0, resting, history.pressure_kpa(np.maximum(since, 0.0)))
    return found


def gauge_noise(seed: int, number: int, rows: int) -> Floats:
    """Standard normal numbers of the gauge in pass `number` of the row of `seed`, (rows,)."""
    sequence = np.random.SeedSequence(seed, spawn_key=(number, GAUGE))
    return np.random.Generator(np.random.SFC64(sequence)).standard_normal(rows)


def mixed_log(classes: Sequence[LoggedClass], counts: Sequence[int], seed: int, gauge: PressureGauge | None) -> PassLog:
    """`counts` passes of each of `classes`, one log, in an order that `seed` shuffles; cuts are numbered in that order.

    The passes of one class are independent of those of the others. `ValueError` for other counts than classes.
    """
    seeds = np.random.SeedSequence(seed, spawn_key=(0, CLASSES)).generate_state(len(classes), np.uint32).tolist()
    logs = [
        logged_passes(each.plant, each.controller, each.target_m_s, own, 0, count, gauge)
        for each, own, count in zip(classes, seeds, counts, strict=True)
    ]
    log = join_logs(logs)
    order = np.random.Generator(np.random.SFC64(np.random.SeedSequence(seed, spawn_key=(1, CLASSES))))
    mixed = one_after_the_other(log.taken(order.permutation(len(log))), GAP_S)
    return replace(mixed, cut_id=tuple(f"cut-{number:06d}" for number in range(len(log))))
