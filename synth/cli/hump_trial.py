"""`retarder-synth hump simulate`, `hump report`, `hump speed`: faults of input are told before a train is humped."""

from __future__ import annotations

import json
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from synth.frame.input_error import InputError
from synth.frame.processors import available
from synth.frame.terminal.telling import LIMITS_MISSED, OK, say

if TYPE_CHECKING:
    from synth.configuration.humping.trial_file import TrialFile
    from synth.frame.results_directory import ResultsDirectory
    from synth.present.humping_outputs import TrialResult
    from synth.sweep.trains.batch import BatchOrder
    from synth.sweep.work import Engine
    from synth.yard.humping.resolved_trial import ResolvedTrial


TRAINS_COMMAND = "hump simulate"
"""The owner of a directory that `hump report` writes into, too."""


@dataclass(frozen=True)
class AskedTrains:
    """What the command line says besides the configuration; None: as configured."""

    number: int | None
    seed: int | None
    sorting_list: Path | None


def asked_file(source: Path | None, asked: AskedTrains) -> TrialFile:
    """The configuration with what the command line says."""
    from synth.configuration.humping.trial_file import read_trial_file

    return read_trial_file(source).with_trains(asked.number, asked.seed, asked.sorting_list)


def simulate_command(
    source: Path | None, asked: AskedTrains, output: Path, workers: int | None, scheduler: str | None, as_json: bool
) -> int:
    """Hump the trains of `source` into the directory `output`; the exit code."""
    from synth.frame.creation_time import require_date
    from synth.frame.results_directory import results_directory
    from synth.sweep.trains.trial_inputs import FOLDER, files_read, write_inputs

    if workers is not None and scheduler is not None:
        raise InputError("hump simulate: --workers and --scheduler are both given; leave one out")
    file = asked_file(source, asked)
    require_date()
    from synth.yard.humping.resolved_trial import resolve_trial

    config = resolve_trial(file)
    with results_directory(output, TRAINS_COMMAND, files_read(file, config), inputs=FOLDER) as directory:
        for warning in config.warnings:
            say(f"warning: {warning}")
        write_inputs(file, config, directory)
        result = simulated(config, directory, workers, scheduler)
    return told(result, output, as_json) if result is not None else LIMITS_MISSED


def simulated(
    config: ResolvedTrial, directory: ResultsDirectory, workers: int | None, scheduler: str | None
) -> TrialResult | None:
    """The work itself; None where a batch could not be humped, which is told."""
    from synth.frame.creation_time import creation_time
    from synth.frame.terminal.progress import Progress
    from synth.kernels.cache import guarded
    from synth.present.humping_outputs import judged, write_trains
    from synth.sweep.trains.batch import orders_of
    from synth.sweep.trains.train_run import BatchFailed, BatchFiles, missing_of, run_trains
    from synth.yard.humping.made_trial import made_trial
    from synth.yard.humping.outcome_file import TrialTrains

    started, number = time.monotonic(), config.settings.trains.number
    trial = guarded(made_trial, config)
    orders = list(orders_of(trial, config.trains_sha256, number))
    files = BatchFiles(directory, TrialTrains(config.routes, config.trains_sha256))
    with Progress(len(orders), "humping", "batches") as progress:
        missing = missing_of(orders, files, progress)
        progress.begin(len(orders) - len(missing))
        engine = engine_for(missing, workers, scheduler)
        try:
            found = run_trains(orders, missing, files, engine, progress)
        except BatchFailed as fault:
            say(f"{fault}; what was humped before is kept in {directory.path}")
            return None
        except KeyboardInterrupt:
            say(f"batches of trains that were humped are kept in {directory.path}; the same command goes on")
            raise
        progress.note(f"{number} trains humped after {time.monotonic() - started:.1f} s")
        result = judged(config, trial, found, creation_time())
        write_trains(result, directory, progress.note)
        progress.note(f"all files written after {time.monotonic() - started:.1f} s")
    return result


def engine_for(missing: list[BatchOrder], workers: int | None, scheduler: str | None) -> Engine:
    """The cluster that was named, processes, or this process for a single batch: workers have to load first."""
    from synth.sweep.trains.batch import answer_batch, answer_batch_here

    if scheduler is not None:
        from synth.sweep.dask_cluster import connect

        cluster = connect(scheduler, answer_batch)
        say(f"the scheduler at {scheduler} has {cluster.threads()} threads of workers; more may join")
        return cluster
    if workers is None and min(len(missing), available()) < 2:
        from synth.sweep.work import InThisProcess

        return InThisProcess(answer_batch_here)
    from synth.sweep.local_workers import LocalWorkers

    return LocalWorkers(max(1, min(workers or available(), len(missing))), answer_batch)


def told(result: TrialResult, output: Path, as_json: bool) -> int:
    """The end of a run on stdout; the exit code."""
    if as_json:
        sys.stdout.write((output / "summary.json").read_text(encoding="utf-8"))
    else:
        from synth.cli.train_figure_table import print_trains

        print_trains(result, output)
    return OK if result.verdict.accepted else LIMITS_MISSED


def report_command(path: Path, as_json: bool) -> int:
    """Make figures, pictures and pages anew from the trains in the directory `path`; the exit code."""
    from synth.frame.creation_time import creation_time, require_date
    from synth.frame.results_directory import results_directory
    from synth.present.humping_outputs import judged, write_trains
    from synth.sweep.trains.train_run import FOLDER as BATCHES
    from synth.sweep.trains.trial_inputs import FOLDER
    from synth.yard.humping.made_trial import made_trial
    from synth.yard.humping.stored_trains import stored_trains

    require_date()
    stored = stored_trains(path, str(path))
    with results_directory(path, TRAINS_COMMAND) as directory:
        directory.retain(*(name for folder in (FOLDER, BATCHES) for name in directory.names_below(folder)))
        result = judged(stored.config, made_trial(stored.config), stored.found, creation_time())
        write_trains(result, directory, say)
    return told(result, path, as_json)


def speed_command(source: Path | None, asked: AskedTrains, train: int, output: Path, as_json: bool) -> int:
    """Write the program of hump speeds of one train into the directory `output`."""
    from synth.frame.results_directory import results_directory
    from synth.kernels.cache import guarded
    from synth.yard.humping.made_trial import made_trial
    from synth.yard.humping.resolved_trial import resolve_trial
    from synth.yard.humping.speed_program import speed_program

    file = asked_file(source, asked)
    config = resolve_trial(file)
    from synth.present.speed_program_outputs import program_document, write_program
    from synth.sweep.trains.trial_inputs import files_read

    with results_directory(output, "hump speed", files_read(file, config)) as directory:
        for warning in config.warnings:
            say(f"warning: {warning}")
        program = guarded(speed_program, guarded(made_trial, config), train - 1)
        files = write_program(program, directory)
    if as_json:
        print(json.dumps(program_document(program, files), indent=1, ensure_ascii=False))
        return OK
    from synth.frame.terminal.printed_page import print_page

    print_page(
        f"train {train}: cuts: {len(program.rows)}; over the crest in {program.rows[-1].time_s:.0f} s at "
        f"{program.mean_m_s:.2f} m/s, {program.cars_per_hour:.0f} cars an hour",
        *map(str, files),
    )
    return OK
