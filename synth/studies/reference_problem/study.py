"""How fast a neutral problem is solved by kernels of its own, beside other software and the machine's limit.

Every solve is whole: from the parameters to the value at entry and the best command of every state and stage. All ways
run in turns and are compared round by round; numpy and plain loops only in the first rounds. QuantEcon takes part
where it can be imported (the extra `benchmark`).
"""

from __future__ import annotations

from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import partial
from importlib.metadata import version
from typing import TYPE_CHECKING

import numpy as np

from synth.studies.options import option
from synth.studies.reference_problem.by_numpy import largest_regret
from synth.studies.reference_problem.by_scipy import solve_targets_by_scipy
from synth.studies.reference_problem.findings import Agreement, Comparison, Limit, Row
from synth.studies.reference_problem.fresh_process import fresh_process
from synth.studies.reference_problem.machine_rates import calls_of, load_loop, multiply_add_loop
from synth.studies.reference_problem.operator_work import OperatorWork, operator_work
from synth.studies.reference_problem.problem import ReferenceProblem, batch_of_16
from synth.studies.reference_problem.solver import ReferenceSolver
from synth.studies.reference_problem.solvers import (
    NUMPY,
    QUANTECON,
    SCIPY,
    SLOW,
    kernels,
    peers,
    solver_named,
)
from synth.studies.study import Method, Tell
from synth.studies.timing.machine import this_machine
from synth.studies.timing.turns import Call, Times, in_turns

if TYPE_CHECKING:
    from synth.studies.reference_problem.solvers import Solve, Solved

SHIFT = 5
"""Floats off a cache line, for loads that straddle two."""

LIMIT_ROUNDS = 25


@dataclass(frozen=True)
class Options:
    """How often."""

    rounds: int = option(15, "turns", (1, 1000))
    slow_rounds: int = option(2, "turns of numpy and of plain loops", (1, 1000))
    threads: int = option(2, "threads of the batch and of the limit", (1, 64))
    stages: int = option(120, "path steps; 120 in the published problem", (2, 1000))


def run(options: Options, tell: Tell) -> Comparison:
    """Agreement first, then times, then processes of their own."""
    machine, problem = this_machine(), ReferenceProblem(stages=options.stages)
    many = sorted({1, 2, 4, options.threads})
    solves = {kernels(n): solver_named(kernels(n), n) for n in many} | {n: solver_named(n, 1) for n in peers()}
    agreement = agreement_of(problem, {name: solve(problem) for name, solve in solves.items()}, many)
    tell(f"{len(solves)} ways solved the problem")
    single, build = solved_in_turns(problem, solves, options)
    tell(f"{options.rounds} rounds timed")
    batch = in_turns(batch_calls(options, solves), max(2, options.rounds // 4))
    work = operator_work(problem)
    limits = tuple(limit_of(problem, work, threads) for threads in sorted({1, options.threads}))
    tell("batch and limit timed")
    fresh = (kernels(options.threads), *(name for name in solves if not name.startswith("kernels")))
    return Comparison(
        machine=machine,
        scipy=version("scipy"),
        quantecon=version("quantecon") if QUANTECON in solves else None,
        transitions=problem.transitions,
        agreement=agreement,
        base=SCIPY,
        single=rows_of(single),
        build=rows_of(build),
        batch=rows_of(batch),
        work=work,
        limits=limits,
        fresh=tuple(fresh_process(name, options.threads, options.stages) for name in fresh),
    )


def rows_of(times: Mapping[str, Times]) -> tuple[Row, ...]:
    """In their order."""
    return tuple(Row(name, each) for name, each in times.items())


def agreement_of(problem: ReferenceProblem, solved: Mapping[str, Solved], threads: list[int]) -> Agreement:
    """How far the values are from numpy's in float64, what the kernels' commands lose in a step, and equal bytes."""
    exact = solved[NUMPY][0]
    parts = [[np.ascontiguousarray(part).tobytes() for part in solved[kernels(n)]] for n in threads]
    return Agreement(
        value_m2_s2={name: float(np.abs(value - exact).max()) for name, (value, _) in solved.items()},
        regret_m2_s2=largest_regret(problem, solved[kernels(1)][1]),
        same_bytes=all(part == parts[0] for part in parts),
    )


def solved_in_turns(
    problem: ReferenceProblem, solves: Mapping[str, Solve], options: Options
) -> tuple[dict[str, Times], dict[str, Times]]:
    """Times of all ways, and of the kernels with one stage, all in the same rounds."""
    short = replace(problem, stages=1)
    whole: dict[str, Call] = {name: partial(solve, problem) for name, solve in solves.items()}
    names = [kernels(n) for n in sorted({1, options.threads})]
    build: dict[str, Call] = {
        f"{name}, one stage": partial(solves[name], short) for name in names
    }  # fmt: skip
    times = in_turns(whole | build, options.rounds, dict.fromkeys(SLOW, options.slow_rounds))
    return {name: times[name] for name in whole}, {name: times[name] for name in build}


def batch_calls(options: Options, solves: Mapping[str, Solve]) -> dict[str, Call]:
    """Ways to solve sixteen problems that differ in brake, resistance and target."""
    batch = [replace(problem, stages=options.stages) for problem in batch_of_16()]
    threads, pool, solver = options.threads, ThreadPoolExecutor(options.threads), ReferenceSolver(options.threads)
    kinds: dict[ReferenceProblem, list[ReferenceProblem]] = {}
    for problem in batch:
        kinds.setdefault(problem.dynamics, []).append(problem)
    by_scipy = solves[SCIPY]
    found: dict[str, Call] = {
        kernels(threads): lambda: solver.solve_batch(batch),
        f"{SCIPY}, operators shared, {threads} threads": lambda: list(pool.map(solve_targets_by_scipy, kinds.values())),
        f"{SCIPY}, {threads} threads": lambda: list(pool.map(by_scipy, batch)),
        SCIPY: lambda: [by_scipy(problem) for problem in batch],
    }
    if QUANTECON in solves:
        found[QUANTECON] = lambda: [solves[QUANTECON](problem) for problem in batch]
    return found


def limit_of(problem: ReferenceProblem, work: OperatorWork, threads: int) -> Limit:
    """Rates of this machine now, at best, and the time that a sweep would take at these rates."""
    loops = {
        "sums": multiply_add_loop(threads),
        "loads": load_loop(threads=threads),
        "straddling": load_loop(shift=SHIFT, threads=threads),
    }
    times = in_turns(calls_of(loops), LIMIT_ROUNDS)
    per_s = {name: loop.operations / min(times[name].wall_s) for name, loop in loops.items()}
    return Limit(
        threads=threads,
        multiply_adds_per_s=per_s["sums"],
        loads_per_s=per_s["loads"],
        straddling_per_s=per_s["straddling"],
        sweep_by_loads_s=problem.stages * (work.weights / per_s["loads"] + work.products / per_s["straddling"]),
        sweep_by_multiply_adds_s=problem.stages * work.products / per_s["sums"],
    )


METHOD = Method(Options, Options(rounds=1, slow_rounds=1, stages=4), Comparison, run)
