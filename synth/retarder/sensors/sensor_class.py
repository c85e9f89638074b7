"""What all targets of one cut class with point sensors share: plant, chains, passes, and the stamp of tables."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from plant_models import Plant, PointSensors
from synth.kernels.loop.passes import Draws
from synth.problem.resolution import Resolution
from synth.retarder.class_setup import Origin
from synth.retarder.configuration.point_sensors.resolved_sensors import ResolvedSensors
from synth.retarder.sensors.tuned_passages import PassageChains, passage_chains
from synth.simulation.exit_range import exit_range
from synth.simulation.passage_controller import PassageController, of_speeds
from synth.simulation.passage_loop import PassageLoop, close_passage_loop, filled_trace
from synth.simulation.passage_sample import PassageSample, PassageTrace
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses
from synth.solver.tabulate import LOWEST_VALID_SPEED_M_S


@dataclass(frozen=True)
class SensorPasses:
    """`passes` and what they mean for a plant with point sensors: the same for every rule that is simulated."""

    loop: PassageLoop
    passes: RandomPasses
    draws: Draws

    def run(self, controller: PassageController) -> PassageSample:
        """All passes under `controller`."""
        return self.loop.run(controller, self.draws)

    @cached_property
    def at_full_brake(self) -> PassageSample:
        """All passes under a regulator that goes to the highest stage allowed at every decision."""
        return self.run(full_brake(self.loop))

    @cached_property
    def released(self) -> ExitSample:
        """All passes without any braking: released where the radar would act first."""
        return exit_range(self.loop.radar, self.draws).fastest

    def trace(self, controller: PassageController, index: int, cut_factor: float) -> PassageTrace:
        """Pass `index`, but with the friction factor `cut_factor`; points at most `TRACE_STEP_S` apart."""
        draws = self.loop.draws(self.passes.part(index, index + 1), cut_factor)
        return filled_trace(self.loop, self.loop.follow(controller, draws), draws)


@dataclass(frozen=True)
class SensorClass:
    """The class `label`: its plant from the first sensor on, chains to design on and to predict on, its passes."""

    label: str
    plant: Plant
    sensors: PointSensors
    chains: PassageChains
    passes: SensorPasses
    origin: Origin


def sensor_class(
    label: str, plant: Plant, resolved: ResolvedSensors, resolution: Resolution, passes: RandomPasses, origin: Origin
) -> SensorClass:
    """The class with the radar's `plant`, served by point sensors, and simulated on `passes`."""
    served, sensors = resolved.serving(plant), resolved.sensors
    chains = passage_chains(served, sensors, resolution)
    return SensorClass(label, served, sensors, chains, sensor_passes(served, sensors, passes), origin)


def sensor_passes(plant: Plant, sensors: PointSensors, passes: RandomPasses, stages: int | None = None) -> SensorPasses:
    """Make `passes` ready for `plant`, whose regulator has so many `stages`; unless told all of the position."""
    loop = close_passage_loop(plant, sensors, stages or plant.position.top_stage + 1)
    return SensorPasses(loop, passes, loop.draws(passes))


def full_brake(loop: PassageLoop) -> PassageController:
    """The rule that wants the highest stage allowed at every passage; it is told which passage each is."""
    top, stages = loop.plant.top_stage, loop.stages
    rows = np.full((len(loop.deciding.path_m), stages, stages - 1), -np.inf, dtype=np.float32)
    for stage in range(stages):
        rows[:, stage, stage:] = LOWEST_VALID_SPEED_M_S
        rows[:, stage, max(stage, top) :] = np.inf
    return of_speeds(loop.plant, loop.sensors, rows)
