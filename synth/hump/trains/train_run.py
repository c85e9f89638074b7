"""A run of a hump trial: batches that are not there yet are humped, and stored one by one; then all are joined."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

from synth.frame.command import Unfinished
from synth.frame.results_directory import ResultsDirectory
from synth.frame.workers.engine import Engine, Watcher
from synth.hump.trains.batch import BatchOrder
from synth.hump.trains.outcome_file import TrialTrains, from_npz, to_npz
from synth.hump.trains.outcomes import TrainOutcomes, joined

FOLDER = "batches"


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
        self.directory.store(self.name(key), to_npz(found, self.trial))

    def stored(self, key: str, count: int) -> TrainOutcomes:
        """A batch of `count` trains; `FileNotFoundError`, or `DamagedTable` where a byte has changed."""
        path = self.file(key)
        return from_npz(path.read_bytes(), str(path), self.trial, count)


def run_trains(
    orders: Sequence[BatchOrder],
    missing: Sequence[BatchOrder],
    files: BatchFiles,
    engine: Engine,
    watcher: Watcher,
) -> TrainOutcomes:
    """All trains of `orders`; those `missing` are humped by `engine` and stored as they come.

    `Unfinished` tells why one could not be humped. What was stored before stays.
    """
    names = {order.key: order.name for order in missing}
    with closing(engine.answers(missing, lambda order: None)) as answers:
        for answer in answers:
            if answer.result is None:
                raise Unfinished(f"{names[answer.key]}: {answer.reason}")
            files.store(answer.key, answer.result)
            watcher.done(f"{names[answer.key]}: {words(answer.result)}")
    files.directory.retain(*(files.name(order.key) for order in orders))
    return joined([files.stored(order.key, order.count) for order in orders])


def words(found: TrainOutcomes) -> str:
    """A batch in a line."""
    speed = found.span_m.sum() / found.span_s.sum()
    return f"{speed:.2f} m/s, {int(found.caught.sum())} of {int(found.cuts.sum())} cuts caught up"
