"""Kernels, threads and processes of a command, and the code with which it ends.

Decorators of kernels: what Python may call, and what only kernels may.
Commands find out on every system how many threads to take, and what the processor is.
The last bit of a table does not depend on how many threads BLAS has, nor on the kernel that it takes.
A second process compiles beside a first run, and ends with it.
The two-level queue: order of results, tasks before starts, failure.
The exit code of every fault, and one sentence for each.
"""

from __future__ import annotations

import errno
import os
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from threadpoolctl import threadpool_info, threadpool_limits

from plant_models import PlantError
from synth.cli import commands, main, told
from synth.frame.faults import MACHINE_FAULTS, InputError
from synth.frame.machine import available, processor_name
from synth.frame.terminal import standard_streams
from synth.frame.terminal.telling import (
    DAMAGED,
    INPUT_FAULT,
    INTERRUPTED,
    LIMITS_MISSED,
    MACHINE_FAULT,
    OK,
    PIPE_CLOSED,
    UNFORESEEN,
)
from synth.kernels.compiling import borrowing, part, part_inline
from synth.retarder import first_run
from synth.retarder.first_run import compiled_beside
from synth.retarder.tune import run_nested
from synth.solver.descent import one_blas_thread
from tuning_tables import OtherKind, TableError
from tuning_tables.errors import InvalidLog


@part
def doubled(x):  # type: ignore[no-untyped-def]
    return 2.0 * x


@part_inline
def raised(x):  # type: ignore[no-untyped-def]
    return x + 1.0


@borrowing
def whole(x):  # type: ignore[no-untyped-def]
    return raised(doubled(x))


def test_parts_are_called_by_kernels_and_refused_to_python() -> None:
    """Before and after they were compiled: a call of what numba did not make would end the process."""
    for compiled in (False, True):
        for each in (doubled, raised):
            with pytest.raises(TypeError, match=rf"{each.__name__} is a part of kernels"):
                each(1.5)
        if not compiled:
            assert whole(1.5) == 4.0
    assert raised.py_func(doubled.py_func(1.5)) == 4.0


def test_as_many_as_this_process_may_use(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "sched_getaffinity", lambda process: {0, 3, 5}, raising=False)
    assert available() == 3


def test_all_where_the_system_does_not_tell(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(os, "sched_getaffinity", raising=False)
    monkeypatch.setattr(os, "cpu_count", lambda: 8)
    assert available() == 8
    monkeypatch.setattr(os, "cpu_count", lambda: None)
    assert available() == 1


def test_the_processor_names_itself(tmp_path: Path) -> None:
    told = tmp_path / "cpuinfo"
    told.write_text("processor : 0\nmodel name\t: A Processor of 3 GHz\n", encoding="utf-8")
    assert processor_name(told) == "A Processor of 3 GHz"
    assert processor_name(tmp_path / "none")


NOISE = """
import importlib.util, sys
from synth.solver.chain.chain import persistent_chain
spec = importlib.util.spec_from_file_location("plants", sys.argv[1])
plants = importlib.util.module_from_spec(spec)
spec.loader.exec_module(plants)
noise = persistent_chain(plants.random_plant(), plants.COARSE).transient_noise
print(noise.probability.tobytes().hex(), noise.mean.tobytes().hex(), noise.std.tobytes().hex())
"""
PLANTS = Path(__file__).parents[1] / "properties" / "conftest.py"


def printed(program: str, **environment: str) -> str:
    """What `program` prints of the random plants."""
    return subprocess.run(
        [sys.executable, "-c", program, str(PLANTS)],
        env={**os.environ, **environment}, check=True, capture_output=True, text=True,
    ).stdout  # fmt: skip


def threads() -> set[int]:
    """What the BLAS libraries of this process would use now."""
    return {library["num_threads"] for library in threadpool_info() if library["user_api"] == "blas"}


def test_every_library_has_one_until_the_first_has_left() -> None:
    np.linalg.inv(np.eye(2))  # whatever BLAS numpy has is there
    with threadpool_limits(2, user_api="blas"):
        assert 1 not in threads()
        seen = []

        def enter_and_leave() -> None:
            with one_blas_thread():
                seen.append(threads())

        with one_blas_thread():
            assert threads() == {1}
            enter_and_leave()
            others = [threading.Thread(target=enter_and_leave) for _ in range(4)]
            for other in others:
                other.start()
            for other in others:
                other.join()
            assert threads() == {1}
        assert seen == [{1}] * 5
        assert 1 not in threads()


def test_what_was_is_restored_after_a_fault() -> None:
    before = threads()
    with pytest.raises(ZeroDivisionError), one_blas_thread():
        raise ZeroDivisionError
    assert threads() == before


def test_the_noise_of_the_prediction_is_the_same_to_the_bit_by_every_kernel_of_blas() -> None:
    # The oldest kernels, which do not fuse multiplication and addition, and those of this processor.
    own = printed(NOISE, OPENBLAS_CORETYPE="")
    assert len(own) > 100
    assert printed(NOISE, OPENBLAS_CORETYPE="Nehalem") == own


WAITS_FOR_EVER = (sys.executable, "-c", "import time; time.sleep(600)")
FAILS = (sys.executable, "-c", "raise SystemExit(1)")
SUCCEEDS = (sys.executable, "-c", "pass")


def ran(command: tuple[str, ...], seconds: float) -> list[str]:
    """What is told where the block takes so many seconds."""
    told: list[str] = []
    with compiled_beside(told.append, command):
        time.sleep(seconds)
    return told


def test_where_kernels_are_kept_nothing_is_begun(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(first_run, "first_time", lambda: False)
    assert ran(("no such program",), 0.0) == []


def test_it_tells_when_the_second_process_has_done_its_work(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(first_run, "first_time", lambda: True)
    begun, done = ran(SUCCEEDS, 2.0)
    assert "in two processes" in begun
    assert "beside the others" in done


@pytest.mark.parametrize("command", [WAITS_FOR_EVER, FAILS])
def test_one_that_is_not_done_is_ended_and_tells_nothing(
    monkeypatch: pytest.MonkeyPatch, command: tuple[str, ...]
) -> None:
    monkeypatch.setattr(first_run, "first_time", lambda: True)
    began = time.monotonic()
    assert len(ran(command, 0.3)) == 1
    assert time.monotonic() - began < 10.0


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


FAULTS = (
    *((fault("x"), INPUT_FAULT) for fault in (InputError, PlantError, InvalidLog, OtherKind)),
    *((fault("x"), DAMAGED) for fault in TableError.__subclasses__() if fault is not OtherKind),
    *((OSError(number, "x"), MACHINE_FAULT) for number in MACHINE_FAULTS),
    (OSError(errno.ENOENT, "x", "file"), INPUT_FAULT),
    (OSError("of a library"), UNFORESEEN),
    (MemoryError(), MACHINE_FAULT),
    (ValueError("x"), UNFORESEEN),
    (ZeroDivisionError("x"), UNFORESEEN),
)


@pytest.mark.requirement("CMD-01")
@pytest.mark.parametrize(("fault", "code"), FAULTS, ids=lambda each: repr(each))
def test_a_fault_has_its_code_and_is_one_line(
    fault: BaseException, code: int, capsys: pytest.CaptureFixture[str]
) -> None:
    def call() -> int:
        raise fault

    assert told(call) == code
    printed = capsys.readouterr()
    assert (printed.out, printed.err.count("\n")) == ("", 1)


@pytest.mark.requirement("CMD-01")
def test_codes_are_those_that_the_documents_tell() -> None:
    codes = (OK, LIMITS_MISSED, INPUT_FAULT, DAMAGED, UNFORESEEN, MACHINE_FAULT, INTERRUPTED, PIPE_CLOSED)
    assert codes == (0, 1, 2, 3, 70, 74, 130, 141)


@pytest.mark.parametrize("code", [OK, LIMITS_MISSED, INPUT_FAULT, DAMAGED, UNFORESEEN, INTERRUPTED])
def test_only_a_whole_result_has_a_code_of_its_own_where_nobody_reads_the_progress(
    code: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    @contextmanager
    def left() -> Iterator[SimpleNamespace]:
        yield SimpleNamespace(reader_left=True)

    monkeypatch.setattr(standard_streams, "standard_streams", left)
    monkeypatch.setattr(commands, "run", lambda _: code)
    assert main([]) == (PIPE_CLOSED if code in (OK, LIMITS_MISSED) else code)
