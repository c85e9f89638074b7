"""What the command `aim` does: the exit speeds at which a park position lets cuts go, as tables of controllers."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from synth.aim.configuration.aim_file import AimFile
from synth.frame.command import Head, Limit, Steps, Work
from synth.frame.exhibits import Chapter

if TYPE_CHECKING:
    from plant_models.library import TrackEntry
    from synth.aim.aim_book import AimBook, AimBookVerdict
    from synth.aim.resolved_aim import ResolvedAim

LIMITS_OF_USE = (
    "All figures are those of a model with the parameters listed here, not of a yard. Assumed parameters are guesses; "
    "replace them by those of your yard, then aim again.",
    "Intervals (95 %) cover the chance of the simulated cuts only, neither the parameters nor the model.",
    "Resistance, wind and bends are drawn once for each cut and stay for its whole way; the wind is one along the "
    "track, and a gust or a lee is not modelled.",
    "Standing cars are taken not to move, and the free distance to be known. A cut that stops short shortens the free "
    "distance of all that follow it: gaps are computed, their consequences are not.",
    "The tool is not certified and claims no safety integrity. Before a table commands a position, check it with an "
    "independent program against the hashes below, and on the track.",
)


@dataclass(frozen=True)
class FoundAim:
    """The tables, and whether they keep what is asked of them."""

    book: AimBook
    verdict: AimBookVerdict


def resolved(file: AimFile, track: TrackEntry | None = None) -> ResolvedAim:
    """Everything that tables depend on, for the `track`, None: that of the file; a book that does not fit is
    refused."""
    from synth.aim.resolved_aim import resolve_aim
    from synth.aim.table_position import position_of

    config = resolve_aim(file, track)
    position_of(config)
    return config


def head(config: ResolvedAim) -> Head:
    """What is said of the configuration."""
    reads = () if config.book is None else tuple(path for path in config.book if path is not None)
    return Head(
        title=config.title,
        canonical_json=config.canonical_json,
        parameters=config.parameters,
        output=config.output,
        warnings=config.warnings,
        reads=reads,
    )


def steps(config: ResolvedAim) -> Steps:
    """A step for each weight category."""
    return Steps(len(config.members), "aiming", "categories")


def compute(config: ResolvedAim, work: Work) -> FoundAim:
    """All tables, and the verdict on them."""
    from synth.aim.aim_book import aim_book, judge_aims
    from synth.frame.version import creation_time
    from synth.kernels.cache import guarded

    book = guarded(aim_book, config, creation_time(), work.progress.done)
    work.progress.note(f"{len(book.tables)} tables computed")
    return FoundAim(book, judge_aims(book.tables, config.acceptance.p_excess))


def limits(found: FoundAim) -> Iterator[Limit]:
    """The probability that is asked for."""
    yield Limit(found.verdict.sentence, found.verdict.accepted)


def show(found: FoundAim) -> Iterator[Chapter]:
    """What is shown of it."""
    from synth.aim.shown import asked, cells, charts, files, gaps
    from synth.aim.shown_commands import cards, command_charts

    yield Chapter("What the position is commanded", (*command_charts(found.book), *cards(found.book)))
    yield Chapter("Results", (*asked(found.book, found.verdict), *gaps(found.book, found.verdict)))
    yield Chapter("Pictures", tuple(charts(found.book)))
    yield Chapter("Cell by cell", (*cells(found.book), *files(found.book)))
