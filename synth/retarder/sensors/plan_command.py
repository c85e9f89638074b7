"""The command `sensors`: where point sensors stand, and how many of them a wanted rms takes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from synth.frame.command import Asked, Command, Limit, Steps, Work
from synth.frame.exhibits import Chapter
from synth.frame.printed_numbers import counted
from synth.retarder.configuration.config_file import parse_config, source_of_text
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.configured import head_of
from synth.retarder.options import PlanOptions

if TYPE_CHECKING:
    from synth.retarder.sensors.layout_results import AskedLayouts, LayoutResults

LIMITS_OF_USE = (
    "The rms is that of the model with the parameters of this page. Assumed ones are guesses.",
    "Sensors may stand at multiples of half a metre. What hinders them on the track is not known here.",
    "Every sensor is taken to work. What a failed one costs is told by 'tune'.",
    "Nothing proves that the layouts found are the best of all.",
)


@dataclass(frozen=True)
class AskedPlan:
    """The configuration, what is asked of it, and how many threads work."""

    config: ResolvedConfig
    layouts: AskedLayouts
    workers: int


def resolve(asked: Asked[ResolvedConfig, PlanOptions]) -> AskedPlan:
    """The problem of a configuration."""
    from synth.retarder.sensors.layout_plan import layout_problem
    from synth.retarder.sensors.layout_results import AskedLayouts

    config, options = asked.settings, asked.options
    problem, labels = layout_problem(config)
    source = source_of_text(asked.text, asked.place)
    seed = config.validation.seed
    layouts = AskedLayouts(source, problem, labels, options.sensors, options.rms_m_s, seed, options.passes)
    return AskedPlan(config, layouts, options.workers)


def compute(asked: AskedPlan, work: Work) -> LayoutResults:
    """The plans, the rule and the radar."""
    from synth.retarder.first_run import compiled_beside
    from synth.retarder.sensors.layout_results import layout_results

    layouts, progress = asked.layouts, work.progress
    classes = counted(len(layouts.problem.cases), "cut class", "cut classes")
    progress.note(
        f"looking for the places of up to {max(layouts.sensors)} sensors, for {classes}, in {layouts.steps} steps"
    )
    with compiled_beside(progress.note):
        return layout_results(layouts, asked.workers, progress.done)


def limits(found: LayoutResults) -> Iterator[Limit]:
    """Whether one of the numbers gives the wanted rms."""
    wanted = f"an rms of at most {found.wanted_rms_m_s:.4f} m/s"
    if found.chosen is None:
        yield Limit(f"none of these numbers of sensors gives {wanted}", False)
        return
    told = found.chosen.errors.rms
    yield Limit(
        f"{found.chosen.deciding + 1} sensors are the fewest chosen for {wanted}; they give {told.value:.4f} "
        f"[{told.low95:.4f}, {told.high95:.4f}] m/s on {told.n} other passes of every table",
        found.is_reached(found.chosen),
    )


def show(found: LayoutResults) -> Iterator[Chapter]:
    """What is shown of it."""
    from synth.retarder.sensors.plan_shown import chapters

    return chapters(found)


COMMAND = Command(
    name="sensors",
    read=parse_config,
    options=PlanOptions,
    resolve=resolve,
    head=lambda asked: head_of(asked.config),
    steps=lambda asked: Steps(asked.layouts.steps, "planning", "steps"),
    compute=compute,
    show=show,
    limits=limits,
    limits_of_use=LIMITS_OF_USE,
)
