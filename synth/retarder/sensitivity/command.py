"""The command `sensitivity`: which number of a configuration to measure first."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from synth.frame.command import Asked, Command, Steps, Work
from synth.frame.exhibits import Chapter
from synth.frame.machine import available
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.configured import head_of
from synth.retarder.options import SensitivityOptions

if TYPE_CHECKING:
    from synth.retarder.sensitivity.responses import FixedTables
    from synth.retarder.sensitivity.sensitivity import Sensitivity, Trial

LIMITS_OF_USE = (
    "Shares are told by the ranges of the library. A range that is too wide makes a number look important.",
    "Parameters are taken as independent, each uniform over its range.",
    "A share is of one number alone. What numbers do together stands in a row of its own; it can be large for the rms.",
    "Intervals cover the choice of the points, not that of the passes: these are the same at every point, and their "
    "part of the variance stands in the row of the noise.",
    "The table stays as it is. How much better a table for the measured number is, is not told here.",
)


@dataclass(frozen=True)
class AskedSensitivity:
    """A configuration, what messages call its file, the trial, and the tables that are asked; None: those of a tune."""

    config: ResolvedConfig
    place: str
    trial: Trial
    given: tuple[FixedTables, ...] | None
    reads: tuple[Path, ...]


def resolve(asked: Asked[ResolvedConfig, SensitivityOptions]) -> AskedSensitivity:
    """Read the tables that are given."""
    from synth.retarder.forms.tables_at import files_at
    from synth.retarder.sensitivity.responses import tables_in
    from synth.retarder.sensitivity.sensitivity import Trial

    config, options = asked.settings, asked.options
    given = None if options.table is None else tables_in(options.table, config, asked.place)
    reads = () if options.table is None else tuple(files_at(options.table))
    seed = config.validation.seed if options.seed is None else options.seed
    return AskedSensitivity(config, asked.place, Trial(options.points, options.passes, seed), given, reads)


def steps(asked: AskedSensitivity) -> Steps:
    """A step for each class that is simulated, and for each that is tuned before."""
    return Steps(len(asked.given) if asked.given else 2 * len(asked.config.cuts), "simulating", "steps")


def compute(asked: AskedSensitivity, work: Work) -> Sensitivity:
    """Tune the tables unless they are given, and let the plant vary under them."""
    from synth.frame.version import creation_time
    from synth.kernels.cache import guarded
    from synth.retarder.failed_case import tables_refused
    from synth.retarder.sensitivity.responses import tables_tuned
    from synth.retarder.sensitivity.sensitivity import sensitivity

    config = asked.config
    with tables_refused(asked.place, config):
        workers = min(len(config.cuts), available())
        fixed = asked.given or guarded(tables_tuned, config, creation_time(), workers, work.progress.done)
        return guarded(sensitivity, config, fixed, asked.trial, available(), work.progress.done)


def show(found: Sensitivity) -> Iterator[Chapter]:
    """What is shown of it."""
    from synth.retarder.sensitivity.shown import case_by_case, first, ranges, shares

    yield Chapter("What to measure first", tuple(first(found)))
    yield Chapter("Shares of variance", tuple(shares(found)))
    yield Chapter("Case by case", tuple(case_by_case(found)))
    yield Chapter("Ranges", tuple(ranges(found)))


COMMAND = Command(
    name="sensitivity",
    read=parse_config,
    options=SensitivityOptions,
    resolve=resolve,
    head=lambda asked: head_of(asked.config, reads=asked.reads),
    steps=steps,
    compute=compute,
    show=show,
    limits_of_use=LIMITS_OF_USE,
)
