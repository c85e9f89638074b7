"""Closed-loop Monte Carlo where a command may be given at every sample; pass i is that of `simulation.closed_loop`."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models import Plant
from plant_models.stage_regulator import resting_modes
from synth.kernels.any_time.closed_loop import SampledDrive, run_any_time_passes
from synth.kernels.loop import closed_loop as kernel
from synth.simulation.any_time.laws import AnyTimeController
from synth.simulation.closed_loop import ClosedLoop, close_loop, empty_exits, sample_of, trace_of
from synth.simulation.controllers import fixed
from synth.simulation.passes import ExitSample, PassTrace
from synth.simulation.random_passes import RandomPasses


@dataclass(frozen=True)
class AnyTimeLoop:
    """A plant made ready for the kernel: the locked loop's path cells, sensor and draws, and a drive of its own."""

    locked: ClosedLoop
    drive: SampledDrive

    def draws(self, passes: RandomPasses, cut_factor: float | None = None) -> kernel.Draws:
        """What `passes` mean for this plant: the same as in the locked loop, so that results are paired."""
        return self.locked.draws(passes, cut_factor)

    def run(self, controller: AnyTimeController, draws: kernel.Draws) -> ExitSample:
        """All passes of `draws` under `controller`."""
        return self._record(controller, draws, np.empty((0, kernel.EVENT_FIELDS)))[0]

    def follow(self, controller: AnyTimeController, draws: kernel.Draws) -> PassTrace:
        """The only pass of `draws` under `controller`, event by event."""
        longest = math.ceil(kernel.LONGEST_PASS_S / self.locked.sensor.period_s + 2) * self.drive.parts + 2
        sample, events = self._record(controller, draws, np.empty((longest, kernel.EVENT_FIELDS)))
        return trace_of(events, bool(sample.stalled[0]))

    def _record(
        self, controller: AnyTimeController, draws: kernel.Draws, events: NDArray[np.float64]
    ) -> tuple[ExitSample, NDArray[np.float64]]:
        if controller.stages != len(self.drive.stage_kpa):
            raise ValueError(f"any-time loop: {controller.stages} stages, the loop has {len(self.drive.stage_kpa)}")
        exits, loop = empty_exits(len(draws.cut_factor)), self.locked
        count = run_any_time_passes(loop.path, self.drive, loop.sensor, controller.law(), draws, exits, events)
        return sample_of(exits, draws), events[:count]


def any_time_loop(plant: Plant) -> AnyTimeLoop:
    """`plant` with all stages that its cut may use; raises `PlantError` for valves that close late."""
    position, top = plant.position, plant.top_stage
    locked = close_loop(plant, top + 1)
    drive = SampledDrive(
        position.pneumatics.valves_shutting_at_once(position.force.touch_pressure_kpa),
        fixed(np.asarray(position.stage_pressures_kpa[: top + 1]), np.float64),
        plant.approach.initial_stage,
        next(kpa for stage, kpa in resting_modes(position, top) if stage == plant.approach.initial_stage),
        plant.entrance_stage,
        plant.sensor.computing_delay_s,
        locked.drive.substeps,
    )
    return AnyTimeLoop(locked, drive)
