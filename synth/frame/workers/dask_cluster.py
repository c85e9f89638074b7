"""Workers of a Dask cluster, on this machine or many; needs the extra [sweep].

The scheduler gives what a dead worker was at to another one by itself; results come back to this process, which alone
writes, so that no file system needs to be shared.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
import os
from collections import deque
from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass
from importlib import import_module
from typing import Any

from synth.frame.faults import InputError
from synth.frame.workers.engine import Answer, Begun, Order, Work

ANSWER_WITHIN_S = 15
AHEAD = 2
"""Units given to the scheduler for each of its threads: one under way, one to begin with at once."""

CLOSE_WITHIN_S = 5
SCHEDULER_LOST = "the scheduler was lost before it was done; the same command goes on"
LOST = (OSError, TimeoutError, asyncio.TimeoutError, asyncio.CancelledError)
"""What the client raises when its scheduler is gone."""

LOGGERS = ("asyncio", "distributed", "tornado")
"""They tell of a lost scheduler in a hundred lines; one sentence of ours says it."""


@dataclass(frozen=True)
class DaskCluster:
    """A connected client."""

    client: Any
    distributed: Any
    work: Work

    def answers(self, orders: Sequence[Order], begun: Begun) -> Generator[Answer]:
        """As they are ready; units whose workers die again and again are answered with the reason."""
        # A run of its own: what a run that was killed has asked for must not be taken for ours.
        run = os.urandom(4).hex()
        waiting = deque(orders)
        given: dict[str, Order] = {}
        try:
            finished = self.distributed.as_completed(loop=self.client.loop)
            while waiting or given:
                while waiting and len(given) < AHEAD * max(1, self.threads()):
                    key = f"unit-{waiting[0].key}-{run}"
                    finished.add(self.client.submit(self.work, waiting[0], key=key, pure=False))
                    given[key] = waiting.popleft()
                    begun(given[key])
                future = next(finished)
                found = self.answer_of(future, given[future.key])
                del given[future.key], future  # the cluster forgets a result that nobody holds
                yield found
        except LOST:
            for order in (*given.values(), *waiting):
                yield Answer(order.key, None, SCHEDULER_LOST)
        finally:
            with contextlib.suppress(*LOST):
                self.client.close(timeout=CLOSE_WITHIN_S)

    def threads(self) -> int:
        """Threads of all workers that are connected now."""
        return sum(self.client.nthreads().values())

    def answer_of(self, future: Any, order: Order) -> Answer:
        """The answer, or why there is none."""
        if future.status == "finished":
            found: Answer = future.result()
            return found
        if future.status == "error":
            fault = future.exception()
            killed = type(fault).__name__ == "KilledWorker"
            reason = "its worker died again and again" if killed else f"{type(fault).__name__}: {fault}"
            return Answer(order.key, None, " ".join(reason.split()))
        return Answer(order.key, None, SCHEDULER_LOST)


def connect(address: str, work: Work, tell: Callable[[str], None]) -> DaskCluster:
    """The cluster at `address`; `tell` is told its size. `InputError` without the library, and without an answer."""
    try:
        distributed = import_module("distributed")
    except ImportError:
        raise InputError("--scheduler needs Dask: pip install 'retarder-synth[sweep]', or take --workers") from None
    try:
        client = distributed.Client(address, timeout=ANSWER_WITHIN_S, set_as_default=False)
    except (OSError, ValueError, TypeError) as fault:
        raise InputError(
            f"--scheduler is {address!r}, where no Dask scheduler answers ({' '.join(str(fault).split())[:120]}); give "
            "the address that it prints, such as tcp://host:8786"
        ) from None
    silence(LOGGERS)
    cluster = DaskCluster(client, distributed, work)
    tell(f"the scheduler at {address} has {cluster.threads()} threads of workers; more may join")
    return cluster


def silence(names: Sequence[str]) -> None:
    """Let the loggers `names` tell nothing, nor any below them: distributed gives these levels of their own."""
    known = tuple(logging.root.manager.loggerDict)
    below = (each for each in known if each.startswith(tuple(f"{name}." for name in names)))
    for each in (*names, *below):
        logging.getLogger(each).setLevel(logging.CRITICAL + 1)
