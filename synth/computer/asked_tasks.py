"""Tasks as a configuration asks for them."""

from __future__ import annotations

from plant_models.errors import require
from synth.computer.settings import TaskSettings
from synth.computer.sizing.service_law import Constant, Erlang, Exponential, Hyperexponential, ServiceLaw
from synth.computer.sizing.task import Task, TaskMix


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
