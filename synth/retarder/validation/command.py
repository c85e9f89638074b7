"""The command `validate`: exported tables in the closed loop, beside what their file says of them."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from synth.frame.command import Asked, Command, Head, Limit, Steps, Work
from synth.frame.exhibits import Chapter, File, Sentence
from synth.frame.faults import InputError
from synth.frame.machine import available
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.configured import configuration_of, given_config, head_of, made_elsewhere
from synth.retarder.exit_figures import CHANCE_ONLY, MODEL_ONLY
from synth.retarder.validation.options import ValidateOptions

if TYPE_CHECKING:
    from synth.retarder.validation.revalidation import Rehearsal, Revalidation
    from tuning_tables import ControllerTable
    from tuning_tables.document import StageTable

LIMITS_OF_USE = (MODEL_ONLY, CHANCE_ONLY)


@dataclass(frozen=True)
class AskedPasses:
    """The tables at one place.

    `infeasible`: whether the summary beside them calls the case of each so; `log`: None where none is asked for.
    """

    tables: tuple[StageTable, ...]
    infeasible: tuple[bool, ...]
    rehearsal: Rehearsal
    log: AskedLog | None


@dataclass(frozen=True)
class AskedLog:
    """`passes` passes of each of `tables` are to be logged in a file called `name`; `gauge_std_kpa` None: no gauge."""

    tables: tuple[ControllerTable, ...]
    name: str
    passes: int
    gauge_std_kpa: float | None


@dataclass(frozen=True)
class FoundPasses:
    """What became of each table, and the log of so many passes of each; None and 0 where none was asked for."""

    title: str
    seed: int
    tables: tuple[Revalidation, ...]
    log: File | None
    logged: int


def resolve(asked: Asked[ResolvedConfig | None, ValidateOptions]) -> AskedPasses:
    """The tables; refused where one fits no class of the configuration, or its passes cannot be logged."""
    from synth.retarder.forms.tables_at import is_infeasible, summary_beside, tables_at

    path, options = asked.options.source, asked.options
    found = tables_at(path)
    tables = found.of_stages
    if not tables:
        raise InputError(f"{path}: its tables are aim tables, which regulate nothing; 'aim' simulates what it makes")
    config, source = configuration_of(asked, tables)
    if found.passages and options.log is not None:
        raise InputError(f"{path}: its tables are for point sensors, whose passes are not logged; leave out --log")
    if options.log is None and options.model_fields_set & {"log_passes", "gauge_std_kpa"}:
        raise InputError("--log-passes and --gauge-std are about a log; name its file in DIR by --log NAME.csv")
    from synth.retarder.served_class import served_class
    from synth.retarder.validation.revalidation import Rehearsal

    for table in tables:
        served_class(table, config, source)
    summary = summary_beside(path)
    seed = config.validation.seed if options.seed is None else options.seed
    return AskedPasses(
        tables,
        tuple(is_infeasible(each, summary) for each in tables),
        Rehearsal(config, source, options.passes or config.validation.passes, seed, available()),
        None if options.log is None else AskedLog(found.lines, options.log, options.log_passes, options.gauge_std_kpa),
    )


def head(asked: AskedPasses) -> Head:
    """What is said of the configuration, with a word about tables that another one made."""
    rehearsal = asked.rehearsal
    return head_of(rehearsal.config, made_elsewhere(asked.tables, rehearsal.config, rehearsal.source))


def steps(asked: AskedPasses) -> Steps:
    """A step for each table."""
    return Steps(len(asked.tables), "simulating", "tables")


def compute(asked: AskedPasses, work: Work) -> FoundPasses:
    """The passes of all tables, and the log."""
    from synth.kernels.cache import guarded
    from synth.retarder.validation.revalidation import revalidated

    rehearsal = asked.rehearsal
    found = guarded(revalidated, asked.tables, rehearsal, asked.infeasible, work.progress.done)
    log = None if asked.log is None else guarded(log_file, rehearsal, asked.log)
    logged = 0 if asked.log is None else asked.log.passes
    return FoundPasses(rehearsal.config.title, rehearsal.seed, tuple(found), log, logged)


def log_file(rehearsal: Rehearsal, log: AskedLog) -> File:
    """Passes of the tables, simulated once more, as cuts come, as a controller logs them."""
    from plant_models.pressure_regulator import PressureGauge
    from synth.retarder.validation.revalidation import rehearsed_log
    from tuning_tables.pass_log.log_files import write_log

    gauge = None if log.gauge_std_kpa is None else PressureGauge(log.gauge_std_kpa)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / log.name
        write_log(rehearsed_log(log.tables, rehearsal, log.passes, gauge), path)
        return File(log.name, path.read_bytes())


def limits(found: FoundPasses) -> Iterator[Limit]:
    """Those of [acceptance], for tables that are not known to be infeasible."""
    from synth.retarder.validation.shown import limits_of

    return limits_of(found.tables)


def show(found: FoundPasses) -> Iterator[Chapter]:
    """What is shown of it."""
    from synth.retarder.validation.shown import tables

    yield Chapter("Tables", tuple(tables(found.title, found.seed, found.tables)))
    if found.log is not None:
        sentence = f"{found.logged} passes of each table, as a controller logs them: {found.log.name}"
        yield Chapter("Log", (Sentence(sentence, brief=True), found.log))


COMMAND = Command(
    name="validate",
    read=given_config,
    options=ValidateOptions,
    resolve=resolve,
    head=head,
    steps=steps,
    compute=compute,
    show=show,
    limits=limits,
    limits_of_use=LIMITS_OF_USE,
)
