"""The command `replay`: measured passes under other tables."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from synth.frame.command import Asked, Command, Head, Limit, Steps, Work
from synth.frame.exhibits import Chapter
from synth.logs.log_options import ReplayOptions
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.failed_case import require_a_table, tables_refused

if TYPE_CHECKING:
    from synth.frame.terminal.progress import Progress
    from synth.logs.fitting_passes import AskedPasses
    from synth.logs.replay.replay import Replay
    from synth.retarder.failed_case import FailedCase
    from tuning_tables import ControllerTable

LIMITS_OF_USE = (
    "Friction along the path and noise of the sensor are drawn anew; friction and resistance of a cut are as its log "
    "tells them.",
    "Rows must be the samples of the regulator: between samples a table that would command cannot have been followed.",
    "The plant is the model of this program with the numbers of the configuration; what the model lacks is not here.",
    "Intervals hold the chance of the passes named, and not that the yard changes after them.",
)


@dataclass(frozen=True, eq=False)
class AskedReplay:
    """Passes, the tables that are tried, and those that drove the log; None: a tune of the configuration makes them."""

    asked: AskedPasses
    other: tuple[ControllerTable, ...]
    own: tuple[ControllerTable, ...] | None


@dataclass(frozen=True, eq=False)
class FoundReplay:
    """The replay; `failed`: cases of which no table could be tuned, so that none of them is the log's."""

    replay: Replay
    failed: tuple[FailedCase, ...]


def resolve(asked: Asked[ResolvedConfig, ReplayOptions]) -> AskedReplay:
    """Passes and tables; a table that fits no class is refused."""
    from synth.retarder.forms.tables_at import tables_at

    config, options = asked.settings, asked.options
    other = tables_at(options.table).only_lines("replay --table")
    own = None if options.own is None else tables_at(options.own).only_lines("replay --own")
    from synth.logs.fitting_passes import asked_passes

    passes = asked_passes(options, config, asked.place)
    from synth.logs.retune.tuned_books import tables_by_case  # numba: a log that is refused needs none

    tables_by_case(other, config, asked.place)
    return AskedReplay(passes, other, own)


def head(asked: AskedReplay) -> Head:
    """What is said of configuration and logs."""
    return asked.asked.head()


def steps(asked: AskedReplay) -> Steps:
    """The cases that are tuned before, and the replay."""
    cases = len(asked.asked.config.problems()) if asked.own is None else 0
    return Steps(cases + 1, "replaying", "steps")


def compute(asked: AskedReplay, work: Work) -> FoundReplay:
    """The passes under both books; the own one is tuned unless it is given."""
    from synth.kernels.cache import guarded

    own, failed = (asked.own, ()) if asked.own is not None else guarded(own_tables, asked.asked, work.progress)
    found = guarded(replayed, asked, own)
    work.progress.done(f"{len(found.passes)} passes run again")
    return FoundReplay(found, failed)


def own_tables(asked: AskedPasses, progress: Progress) -> tuple[tuple[ControllerTable, ...], tuple[FailedCase, ...]]:
    """The tables that a tune of the configuration makes, and the cases without one; `PlantError` for no table."""
    from synth.frame.machine import available
    from synth.frame.version import creation_time
    from synth.logs.retune.tuned_books import class_setups, tuned_tables

    config = asked.config
    with tables_refused(asked.place, config):
        made = tuned_tables(config, class_setups(config, creation_time()), available(), progress)
        require_a_table(tuple(made.tables), made.failed)
    return tuple(made.tables.values()), made.failed


def replayed(asked: AskedReplay, own: tuple[ControllerTable, ...]) -> Replay:
    """The passes under `own` and the other tables."""
    from synth.logs.replay.replay import ReplayOrder, replay

    return replay(asked.asked.passes, asked.asked.config, ReplayOrder(own, asked.other))


def limits(found: FoundReplay) -> Iterator[Limit]:
    """Whether the configuration describes the log; nothing is judged where no exit was measured."""
    from synth.logs.replay.shown import is_described, uniformity_sentence

    if found.replay.uniformity.n:
        yield Limit(uniformity_sentence(found.replay), is_described(found.replay))


def show(found: FoundReplay) -> Iterator[Chapter]:
    """What is shown of it."""
    from synth.logs.replay.shown import commands, exits, measured, passes

    failed = tuple(case.sentence for case in found.failed)
    yield Chapter("Exits under both tables", tuple(exits(found.replay)))
    yield Chapter("Commands", tuple(commands(found.replay, failed)))
    yield Chapter("Measured and predicted", tuple(measured(found.replay)))
    yield Chapter("Passes", tuple(passes(found.replay)))


COMMAND = Command(
    name="replay",
    read=parse_config,
    options=ReplayOptions,
    resolve=resolve,
    head=head,
    steps=steps,
    compute=compute,
    show=show,
    limits=limits,
    limits_of_use=LIMITS_OF_USE,
)
