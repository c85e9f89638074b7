"""The command `sensors plan`: where point sensors stand, and how many of them a wanted rms takes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from synth.frame.command import Asked, Command, Head, Limit, Steps, Work
from synth.frame.exhibits import Chapter
from synth.frame.printed_numbers import counted
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.configured import head_of
from synth.retarder.sensors.plan_options import PlanOptions

if TYPE_CHECKING:
    from synth.retarder.sensors.layout_plan import LayoutProblem
    from synth.retarder.sensors.layout_results import LayoutResults

LIMITS_OF_USE = (
    "The rms is predicted of the model with the parameters of this page. Assumed ones are guesses.",
    "Sensors may stand at multiples of half a metre. What hinders them on the track is not known here.",
    "Every sensor is taken to work. What a failed one costs is told by 'sensors tune'.",
)


@dataclass(frozen=True)
class AskedPlan:
    """A problem of all cut classes and targets, the labels of the classes, and what is asked of the plan."""

    config: ResolvedConfig
    problem: LayoutProblem
    labels: tuple[str, ...]
    options: PlanOptions


def resolve(asked: Asked[ResolvedConfig, PlanOptions]) -> AskedPlan:
    """The problem of a configuration."""
    from synth.retarder.sensors.layout_order import layout_problem

    return AskedPlan(asked.settings, *layout_problem(asked.settings), asked.options)


def head(asked: AskedPlan) -> Head:
    """What is said of the configuration."""
    return head_of(asked.config)


def steps(asked: AskedPlan) -> Steps:
    """Each number of sensors, each layout, and what stands beside them."""
    from synth.retarder.sensors.layout_plan import steps_of_plan

    return Steps(steps_of_plan([number - 1 for number in asked.options.sensors]) + 1, "planning", "steps")


def compute(asked: AskedPlan, work: Work) -> LayoutResults:
    """The plans, the rule and the radar."""
    from synth.retarder.first_run import compiled_beside
    from synth.retarder.sensors.layout_results import layout_results

    options, progress = asked.options, work.progress
    classes = counted(len(asked.problem.cases), "cut class", "cut classes")
    progress.note(f"looking for the places of up to {max(options.sensors)} sensors, for {classes}")
    with compiled_beside(progress.note):
        return layout_results(
            asked.problem, asked.labels, options.sensors, options.rms_m_s, options.workers, progress.done
        )


def limits(found: LayoutResults) -> Iterator[Limit]:
    """Whether one of the numbers gives the wanted rms."""
    wanted = f"an rms of at most {found.wanted_rms_m_s:.4f} m/s"
    if found.chosen is None:
        yield Limit(f"none of these numbers of sensors gives {wanted}", False)
    else:
        yield Limit(f"{found.chosen.deciding + 1} sensors are the fewest that give {wanted}", True)


def show(found: LayoutResults) -> Iterator[Chapter]:
    """What is shown of it."""
    from synth.retarder.sensors.plan_shown import plan

    yield Chapter("Layouts", tuple(plan(found)))


COMMAND = Command(
    name="sensors plan",
    read=parse_config,
    options=PlanOptions,
    resolve=resolve,
    head=head,
    steps=steps,
    compute=compute,
    show=show,
    limits=limits,
    limits_of_use=LIMITS_OF_USE,
)
