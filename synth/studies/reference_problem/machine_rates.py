"""What this machine can do at most now: loops over vectors of sixteen float32 that do nothing else."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial

from synth.studies.reference_problem.kernels.roofline import loads, loads_a_turn, multiply_adds
from synth.studies.reference_problem.kernels.vectors import LANES
from synth.studies.reference_problem.scratch import Scratch
from synth.studies.timing.turns import Call

SUMS_A_TURN = 12
WORK = 2_500_000
"""Operations of one loop on one thread: about a millisecond."""

NEAREST_FLOATS = 4096
"""16 KB: less than the first-level cache of any processor that this runs on."""


@dataclass(frozen=True)
class Loop:
    """A call, and how many operations on vectors of sixteen it makes on all its threads."""

    call: Call
    operations: int


def multiply_add_loop(threads: int = 1) -> Loop:
    """Sums of products in registers."""
    turns = WORK // SUMS_A_TURN
    factor, results = Scratch().singles("factor", LANES), results_of(threads)
    factor[:] = 0.5
    calls = [partial(multiply_adds, turns, factor, result) for result in results]
    return Loop(on_threads(calls), SUMS_A_TURN * turns * threads)


def load_loop(floats: int = NEAREST_FLOATS, shift: int = 0, threads: int = 1) -> Loop:
    """Loads from so many floats over and over; each `shift` floats off a cache line."""
    a_turn = int(loads_a_turn(floats, shift))
    turns = max(1, WORK // a_turn)
    data = [Scratch().singles("data", floats) for _ in range(threads)]
    for piece in data:
        piece[:] = 1.0
    calls = [partial(loads, turns, shift, *each) for each in zip(data, results_of(threads), strict=True)]
    return Loop(on_threads(calls), a_turn * turns * threads)


def results_of(threads: int) -> list[object]:
    """A place for what each thread sums up, so that no loop is left out."""
    return [Scratch().singles("result", LANES) for _ in range(threads)]


def on_threads(calls: Sequence[Call]) -> Call:
    """All calls at once, each on a thread of its own; one alone runs on the caller's."""
    if len(calls) == 1:
        return calls[0]
    pool = ThreadPoolExecutor(len(calls))
    return lambda: [each.result() for each in [pool.submit(call) for call in calls]]


def calls_of(loops: Mapping[str, Loop]) -> dict[str, Call]:
    """What `in_turns` takes."""
    return {name: loop.call for name, loop in loops.items()}
