"""The command `tune`: a book of tables for every cut class and target of a configuration, and its proof.

Where the configuration has point sensors, `sensors.tune_command` does it.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from synth.frame.command import Asked, Command, Work
from synth.frame.exhibits import Chapter, Sentence
from synth.retarder.asked_tune import AskedTune, RadarEpochs, asked_tune, drawing, limits, steps, tuned
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.configured import head_of
from synth.retarder.exit_figures import CHANCE_ONLY, MODEL_ONLY, NOT_CERTIFIED
from synth.retarder.options import TUNE, TuneOptions

if TYPE_CHECKING:
    from synth.frame.exhibits import File
    from synth.retarder.acceptance import FoundBook
    from synth.retarder.case_result import CaseResult
    from synth.retarder.tune import Book
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


def resolve(asked: Asked[ResolvedConfig, TuneOptions]) -> AskedTune[CaseResult, ControllerTable]:
    """Refuse what does not fit into memory."""
    return asked_tune(asked.settings, asked.place, RadarEpochs(asked.options.pareto), asked.options)


def compute(asked: AskedTune[CaseResult, ControllerTable], work: Work) -> FoundBook[CaseResult]:
    """The book; the picture of a case is begun when that is computed."""
    from synth.retarder.shown.pictures import case_chart

    return tuned(asked, work, lambda case: work.begin(case_chart(case)), book_files)


def book_files(book: Book[CaseResult]) -> tuple[tuple[File, ...], str]:
    """The tables together: as a book, in C, and a CSV each if the configuration asks for it; no Structured Text."""
    from synth.frame.exhibits import File
    from synth.retarder.forms.table_forms import c_form, csv_form
    from tuning_tables.hdf5_file import book_bytes

    tables = [case.table for case in book.cases]
    files = {"book.h5": book_bytes(tables)}
    if book.config.output.csv:
        files |= {f"tables/{name}": content for name, content in csv_form(tables).items()}
    files |= {f"c/{name}": content for name, content in c_form(tables).items()}
    return tuple(File(name, content) for name, content in files.items()), ""


def show(found: FoundBook[CaseResult]) -> Iterator[Chapter]:
    """What is shown of it."""
    from synth.retarder.case_result import fronts_of
    from synth.retarder.shown.checks import checks, off_nominal
    from synth.retarder.shown.pictures import case_pictures, fronts
    from synth.retarder.shown.results import controllers, criterion, predictions, results

    yield Chapter("Results", tuple(results(found)))
    yield Chapter("Case by case", tuple(case_pictures(found.book.cases)))
    yield Chapter("Controllers side by side", tuple(controllers(found)))
    yield Chapter("Off nominal", tuple(off_nominal(found)))
    if made := fronts_of(found.book.cases):
        yield Chapter("Accuracy against time", tuple(fronts(made)))
    yield Chapter("Criterion", tuple(criterion(found)))
    yield Chapter("Predicted against simulated", tuple(predictions(found)))
    yield Chapter("Limit cycles and doubts", tuple(checks(found.book.cases)))
    where = "A controller loads tables/*.json, or is compiled with c/; book.h5 holds the same tables as arrays."
    yield Chapter("Tables", (Sentence(where), *found.files))


def by_what_measures(asked: Asked[ResolvedConfig, TuneOptions]) -> Command[ResolvedConfig, TuneOptions, Any, Any]:
    """The command for a radar, or that for point sensors."""
    from synth.retarder.sensors.tune_command import COMMAND as WITH_POINT_SENSORS

    return COMMAND if asked.settings.sensors is None else WITH_POINT_SENSORS


COMMAND = Command(
    name=TUNE,
    read=parse_config,
    options=TuneOptions,
    resolve=resolve,
    head=lambda asked: head_of(asked.config),
    steps=steps,
    compute=compute,
    show=show,
    limits=limits,
    limits_of_use=LIMITS_OF_USE,
    drawing=drawing,
    variant=by_what_measures,
)
