"""Processes on this machine, each with one order at a time.

Processes and not threads: a kernel that crashes, or the system that kills for want of memory, ends one worker and not
the sweep; what a unit leaves in memory ends with its worker; and Python between the kernels runs on every core.
Not `concurrent.futures`: there one dead process loses all that is under way. Started anew, never forked: a fork would
copy numba's threads.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import threading
from collections import deque
from collections.abc import Generator, Sequence
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from multiprocessing.context import SpawnProcess
from typing import Any

from synth.frame.terminal.interrupt import interrupts_ignored
from synth.frame.workers.engine import Answer, Begun, Order, Work

TRIES = 2
"""How often a unit is given to a worker before the death of its worker counts as its fault."""


@dataclass
class Worker:
    """A process, our end of its pipe, and the order it is at."""

    process: SpawnProcess
    pipe: Connection
    order: Order | None = None


@dataclass(frozen=True)
class LocalWorkers:
    """`count` worker processes. Results do not depend on how many."""

    count: int
    work: Work

    def answers(self, orders: Sequence[Order], begun: Begun) -> Generator[Answer]:
        """As they are ready. A unit whose worker dies is given to another one once, then answered with the reason."""
        waiting = deque(orders)
        tries = dict.fromkeys((order.key for order in orders), 0)
        workers = [start(self.work) for _ in range(min(self.count, len(orders)))]
        try:
            while True:
                for worker in workers:
                    if worker.order is None and waiting:
                        hand_out(worker, waiting.popleft(), tries, begun)
                busy = [worker for worker in workers if worker.order is not None]
                if not busy:
                    return
                for worker in ready(busy):
                    order, worker.order = worker.order, None
                    assert order is not None
                    found = received(worker)
                    if found is None:
                        workers[workers.index(worker)] = start(self.work)
                        if tries[order.key] < TRIES:
                            waiting.append(order)
                            continue
                        found = Answer(order.key, None, death_of(worker.process))
                    yield found
        finally:
            for worker in workers:
                worker.process.kill()
                worker.process.join()
                worker.pipe.close()


def start(work: Work) -> Worker:
    """A new worker process; the environment tells it where this process keeps its kernels."""
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe()
    process = context.Process(target=serve, args=(theirs, work), daemon=True)
    with interrupts_ignored():  # Ctrl-C is for the process that was started by hand, from the child's first moment
        process.start()
    theirs.close()
    return Worker(process, ours)


def hand_out(worker: Worker, order: Order, tries: dict[str, int], begun: Begun) -> None:
    """Give an order to a worker; if it has just died, that is found when its answer is looked for."""
    tries[order.key] += 1
    worker.order = order
    begun(order)
    with contextlib.suppress(OSError):
        worker.pipe.send(order)


def ready(workers: Sequence[Worker]) -> list[Worker]:
    """The workers that have answered or died; waits for the first."""
    signs: list[Any] = [sign for worker in workers for sign in (worker.pipe, worker.process.sentinel)]
    found = wait(signs)
    return [worker for worker in workers if worker.pipe in found or worker.process.sentinel in found]


def received(worker: Worker) -> Answer | None:
    """What the worker has answered; None if it has died instead."""
    try:
        if worker.pipe.poll():
            found: Answer = worker.pipe.recv()
            return found
    except (EOFError, OSError):
        pass
    worker.process.kill()
    worker.process.join()
    return None


def death_of(process: SpawnProcess) -> str:
    """How a worker ended, in words."""
    code = process.exitcode or 0
    if code >= 0:
        return f"its worker ended with code {code}, {TRIES} times in {TRIES}"
    name = signal.Signals(-code).name
    hint = "; the system does that where memory is short: take fewer --workers" if name == "SIGKILL" else ""
    return f"its worker was ended by {name}, {TRIES} times in {TRIES}{hint}"


def serve(pipe: Connection, work: Work) -> None:
    """What a worker process does: answer each order, until the pipe ends or the process that started it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=end_with_parent, daemon=True).start()
    while True:
        try:
            order = pipe.recv()
        except EOFError:
            return
        found = work(order)
        try:
            pipe.send(found)
        except BrokenPipeError:
            return


def end_with_parent() -> None:
    """End this process when its parent has ended, even in the middle of a kernel: kernels release the interpreter."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)
