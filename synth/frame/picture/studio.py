"""Charts drawn by several processes: drawing is Python through and through, threads would not help.

The processes start with the command, and draw a chart as soon as its figures are there, at low priority: what is left
to draw at the end is little.
"""

from __future__ import annotations

import contextlib
import gc
import multiprocessing
import os
import signal
import threading
from concurrent.futures import Future, ThreadPoolExecutor
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection
from types import TracebackType
from typing import Final

from synth.frame.exhibits import Chart

NICENESS: Final = 5
"""Drawing gives way to computing."""


class Studio:
    """Drawing processes for the charts of one run; with less than two they are drawn in this process.

    What several processes draw is pickled. Not `concurrent.futures` alone: its processes wait for ever if this one is
    killed; ours end when their pipe does. Drawings do not depend on the number of processes, nor on when they are made.
    """

    def __init__(self, processes: int) -> None:
        self._processes = processes
        self._mine = threading.local()
        self._pool = ThreadPoolExecutor(max(processes, 1))
        self._begun: dict[str, Future[bytes]] = {}
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

    def begin(self, chart: Chart) -> None:
        """Start to draw `chart`, which will be shown under its name, if there are processes for it."""
        if self._processes > 1:
            self._begun[chart.name] = self._pool.submit(self._order, chart)

    def drawing(self, chart: Chart) -> Future[bytes]:
        """The drawing of `chart`, to come."""
        begun = self._begun.pop(chart.name, None)
        return begun or self._pool.submit(draw_chart if self._processes < 2 else self._order, chart)

    def _order(self, chart: Chart) -> bytes:
        """Have this thread's process draw `chart`; if that process is dead, somebody has to."""
        try:
            pipe = self._pipe()
            pipe.send(chart)
            answer = pipe.recv()
        except (EOFError, OSError):
            return draw_chart(chart)
        if isinstance(answer, Exception):
            raise answer
        drawing: bytes = answer
        return drawing

    def _pipe(self) -> Connection:
        if not hasattr(self._mine, "pipe"):
            # What is started here inherits it, from its first moment on: Ctrl-C is for the command.
            resource_tracker.ensure_running()  # its start would undo it
            signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
            # A fork of this process would copy numba's threads and BLAS's; the server's has none, and has loaded
            # matplotlib once for all.
            context = multiprocessing.get_context("forkserver")
            context.set_forkserver_preload(["synth.frame.picture.house_style"])
            self._mine.pipe, theirs = context.Pipe()
            context.Process(target=draw_charts, args=(theirs,), daemon=True).start()
            theirs.close()
        pipe: Connection = self._mine.pipe
        return pipe


def draw_chart(chart: Chart) -> bytes:
    """The drawing of one chart."""
    from synth.frame.picture.figure_file import draw  # matplotlib only where it is needed

    return draw(chart.draw())


def draw_charts(pipe: Connection) -> None:
    """What a drawing process does: answer each chart with its drawing or with what went wrong, until the pipe ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the process that was started by hand
    with contextlib.suppress(OSError):
        os.nice(NICENESS)
    gc.disable()  # figures are trees of small objects, and this process ends before their cycles would matter
    while True:
        try:
            chart = pipe.recv()
        except EOFError:
            return
        try:
            answer: object = draw_chart(chart)
        except Exception as fault:
            answer = fault
        try:
            pipe.send(answer)
        except BrokenPipeError:
            return
