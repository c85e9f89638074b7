"""`retarder-synth sensors tune`: everything that can be refused is refused before anything is computed or written."""

from __future__ import annotations

import sys
import time
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from synth.book.tables_refused import require_a_table, tables_refused
from synth.frame.processors import available
from synth.frame.terminal.telling import LIMITS_MISSED, OK, say

if TYPE_CHECKING:
    from synth.configuration.point_sensors.resolved_sensors import ResolvedSensors
    from synth.configuration.resolved_config import ResolvedConfig
    from synth.frame.results_directory import ResultsDirectory


def sensors_tune_command(path: Path | None, output: Path, workers: int | None, as_json: bool) -> int:
    """Tune the configuration in `path` for its point sensors into the directory `output`; the exit code."""
    from synth.frame.creation_time import require_date
    from synth.frame.results_directory import results_directory

    place, config, sensors = read_configuration(path)
    workers = workers or min(len(config.cuts), available())
    require_room(config, sensors, place, workers)
    require_date()
    with results_directory(output, "sensors tune", filter(None, [path])) as directory:
        for warning in config.warnings:
            say(f"warning: {warning}")
        return tune_into(directory, config, sensors, place, workers, as_json)


def read_configuration(path: Path | None) -> tuple[str, ResolvedConfig, ResolvedSensors]:
    """(what messages call it, the configuration, its sensors); `InputError` where it asks for what is not possible."""
    from synth.configuration.config_file import load_config
    from synth.configuration.point_sensors.template import BUILT_IN_SENSORS, built_in_sensors
    from synth.frame.input_error import InputError

    place = BUILT_IN_SENSORS if path is None else str(path)
    config = built_in_sensors() if path is None else load_config(path)
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
    return place, config, config.sensors


def tune_into(
    directory: ResultsDirectory,
    config: ResolvedConfig,
    sensors: ResolvedSensors,
    place: str,
    workers: int,
    as_json: bool,
) -> int:
    """The work itself, and what is said about it."""
    from synth.frame.terminal.interrupt import interruptible
    from synth.frame.terminal.progress import Progress
    from synth.kernels.cache import cache_in_use, guarded

    started, cache = time.monotonic(), cache_in_use()
    with interruptible(directory), Progress(len(config.problems())) as progress:
        if cache is None or next(cache.rglob("*.nbi"), None) is None:
            progress.note("compiling the kernels for this machine, once; this takes a few minutes")
        from synth.book.sensors.sensor_acceptance import judge_sensors
        from synth.book.sensors.sensor_tune import tune_sensors
        from synth.frame.printed_numbers import counted
        from synth.present.sensor_outputs import store_passages, write_sensors

        with tables_refused(place, config):
            store = partial(store_passages, directory=directory)
            book = guarded(tune_sensors, config, sensors, store, progress, workers)
            require_a_table(book.cases, book.failed)
            progress.note(f"{counted(len(book.cases), 'case')} computed in {time.monotonic() - started:.1f} s")
            verdict = judge_sensors(book)
            summary = write_sensors(book, verdict, directory, progress.note)
        progress.note(f"all files written after {time.monotonic() - started:.1f} s")
    if as_json:
        sys.stdout.write((directory.path / "summary.json").read_text(encoding="utf-8"))
    else:
        from synth.cli.sensors_table import print_sensors

        print_sensors(summary, directory.path)
    return OK if verdict.accepted else LIMITS_MISSED


def require_room(config: ResolvedConfig, sensors: ResolvedSensors, place: str, workers: int) -> None:
    """`InputError` if the grid would not fit into memory."""
    from plant_models import PlantError
    from synth.frame.input_error import InputError
    from synth.solver.chain.grid import require_memory

    for label, plant in config.plants():
        try:
            require_memory(label, sensors.serving(plant), (config.resolution,), workers)
        except PlantError as error:
            raise InputError(f"{place}: {str(error).replace('grid: ', 'grid.', 1)}") from None
