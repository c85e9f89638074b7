"""The command `identify`: the numbers of a position from its measured passes, as a configuration."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from synth.frame.command import Asked, Command, Head, Limit, Steps, Work
from synth.frame.exhibits import Chapter
from synth.logs.log_options import LogOptions
from synth.retarder.configuration.config_file import ConfigSource, source_of_text

if TYPE_CHECKING:
    from synth.logs.fitting_passes import AskedPasses
    from synth.logs.identify import Identified

LIMITS_OF_USE = (
    "The numbers are those of the model of this program. Where a test says that the model does not hold, they are what "
    "comes nearest to the passes, and the intervals hold for that.",
    "The intervals hold for the plant as it was while the log was made.",
)


@dataclass(frozen=True, eq=False)
class AskedNumbers:
    """Passes, and the configuration that gets their numbers."""

    source: ConfigSource
    asked: AskedPasses


@dataclass(frozen=True, eq=False)
class FoundNumbers:
    """The numbers, and the configuration with them."""

    found: Identified
    identified: ConfigSource


def resolve(asked: Asked[ConfigSource, LogOptions]) -> AskedNumbers:
    """The passes; too few of them are refused."""
    config = asked.settings.resolved()
    from synth.logs.fitting_passes import asked_passes

    found = asked_passes(asked.options, config, asked.place)
    from synth.logs.identify import require_enough  # scipy: a log that is refused needs none

    require_enough(found.passes)
    return AskedNumbers(asked.settings, found)


def head(asked: AskedNumbers) -> Head:
    """What is said of configuration and logs."""
    return asked.asked.head(reads=asked.source.reads)


def steps(asked: AskedNumbers) -> Steps:
    """All numbers are told at once."""
    return Steps(1, "identifying", "logs")


def compute(asked: AskedNumbers, work: Work) -> FoundNumbers:
    """The numbers, and whether the model holds."""
    from synth.frame.machine import available
    from synth.kernels.cache import guarded
    from synth.logs.identified_config import identified
    from synth.logs.identify import identify

    found = guarded(identify, asked.asked.passes, asked.asked.config, available())
    work.progress.done(f"{len(found.findings)} numbers estimated, {found.origin}")
    return FoundNumbers(found, identified(asked.source, found.estimate, found.origin))


def limits(result: FoundNumbers) -> Iterator[Limit]:
    """Whether a test says that the model does not hold."""
    from synth.logs.identify_shown import test_sentence

    if not result.found.wrong:
        yield Limit(f"none of {len(result.found.tests)} tests says that the model does not hold", True)
    for test in result.found.wrong:
        yield Limit(f"the model does not hold: {test_sentence(test)} (p = {test.p:.1g})", False)


def show(result: FoundNumbers) -> Iterator[Chapter]:
    """What is shown of it."""
    from synth.logs.identify_shown import files, model, numbers

    yield Chapter("Numbers", tuple(numbers(result.found)))
    yield Chapter("Does the model hold?", tuple(model(result.found)))
    yield Chapter("Configuration", tuple(files(result.identified)))


COMMAND = Command(
    name="identify",
    read=source_of_text,
    options=LogOptions,
    resolve=resolve,
    head=head,
    steps=steps,
    compute=compute,
    show=show,
    limits=limits,
    limits_of_use=LIMITS_OF_USE,
)
