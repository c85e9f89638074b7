"""Who humps the batches of a run: a cluster, processes, or this process."""

from __future__ import annotations

from collections.abc import Callable

from synth.frame.processors import available
from synth.frame.workers.engine import Engine, InThisProcess
from synth.frame.workers.engine_options import EngineOptions
from synth.hump.trains.batch import answer_batch, answer_batch_here


def engine_for(options: EngineOptions, tell: Callable[[str], None], batches: int) -> Engine:
    """The cluster that was named, which `tell` is told, processes, or this process for a single batch: workers load."""
    if options.scheduler is not None:
        from synth.frame.workers.dask_cluster import connect

        return connect(options.scheduler, answer_batch, tell)
    if options.workers is None and min(batches, available()) < 2:
        return InThisProcess(answer_batch_here)
    from synth.frame.workers.local_workers import LocalWorkers

    return LocalWorkers(max(1, min(options.workers or available(), batches)), answer_batch)
