"""Closed-loop Monte Carlo: passes of a plant under a table or switching lines (the proof that a table works)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate, pairwise

import numpy as np
from numpy.typing import NDArray

from plant_models import Plant
from plant_models.frozen_arrays import Floats, Ints
from plant_models.pressure_regulator import overpressure_kpa
from plant_models.stage_regulator import resting_modes, stage_locked_actuator
from synth.kernels.any_time.any_time_law import AnyTimeLaw
from synth.kernels.any_time.closed_loop import run_any_time_passes
from synth.kernels.any_time.driven_period import SampledDrive
from synth.kernels.loop import lane_places as places
from synth.kernels.loop.closed_loop import run_passes
from synth.kernels.loop.drive import Drive, Pieces
from synth.kernels.loop.lane_estimator import FIELDS, Observed
from synth.kernels.loop.motion import Path, brake_rows
from synth.kernels.loop.passes import LONGEST_PASS_S, Draws, Exits
from synth.kernels.loop.regulator import Rule, Sensor
from synth.kernels.loop.trace import EVENT_FIELDS, Trace
from synth.simulation.controllers import Controller, LineController, Regulator, TableController, all_fixed, fixed
from synth.simulation.passes import ExitSample, PassTrace
from synth.simulation.path_and_drive import drive_pieces, empty_periods, path_cells
from synth.simulation.random_passes import RandomPasses, readings_z
from synth.simulation.stratified_passes import many_passes

__all__ = [
    "ClosedLoop",
    "Controller",
    "LineController",
    "TableController",
    "close_loop",
    "simulate",
    "simulate_many",
    "trace",
]

SUBSTEP_S = 0.02
"""Longest part of a transient that is played as its mean (see the convergence test): within 0.1 mm/s at the exit."""


@dataclass(frozen=True)
class ClosedLoop:
    """A plant made ready for the kernel: path cells, actuator, sensor. Build it with `close_loop`."""

    plant: Plant
    path: Path
    drive: Drive
    sensor: Sensor

    @cached_property
    def pieces(self) -> Pieces:
        """What the drive plays, piece by piece."""
        return drive_pieces(self.drive, self.sensor.period_s)

    @property
    def stages(self) -> int:
        """Number of stages K + 1."""
        return int(self.drive.command.shape[1])

    @property
    def cells(self) -> int:
        """Number of path cells behind the entrance."""
        return len(self.path.gravity_m_s2) - self.path.approach_cells

    @property
    def stage_overpressures_kpa(self) -> Floats:
        """max(0, P_k − P0) of the stages, shape (K + 1,)."""
        position = self.plant.position
        nominal = np.asarray(position.stage_pressures_kpa[: self.stages])
        return overpressure_kpa(nominal, position.force.touch_pressure_kpa)

    def draws(self, passes: RandomPasses, cut_factor: float | None = None) -> Draws:
        """What `passes` mean for this plant; `cut_factor` fixes ξ_cut (the friction is known), for all cuts alike."""
        plant = self.plant
        factor, weight = plant.friction.cut_factor(passes.cut_z, plant.friction_cv), passes.weight
        if cut_factor is not None:
            factor, weight = np.full(len(passes), cut_factor, dtype=np.float64), np.ones(len(passes))
        factor, path_z = fixed(factor, np.float64), fixed(passes.path_z, np.float32)
        resistance = self.resistance_n_kn(passes.resistance_u)
        return Draws(
            factor,
            fixed(resistance, np.float64),
            fixed(plant.start_speed_m_s(plant.entry.speed_m_s(passes.entry_u), resistance), np.float64),
            fixed(passes.phase_u * plant.sensor.sample_period_s, np.float64),
            path_z,
            fixed(readings_z(passes, plant.sensor), np.float32),
            pad_slopes(self.path, factor, path_z),
            fixed(weight, np.float64),
        )

    def resistance_n_kn(self, u: Floats) -> Floats:
        """w0 for uniform `u`: the quantiles of its gamma law."""
        law = self.plant.resistance
        if law.std_n_per_kn == 0.0:
            return np.full(u.shape, law.mean_n_per_kn)
        from scipy.special import gammaincinv  # start-up: scipy only where it is needed

        return np.asarray(gammaincinv(law.shape, u) * law.scale_n_per_kn, dtype=np.float64)

    @cached_property
    def sampled(self) -> SampledDrive:
        """The drive for commands at every sample; raises `PlantError` as `Plant.drive_at_any_time`."""
        position, top = self.plant.position, self.stages - 1
        first = self.drive.initial_stage
        return SampledDrive(
            self.plant.drive_at_any_time(),
            fixed(np.asarray(position.stage_pressures_kpa[: top + 1]), np.float64),
            first,
            next(kpa for stage, kpa in resting_modes(position, top) if stage == first),
            self.drive.entrance_stage,
            self.plant.sensor.computing_delay_s,
            self.drive.substeps,
        )

    def run(self, controller: Regulator, draws: Draws) -> ExitSample:
        """All passes of `draws` under `controller`; `PlantError` where it commands what valves cannot follow."""
        return self._run(controller, draws, empty_trace(0))

    def follow(self, controller: Regulator, draws: Draws) -> PassTrace:
        """The only pass of `draws` under `controller`, event by event."""
        samples = math.ceil(LONGEST_PASS_S / self.sensor.period_s + 2) + int(self.drive.chain_samples.max())
        trace = empty_trace(samples * self.drive.substeps + 2)
        sample = self._run(controller, draws, trace)
        return trace_of(trace.events[: trace.noted[0]], bool(sample.stalled[0]))

    def _run(self, controller: Regulator, draws: Draws, trace: Trace) -> ExitSample:
        if controller.stages != self.stages:
            raise ValueError(f"closed loop: the controller has {controller.stages} stages, the loop {self.stages}")
        law, passes, draws = controller.law(), len(draws.cut_factor), all_fixed(draws)
        exits, work = empty_exits(passes), lane_memory()
        if isinstance(law, AnyTimeLaw):
            memory = work, empty_periods(self.sampled), empty_observed(law.rule, passes)
            run_any_time_passes(self.path, self.sampled, self.sensor, law, draws, exits, trace, *memory)
        else:
            run_passes(self.path, self.pieces, self.sensor, law, draws, exits, trace, work, empty_observed(law, passes))
        return sample_of(exits, draws)


def pad_slopes(path: Path, factor: Floats, path_z: NDArray[np.float32]) -> Floats:
    """Slope of the pads in every cell of n passes, (n, C): deceleration by one kPa of overpressure, m/s² per kPa.

    Its mean depends on the number N of braked wheel pairs (`path_coefficients`); `factor` (n,) is ξ_cut, `path_z` the
    standard normal numbers of η.
    """
    slopes = np.empty((len(factor), len(path.gravity_m_s2)))
    brake_rows(path, factor, path_z, slopes)
    return fixed(slopes, np.float64)


def empty_exits(passes: int) -> Exits:
    """Memory for the results of `passes` passes."""
    return Exits(np.empty(passes), np.empty(passes), np.empty(passes, dtype=np.bool_), np.empty(passes, dtype=np.int32))


def empty_trace(events: int) -> Trace:
    """Memory for so many events of a pass, of which none is noted yet; 0: no trace is wanted."""
    return Trace(np.empty((events, EVENT_FIELDS)), np.array([0, -1, -1]))


def empty_observed(law: Rule, passes: int) -> Observed:
    """Memory of the estimator of `law` for `passes` passes that have not begun; none if it has no estimator."""
    passes = passes if law.table.breaks > 0 else 0
    return Observed(
        np.zeros((passes, FIELDS), dtype=np.float32),
        np.zeros((passes, 2), dtype=np.float32),
        np.zeros(passes, dtype=np.int64),
        np.zeros(passes),
    )


def lane_memory() -> places.Work:
    """Memory for one call of the kernels that run passes side by side: one block that begins a page.

    A pack is then one line of the cache, not two, and no load waits for a store that only looks like its own: the
    processor compares no more than the place within a page, and where numpy happens to put arrays cost up to half.
    """
    page, n = 4096 // 8, places.PLACES
    sizes = (places.FLOATS * n, places.INTS * n, n, n, n, n, n)
    room = np.zeros(page + sum(sizes), dtype=np.int64)
    ends = accumulate(sizes, initial=-(room.ctypes.data // 8) % page)
    floats, ints, waiting, read, ended, told, heard = (room[start:end] for start, end in pairwise(ends))
    return places.Work(
        floats.view(np.float64), ints, waiting, read.view(np.float64), ended, told, heard.view(np.float64)
    )


def sample_of(exits: Exits, draws: Draws) -> ExitSample:
    """What the kernel has filled in for `draws`, for reading."""
    return ExitSample(exits.speed_m_s, exits.stalled, exits.switchings, exits.time_s, draws.weight)


def trace_of(events: Floats, stalled: bool) -> PassTrace:
    """The events that a kernel has noted of one pass, (events, `EVENT_FIELDS`), for reading."""
    time, path, speed, overpressure, stage, measured = np.ascontiguousarray(events.T)
    return PassTrace(time, path, speed, overpressure, stage.astype(np.int64), measured, stalled)


def close_loop(plant: Plant, stages: int, substeps: int | None = None) -> ClosedLoop:
    """`plant` with a regulator of `stages` stages: as many as its controller has, allowed or not."""
    if not 2 <= stages <= plant.position.top_stage + 1:
        raise ValueError(f"closed loop: {stages} stages; {plant.position.name} has {plant.position.top_stage + 1}")
    if substeps is None:
        substeps = math.ceil(plant.sensor.sample_period_s / SUBSTEP_S)
    actuator = stage_locked_actuator(plant.position, plant.sensor, stages - 1, substeps)
    drive = Drive(
        fixed(actuator.mode_overpressure_kpa, np.float64),
        fixed(actuator.command, np.int64),
        fixed(actuator.chain_mode, np.int64),
        fixed(actuator.chain_samples, np.int64),
        # Rounded, so that the kernel sees that a pressure at rest is one and the same.
        fixed(np.round(actuator.chain_overpressure_kpa, 9), np.float64),
        actuator.substeps,
        actuator.mode_of(plant.approach.initial_stage),
        plant.approach.initial_stage,
        plant.approach.entrance_stage,
    )
    sensor = plant.sensor
    return ClosedLoop(
        plant=plant,
        path=path_cells(plant),
        drive=drive,
        sensor=Sensor(sensor.sample_period_s, sensor.noise_m_s, sensor.resolution_m_s),
    )


def picked(draws: Draws, which: Ints) -> Draws:
    """Some passes of `draws`, in this order; of the path they keep what follows from `path_z`, not the numbers."""
    kept = draws._replace(path_z=draws.path_z[:, :0])
    return Draws._make(fixed(each[which], each.dtype.type) for each in kept)


def simulate(plant: Plant, controller: Controller, passes: RandomPasses, cut_factor: float | None = None) -> ExitSample:
    """`passes` of `plant` under `controller`; `cut_factor` fixes ξ_cut instead of drawing it."""
    loop = close_loop(plant, controller.stages)
    return loop.run(controller, loop.draws(passes, cut_factor))


def simulate_many(
    plant: Plant, controller: Controller, seed: int, count: int, first_pass: int = 0, threads: int = 1
) -> ExitSample:
    """`many_passes` of `plant` under `controller`."""
    loop = close_loop(plant, controller.stages)

    def run(passes: RandomPasses) -> ExitSample:
        return loop.run(controller, loop.draws(passes))

    return many_passes(run, loop.cells, seed, count, first_pass, threads)


def trace(
    plant: Plant, controller: Controller, passes: RandomPasses, index: int, cut_factor: float | None = None
) -> PassTrace:
    """Pass `index` of `passes` event by event: the same pass as in `simulate`."""
    loop = close_loop(plant, controller.stages)
    return loop.follow(controller, loop.draws(passes.part(index, index + 1), cut_factor))
