"""All pictures of a book, drawn by several processes: drawing is Python through and through, threads would not help."""

from __future__ import annotations

import multiprocessing
import signal
import threading
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from multiprocessing.connection import Connection
from typing import TypeVar

from synth.case_result import CaseResult, DegreeStudy
from synth.plots.case_names import by_class
from synth.plots.picture import Picture

Job = tuple[str, tuple[object, ...]]
"""Name of a function of `synth.plots.picture_book`, and its arguments."""

FEWEST_JOBS_A_PROCESS = 4
"""A process takes over half a second to start, as long as drawing two jobs."""

_Answer = TypeVar("_Answer")


def draw_pictures(
    cases: Sequence[CaseResult], studies: Sequence[DegreeStudy], limit_m_s: float, workers: int
) -> tuple[Picture, ...]:
    """The pictures in the order of `all_pictures`; they do not depend on the number of `workers` (processes)."""
    jobs: list[Job] = [("book_pictures", (tuple(cases), tuple(studies), limit_m_s))]
    jobs += [("class_pictures", (group,)) for group in by_class(cases)]
    jobs += [("case_pictures", (case,)) for case in cases]
    workers = min(workers, len(jobs) // FEWEST_JOBS_A_PROCESS)
    drawn = [draw_job(job) for job in jobs] if workers < 2 else draw_in_processes(jobs, workers)
    return tuple(picture for pictures in drawn for picture in pictures)


def draw_job(job: Job) -> tuple[Picture, ...]:
    """The pictures of one job."""
    from synth.plots import picture_book  # matplotlib only where it is needed

    name, arguments = job
    return tuple(getattr(picture_book, name)(*arguments))


def draw_in_processes(jobs: Sequence[Job], workers: int) -> list[tuple[Picture, ...]]:
    """The same by `workers` processes, each given its next job when it has done one.

    Not by `concurrent.futures`: its processes wait for ever if this one is killed; ours end when their pipe does.
    """
    todo, lock = iter(range(len(jobs))), threading.Lock()
    drawn: dict[int, tuple[Picture, ...]] = {}

    def serve() -> None:
        context = multiprocessing.get_context("spawn")  # a fork would copy numba's threads and BLAS's
        ours, theirs = context.Pipe()
        process = context.Process(target=draw_jobs, args=(theirs,), daemon=True)
        process.start()
        theirs.close()
        with ours:
            while (place := locked(lock, lambda: next(todo, None))) is not None:
                try:
                    ours.send(jobs[place])
                    answer = ours.recv()
                except (EOFError, BrokenPipeError):  # that process is dead: somebody has to draw
                    answer = draw_job(jobs[place])
                if isinstance(answer, Exception):
                    raise answer
                drawn[place] = answer
        process.join()

    with ThreadPoolExecutor(workers) as pool:
        for done in [pool.submit(serve) for _ in range(workers)]:
            done.result()
    return [drawn[place] for place in range(len(jobs))]


def locked(lock: threading.Lock, call: Callable[[], _Answer]) -> _Answer:
    """`call()` while `lock` is held."""
    with lock:
        return call()


def draw_jobs(pipe: Connection) -> None:
    """What a drawing process does: answer each job with its pictures or with what went wrong, until the pipe ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the process that was started by hand
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
