"""Charts drawn by several processes: drawing is Python through and through, threads would not help.

The processes start with the command, and draw a chart as soon as its figures are there, at low priority: what is left
to draw at the end is little.
"""

from __future__ import annotations

import contextlib
import gc
import multiprocessing
import os
import threading
from concurrent.futures import Future, ThreadPoolExecutor
from multiprocessing.connection import Connection
from queue import SimpleQueue
from types import TracebackType
from typing import Final

from synth.frame.exhibits import Chart
from synth.frame.terminal.interrupt import interrupts_ignored

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
        self._free: SimpleQueue[Connection] = SimpleQueue()
        if processes > 1:
            with interrupts_ignored():  # Ctrl-C is for the process that was started by hand
                for _ in range(processes):
                    self._free.put(drawing_process())

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
        """The pipe of this thread's process."""
        if not hasattr(self._mine, "pipe"):
            self._mine.pipe = self._free.get()
        pipe: Connection = self._mine.pipe
        return pipe


def drawing_process() -> Connection:
    """A new drawing process; our end of its pipe. Started anew, never forked: a fork would copy numba's threads."""
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe()
    context.Process(target=draw_charts, args=(theirs,), daemon=True).start()
    theirs.close()
    return ours


def draw_chart(chart: Chart) -> bytes:
    """The drawing of one chart."""
    from synth.frame.picture.house_style import draw  # matplotlib only where it is needed

    return draw(chart.draw())


def draw_charts(pipe: Connection) -> None:
    """What a drawing process does: answer each chart with its drawing or with what went wrong, until the pipe ends."""
    with contextlib.suppress(OSError, AttributeError):  # Windows has no such number
        os.nice(NICENESS)
    import synth.frame.picture.house_style  # noqa: F401  # matplotlib, while there is nothing to draw yet

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
