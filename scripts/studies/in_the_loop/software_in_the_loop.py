"""The closed loop with the compiled C controller as a separate process, asked through a pipe at every decision.

If the table has an estimator, the process observes as well, at every sample. A table that decides at any time is asked
at every sample, with the pressure of the gauge if it has slopes.
"""

from __future__ import annotations

import ctypes
import os
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

import numpy as np
from numba import njit

from plant_models import Plant
from scripts.studies.in_the_loop.controller_process import Controller
from scripts.studies.regulated_lane import loop_at_any_time, loop_at_rest
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
from synth.simulation.drive_pieces import empty_periods
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses
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
