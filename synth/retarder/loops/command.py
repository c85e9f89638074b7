"""The command `loop`: exported tables in the loop as python-control sees it; nothing is solved."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, TypeAlias

from synth.frame.command import Asked, Command, Limit, Steps, Work
from synth.frame.exhibits import Chapter
from synth.frame.faults import InputError
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.configured import configuration_of, given_config, head_of
from synth.retarder.exit_figures import MODEL_ONLY
from synth.retarder.options import TablesOptions

if TYPE_CHECKING:
    from synth.retarder.loops.control_loop import LineControlLoop, PassageControlLoop
    from tuning_tables.document import StageTable

    AnyLoop: TypeAlias = LineControlLoop | PassageControlLoop

LIMITS_OF_USE = (
    MODEL_ONLY,
    "A nominal pass has mean friction and resistance, the median entry speed and no noise; it tells nothing of the "
    "spread of exits. What does is 'retarder-synth validate'.",
)


@dataclass(frozen=True)
class AskedLoops:
    """What closes each loop, and the configuration with its plant."""

    config: ResolvedConfig
    closings: tuple[Callable[[], AnyLoop], ...]


@dataclass(frozen=True)
class FoundLoops:
    """The loops, in the order of their tables, and the title of their configuration."""

    title: str
    loops: tuple[AnyLoop, ...]


def resolve(asked: Asked[ResolvedConfig | None, TablesOptions]) -> AskedLoops:
    """The tables; refused where one fits no class of the configuration, or python-control cannot close its loop."""
    from synth.retarder.forms.tables_at import tables_at

    path = asked.options.source
    tables = tables_at(path).of_stages
    if not tables:
        raise InputError(f"{path}: its tables are aim tables, which regulate nothing; give those of a tune")
    config, place = configuration_of(asked, tables)
    return AskedLoops(config, tuple(closing(table, config, place) for table in tables))


def closing(table: StageTable, config: ResolvedConfig, source: str) -> Callable[[], AnyLoop]:
    """What closes the loop of `table` with the plant of `config` that it is for; `InputError` if there is none."""
    from synth.retarder.loops.control_loop import line_control_loop, passage_control_loop
    from synth.retarder.served_class import served_class
    from tuning_tables.decisions import Decisions
    from tuning_tables.passages.passage_table import PassageTable

    if isinstance(table, PassageTable):
        return partial(passage_control_loop, table, served_class(table, config, source))
    if table.decisions is Decisions.AT_ANY_TIME:
        raise InputError(
            f"{table.id}: the table decides at any time; the loop of python-control is built for tables that decide at "
            "rest and for point sensors: give one of those"
        )
    return partial(line_control_loop, table, served_class(table, config, source))


def compute(asked: AskedLoops, work: Work) -> FoundLoops:
    """All loops."""
    from synth.kernels.cache import guarded

    loops = []
    for close in asked.closings:
        loops.append(guarded(close))
        work.progress.done(loops[-1].table.id)
    return FoundLoops(asked.config.title, tuple(loops))


def limits(found: FoundLoops) -> Iterator[Limit]:
    """Whether python-control and the simulator agree."""
    from synth.retarder.loops.shown import limits_of

    return limits_of(found.loops)


def show(found: FoundLoops) -> Iterator[Chapter]:
    """What is shown of it."""
    from synth.retarder.loops.shown import chapters

    return chapters(found.title, found.loops)


COMMAND = Command(
    name="loop",
    read=given_config,
    options=TablesOptions,
    resolve=resolve,
    head=lambda asked: head_of(asked.config),
    steps=lambda asked: Steps(len(asked.closings), "closing", "loops"),
    compute=compute,
    show=show,
    limits=limits,
    limits_of_use=LIMITS_OF_USE,
)
