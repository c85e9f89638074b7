"""The command `watch`: charts of a position's measured passes, and what has drifted."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from synth.frame.command import Asked, Command, Head, Limit, Steps, Work
from synth.frame.exhibits import Chapter
from synth.logs.log_options import WatchOptions
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.configuration.resolved_config import ResolvedConfig

if TYPE_CHECKING:
    from synth.frame.terminal.progress import Progress
    from synth.logs.drift.watch import Watch
    from synth.logs.fitting_passes import AskedPasses

LIMITS_OF_USE = (
    "One drift at a time: the first alarm is explained. After a repair or new tables watch again.",
    "A size at the edge of those supposed may be larger.",
    "The interval of a size leaves out that its beginning is uncertain too, which has an interval of its own.",
    "Weather that comes and goes within an hour is a drift to this watch.",
)


@dataclass(frozen=True, eq=False)
class AskedWatch:
    """The passes to be watched, and those whose numbers drifts are counted from; None: the configuration has them."""

    watched: AskedPasses
    reference: AskedPasses | None


def resolve(asked: Asked[ResolvedConfig, WatchOptions]) -> AskedWatch:
    """The passes of both kinds of logs."""
    from synth.logs.fitting_passes import asked_passes

    config, options = asked.settings, asked.options
    watched = asked_passes(options, config, asked.place)
    if not options.reference:
        return AskedWatch(watched, None)
    reference = asked_passes(options.model_copy(update={"logs": options.reference}), config, asked.place)
    from synth.logs.drift.evidence import require_enough  # scipy: a log that is refused needs none

    require_enough(reference.passes)
    return AskedWatch(watched, reference)


def head(asked: AskedWatch) -> Head:
    """What is said of configuration and logs."""
    return asked.watched.head(() if asked.reference is None else asked.reference.warnings)


def steps(asked: AskedWatch) -> Steps:
    """The numbers of the reference, and the charts."""
    return Steps(1 if asked.reference is None else 2, "watching", "steps")


def compute(asked: AskedWatch, work: Work) -> Watch:
    """The charts, and what is behind the first alarm."""
    from synth.kernels.cache import guarded

    return guarded(watched, asked, work.progress)


def watched(asked: AskedWatch, progress: Progress) -> Watch:
    """The same with kernels that may have to be compiled anew."""
    from synth.frame.machine import available
    from synth.logs.drift.evidence import configured, of_reference
    from synth.logs.drift.watch import watch

    passes, parameters = asked.watched.passes, asked.watched.config.parameters
    values, slope_key = configured(passes, parameters)
    if asked.reference is not None:
        values = of_reference(asked.reference.passes, parameters, values, available())
        progress.done(f"numbers told by {len(asked.reference.passes)} passes of the reference")
    found = watch(passes, values, slope_key, available())
    progress.done(f"{len(passes)} passes watched")
    return found


def limits(found: Watch) -> Iterator[Limit]:
    """Whether a sum has reached the limit."""
    from synth.logs.drift.shown import alarm

    yield Limit(alarm(found), found.drift is None)


def show(found: Watch) -> Iterator[Chapter]:
    """What is shown of it."""
    from synth.logs.drift.shown import charts, drifted

    yield Chapter("What has drifted", tuple(drifted(found)))
    yield Chapter("Charts", tuple(charts(found)))


COMMAND = Command(
    name="watch",
    read=parse_config,
    options=WatchOptions,
    resolve=resolve,
    head=head,
    steps=steps,
    compute=compute,
    show=show,
    limits=limits,
    limits_of_use=LIMITS_OF_USE,
)
