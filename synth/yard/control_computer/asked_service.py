"""Tasks and their service as a configuration asks for them."""

from __future__ import annotations

from dataclasses import dataclass

from plant_models.errors import require
from synth.configuration.computer.settings import CycleSettings, ServiceSettings, TaskSettings
from synth.yard.control_computer.sizing.cyclic_service import Cycle
from synth.yard.control_computer.sizing.demand_service import Discipline
from synth.yard.control_computer.sizing.needed_speed import AllowedWait
from synth.yard.control_computer.sizing.service_law import (
    Constant,
    Erlang,
    Exponential,
    Hyperexponential,
    ServiceLaw,
)
from synth.yard.control_computer.sizing.task import Task, TaskMix

DISCIPLINES = {
    "first-come": Discipline.FIRST_COME,
    "relative": Discipline.RELATIVE,
    "absolute": Discipline.ABSOLUTE,
}


@dataclass(frozen=True)
class Service:
    """Service on demand by one processor: its speed, who is next, and how long tasks may wait."""

    speed_op_s: float
    discipline: Discipline
    allowed: AllowedWait
    simulated_requests: int


def asked_mix(tasks: tuple[TaskSettings, ...]) -> TaskMix:
    """The tasks; `PlantError` names the one at fault."""
    return TaskMix(
        tuple(Task(each.name, each.rate_per_s, law_of(each), each.priority, each.deadline_s) for each in tasks)
    )


def law_of(task: TaskSettings) -> ServiceLaw:
    """The law of the operations of a task."""
    require(
        (task.stages is not None) == (task.law == "erlang"),
        f"task {task.name}: stages is for law = 'erlang', which needs it; the law is {task.law!r}",
    )
    require(
        (task.squared_cv is not None) == (task.law == "hyperexponential"),
        f"task {task.name}: squared_cv is for law = 'hyperexponential', which needs it; the law is {task.law!r}",
    )
    if task.stages is not None:
        return Erlang(task.operations, task.stages)
    if task.squared_cv is not None:
        return Hyperexponential(task.operations, task.squared_cv)
    return Constant(task.operations) if task.law == "constant" else Exponential(task.operations)


def asked_service(settings: ServiceSettings) -> Service:
    """Service on demand."""
    allowed = AllowedWait(settings.mean_wait_s, settings.long_wait_s, settings.long_wait_share)
    return Service(settings.speed_op_s, DISCIPLINES[settings.discipline], allowed, settings.simulated_requests)


def asked_cycle(settings: CycleSettings) -> Cycle:
    """Cyclic service."""
    return Cycle(settings.cycle_s, settings.check_share, settings.recovery_share)
