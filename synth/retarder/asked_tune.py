"""What every command that tunes is asked and does; the commands differ in epochs, in files and in what they show."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Generic

from plant_models import Plant
from synth.frame.command import Limit, Steps, Work
from synth.problem.resolution import Resolution
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.configured import require_room
from synth.retarder.epochs import Epochs, Ground, Table
from synth.retarder.tuned_case import Case

if TYPE_CHECKING:
    from synth.frame.exhibits import File
    from synth.frame.results_directory import ResultsDirectory
    from synth.retarder.acceptance import FoundBook
    from synth.retarder.case_result import CaseResult
    from synth.retarder.options import TuneOptions
    from synth.retarder.tune import Book, CaseDone
    from tuning_tables import ControllerTable


@dataclass(frozen=True)
class RadarEpochs:
    """See `Epochs`; the section [regulator] of a configuration tells which of them.

    With `pareto` each case also tells what less time in the position costs.
    """

    pareto: bool = False

    def grids(self, config: ResolvedConfig, plant: Plant) -> tuple[Plant, Sequence[Resolution]]:
        """See `Epochs`."""
        return plant, config.grids(plant)

    def cases(self, ground: Ground[ControllerTable], label: str, plant: Plant) -> list[Callable[[], CaseResult]]:
        """See `Epochs`; all targets of a class are solved together."""
        from synth.retarder.tune_case import case_orders, tune_case  # with the kernels

        return [partial(tune_case, order) for order in case_orders(ground, label, plant, self.pareto)]


@dataclass(frozen=True)
class AskedTune(Generic[Case, Table]):
    """A configuration, what messages call its file, the epochs of its regulators, and classes solved at once."""

    config: ResolvedConfig
    place: str
    epochs: Epochs[Case, Table]
    workers: int


def asked_tune(
    config: ResolvedConfig, place: str, epochs: Epochs[Case, Table], options: TuneOptions
) -> AskedTune[Case, Table]:
    """A tune of `config`, the file `place`, refused where it does not fit into memory."""
    workers = options.workers_for(len(config.cuts))
    require_room(config, epochs, place, workers)
    return AskedTune(config, place, epochs, workers)


def steps(asked: AskedTune[Case, Table]) -> Steps:
    """A step for each case."""
    return Steps(len(asked.config.problems()), "tuning", "cases")


def drawing(asked: AskedTune[Case, Table]) -> int:
    """As many processes as classes are solved at once."""
    return asked.workers


def tuned(
    asked: AskedTune[Case, Table],
    work: Work,
    case_done: CaseDone[Case],
    files: Callable[[Book[Case]], tuple[tuple[File, ...], str]],
) -> FoundBook[Case]:
    """The book with its verdicts and files, its tables written as they are made; `case_done` is given each case.

    `files`: the tables together, and why they are no Structured Text. `InputError` where no case has a table, or where
    `files` raises `InvalidTable`: the tables make no book.
    """
    from synth.kernels.cache import guarded
    from synth.retarder.acceptance import FoundBook, judged
    from synth.retarder.failed_case import require_a_table, tables_refused
    from synth.retarder.first_run import compiled_beside
    from synth.retarder.tune import tune

    with compiled_beside(work.progress.note), tables_refused(asked.place, asked.config):
        store = partial(stored, directory=work.directory)
        book = guarded(tune, asked.config, asked.epochs, store, work.progress, asked.workers, case_done)
        require_a_table(book.cases, book.failed)
        return FoundBook(book, judged(book.cases, book.config.acceptance), *files(book))


def stored(table: Table, directory: ResultsDirectory) -> Table:
    """Write `table` as JSON; the table as a controller will load it."""
    from tuning_tables import read_json, to_json

    return read_json(directory.write(f"tables/{table.id}.json", to_json(table)), type(table))


def limits(found: FoundBook[Case]) -> Iterator[Limit]:
    """Those of [acceptance]."""
    from synth.retarder.acceptance import limits_of

    book = found.book
    return limits_of(found.verdicts, book.cases, book.config.acceptance, book.failed)
