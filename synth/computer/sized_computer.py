"""How fast the control computer must be: on demand, in cycles, at the track; words, memory, inputs and outputs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from plant_models.hump import Switch
from synth.computer.sizing.carried_positions import Carried, carried, most_positions
from synth.computer.sizing.cyclic_service import cyclic_speed, used_share
from synth.computer.sizing.demand_service import Discipline, MeanWait, mean_waits
from synth.computer.sizing.inputs_outputs import ChannelRules, CountedChannels, counted_channels
from synth.computer.sizing.laplace_inversion import Inverted
from synth.computer.sizing.memory_need import ControllerCounts, MemoryTable, controller_memory
from synth.computer.sizing.needed_speed import AllowedWait, needed_speed
from synth.computer.sizing.queue_simulation import SimulatedWait, simulated_waits
from synth.computer.sizing.task import total_load
from synth.computer.sizing.trackside_controllers import TracksideController, usual_controllers
from synth.computer.sizing.waiting_tail import sojourn_tail, start_tail
from synth.computer.sizing.word_length import common_word_bits, hump_quantities

if TYPE_CHECKING:
    from synth.computer.resolved_computer import ResolvedComputer

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
