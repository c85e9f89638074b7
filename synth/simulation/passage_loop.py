"""Closed-loop Monte Carlo with point sensors: passes of a plant under switching speeds at the passages."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plant_models import Plant, PointSensors
from plant_models.frozen_arrays import Floats
from plant_models.stage_regulator import Actuator, stage_locked_actuator
from synth.kernels.loop import passage_loop as kernel
from synth.kernels.loop import passage_pulses
from synth.kernels.loop.passage_loop import roll
from synth.kernels.loop.passage_regulator import STATE_FIELDS
from synth.kernels.loop.passes import Draws
from synth.kernels.loop.trace import EVENT_FIELDS
from synth.simulation.closed_loop import SUBSTEP_S, ClosedLoop, close_loop, empty_exits, trace_of
from synth.simulation.controllers import all_fixed, fixed
from synth.simulation.passage_controller import (
    HeardPairs,
    PassageController,
    PassageSample,
    PassageTrace,
    PassReadings,
    as_given,
    deciding_pulses,
    every_pulse,
)
from synth.simulation.random_passes import RandomPasses
from synth.simulation.stratified_passes import many_passes

PATH_ERROR_M = 1e-3
"""How far the passages that a controller knows may lie from those of the loop, where it is told each of them."""

Faults = Callable[[HeardPairs, Draws], HeardPairs]
"""What faults make of the pairs of the passes that were drawn (`sensor_faults`)."""


@dataclass(frozen=True)
class PassageLoop:
    """A plant with point sensors made ready for the kernel. Build it with `close_passage_loop`.

    A regulator with tracker hears the pulses of every axle, `heard`, as a controller does. One that is told its
    passages needs those alone at which it decides, `deciding`.
    """

    sensors: PointSensors
    radar: ClosedLoop
    drive: kernel.PieceDrive
    heard: passage_pulses.Pulses
    deciding: passage_pulses.Pulses

    @property
    def plant(self) -> Plant:
        """The plant; its radar takes no part."""
        return self.radar.plant

    @property
    def stages(self) -> int:
        """Number of stages K + 1."""
        return int(self.drive.command.shape[1])

    def draws(self, passes: RandomPasses, cut_factor: float | None = None) -> Draws:
        """What `passes` mean for this plant: the same as with the radar. `cut_factor` fixes ξ_cut for all cuts."""
        return self.radar.draws(passes, cut_factor)

    def run(self, controller: PassageController, draws: Draws, faults: Faults | None = None) -> PassageSample:
        """All passes of `draws` under `controller`; with `faults` it must have the tracker."""
        nothing = np.empty((0, kernel.READING_FIELDS))
        return self._alone(controller, draws, faults, np.empty((0, EVENT_FIELDS)), nothing)[0]

    def follow(self, controller: PassageController, draws: Draws, faults: Faults | None = None) -> PassageTrace:
        """The only pass of `draws` under `controller`, event by event."""
        pairs = len(pairs_of(self.pulses_of(controller), draws, faults).source)
        events = np.empty(((pairs + 1) * (len(self.drive.kpa) + 1) + 2, EVENT_FIELDS))
        seen = np.empty((pairs, kernel.READING_FIELDS))
        sample, events, seen = self._alone(controller, draws, faults, events, seen)
        motion = trace_of(events, bool(sample.stalled[0]))
        return PassageTrace(**vars(motion), readings=readings_of(seen))

    def pulses_of(self, controller: PassageController) -> passage_pulses.Pulses:
        """The pulses that `controller` hears."""
        return self.heard if controller.tracks else self.deciding

    def _alone(
        self, controller: PassageController, draws: Draws, faults: Faults | None, events: Floats, seen: Floats
    ) -> tuple[PassageSample, Floats, Floats]:
        """One pass after the other, with the events and pulse pairs of the last."""
        self._require_fit(controller, faults)
        every, passes = self.pulses_of(controller), len(draws.cut_factor)
        pairs, sources = pairs_of(every, draws, faults), len(every.path_m)
        pulses = every._replace(
            first_row=fixed(pairs.first_row(sources), np.int64), told_sensor=fixed(pairs.sensor, np.int64)
        )
        exits, outcome = empty_exits(passes), np.empty((passes, len(self.deciding.path_m)), dtype=np.uint8)
        memory = pass_memory(sources, len(pairs.source))
        count, heard = kernel.run_passage_passes(
            self.radar.path, self.drive, pulses, pairs.for_kernel(), controller.rule, controller.tracks,
            all_fixed(draws), memory, exits, outcome, events, seen,
        )  # fmt: skip
        sample = PassageSample(
            exits.speed_m_s, exits.stalled, exits.switchings, exits.time_s, draws.weight, outcome=outcome
        )
        return sample, events[:count], seen[:heard]

    def _require_fit(self, controller: PassageController, faults: Faults | None) -> None:
        if controller.stages != self.stages:
            raise ValueError(f"passage loop: the controller has {controller.stages} stages, the loop {self.stages}")
        if controller.tracks:
            return
        if faults is not None:
            raise ValueError("passage loop: a regulator without tracker cannot be run with faults")
        known, here = np.flatnonzero(controller.rule.deciding >= 0), self.deciding
        if not np.array_equal(known, here.number) or (
            np.abs(controller.rule.path_m[known] - here.path_m).max(initial=0.0) > PATH_ERROR_M
        ):
            raise ValueError("passage loop: the passages of the controller are not those of sensors and cut")


def pairs_of(pulses: passage_pulses.Pulses, draws: Draws, faults: Faults | None) -> HeardPairs:
    """The pulse pairs that are heard in the passes of `draws`."""
    if faults is None:
        return as_given(pulses.sensor, 1)
    return faults(as_given(pulses.sensor, len(draws.cut_factor)), draws)


def close_passage_loop(plant: Plant, sensors: PointSensors, stages: int, substeps: int | None = None) -> PassageLoop:
    """`plant` with a regulator of `stages` stages that decides at the passages of its cut over `sensors`.

    A transient is played as its means over `substeps` equal parts of a scan, by default as many as make them at most
    `SUBSTEP_S`. `ValueError` where a sensor stands ahead of the place from which on the regulator acts, where no
    passage is before the exit, or for more stages than the position has.
    """
    first_m = sensors.path_m[0] + plant.cut.axle_offsets_m[0]
    if first_m < plant.start_m - 1e-9:
        raise ValueError(
            f"passage loop: the first sensor stands at {first_m:g} m and the plant begins at "
            f"{plant.start_m:g} m: make the approach as long as that sensor is ahead of the entrance"
        )
    pulses = every_pulse(plant, sensors)
    deciding = deciding_pulses(pulses)
    if not len(deciding.path_m):
        raise ValueError("passage loop: no axle at which is decided passes a sensor before the exit")
    radar = close_loop(replace(plant, sensor=replace(plant.sensor, missed_share=0.0)), stages)
    substeps = substeps or scan_substeps(sensors)
    actuator = stage_locked_actuator(plant.position, sensors, stages - 1, substeps)
    drive = piece_drive(actuator, sensors.scan_period_s, plant.approach.initial_stage)
    return PassageLoop(sensors, radar, drive, pulses, deciding)


def scan_substeps(sensors: PointSensors) -> int:
    """Parts of a scan in which a transient is played: as many as make them at most `SUBSTEP_S`."""
    return math.ceil(sensors.scan_period_s / SUBSTEP_S - 1e-9)


def piece_drive(actuator: Actuator, period_s: float, initial_stage: int) -> kernel.PieceDrive:
    """What `actuator` plays as pieces of constant overpressure; `period_s` of the clock that its chains count in."""
    modes, part = len(actuator.mode_overpressure_kpa), period_s / actuator.substeps
    kpa, ends, after = [actuator.mode_overpressure_kpa], [np.full(modes, math.inf)], [np.arange(modes)]
    first, count = [], modes
    for chain, mode in enumerate(actuator.chain_mode):
        parts = int(actuator.chain_samples[chain]) * actuator.substeps
        played = np.round(actuator.chain_overpressure_kpa[chain, :parts], 9)  # so that a rest is one piece
        last = np.flatnonzero(np.append(np.diff(played) != 0.0, True))
        first.append(count)
        count += last.size
        kpa.append(played[last])
        ends.append((last + 1) * part)
        after.append(np.append(np.arange(first[-1] + 1, count), mode))
    return kernel.PieceDrive(
        fixed(np.concatenate(kpa), np.float64),
        fixed(np.concatenate(ends), np.float64),
        fixed(np.concatenate(after), np.int64),
        fixed(np.where(actuator.command < 0, -1, np.asarray(first)[actuator.command]), np.int64),
        actuator.mode_of(initial_stage),
        initial_stage,
    )


def pass_memory(sources: int, rows: int) -> passage_pulses.Memory:
    """Memory of the kernel for one pass at a time."""
    coils = 2 * sources
    return passage_pulses.Memory(
        np.empty(coils), np.empty(coils, dtype=np.int64), np.empty(sources),
        np.empty(rows), np.empty(rows), np.empty(rows),
        np.empty(rows, dtype=np.int64), np.empty(rows, dtype=np.int64), np.empty(STATE_FIELDS, dtype=np.float32),
    )  # fmt: skip


def readings_of(seen: Floats) -> PassReadings:
    """The pulse pairs that the kernel has noted, (pairs, `READING_FIELDS`), for reading."""
    time, middle, told, passage, believed, reading, outcome, stage = np.ascontiguousarray(seen.T)
    told, passage, believed, stage = (each.astype(np.int64) for each in (told, passage, believed, stage))
    return PassReadings(time, middle, told, passage, believed, reading, outcome.astype(np.uint8), stage)


def simulate_passages(
    plant: Plant,
    sensors: PointSensors,
    controller: PassageController,
    seed: int,
    count: int,
    first_pass: int = 0,
    threads: int = 1,
    faults: Faults | None = None,
) -> PassageSample:
    """`many_passes` of `plant` under `controller`: pass i is the same cut, friction, entry and resistance as in
    `simulate_many`."""
    loop = close_passage_loop(plant, sensors, controller.stages)

    def run(passes: RandomPasses) -> PassageSample:
        return loop.run(controller, loop.draws(passes), faults)

    return many_passes(run, loop.radar.cells, seed, count, first_pass, threads)


TRACE_STEP_S = 0.05
"""Between points of a traced pass, which has events of its own only at coils and changes of pressure."""


def filled_trace(loop: PassageLoop, trace: PassageTrace, draws: Draws, step_s: float = TRACE_STEP_S) -> PassageTrace:
    """`trace` of the only pass of `draws` with points at most `step_s` apart.

    Between two events the overpressure is constant, so each point is as exact as the events are.
    """
    path = loop.radar.path
    free = path.gravity_m_s2 - path.drag_m_s2_per_n_kn * draws.resistance_n_kn[0]
    added: list[tuple[float, float, float, int]] = []
    for event, (start, end) in enumerate(pairwise(trace.time_s.tolist())):
        s, v = float(trace.path_m[event]), float(trace.speed_m_s[event])
        cell = min(int(np.searchsorted(path.edges_m, s, side="right")) - 1, free.size - 1)
        for time in np.arange(start + step_s, end - 1e-9, step_s).tolist():
            cell, s, v, _, _ = roll(
                path.edges_m, free, draws.brake_m_s2_per_kpa[0], trace.overpressure_kpa[event], step_s, np.inf,
                cell, s, v,
            )  # fmt: skip
            added.append((time, s, v, event))
    times = np.array([time for time, *_ in added])
    events = np.array([event for *_, event in added], dtype=np.int64)
    order = np.argsort(np.concatenate([trace.time_s, times]), kind="stable")

    def with_points(events_of: NDArray[Any], points: NDArray[Any]) -> NDArray[Any]:
        return np.concatenate([events_of, points])[order]

    return replace(
        trace,
        time_s=with_points(trace.time_s, times),
        path_m=with_points(trace.path_m, np.array([s for _, s, _, _ in added])),
        speed_m_s=with_points(trace.speed_m_s, np.array([v for _, _, v, _ in added])),
        overpressure_kpa=with_points(trace.overpressure_kpa, trace.overpressure_kpa[events]),
        stage=with_points(trace.stage, trace.stage[events]),
        measured_m_s=with_points(trace.measured_m_s, np.full(times.size, np.nan)),
    )
