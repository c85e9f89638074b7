"""The command `tune` with point sensors: tables that decide where axles pass them, and their proof."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from plant_models import Plant
from synth.frame.command import Asked, Command, Work
from synth.frame.exhibits import Chapter, Sentence
from synth.frame.faults import InputError
from synth.problem.resolution import Resolution
from synth.retarder.asked_tune import AskedTune, asked_tune, drawing, limits, steps, tuned
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.configuration.resolved_position import ResolvedSensors
from synth.retarder.configured import head_of
from synth.retarder.epochs import Ground
from synth.retarder.exit_figures import CHANCE_ONLY, MODEL_ONLY, NOT_CERTIFIED
from synth.retarder.options import TUNE, TuneOptions

if TYPE_CHECKING:
    from synth.frame.exhibits import File
    from synth.retarder.acceptance import FoundBook
    from synth.retarder.sensors.sensor_case import SensorCase
    from synth.retarder.tune import Book
    from tuning_tables.passages.passage_table import PassageTable


@dataclass(frozen=True)
class PassageEpochs:
    """See `Epochs`; `sensors` tell the passages."""

    sensors: ResolvedSensors

    def grids(self, config: ResolvedConfig, plant: Plant) -> tuple[Plant, Sequence[Resolution]]:
        """See `Epochs`."""
        return self.sensors.serving(plant), (config.resolution,)

    def cases(self, ground: Ground[PassageTable], label: str, plant: Plant) -> list[Callable[[], SensorCase]]:
        """See `Epochs`."""
        from synth.retarder.sensors.sensor_case import (
            sensor_case,  # with the kernels
            sensor_class,
        )

        config = ground.config
        setup = sensor_class(label, plant, self.sensors, config.resolution, ground.passes, ground.origin)
        return [partial(sensor_case, setup, aim, ground.store) for aim in config.aims_of(label)]


LIMITS_OF_USE = (
    MODEL_ONLY,
    CHANCE_ONLY,
    "A table holds for its cut class, target speed and sensors, for the entry speeds named in the parameters and for a "
    "regulator that gives no new command until the change of the last one has ended.",
    "Sensors are simulated in order. A dead, late or spurious one costs accuracy; the table's tracker leaves pulses "
    "that no cut can have made out of account.",
    "The regulator acts from the first sensor on. The cut ahead must have left the position by then: this interlock is "
    "the yard's.",
    NOT_CERTIFIED,
)


def resolve(asked: Asked[ResolvedConfig, TuneOptions]) -> AskedTune[SensorCase, PassageTable]:
    """Refuse what sensors cannot keep, what is for a radar, and what does not fit into memory."""
    config, place = asked.settings, asked.place
    assert config.sensors is not None  # else it is another command
    if asked.options.pareto:
        raise InputError(f"{place}: it has point sensors; --pareto is for tables for a radar: leave one of the two out")
    if config.criterion.requirement is not None:
        raise InputError(
            f"{place}: criterion.p_overspeed and criterion.worst_friction_* can be kept only by tables for a radar; "
            "set them back to 1"
        )
    return asked_tune(config, place, PassageEpochs(config.sensors), asked.options)


def compute(asked: AskedTune[SensorCase, PassageTable], work: Work) -> FoundBook[SensorCase]:
    """The book, and its tables as C99 and as Structured Text."""
    from synth.retarder.tune import no_notice

    return tuned(asked, work, no_notice, book_files)


def book_files(book: Book[SensorCase]) -> tuple[tuple[File, ...], str]:
    """The tables together, and why they are no Structured Text, '' where they are: 16 bits do not count all.

    `InvalidTable` where they make no book.
    """
    from synth.frame.exhibits import File
    from synth.retarder.forms.table_forms import c_form, csv_form, plc_form
    from tuning_tables import InvalidTable

    tables = [case.table for case in book.cases]
    files, no_st = {f"c/{name}": content for name, content in c_form(tables).items()}, ""
    try:
        files |= {f"st/{name}": content for name, content in plc_form("st", tables).items()}
    except InvalidTable as fault:
        no_st = str(fault)
    if book.config.output.csv:
        files |= {f"tables/{name}": content for name, content in csv_form(tables).items()}
    return tuple(File(name, content) for name, content in files.items()), no_st


def show(found: FoundBook[SensorCase]) -> Iterator[Chapter]:
    """What is shown of it."""
    from synth.retarder.sensors.tune_shown import chapters, designs, heard, results

    cases, sensors = found.book.cases, found.book.config.sensors
    assert sensors is not None  # `resolve` has refused a configuration without
    yield Chapter("Results", tuple(results(found)))
    yield Chapter("Sensors and passages", tuple(heard(sensors, cases)))
    yield Chapter("How the tables were found", tuple(designs(cases)))
    yield from chapters(cases)
    where = Sentence("A controller loads tables/*.json, or is compiled with c/ or st/.")
    yield Chapter("Tables", (where, *found.files))


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
)
