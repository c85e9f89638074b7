"""The command `explore`: one page on which tables brake cuts in the browser."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

from synth.frame.command import Asked, Command, Head, Steps, Work
from synth.frame.exhibits import Chapter, File, Sentence
from synth.frame.input_error import InputError
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.configured import head_of
from synth.retarder.exit_figures import MODEL_ONLY
from synth.retarder.explore.options import ExploreOptions
from synth.retarder.tables_configuration import configuration_for, given_config, made_elsewhere

if TYPE_CHECKING:
    from synth.retarder.explore.explore_page import PlayedTable
    from tuning_tables import ControllerTable

LARGEST_PAGE_BYTES: Final = 3_000_000
"""A page goes by mail, and a telephone opens it."""


@dataclass(frozen=True)
class ExplorePage:
    """The page of so many tables, and the configuration that their plants are from."""

    config: ResolvedConfig
    tables: int
    file: File
    warnings: tuple[str, ...]


def resolve(asked: Asked[ResolvedConfig | None, ExploreOptions]) -> ExplorePage:
    """The page, made here so that it can be refused: tables without a plant, for point sensors, or too many."""
    from synth.frame.version import __version__
    from synth.retarder.explore.explore_page import PAGE, explore_page
    from synth.retarder.forms.tables_at import tables_at

    path = asked.options.source
    tables = tables_at(path).only_lines("explore")
    config, source = (asked.settings, asked.place) if asked.settings else configuration_for(None, path, tables)
    played = tuple(played_tables(tables, path, config, source))
    named = Path(source).name  # no file holds a path
    warnings = made_elsewhere(tables, config, named)
    told = " · ".join((f"retarder-synth {__version__}", f"plant: {named}", "one file, which loads nothing", *warnings))
    content = explore_page(config.title, told, played).encode()
    if len(content) > LARGEST_PAGE_BYTES:
        raise InputError(
            f"{path}: a page of its {len(tables)} tables would have {len(content) / 1e6:.1f} MB; "
            f"{LARGEST_PAGE_BYTES / 1e6:g} MB are allowed: give one table, or a folder of fewer"
        )
    return ExplorePage(config, len(tables), File(PAGE, content, "Play with the tables"), warnings)


def played_tables(
    tables: tuple[ControllerTable, ...], path: Path, config: ResolvedConfig, source: str
) -> Iterator[PlayedTable]:
    """The tables with the plants of their classes; `InputError` where the configuration has none for one.

    `PlantError` for a table at any time whose drive or delays are modelled for commands at rest alone.
    """
    from synth.retarder.explore.explore_page import PlayedTable
    from synth.retarder.forms.table_file import is_infeasible, summary_beside
    from synth.retarder.served_class import served_class
    from tuning_tables.decisions import Decisions

    summary, limits_t = summary_beside(path), {each.label: each.mass_limits_t for each in config.cuts}
    for table in tables:
        served = served_class(table, config, source)
        if table.decisions is Decisions.AT_ANY_TIME:
            served.plant.drive_at_any_time()  # refused here: the scripts know no other drive
        infeasible = is_infeasible(table, summary)
        yield PlayedTable(table, served.label, served.plant, limits_t[served.label], infeasible)


def head(page: ExplorePage) -> Head:
    """What is said of the configuration, with a word about tables that another one made."""
    return head_of(page.config, page.warnings)


def compute(page: ExplorePage, work: Work) -> ExplorePage:
    """It is made already, so that it could be refused."""
    work.progress.done(page.file.name)
    return page


def show(page: ExplorePage) -> Iterator[Chapter]:
    """The page, and what it holds."""
    noun = "table brakes" if page.tables == 1 else "tables brake"
    told = f"{page.file.name}: {page.tables} {noun} cuts in the browser; it needs neither this program nor a network"
    yield Chapter("The page", (page.file, Sentence(told, {"tables": page.tables}, brief=True)))


COMMAND = Command(
    name="explore",
    read=given_config,
    options=ExploreOptions,
    resolve=resolve,
    head=head,
    steps=lambda page: Steps(1, "writing", "pages"),
    compute=compute,
    show=show,
    limits_of_use=(MODEL_ONLY,),
)
