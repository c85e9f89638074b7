"""A run of hump trials: batches that are not there yet are humped by a cluster, processes, or this process, and stored
one by one; then all are joined.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Protocol

from synth.frame.command import Unfinished
from synth.frame.machine import available
from synth.frame.results_directory import ResultsDirectory
from synth.frame.workers.engine import Engine, InThisProcess, Watcher, missing_of
from synth.frame.workers.engine_options import EngineOptions
from synth.hump.rolling.outcomes import TrainOutcomes, joined
from synth.hump.trains.batch import BatchOrder, answer_batch, answer_batch_here, orders_of
from synth.hump.trains.outcome_file import TrialTrains, from_npz, to_npz, trains_of
from synth.hump.trial.resolved_trial import ResolvedTrial
from synth.hump.trial.trial import HumpTrial


def engine_for(options: EngineOptions, tell: Callable[[str], None], batches: int) -> Engine:
    """The cluster that was named, which `tell` is told, processes, or this process for a single batch: workers load."""
    if options.scheduler is not None:
        from synth.frame.workers.dask_cluster import connect

        return connect(options.scheduler, answer_batch, tell)
    if options.workers is None and min(batches, available()) < 2:
        return InThisProcess(answer_batch_here)
    from synth.frame.workers.local_workers import LocalWorkers

    return LocalWorkers(max(1, min(options.workers or available(), batches)), answer_batch)


FOLDER = "batches"


class Progress(Watcher, Protocol):
    """Is told how much is there already, then of each batch."""

    def begin(self, done: int) -> None:
        """So many batches are stored."""


@dataclass(frozen=True)
class BatchFiles:
    """The stored batches of `trial` in `directory`, each under a seal."""

    directory: ResultsDirectory
    trial: TrialTrains

    def name(self, key: str) -> str:
        """The name of the file of one batch."""
        return f"{FOLDER}/{key}.npz"

    def file(self, key: str) -> Path:
        """The file of one batch."""
        return self.directory.path / self.name(key)

    def store(self, key: str, found: TrainOutcomes) -> None:
        """Write a batch, complete or not at all; raises `OSError`."""
        self.directory.store(self.name(key), to_npz(found, self._only(key)))

    def stored(self, order: BatchOrder) -> TrainOutcomes:
        """The batch of an order; `FileNotFoundError`, or `DamagedTable` where it is not what was stored for it."""
        path = self.file(order.key)
        return from_npz(path.read_bytes(), str(path), self._only(order.key), order.count)

    def _only(self, key: str) -> TrialTrains:
        """The trains of one batch: its file says of which, so that it is not taken for another's."""
        return replace(self.trial, trains_sha256=key)


@dataclass(frozen=True)
class TrialRun:
    """All batches of one trial of a run; `name` tells it from the others, "" where it is alone."""

    name: str
    files: BatchFiles
    orders: tuple[BatchOrder, ...]

    def outcomes(self) -> TrainOutcomes:
        """Those of all its trains, from the stored batches."""
        return joined([self.files.stored(order) for order in self.orders])


def run_of(
    config: ResolvedTrial, trial: HumpTrial, number: int, directory: ResultsDirectory, name: str = ""
) -> TrialRun:
    """The first `number` trains of `trial`, which was made of `config`."""
    files = BatchFiles(directory, trains_of(config))
    return TrialRun(name, files, tuple(orders_of(trial, config.trains_sha256, number)))


def run_trials(runs: Sequence[TrialRun], engine: Callable[[int], Engine], watcher: Progress) -> list[TrainOutcomes]:
    """The outcomes of each run; batches that are not stored are humped by the `engine` for so many, and stored as they
    come.

    `Unfinished` tells why one could not be humped. What was stored before stays.
    """
    owner = {order.key: (run, order) for run in runs for order in run.orders}
    orders = [order for _, order in owner.values()]
    missing = missing_of(
        orders,
        lambda key: owner[key][0].files.file(key),
        lambda order: owner[order.key][0].files.stored(order),
        watcher,
    )
    watcher.begin(len(orders) - len(missing))
    with closing(engine(len(missing)).answers(missing, lambda order: None)) as answers:
        for answer in answers:
            run, order = owner[answer.key]
            name = ", ".join(filter(None, (run.name, order.name)))
            if answer.result is None:
                raise Unfinished(f"{name}: {answer.reason}")
            run.files.store(answer.key, answer.result)
            watcher.done(f"{name}: {words(answer.result)}")
    for key, (run, _) in owner.items():
        run.files.directory.retain(run.files.name(key))
    return [run.outcomes() for run in runs]


def words(found: TrainOutcomes) -> str:
    """A batch in a line."""
    speed = found.span_m.sum() / found.span_s.sum()
    return f"{speed:.2f} m/s, {int(found.caught.sum())} of {int(found.cuts.sum())} cuts caught up"
