"""What surfaces lose beside lines for commands at rest, where valves, plant, gauge or sensor are not as they
should be.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from plant_models import Plant
from plant_models.frozen_arrays import Floats
from scripts.studies.any_time.findings import Ratio, SilentGauge, StuckFigures, Way, Ways
from scripts.studies.any_time.kernels.stuck_valves import Asking, Stuck, run_stuck_passes
from scripts.studies.changed_plants import DropOut, LostReadings, aged_valves, at_random
from scripts.studies.estimator.wrong_study import Wrong, braking_otherwise, simulated
from scripts.studies.near_target import near_target
from synth.kernels.any_time.any_time_law import AnyTimeLaw
from synth.kernels.loop.passes import LONGEST_PASS_S, Draws
from synth.kernels.loop.trace import EVENT_FIELDS
from synth.simulation.closed_loop import (
    ClosedLoop,
    Controller,
    LineController,
    TableController,
    empty_exits,
    sample_of,
    simulate,
    trace_of,
)
from synth.simulation.common_passes import CommonPasses
from synth.simulation.controllers import fixed
from synth.simulation.exit_statistics import exit_statistics, rms_ratio
from synth.simulation.passes import ExitSample, PassTrace
from synth.simulation.random_passes import RandomPasses
from synth.solver.tabulate import lines_of
from tuning_tables import ControllerTable, Decisions


@dataclass(frozen=True)
class StuckValves:
    """Valves that do not open for `duration_s`: an open one shuts when that begins."""

    name: str
    filling: bool
    release: bool
    duration_s: float

    def in_drive(self, loop: ClosedLoop, starts_s: Floats) -> Stuck:
        """The same as the kernel takes it, from `starts_s` (n,) on."""
        valves = loop.sampled.valves
        stuck = valves._replace(
            brake_delay_s=math.inf if self.filling else valves.brake_delay_s,
            release_delay_s=math.inf if self.release else valves.release_delay_s,
        )
        return Stuck(stuck, fixed(starts_s, np.float64), self.duration_s)


NOTHING = StuckValves("nothing", False, False, 0.0)

STUCK = (
    NOTHING,
    StuckValves("both valves, 1 s", True, True, 1.0),
    StuckValves("filling valve, 2 s", True, False, 2.0),
    StuckValves("release valve, 2 s", False, True, 2.0),
    StuckValves("filling valve, for good", True, False, math.inf),
    StuckValves("release valve, for good", False, True, math.inf),
)


@dataclass(frozen=True)
class StuckLoop:
    """A closed loop whose valves get stuck, and a regulator that asks its lines in one of the `Ways`."""

    loop: ClosedLoop
    controller: LineController | TableController
    way: Ways

    def law(self) -> AnyTimeLaw:
        """The rule; raises `ValueError` for an estimator or a lead, which no table of this study has."""
        controller = self.controller
        if isinstance(controller, LineController):
            controller = replace(controller, decisions=Decisions.AT_ANY_TIME)
        law = controller.law()
        if not isinstance(law, AnyTimeLaw) or law.rule.table.breaks > 0 or law.rule.lead_s != 0.0:
            raise ValueError("stuck valves: lines for measured speeds, or a table for commands at any time")
        return law

    def asking(self) -> Asking:
        """When the rule is asked."""
        drive = self.loop.drive
        how = self.way is Ways.GAUGE, self.way is Ways.TIMES
        return Asking(*how, drive.command, drive.chain_mode, drive.chain_samples, drive.initial_mode)

    def run(self, draws: Draws, stuck: StuckValves, starts_s: Floats) -> ExitSample:
        """All passes of `draws`; `starts_s` (n,): when valves get stuck."""
        return self._passes(draws, stuck, starts_s, np.empty((0, EVENT_FIELDS)))[0]

    def follow(self, draws: Draws, stuck: StuckValves, start_s: float) -> PassTrace:
        """The only pass of `draws`, event by event."""
        samples = math.ceil(LONGEST_PASS_S / self.loop.sensor.period_s + 2)
        events = np.empty((samples * self.loop.drive.substeps + 2, EVENT_FIELDS))
        sample, events = self._passes(draws, stuck, np.array([start_s]), events)
        return trace_of(events, bool(sample.stalled[0]))

    def _passes(self, draws: Draws, stuck: StuckValves, starts_s: Floats, events: Floats) -> tuple[ExitSample, Floats]:
        loop, exits = self.loop, empty_exits(len(draws.cut_factor))
        count = run_stuck_passes(
            loop.path, loop.sampled, loop.sensor, self.law(), self.asking(), stuck.in_drive(loop, starts_s), draws,
            exits, events,
        )  # fmt: skip
        return sample_of(exits, draws), events[:count]


def where_stuck(
    target_m_s: float, table: TableController, at_rest: LineController, passes: CommonPasses, seed: int
) -> dict[str, StuckFigures]:
    """What `table` and `at_rest` do on the same `passes`, for each of `STUCK`.

    `seed` draws the moments, uniform over the time that a pass takes at rest with sound valves.
    """
    loop = passes.loop(table.stages)
    regulators: dict[Ways, LineController | TableController] = {
        Ways.GAUGE: at_rest,
        Ways.TIMES: at_rest,
        Ways.ANY_TIME: table,
    }
    starts_s = at_random(seed)(passes.run(at_rest).transit_time_s)
    found = {}
    for stuck in STUCK:
        samples = {
            way: StuckLoop(loop, controller, way).run(passes.draws, stuck, starts_s)
            for way, controller in regulators.items()
        }
        found[stuck.name] = StuckFigures(
            {way.value: way_of(sample, target_m_s) for way, sample in samples.items()},
            *(Ratio(*rms_ratio(samples[Ways.ANY_TIME], samples[way], target_m_s)) for way in (Ways.GAUGE, Ways.TIMES)),
        )
    return found


def way_of(sample: ExitSample, target_m_s: float) -> Way:
    """What is told of one regulator."""
    found = exit_statistics(sample, target_m_s)
    return Way(found.rms_m_s, near_target(sample, target_m_s).outside, found.stalled)


LINE_NODES = 301


def otherwise(plant: Plant, seed: int) -> Iterator[Wrong]:
    """Plants and sensors to try; `seed` draws what readings are lost."""
    rough = replace(plant.friction, path_std=2.0 * plant.friction.path_std)
    yield from braking_otherwise(plant)
    yield Wrong("path noise × 2", replace(plant, friction=rough))
    yield Wrong("valves: delays × 2, constants × 1.5", aged_valves(plant))
    yield Wrong("one reading in ten lost", plant, fault=LostReadings(0.1, seed))
    yield Wrong("no reading for 1 s, any moment", plant, fault=DropOut(1.0, at_random(seed)))


def ratios_to_rest(
    plant: Plant, target_m_s: float, table: TableController, at_rest: Controller, passes: RandomPasses, seed: int
) -> dict[str, Ratio]:
    """rms of `table` over that of `at_rest` on the same `passes`, for each thing that is wrong."""
    rest, found = simulate(plant, at_rest, passes), {}
    for wrong in otherwise(plant, seed):
        ours, theirs = (simulated(wrong, each, passes, rest.transit_time_s) for each in (table, at_rest))
        found[wrong.name] = Ratio(*rms_ratio(ours, theirs, target_m_s))
    return found


def with_a_silent_gauge(
    target_m_s: float, table: ControllerTable, at_rest: Controller, passes: CommonPasses
) -> SilentGauge:
    """`table`, one stage a command, beside a gauge that shows nothing: asked at every sample, or at rest."""
    lines = lines_of(waiting_table(table), np.linspace(*table.valid.s_m, LINE_NODES))
    rest, waiting = passes.run(at_rest), passes.run(LineController(lines, farthest=table.farthest))
    going_on = passes.run(TableController(table, math.nan))
    pairs = (going_on, rest), (waiting, rest), (waiting, going_on)
    return SilentGauge(*(Ratio(*rms_ratio(*pair, target_m_s)) for pair in pairs))


def waiting_table(table: ControllerTable) -> ControllerTable:
    """The lines of `table` as they stand at the pressure of their stage, for commands at rest."""
    stages = (replace(each, lower_slope_m_s_per_kpa=None, upper_slope_m_s_per_kpa=None) for each in table.stages)
    return replace(table, decisions=Decisions.AT_REST, stages=tuple(stages))
