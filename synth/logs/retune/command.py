"""The command `retune`: new tables from measured passes, refused where they are within noise."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from synth.frame.command import Asked, Command, Head, Limit, Steps, Work
from synth.frame.exhibits import Chapter
from synth.logs.log_options import RetuneOptions
from synth.retarder.configuration.config_file import ConfigSource, source_of_text

if TYPE_CHECKING:
    from collections.abc import Mapping

    from synth.logs.fitting_passes import AskedPasses
    from synth.logs.retune.retune import Retuned
    from synth.logs.retune.tuned_books import Case
    from tuning_tables import ControllerTable

LIMITS_OF_USE = (
    "A sensor that shows too much is not corrected by new tables: see sensor.bias_m_s among the numbers.",
    "A table counts as better where p passes Holm's rule over all cases at 2.5 %; the interval is of its case alone.",
    "New tables are made for the passes measured. After a repair of valves or sensors measure anew.",
    "The plant is the model of this program with the numbers of the configuration; what the model lacks is not here.",
    "Intervals hold the chance of the passes named, and not that the yard changes after them.",
)


@dataclass(frozen=True, eq=False)
class AskedRetune:
    """Passes, the configuration that gets their numbers, and the tables that run; None: a tune of it makes them."""

    source: ConfigSource
    asked: AskedPasses
    old: Mapping[Case, ControllerTable] | None


def resolve(asked: Asked[ConfigSource, RetuneOptions]) -> AskedRetune:
    """Passes and tables; a table that fits no class is refused."""
    from synth.retarder.forms.tables_at import tables_at

    config, options = asked.settings.resolved(), asked.options
    given = None if options.table is None else tables_at(options.table).only_lines("retune --table")
    from synth.logs.fitting_passes import asked_passes

    passes = asked_passes(options, config, asked.place)
    if given is None:
        return AskedRetune(asked.settings, passes, None)
    from synth.logs.retune.tuned_books import tables_by_case  # numba: a log that is refused needs none

    return AskedRetune(asked.settings, passes, tables_by_case(given, config, asked.place))


def head(asked: AskedRetune) -> Head:
    """What is said of configuration and logs."""
    return asked.asked.head(reads=asked.source.reads)


def steps(asked: AskedRetune) -> Steps:
    """A step for each case that is tuned for the identified numbers."""
    return Steps(len(asked.asked.config.problems()), "tuning", "cases")


def compute(asked: AskedRetune, work: Work) -> Retuned:
    """The new tables, and what they gain."""
    from synth.frame.machine import available
    from synth.frame.version import creation_time
    from synth.kernels.cache import guarded
    from synth.logs.retune.retune import RetuneOrder, retune
    from synth.retarder.failed_case import tables_refused

    order = RetuneOrder(asked.old, creation_time(), threads=available())
    with tables_refused(asked.asked.place, asked.asked.config):
        return guarded(retune, asked.asked.passes, asked.source, order, work.progress)


def limits(found: Retuned) -> Iterator[Limit]:
    """Whether any table is better beyond doubt, and whether every case has a new one."""
    from synth.logs.retune.shown import changed_sentence, failed_sentence

    yield Limit(changed_sentence(found), bool(found.changed))
    for case in found.failed:
        yield Limit(failed_sentence(found, case), False)


def show(found: Retuned) -> Iterator[Chapter]:
    """What is shown of it."""
    from synth.logs.retune.shown import files, gained, numbers

    yield Chapter("What is gained", tuple(gained(found)))
    yield Chapter("Numbers", tuple(numbers(found)))
    yield Chapter("Tables", tuple(files(found)))


COMMAND = Command(
    name="retune",
    read=source_of_text,
    options=RetuneOptions,
    resolve=resolve,
    head=head,
    steps=steps,
    compute=compute,
    show=show,
    limits=limits,
    limits_of_use=LIMITS_OF_USE,
)
