"""How fast the control computer must be, so that no task waits longer than is allowed: on demand, in cycles, at
the track; words, memory, inputs and outputs.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from plant_models.hump import Switch
from synth.computer.sizing.carried_positions import Carried, carried, most_positions
from synth.computer.sizing.counted_needs import (
    ChannelRules,
    ControllerCounts,
    CountedChannels,
    MemoryTable,
    common_word_bits,
    controller_memory,
    counted_channels,
    hump_quantities,
)
from synth.computer.sizing.queue_simulation import SimulatedWait, simulated_waits
from synth.computer.sizing.service import Discipline, MeanWait, cyclic_speed, mean_waits, used_share
from synth.computer.sizing.task import TaskMix, total_load
from synth.computer.sizing.trackside_controllers import TracksideController, usual_controllers
from synth.computer.sizing.waiting_tail import Inverted, sojourn_tail, start_tail

if TYPE_CHECKING:
    from synth.computer.resolved_computer import ResolvedComputer

LEAST_PROBABILITY = 1e-8
"""Below this the inversion of a transform tells nothing."""

RELATIVE_ERROR = 1e-9
"""Of the speed that is found, for the mean; the tail's own error comes on top."""


@dataclass(frozen=True)
class AllowedWait:
    """Every task's time from request to begin of service: mean at most `mean_s`, P(more than `long_s`) at most `share`.

    Either may be missing, but not both; `long_s` and `share` go together.
    """

    mean_s: float | None = None
    long_s: float | None = None
    share: float | None = None


def needed_speed(mix: TaskMix, discipline: Discipline, allowed: AllowedWait) -> float:
    """The least speed, op/s, that keeps `allowed` for every task of `mix`; it is always found.

    A faster computer makes every wait shorter, so each bound has one speed, and the greatest of them is the answer.
    """
    speeds = []
    if allowed.mean_s is not None:
        limit_s = allowed.mean_s
        speeds.append(_least_speed(mix, lambda speed: math.log(longest_mean_s(mix, discipline, speed) / limit_s)))
    if allowed.long_s is not None and allowed.share is not None:
        long_s, share = allowed.long_s, allowed.share

        def too_often(speed_op_s: float) -> float:
            return math.log(max(largest_tail(mix, discipline, speed_op_s, long_s), LEAST_PROBABILITY / 10) / share)

        speeds.append(_least_speed(mix, too_often))
    return max(speeds)


def longest_mean_s(mix: TaskMix, discipline: Discipline, speed_op_s: float) -> float:
    """The mean time to the begin of service of the task that has the longest."""
    return max(wait.start_s for wait in mean_waits(mix.streams(speed_op_s), discipline))


def largest_tail(mix: TaskMix, discipline: Discipline, speed_op_s: float, long_s: float) -> float:
    """P(time to the begin of service > `long_s`) of the task where it is largest."""
    streams = mix.streams(speed_op_s)
    alike = streams[:1] if discipline is Discipline.FIRST_COME else streams
    return max(start_tail(streams, discipline, stream.name, long_s).value for stream in alike)


def _least_speed(mix: TaskMix, excess: Callable[[float], float]) -> float:
    """The root of `excess`, which falls with the speed: from above 0 next to overload to below 0 for fast ones."""
    from scipy.optimize import brentq

    overload = mix.operations_per_s
    spare = overload
    while excess(overload + spare) > 0.0:
        spare *= 2.0
    above = spare
    while excess(overload + spare) <= 0.0:
        spare *= 0.5
    # the spare speed, not the speed, is the unknown: near overload it is what counts
    root = brentq(lambda log: excess(overload + math.exp(log)), math.log(spare), math.log(above), xtol=RELATIVE_ERROR)
    return overload + math.exp(float(root))


CUTS_OF_A_TRAIN = 40


@dataclass(frozen=True)
class TaskWait:
    """One task: its mean wait, the chance of a long one (None of a missed deadline where it has none), simulated."""

    formula: MeanWait
    long_share: Inverted
    late_share: Inverted | None
    simulated: SimulatedWait


@dataclass(frozen=True)
class ControllerRow:
    """A controller with all positions of the hump, and how many it carries at most."""

    controller: TracksideController
    all_positions: Carried
    most: int


@dataclass(frozen=True)
class SizedComputer:
    """`needed_op_s` by discipline; `waits_allowed`: the configured speed keeps what is allowed."""

    load: float
    waits: tuple[TaskWait, ...]
    needed_op_s: dict[Discipline, float]
    waits_allowed: bool
    cyclic_op_s: float
    cyclic_used: float
    word_bits: int
    memory: MemoryTable
    channels: tuple[CountedChannels, ...]
    controllers: tuple[ControllerRow, ...]


def sized(config: ResolvedComputer) -> SizedComputer:
    """All of it; `PlantError` where the tasks take more than the processor has."""
    mix, service, cycle = config.mix, config.settings.service, config.settings.cycle
    streams = mix.streams(service.speed_op_s)
    cyclic, times = cyclic_speed(cycle), config.settings.position
    allowed = AllowedWait(service.mean_wait_s, service.long_wait_s, service.long_wait_share)
    needed = {each: needed_speed(mix, each, allowed) for each in Discipline}
    return SizedComputer(
        load=total_load(streams),
        waits=task_waits(config),
        needed_op_s=needed,
        waits_allowed=needed[service.discipline] <= service.speed_op_s,
        cyclic_op_s=cyclic,
        cyclic_used=used_share(mix, cyclic, cycle, checks_count=True),
        word_bits=common_word_bits(hump_quantities()),
        memory=controller_memory(counts_of(config)),
        channels=counted_channels(config.hump, ChannelRules()),
        controllers=tuple(
            ControllerRow(each, carried(each, times, config.positions), most_positions(each, times))
            for each in usual_controllers()
        ),
    )


def task_waits(config: ResolvedComputer) -> tuple[TaskWait, ...]:
    """Formulas beside the simulation, by task."""
    service = config.settings.service
    long_s = service.long_wait_s
    streams = config.mix.streams(service.speed_op_s)
    means = mean_waits(streams, service.discipline)
    seed = config.settings.uncertainty.seed
    simulated = simulated_waits(streams, service.discipline, service.simulated_requests, seed, long_s)
    return tuple(
        TaskWait(
            mean,
            start_tail(streams, service.discipline, task.name, long_s),
            None if task.deadline_s is None else sojourn_tail(streams, service.discipline, task.name, task.deadline_s),
            beside,
        )
        for task, mean, beside in zip(config.mix.tasks, means, simulated, strict=True)
    )


def counts_of(config: ResolvedComputer) -> ControllerCounts:
    """What our controller of this hump holds."""
    switches = sum(isinstance(vertex, Switch) for vertex in config.hump.vertices)
    tracks = {track for lead in config.hump.leads for track in config.hump.routes(lead)}
    return ControllerCounts(
        positions=config.positions,
        books=config.positions,
        aim_tables=len(tracks),
        switches=switches,
        tracks=len(tracks),
        cuts=CUTS_OF_A_TRAIN,
    )
