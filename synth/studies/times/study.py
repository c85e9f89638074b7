"""How long things take: start-up, the default tune cold and warm, the closed loop and its parts.

What is compared runs in turns. Nothing else should be running.
"""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from synth.kernels.loop import closed_loop as kernel
from synth.simulation.closed_loop import CHUNK_PASSES, close_loop, simulate_many
from synth.simulation.random_passes import random_passes
from synth.studies.options import option
from synth.studies.study import Method, Tell
from synth.studies.times.cases import LoopCase, middle_case
from synth.studies.times.commands import start_calls, tune_calls
from synth.studies.times.findings import Waited, WaitingTimes
from synth.studies.timing.machine import this_machine
from synth.studies.timing.turns import Call, Times, in_turns

SMALL = """\
[targets]
exit_speeds_m_s = [3.0]
[grid]
path_step_m = 1.0
speed_step_m_s = 0.1
[validation]
passes = 1000
[output]
plots = false
report = false
[[cut]]
car = "gondola-4"
mass_t = 52
"""
"""A tune of one table on a coarse grid, to see that the study runs."""


@dataclass(frozen=True)
class Options:
    """How often, how many passes."""

    config: Path | None = option(None, "configuration of the tune; the built-in default book without it")
    rounds: int = option(5, "turns of the tune; of shorter things more", (1, 1000))
    passes: int = option(40_000, "passes of one simulation", (1000, 10**8))
    small_tune: bool = option(False, "tune one table on a coarse grid only, and nothing without compiled kernels")


def run(options: Options, tell: Tell) -> WaitingTimes:
    """Processes first, then the closed loop in this process."""
    machine = this_machine()
    with tempfile.TemporaryDirectory() as name:
        folder, config = Path(name), options.config
        if options.small_tune:
            config = folder / "small.toml"
            config.write_text(SMALL, encoding="utf-8")
        commands = in_turns(start_calls(), 2 * options.rounds)
        calls = tune_calls(folder, config, cold=not options.small_tune)
        calls["tune, warm"]()  # compiles what is not compiled yet
        commands |= in_turns(calls, options.rounds, warm_up=False)
    tell(f"{len(commands)} commands timed")
    case = middle_case()
    simulated = in_turns(simulation_calls(case, options.passes), options.rounds)
    parts = in_turns(part_calls(case), 5 * options.rounds)
    tell("closed loop timed")
    return WaitingTimes(
        machine, case.name, options.passes, CHUNK_PASSES, waited(commands), waited(simulated), waited(parts)
    )


def waited(times: Mapping[str, Times]) -> tuple[Waited, ...]:
    """In their order."""
    return tuple(Waited(name, each) for name, each in times.items())


def simulation_calls(case: LoopCase, passes: int) -> dict[str, Call]:
    """The Monte Carlo as a tune runs it."""
    return {
        f"{threads} thread{'s' if threads > 1 else ''}": partial(
            simulate_many, case.plant, case.controller, seed=1, count=passes, threads=threads
        )
        for threads in (1, 2)
    }


def part_calls(case: LoopCase) -> dict[str, Call]:
    """The parts of one chunk on one thread; one by one is how a trace and an estimator run."""
    loop, law, n = close_loop(case.plant, case.controller.stages), case.controller.rule, CHUNK_PASSES
    cells = len(loop.path.gravity_m_s2)
    passes = random_passes(1, 0, n, cells)
    draws, none = loop.draws(passes), np.empty((0, kernel.EVENT_FIELDS))
    exits = kernel.Exits(np.empty(n), np.empty(n), np.empty(n, dtype=np.bool_), np.empty(n, dtype=np.int32))
    return {
        "random numbers": lambda: random_passes(1, 0, n, cells),
        "what they mean": lambda: loop.draws(passes),
        "passes side by side": lambda: loop.run(case.controller, draws),
        "passes one by one": lambda: kernel.run_passes(loop.path, loop.drive, loop.sensor, law, draws, exits, none),
    }


METHOD = Method(Options, Options(rounds=1, passes=2000, small_tune=True), WaitingTimes, run)
