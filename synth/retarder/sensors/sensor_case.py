"""What all targets of one cut class with point sensors share: plant, chains, passes, and the stamp of tables; and one
case of a tune: its table, and what became of the passages at which it decides.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from plant_models import Plant, PointSensors
from plant_models.frozen_arrays import frozen_arrays
from synth.kernels.loop.passes import Draws
from synth.problem.problem import Aim
from synth.problem.resolution import Resolution
from synth.retarder.class_setup import Origin
from synth.retarder.configuration.resolved_position import ResolvedSensors
from synth.retarder.epochs import Store, validated
from synth.retarder.sensors.passage_table import PassageChains, passage_chains, passage_table, tuned_passages
from synth.retarder.tuned_case import TunedCase
from synth.simulation.common_passes import exit_range
from synth.simulation.exit_statistics import UnavoidableError, unavoidable_error
from synth.simulation.passage_controller import (
    HEARD,
    MISTAKEN,
    TAKEN,
    UNFINISHED,
    PassageController,
    PassageSample,
    PassageTrace,
    of_speeds,
    of_table,
    shares_of_outcomes,
)
from synth.simulation.passage_loop import PassageLoop, close_passage_loop, filled_trace
from synth.simulation.passes import TRACE_FACTORS, ExitSample
from synth.simulation.random_passes import RandomPasses
from synth.simulation.replicates import Interval
from synth.solver.tabulate import LOWEST_VALID_SPEED_M_S
from tuning_tables.passages.passage_table import PassageTable


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


@dataclass(frozen=True)
class HeardShares:
    """Of the cuts heard at every passage at which is decided, in its order, the shares with 95 % intervals.

    `unfinished`: found a change of stage unfinished, so that nothing was decided; `mistaken`: the tracker took the
    pulses for no passage, or for one at which nothing is decided. NaN where no cut came. `taken`: passes whose pulses
    were taken for the passage, of which `unfinished` is told; `heard`: all heard there, of which `mistaken` is.
    """

    unfinished: tuple[tuple[float, Interval], ...]
    mistaken: tuple[tuple[float, Interval], ...]
    taken: tuple[int, ...]
    heard: tuple[int, ...]


@frozen_arrays
class SensorCase(TunedCase):
    """One case of tables for point sensors.

    Slowest of the passes behind `unavoidable` are cuts under the harder braking of two, the table and full brake at
    every passage.
    """

    table: PassageTable
    traces: tuple[PassageTrace, ...]
    heard: HeardShares


def sensor_case(setup: SensorClass, aim: Aim, store: Store[PassageTable]) -> SensorCase:
    """Tune one case; the table is simulated as read back from where it is stored, and stored with the figures."""
    passes, target_m_s = setup.passes, aim.target_speed_m_s
    tuned = tuned_passages(setup.chains, aim)
    table = passage_table(tuned, *setup.origin.stamp(setup.label, target_m_s))
    found = validated(table, store, lambda kept: passes.run(of_table(kept, tracking=True)), setup.passes.at_full_brake)
    controller = of_table(found.table, tracking=True)
    return SensorCase(
        label=setup.label,
        plant=setup.plant,
        table=found.table,
        predicted=tuned.predicted,
        polish=tuned.polish,
        exit_speeds_m_s=found.sample.exit_speed_m_s.astype(np.float32),
        exit_weight=found.sample.weight,
        statistics=found.statistics,
        brake_power=found.brake_power,
        unavoidable=unavoidable(passes, found.sample, target_m_s),
        traces=tuple(passes.trace(controller, i, factor) for i, factor in enumerate(TRACE_FACTORS)),
        heard=heard_shares(found.sample),
    )


def unavoidable(passes: SensorPasses, sample: ExitSample, target_m_s: float) -> UnavoidableError:
    """The error that no rule with these sensors avoids; `sample`: the passes under a table."""
    slowest = np.minimum(sample.exit_speed_m_s, passes.at_full_brake.exit_speed_m_s)
    return unavoidable_error(replace(sample, exit_speed_m_s=slowest), passes.released, target_m_s)


def heard_shares(sample: PassageSample) -> HeardShares:
    """Passages that found a change of stage unfinished, or were mistaken."""
    taken, heard = (np.isin(sample.outcome, outcomes).sum(axis=0) for outcomes in (TAKEN, HEARD))
    return HeardShares(
        shares_of_outcomes(sample, (UNFINISHED,), TAKEN),
        shares_of_outcomes(sample, MISTAKEN, HEARD),
        tuple(taken.tolist()),
        tuple(heard.tolist()),
    )
