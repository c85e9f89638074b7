"""The command `tune`: a book of tables for every cut class and target of a configuration, and its proof."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from synth.frame.command import Asked, Command, Head, Limit, Steps, Work
from synth.frame.exhibits import Chapter, Sentence
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.configured import head_of, require_room, sensors_left_aside
from synth.retarder.exit_figures import CHANCE_ONLY, MODEL_ONLY, NOT_CERTIFIED
from synth.retarder.tune_options import TuneOptions

if TYPE_CHECKING:
    from synth.frame.exhibits import File
    from synth.frame.results_directory import ResultsDirectory
    from synth.retarder.found_book import FoundBook
    from synth.retarder.tune import Book, CaseDone
    from tuning_tables import ControllerTable

LIMITS_OF_USE = (
    MODEL_ONLY,
    CHANCE_ONLY,
    "A share of 0 does not mean never: it shows a probability below the upper end of its interval, no more.",
    "A table holds for its cut class, target speed, path and speed range, for the entry speeds named in the parameters "
    "and for a regulator that gives no new command until the transient of the last one has ended.",
    "Where the regulator acts before the entrance, the cut ahead must have left the position by then: this interlock, "
    "and a sensor that sees the cut there, are the yard's.",
    "Predictions come from a grid; they carry its error beside that of the model.",
    "An infeasible case has a table too. It does what brake power allows; it does not meet the limit.",
    NOT_CERTIFIED,
)


@dataclass(frozen=True)
class AskedTune:
    """A configuration, what messages call its file, classes solved at once, and whether fronts are made."""

    config: ResolvedConfig
    place: str
    workers: int
    pareto: bool


def resolve(asked: Asked[ResolvedConfig, TuneOptions]) -> AskedTune:
    """Refuse what does not fit into memory."""
    config = asked.settings
    workers = asked.options.workers_for(len(config.cuts))
    require_room(config, asked.place, workers)
    return AskedTune(config, asked.place, workers, asked.options.pareto)


def head(asked: AskedTune) -> Head:
    """What is said of the configuration."""
    return head_of(asked.config, sensors_left_aside(asked.config))


def steps(asked: AskedTune) -> Steps:
    """A step for each case."""
    return Steps(len(asked.config.problems()), "tuning", "cases")


def drawing(asked: AskedTune) -> int:
    """As many processes as classes are solved at once."""
    return asked.workers


def compute(asked: AskedTune, work: Work) -> FoundBook:
    """The book; its tables are written as they are made. `InputError` where no case has a table."""
    from synth.kernels.cache import guarded
    from synth.retarder.acceptance import judged
    from synth.retarder.first_run import compiled_beside
    from synth.retarder.found_book import FoundBook
    from synth.retarder.tables_refused import require_a_table, tables_refused
    from synth.retarder.tune import tune

    with compiled_beside(work.progress.note), tables_refused(asked.place, asked.config):
        store = partial(stored, directory=work.directory)
        book = guarded(tune, asked.config, store, work.progress, asked.workers, drawn(work), asked.pareto)
        require_a_table(book.cases, book.failed)
        return FoundBook(book, judged(book.cases, asked.config.acceptance), book_files(book))


def stored(table: ControllerTable, directory: ResultsDirectory) -> ControllerTable:
    """Write `table` as JSON; the table as a controller will load it."""
    from tuning_tables import read_json, to_json

    return read_json(directory.write(f"tables/{table.id}.json", to_json(table)))


def drawn(work: Work) -> CaseDone:
    """Who begins with the picture of a case when that is computed."""
    from synth.retarder.shown.pictures import lines_chart

    return lambda case: work.begin(lines_chart(case))


def book_files(book: Book) -> tuple[File, ...]:
    """The tables together: as a book, in C, and a CSV each if the configuration asks for it."""
    from synth.frame.exhibits import File
    from synth.retarder.forms.table_forms import c_form, csv_form
    from tuning_tables.hdf5_file import book_bytes

    tables = [case.table for case in book.cases]
    files = {"book.h5": book_bytes(tables)}
    if book.config.output.csv:
        files |= {f"tables/{name}": content for name, content in csv_form(tables).items()}
    files |= {f"c/{name}": content for name, content in c_form(tables).items()}
    return tuple(File(name, content) for name, content in files.items())


def limits(found: FoundBook) -> Iterator[Limit]:
    """Those of [acceptance]."""
    from synth.retarder.acceptance import limits_of

    statistics = [case.comparison.table.statistics for case in found.book.cases]
    return limits_of(found.verdicts, statistics, found.book.config.acceptance, found.book.failed)


def show(found: FoundBook) -> Iterator[Chapter]:
    """What is shown of it."""
    from synth.retarder.shown.checks import checks
    from synth.retarder.shown.controllers import controllers
    from synth.retarder.shown.criterion import criterion
    from synth.retarder.shown.fronts import fronts
    from synth.retarder.shown.off_nominal import off_nominal
    from synth.retarder.shown.pictures import chapters
    from synth.retarder.shown.predictions import predictions
    from synth.retarder.shown.results import results

    yield Chapter("Results", tuple(results(found)))
    yield Chapter("Controllers side by side", tuple(controllers(found)))
    yield Chapter("Off nominal", tuple(off_nominal(found)))
    if found.book.fronts:
        yield Chapter("Accuracy against time", tuple(fronts(found.book.fronts)))
    yield Chapter("Criterion", tuple(criterion(found)))
    yield Chapter("Predicted against simulated", tuple(predictions(found)))
    yield Chapter("Limit cycles and doubts", tuple(checks(found.book.cases)))
    yield from chapters(found.book.cases)
    where = "A controller loads tables/*.json, or is compiled with c/; book.h5 holds the same tables as arrays."
    yield Chapter("Tables", (Sentence(where), *found.files))


COMMAND = Command(
    name="tune",
    read=parse_config,
    options=TuneOptions,
    resolve=resolve,
    head=head,
    steps=steps,
    compute=compute,
    show=show,
    limits=limits,
    limits_of_use=LIMITS_OF_USE,
    drawing=drawing,
)
