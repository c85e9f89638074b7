"""All pictures of a book, drawn by several processes: drawing is Python through and through, threads would not help.

The processes start with the tune, while the compiled kernels are still being loaded, and draw a case as soon as
it is computed, at low priority: what is left to draw at the end is little.
"""

from __future__ import annotations

import contextlib
import gc
import multiprocessing
import os
import signal
import threading
from collections.abc import Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection
from types import TracebackType

from synth.book.case_names import by_class
from synth.book.case_result import CaseResult
from synth.frame.picture.picture import Picture

Job = tuple[str, tuple[object, ...]]
"""Name of a function of `synth.present.plots.picture_book`, and its arguments."""

Drawn = Future[tuple[Picture, ...]]

NICENESS = 5
"""Drawing gives way to computing."""


class Studio:
    """Drawing processes for the pictures of one book; with less than two they are drawn in this process.

    Not `concurrent.futures` alone: its processes wait for ever if this one is killed; ours end when their pipe
    does. Pictures do not depend on the number of processes, nor on when they are drawn.
    """

    def __init__(self, processes: int) -> None:
        self._processes = processes
        self._mine = threading.local()
        self._pool = ThreadPoolExecutor(max(processes, 1))
        self._cases: dict[tuple[str, float], Drawn] = {}
        if processes > 1:
            together = threading.Barrier(processes)
            for _ in range(processes):  # the barrier gives every thread one of them, so that all processes start now
                self._pool.submit(lambda: (together.wait(), self._pipe()))

    def __enter__(self) -> Studio:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._pool.shutdown(cancel_futures=True)

    def draw(self, job: Job) -> Drawn:
        """The pictures of `job`, to come."""
        return self._pool.submit(draw_job if self._processes < 2 else self._order, job)

    def case_done(self, case: CaseResult) -> None:
        """Start on the pictures of a single case."""
        if self._processes > 1:
            self._cases[case.label, case.target_speed_m_s] = self.draw(("case_pictures", (case,)))

    def book(self, cases: Sequence[CaseResult], limit_m_s: float) -> tuple[Picture, ...]:
        """All pictures in the order of the report: of the book, of each class, of each case."""
        drawn = [self.draw(("book_pictures", (tuple(cases), limit_m_s)))]
        drawn += [self.draw(("class_pictures", (group,))) for group in by_class(cases)]
        for case in cases:
            begun = self._cases.pop((case.label, case.target_speed_m_s), None)
            drawn.append(self.draw(("case_pictures", (case,))) if begun is None else begun)
        return tuple(picture for pictures in drawn for picture in pictures.result())

    def _order(self, job: Job) -> tuple[Picture, ...]:
        """Have this thread's process do `job`; if that process is dead, somebody has to."""
        try:
            pipe = self._pipe()
            pipe.send(job)
            answer = pipe.recv()
        except (EOFError, OSError):
            return draw_job(job)
        if isinstance(answer, Exception):
            raise answer
        pictures: tuple[Picture, ...] = answer
        return pictures

    def _pipe(self) -> Connection:
        if not hasattr(self._mine, "pipe"):
            # What is started here inherits it, from its first moment on: Ctrl-C is for the tune.
            resource_tracker.ensure_running()  # its start would undo it
            signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
            # A fork of this process would copy numba's threads and BLAS's; the server's has none, and has loaded
            # matplotlib once for all.
            context = multiprocessing.get_context("forkserver")
            context.set_forkserver_preload(["synth.present.plots.picture_book"])
            self._mine.pipe, theirs = context.Pipe()
            context.Process(target=draw_jobs, args=(theirs,), daemon=True).start()
            theirs.close()
        pipe: Connection = self._mine.pipe
        return pipe


def draw_job(job: Job) -> tuple[Picture, ...]:
    """The pictures of one job."""
    from synth.present.plots import picture_book  # matplotlib only where it is needed

    name, arguments = job
    return tuple(getattr(picture_book, name)(*arguments))


def draw_jobs(pipe: Connection) -> None:
    """What a drawing process does: answer each job with its pictures or with what went wrong, until the pipe ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the process that was started by hand
    with contextlib.suppress(OSError):
        os.nice(NICENESS)
    gc.disable()  # figures are trees of small objects, and this process ends before their cycles would matter
    while True:
        try:
            job = pipe.recv()
        except EOFError:
            return
        try:
            answer: object = draw_job(job)
        except Exception as fault:
            answer = fault
        try:
            pipe.send(answer)
        except BrokenPipeError:
            return
