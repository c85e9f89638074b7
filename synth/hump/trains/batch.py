"""A batch of trains as a worker is asked for it."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from dataclasses import dataclass, replace

from synth.frame.workers.engine import Answer, answered, require_software, software_sha256
from synth.hump.rolling.outcomes import TrainOutcomes
from synth.hump.trial.trial import BATCH, HumpTrial


@dataclass(frozen=True)
class BatchOrder:
    """The trains `first` … `first + count − 1` of `trial`; `key`: SHA-256 of what their outcomes depend on, then which
    they are. `software`: that has to hump them."""

    key: str
    first: int
    count: int
    software: str
    trial: HumpTrial

    @property
    def name(self) -> str:
        """The batch in messages; trains count from 1 there."""
        return f"trains {self.first + 1} to {self.first + self.count}"


def trains_of_batch(shift_trains: int) -> int:
    """How many trains are humped in one batch; `shift_trains`: of each shift."""
    return BATCH * shift_trains


def batches(number: int, shift_trains: int) -> int:
    """In how many batches so many trains are humped."""
    return -(-number // trains_of_batch(shift_trains))


def orders_of(trial: HumpTrial, trains_sha256: str, number: int) -> Iterator[BatchOrder]:
    """The batches of `number` trains; `trains_sha256`: of all that each of them depends on."""
    software = software_sha256()
    trains = hashlib.sha256(f"{trains_sha256}\0{software}".encode()).hexdigest()
    one_thread = replace(trial, threads=1)
    most = trains_of_batch(trial.tracks.shift_trains)
    for first in range(0, number, most):
        count = min(most, number - first)
        yield BatchOrder(f"{trains[:32]}-{first}-{count}", first, count, software, one_thread)


def answer_batch(order: BatchOrder) -> Answer:
    """Hump a batch."""
    return answered(order, humped_batch)


def answer_batch_here(order: BatchOrder) -> Answer:
    """Hump a batch in the process that asks, on all its threads; the outcomes are the same."""
    return answer_batch(replace(order, trial=replace(order.trial, threads=0)))


def humped_batch(order: BatchOrder) -> TrainOutcomes:
    """What becomes of the trains of `order`, humped in this process by this very software."""
    require_software(order.software)
    from synth.kernels.cache import guarded

    return guarded(order.trial.batch, order.first, order.count)
