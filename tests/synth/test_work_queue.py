"""The two-level queue: order of results, tasks before starts, failure."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

import pytest

from synth.retarder.work_queue import run_nested


@pytest.mark.parametrize("workers", [1, 2, 5])
def test_results_keep_the_order_of_starts_and_tasks(workers: int) -> None:
    def start(i: int) -> Callable[[], list[Callable[[], tuple[int, int]]]]:
        def task(j: int) -> tuple[int, int]:
            time.sleep(0.002 * ((i + j) % 3))
            return i, j

        return lambda: [lambda j=j: task(j) for j in range(i)]  # type: ignore[misc]

    found = run_nested([start(i) for i in range(5)], workers)
    assert found == [[(i, j) for j in range(i)] for i in range(5)]


def test_tasks_go_before_further_starts() -> None:
    """With one worker at most one preparation is alive at a time."""
    log: list[str] = []

    def start(name: str) -> Callable[[], list[Callable[[], None]]]:
        def begin() -> list[Callable[[], None]]:
            log.append(f"start {name}")
            return [lambda: log.append(f"task {name}")] * 2

        return begin

    run_nested([start("a"), start("b")], workers=1)
    assert log == ["start a", "task a", "task a", "start b", "task b", "task b"]


def test_an_idle_worker_takes_tasks_of_another_start() -> None:
    seen: set[int] = set()
    both = threading.Barrier(2, timeout=10.0)

    def task() -> None:
        seen.add(threading.get_ident())
        both.wait()

    run_nested([lambda: [task, task]], workers=2)
    assert len(seen) == 2


def test_the_first_failure_is_raised_and_ends_the_queue() -> None:
    done: list[int] = []

    def bad() -> None:
        raise ArithmeticError("no")

    with pytest.raises(ArithmeticError, match="no"):
        run_nested([lambda: [bad], lambda: [lambda: done.append(1)]], workers=1)
    assert done == []
