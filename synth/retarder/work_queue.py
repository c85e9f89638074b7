"""Two-level work on a few threads: a start prepares something large, the tasks that it returns use it."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from threading import Condition
from typing import Generic, TypeVar

Result = TypeVar("Result")
Start = Callable[[], Sequence[Callable[[], Result]]]


def run_nested(starts: Sequence[Start[Result]], workers: int) -> list[list[Result]]:
    """Results of all tasks, by start and in the order in which the start returned them.

    Tasks go before further starts, so that at most about `workers` preparations are in memory; idle threads
    take tasks of any start, so that the last ones end together. The first exception ends the queue and is
    raised.
    """
    queue = NestedQueue(starts)
    with ThreadPoolExecutor(max_workers=workers) as pool:
        for turn in [pool.submit(queue.work) for _ in range(workers)]:
            turn.result()
    return queue.results


class NestedQueue(Generic[Result]):
    """State shared by the threads of `run_nested`."""

    def __init__(self, starts: Sequence[Start[Result]]) -> None:
        self.results: list[list[Result]] = [[] for _ in starts]
        self._starts = deque(enumerate(starts))
        self._tasks: deque[tuple[int, int, Callable[[], Result]]] = deque()
        self._starting = 0
        self._failed = False
        self._changed = Condition()

    def work(self) -> None:
        """Take tasks, else starts, until there are none and no start is under way."""
        while (action := self._next()) is not None:
            try:
                action()
            except BaseException:
                with self._changed:
                    self._failed = True
                    self._changed.notify_all()
                raise

    def _next(self) -> Callable[[], None] | None:
        with self._changed:
            while not self._failed:
                if self._tasks:
                    index, place, task = self._tasks.popleft()
                    return lambda: self._run(index, place, task)
                if self._starts:
                    first, start = self._starts.popleft()
                    self._starting += 1
                    return lambda: self._begin(first, start)
                if self._starting == 0:
                    return None
                self._changed.wait()
            return None

    def _begin(self, index: int, start: Start[Result]) -> None:
        tasks = list(start())
        with self._changed:
            self.results[index] = [None] * len(tasks)  # type: ignore[list-item]  # each is set by its task
            self._tasks.extend((index, place, task) for place, task in enumerate(tasks))
            self._starting -= 1
            self._changed.notify_all()

    def _run(self, index: int, place: int, task: Callable[[], Result]) -> None:
        result = task()
        with self._changed:
            self.results[index][place] = result
