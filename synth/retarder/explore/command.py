"""The command `explore`: one page on which tables brake cuts in the browser."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

from synth.frame.command import Asked, Command, Head, Steps, Work
from synth.frame.exhibits import Chapter, File, Sentence
from synth.frame.faults import InputError
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.configured import configuration_of, given_config, head_of, made_elsewhere
from synth.retarder.exit_figures import MODEL_ONLY
from synth.retarder.options import TablesOptions

if TYPE_CHECKING:
    from synth.retarder.explore.explore_page import PlayedTable
    from tuning_tables.document import StageTable

LARGEST_PAGE_BYTES: Final = 3_000_000
"""A page goes by mail, and a telephone opens it."""

BESIDE_BYTES: Final = 30_000
"""More than what stands beside a table takes in a page."""


@dataclass(frozen=True)
class Asking:
    """Tables to be played, with the configuration that their plants are from, called `source`."""

    config: ResolvedConfig
    source: str
    tables: tuple[PlayedTable, ...]

    @property
    def warnings(self) -> tuple[str, ...]:
        """That the plants may be others than those of the tables."""
        return made_elsewhere([each.table for each in self.tables], self.config, self.source)


@dataclass(frozen=True)
class ExplorePage:
    """The page of so many tables."""

    tables: int
    file: File


def resolve(asked: Asked[ResolvedConfig | None, TablesOptions]) -> Asking:
    """The tables; refused are those without a plant, aim tables, and more than a page may hold."""
    from synth.retarder.forms.tables_at import tables_at

    path = asked.options.source
    tables = tables_at(path).only_of_stages("explore")
    config, source = configuration_of(asked, tables)
    played = tuple(played_tables(tables, path, config, source))
    asking = Asking(config, Path(source).name, played)  # no file holds a path
    size = len(page_of(asking)) + BESIDE_BYTES * len(tables)
    if size > LARGEST_PAGE_BYTES:
        raise InputError(
            f"{path}: a page of its {len(tables)} tables could have {size / 1e6:.1f} MB; "
            f"{LARGEST_PAGE_BYTES / 1e6:g} MB are allowed: give one table, or a folder of fewer"
        )
    return asking


def played_tables(
    tables: tuple[StageTable, ...], path: Path, config: ResolvedConfig, source: str
) -> Iterator[PlayedTable]:
    """The tables with the plants of their classes; `InputError` where the configuration has none for one.

    `PlantError` for a table at any time whose drive or delays are modelled for commands at rest alone.
    """
    from synth.retarder.explore.explore_page import PlayedTable
    from synth.retarder.forms.tables_at import is_infeasible, summary_beside
    from synth.retarder.served_class import served_class
    from tuning_tables import ControllerTable
    from tuning_tables.decisions import Decisions

    summary, limits_t = summary_beside(path), {each.label: each.mass_limits_t for each in config.cuts}
    for table in tables:
        served = served_class(table, config, source)
        if isinstance(table, ControllerTable) and table.decisions is Decisions.AT_ANY_TIME:
            served.plant.drive_at_any_time()  # refused here: the scripts know no other drive
        yield PlayedTable(table, served, limits_t[served.label], is_infeasible(table, summary))


def page_of(asking: Asking) -> bytes:
    """The page of the tables, with what stands beside them as far as that is known."""
    from synth.frame.version import __version__
    from synth.retarder.explore.explore_page import explore_page

    plant = f"plant: {asking.source}"
    told = " · ".join((f"retarder-synth {__version__}", plant, "one file, which loads nothing", *asking.warnings))
    return explore_page(asking.config.title, told, asking.tables).encode()


def head(asking: Asking) -> Head:
    """What is said of the configuration, with a word about tables that another one made."""
    return head_of(asking.config, asking.warnings)


def compute(asking: Asking, work: Work) -> ExplorePage:
    """Each table and the best rule on the passes of its case, then the page of all."""
    from synth.retarder.explore.explore_page import PAGE, beside

    played = []
    for each in asking.tables:
        played.append(replace(each, beside=beside(each.table, each.served, asking.config)))
        work.progress.done(each.title)
    content = page_of(replace(asking, tables=tuple(played)))
    return ExplorePage(len(played), File(PAGE, content, "Play with the tables"))


def show(page: ExplorePage) -> Iterator[Chapter]:
    """The page, and what it holds."""
    noun = "table brakes" if page.tables == 1 else "tables brake"
    told = f"{page.file.name}: {page.tables} {noun} cuts in the browser; it needs neither this program nor a network"
    yield Chapter("The page", (page.file, Sentence(told, {"tables": page.tables}, brief=True)))


COMMAND = Command(
    name="explore",
    read=given_config,
    options=TablesOptions,
    resolve=resolve,
    head=head,
    steps=lambda asking: Steps(len(asking.tables), "playing", "tables"),
    compute=compute,
    show=show,
    limits_of_use=(MODEL_ONLY,),
)
