"""The compiled C controller as a process of its own in the closed loop, asked through a pipe at every decision, against
the same in the simulator.

Every table runs over the same passes twice: with rule and estimator in the simulator, and with each decision asked from
the process. If the table has an estimator, the process observes as well, at every sample. A table that decides at any
time is asked at every sample, with the pressure of the gauge if it has slopes.
"""

from __future__ import annotations

import ctypes
import os
import subprocess
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Final

import numpy as np
from numba import njit

from plant_models import Plant
from scripts.studies.in_the_loop.agreement_study import Tuned, tuned_book
from scripts.studies.in_the_loop.controller_process import BuildError, Controller, build_controller
from scripts.studies.regulated_lane import loop_at_any_time, loop_at_rest
from scripts.studies.study import Findings, MarkdownTable, Method, Tell, option, table
from synth.frame.faults import InputError
from synth.kernels.any_time.any_time_law import AnyTimeLaw
from synth.kernels.loop.passes import Draws
from synth.kernels.loop.regulator import measure
from synth.simulation.closed_loop import (
    ClosedLoop,
    TableController,
    close_loop,
    empty_exits,
    empty_observed,
    empty_trace,
    lane_memory,
    sample_of,
)
from synth.simulation.exit_statistics import exit_statistics
from synth.simulation.passes import ExitSample
from synth.simulation.path_and_drive import empty_periods
from synth.simulation.random_passes import RandomPasses, random_passes
from tuning_tables import ControllerTable

OBSERVE: Final = -1
BEGIN: Final = -2
"""What is asked for, in the place of a stage (controller_process.c)."""


@dataclass(frozen=True)
class Comparison:
    """The same passes with the rule in the simulator and with the controller process.

    `differing`: passes of which exit speed, time, stall or number of switchings differ in any bit.
    """

    inside: ExitSample
    process: ExitSample
    differing: int


def closed_loop_with_process(
    plant: Plant, table: ControllerTable, number: int, controller: Controller, passes: RandomPasses, line: PipeLine
) -> Comparison:
    """Run `passes` of `plant` under `table`, number `number` in the book of `controller`, both ways."""
    loop = close_loop(plant, len(table.stages))
    draws = loop.draws(passes)
    inside = loop.run(TableController(table), draws)
    with line.connected(controller, number):
        process = run_passes(loop, TableController(table), draws, line)
    pairs = [(getattr(inside, name), getattr(process, name)) for name in vars(inside)]
    differs = np.zeros(len(inside), dtype=np.bool_)
    for one, other in pairs:
        differs |= one != other
    return Comparison(inside, process, int(differs.sum()))


def run_passes(loop: ClosedLoop, controller: TableController, draws: Draws, line: PipeLine) -> ExitSample:
    """All passes of `draws`, one after the other, by the kernel that asks through `line`."""
    n, law = len(draws.cut_factor), controller.law()
    exits, trace, work = empty_exits(n), empty_trace(0), lane_memory()
    for i in range(n):
        one, alone = draws.part(i, i + 1), exits.part(i, i + 1)
        if isinstance(law, AnyTimeLaw):
            memory = work, empty_periods(loop.sampled), empty_observed(law.rule, 1)
            line.run_any_time_passes(loop.path, loop.sampled, loop.sensor, law, one, alone, trace, *memory)
        else:
            observed = empty_observed(law, 1)
            line.run_passes(loop.path, loop.pieces, loop.sensor, law, one, alone, trace, work, observed)
    return sample_of(exits, draws)


class PipeLine:
    """The kernels of the closed loop compiled with a decision and an estimator that ask through two file descriptors.

    Compiling one takes some seconds, when it is first needed; after that any controller process can be connected, one
    at a time.
    """

    def __init__(self) -> None:
        self._ask, self._hear = os.open(os.devnull, os.O_RDWR), os.open(os.devnull, os.O_RDWR)
        self._decide, self._observe = _controller_through(self._ask, self._hear)

    @cached_property
    def run_passes(self) -> Any:
        """`kernels.loop.closed_loop.run_passes` for tables that decide at rest, one pass at a time."""
        return loop_at_rest(measure, self._observe, self._decide)

    @cached_property
    def run_any_time_passes(self) -> Any:
        """`kernels.any_time.closed_loop.run_any_time_passes` for tables that decide at any time, likewise."""
        return loop_at_any_time(measure, self._observe, self._decide)

    @contextmanager
    def connected(self, controller: Controller, number: int) -> Iterator[None]:
        """Start the controller for table `number`, and end it afterwards."""
        command = [*controller.command, "serve", str(number)]
        with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, bufsize=0) as process:
            assert process.stdin is not None
            assert process.stdout is not None
            os.dup2(process.stdin.fileno(), self._ask, inheritable=False)
            os.dup2(process.stdout.fileno(), self._hear, inheritable=False)
            try:
                yield
            finally:
                for descriptor in (self._ask, self._hear):
                    closed = os.open(os.devnull, os.O_RDWR)
                    os.dup2(closed, descriptor)
                    os.close(closed)
                process.stdin.close()
        if process.returncode != 0:
            raise RuntimeError(f"{' '.join(command)} ended with exit code {process.returncode}")


def _controller_through(ask: int, hear: int) -> tuple[Any, Any]:
    """A decision and an estimator that write a request to `ask` and read its answer at `hear`."""
    library = ctypes.CDLL(None)
    write, read = library.write, library.read
    for call in (write, read):
        call.argtypes = [ctypes.c_int, ctypes.c_void_p, ctypes.c_size_t]
        call.restype = ctypes.c_ssize_t

    # Compiled here and now, as what calls it is compiled for making no array.
    @njit("int32(int64, float64, float64, float64)")
    def answered(what, s, v, kpa):  # type: ignore[no-untyped-def]  # as the line above tells
        request = np.empty(4, np.int32)
        reading = request.view(np.float32)
        request[0], reading[1], reading[2], reading[3] = what, s, v, kpa
        answer = np.empty(1, np.int32)
        # Writes and reads of sixteen and four bytes are never split in a pipe.
        if write(ask, request.ctypes.data, 16) != 16 or read(hear, answer.ctypes.data, 4) != 4:
            raise RuntimeError("the controller process does not answer")
        return answer[0]

    @njit
    def decide(table, stage, s, v, kpa):  # type: ignore[no-untyped-def]  # as above
        return answered(stage, s, v, kpa)

    @njit
    def observe(table, state, s, v, kpa):  # type: ignore[no-untyped-def]  # as above
        # The process has the state; what the kernel holds only tells whether a pass begins.
        what = OBSERVE if state[0] != 0.0 else BEGIN
        state[0] = 1.0
        return np.int32(answered(what, s, v, kpa)).view(np.float32)

    return decide, observe


@dataclass(frozen=True)
class Options:
    """How many passes, and how it is compiled."""

    config: Path | None = option(None, "configuration; the built-in default book without it")
    masses_t: tuple[float, ...] = option((), "only cuts of these masses, t")
    passes: int = option(500, "passes of each table", (1, 10**6))
    seed: int = option(1, "of the passes", (0, 2**31))
    compiler: str = option("gcc", "compiler")
    level: str = option("-O2", "its level of optimisation")


@dataclass(frozen=True)
class Row:
    """One table; `differing`: passes of which exit speed, time, stall or number of switchings differ in any bit."""

    id: str
    estimator: bool
    passes: int
    differing: int
    rms_m_s: float


@dataclass(frozen=True)
class InTheLoop(Findings):
    """All tables, without estimators and with them."""

    config_sha256: tuple[str, str]
    seed: int
    compiled_by: str
    rows: tuple[Row, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`passes`: a row a table."""
        heads = ("table", "estimator", "passes", "differ", "rms, m/s")
        rows = [
            (row.id, "yes" if row.estimator else "no", str(row.passes), str(row.differing), f"{row.rms_m_s:.4f}")
            for row in self.rows
        ]
        return {"passes": table("Passes by a process of its own", heads, rows)}

    def sentences(self) -> tuple[str, ...]:
        """All passes together."""
        return (
            f"{self.differing} of {sum(row.passes for row in self.rows)} passes differ ({self.compiled_by}), "
            f"seed {self.seed}",
        )

    @property
    def differing(self) -> int:
        """Passes that differ, of all tables."""
        return sum(row.differing for row in self.rows)

    def faults(self) -> tuple[str, ...]:
        """No pass may differ."""
        return (f"{self.differing} passes differ",) if self.differing else ()


def run(options: Options, tell: Tell) -> InTheLoop:
    """Tune both books, compile, run."""
    books = [tuned_book(options.config, estimator, options.masses_t, tell) for estimator in (False, True)]
    line = PipeLine()
    rows = [row for tuned in books for row in rows_of(tuned, options, line)]
    tell(f"{len(rows)} tables run")
    return InTheLoop(
        config_sha256=(books[0].config_sha256, books[1].config_sha256),
        seed=options.seed,
        compiled_by=f"{options.compiler} {options.level}",
        rows=tuple(rows),
    )


def rows_of(tuned: Tuned, options: Options, line: PipeLine) -> Iterator[Row]:
    """Every table of a book. Raises `InputError` where the compiler is not there."""
    passes = random_passes(options.seed, 0, options.passes)
    with tempfile.TemporaryDirectory() as directory:
        try:
            controller = build_controller(tuned.book, Path(directory), options.compiler, (options.level,))
        except (BuildError, FileNotFoundError) as fault:
            raise InputError(f"study: {options.compiler} {options.level} makes no controller: {fault}") from None
        for number, (each, plant) in enumerate(zip(tuned.book.tables, tuned.plants, strict=True)):
            found = closed_loop_with_process(plant, each, number, controller, passes, line)
            rms = exit_statistics(found.process, each.target_speed_m_s).rms_m_s
            yield Row(each.id, each.estimator is not None, len(passes), found.differing, rms)


METHOD = Method(Options, Options(masses_t=(52.0,), passes=120), InTheLoop, run)
