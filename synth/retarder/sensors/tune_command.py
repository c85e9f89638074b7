"""The command `sensors tune`: tables that decide where axles pass point sensors, and their proof."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from synth.frame.command import Asked, Command, Head, Limit, Steps, Work
from synth.frame.exhibits import Chapter, Sentence
from synth.frame.input_error import InputError
from synth.frame.settings.settings_file import BUILT_IN
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.configuration.point_sensors.resolved_sensors import ResolvedSensors
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.configured import head_of, require_memory_for
from synth.retarder.exit_figures import CHANCE_ONLY, MODEL_ONLY, NOT_CERTIFIED
from synth.retarder.sensors.tune_options import SensorsTuneOptions

if TYPE_CHECKING:
    from synth.frame.results_directory import ResultsDirectory
    from synth.retarder.sensors.found_passages import FoundPassages
    from tuning_tables.passages.passage_table import PassageTable

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


@dataclass(frozen=True)
class AskedSensors:
    """A configuration with its sensors, what messages call its file, and how many classes are solved at once."""

    config: ResolvedConfig
    sensors: ResolvedSensors
    place: str
    workers: int


def read(text: str, place: str) -> ResolvedConfig:
    """The configuration in `text`; the one that `init --sensors` prints where there is no file."""
    from synth.retarder.configuration.point_sensors.template import built_in_sensors

    return built_in_sensors() if place == BUILT_IN else parse_config(text, place)


def resolve(asked: Asked[ResolvedConfig, SensorsTuneOptions]) -> AskedSensors:
    """Refuse a configuration without sensors, what they cannot keep, and what does not fit into memory."""
    config, place = asked.settings, asked.place
    if config.sensors is None:
        raise InputError(
            f"{place}: the section [sensors] is missing; 'retarder-synth init --sensors' prints one to start from, and "
            "'retarder-synth tune' makes tables for the radar"
        )
    if config.criterion.requirement is not None:
        raise InputError(
            f"{place}: criterion.p_overspeed and criterion.worst_friction_* can be kept only by tables for a radar; "
            "set them back to 1"
        )
    workers = asked.options.workers_for(len(config.cuts))
    for label, plant in config.plants():
        require_memory_for(label, config.sensors.serving(plant), (config.resolution,), place, workers)
    return AskedSensors(config, config.sensors, place, workers)


def head(asked: AskedSensors) -> Head:
    """What is said of the configuration."""
    return head_of(asked.config)


def steps(asked: AskedSensors) -> Steps:
    """A step for each case."""
    return Steps(len(asked.config.problems()), "tuning", "cases")


def drawing(asked: AskedSensors) -> int:
    """As many processes as classes are solved at once."""
    return asked.workers


def compute(asked: AskedSensors, work: Work) -> FoundPassages:
    """The book; its tables are written as they are made. `InputError` where no case has a table."""
    from synth.kernels.cache import guarded
    from synth.retarder.first_run import compiled_beside
    from synth.retarder.sensors.found_passages import found_passages
    from synth.retarder.sensors.sensor_tune import tune_sensors
    from synth.retarder.tables_refused import require_a_table, tables_refused

    with compiled_beside(work.progress.note), tables_refused(asked.place, asked.config):
        store = partial(stored, directory=work.directory)
        book = guarded(tune_sensors, asked.config, asked.sensors, store, work.progress, asked.workers)
        require_a_table(book.cases, book.failed)
        return found_passages(book)


def stored(table: PassageTable, directory: ResultsDirectory) -> PassageTable:
    """Write `table` as JSON; the table as a controller will load it."""
    from tuning_tables.json_file import read_json, to_json
    from tuning_tables.passages.passage_table import PassageTable

    return read_json(directory.write(f"tables/{table.id}.json", to_json(table)), PassageTable)


def limits(found: FoundPassages) -> Iterator[Limit]:
    """Those of [acceptance]."""
    from synth.retarder.acceptance import limits_of

    book = found.book
    return limits_of(found.verdicts, [case.statistics for case in book.cases], book.config.acceptance, book.failed)


def show(found: FoundPassages) -> Iterator[Chapter]:
    """What is shown of it."""
    from synth.retarder.sensors.tune_pictures import chapters
    from synth.retarder.sensors.tune_shown import designs, heard, results

    yield Chapter("Results", tuple(results(found)))
    yield Chapter("Sensors and passages", tuple(heard(found.book)))
    yield Chapter("How the tables were found", tuple(designs(found.book)))
    yield from chapters(found.book.cases)
    where = Sentence("A controller loads tables/*.json, or is compiled with c/ or st/.")
    yield Chapter("Tables", (where, *found.files))


COMMAND = Command(
    name="sensors tune",
    read=read,
    options=SensorsTuneOptions,
    resolve=resolve,
    head=head,
    steps=steps,
    compute=compute,
    show=show,
    limits=limits,
    limits_of_use=LIMITS_OF_USE,
    drawing=drawing,
)
