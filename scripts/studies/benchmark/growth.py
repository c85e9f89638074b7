"""How the time of solving grows: with classes of cuts, targets, nodes of the path, speeds, and hidden scenarios.

One quantity is changed at a time, the others stay as the first class of the book has them. All sizes run in turns; the
exponent is the slope of the logarithm of the time over that of the size, fitted to each round by itself.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

from plant_models import Plant
from scripts.studies.benchmark.study import spread_aims
from scripts.studies.cases import from_the_entrance
from scripts.studies.study import Findings, MarkdownTable, Method, Tell, option, table
from scripts.studies.timing import Call, Machine, Times, in_turns, this_machine, three_digits
from synth.problem.problem import Aim
from synth.problem.resolution import Resolution
from synth.solver.backward_induction import solve_all
from synth.solver.chain.chain import persistent_chain

TARGETS = 3
"""Of a class of the default book."""

FINER = (2.0, 1.4, 1.0, 0.7)
"""Steps of the grid, in those of the default."""


@dataclass(frozen=True)
class Options:
    """What is timed."""

    config: Path | None = option(None, "configuration; the built-in default book without it")
    rounds: int = option(5, "turns", (2, 1000))
    coarse: bool = option(False, "a coarse grid, to see that it runs")


@dataclass(frozen=True)
class Growth:
    """Processor times of sweep and preparation, s, by round, for each size of `quantity`."""

    quantity: str
    sizes: tuple[int, ...]
    processor_s: tuple[tuple[float, ...], ...]

    @property
    def exponents(self) -> tuple[float, ...]:
        """Of each round: the time grows as this power of the size."""
        logs = np.log(np.array(self.sizes))
        rounds = zip(*self.processor_s, strict=True)
        return tuple(float(np.polyfit(logs, np.log(np.array(seconds)), 1)[0]) for seconds in rounds)


@dataclass(frozen=True)
class SolverGrowth(Findings):
    """A row a quantity."""

    config_sha256: str
    machine: Machine
    rows: tuple[Growth, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`growth`: medians at the least and the largest size, and the exponent."""
        heads = ("grows with", "sizes", "processor ms", "exponent")
        rows = [
            (
                each.quantity,
                ", ".join(map(str, each.sizes)),
                ", ".join(three_digits(1e3 * median(seconds)) for seconds in each.processor_s),
                f"{median(each.exponents):.2f} ({min(each.exponents):.2f} to {max(each.exponents):.2f}, "
                f"n = {len(each.exponents)})",
            )
            for each in self.rows
        ]
        return {"growth": table("Time of solving a class", heads, rows)}

    def sentences(self) -> tuple[str, ...]:
        """The machine."""
        return (self.machine.sentence,)


@dataclass(frozen=True)
class Problem:
    """Classes of cuts that are solved for the same aims, each on a chain of its own."""

    plants: Sequence[Plant]
    resolution: Resolution
    aims: Sequence[Aim]

    def solved(self) -> None:
        """Prepare and sweep, as a tune does with each class."""
        for plant in self.plants:
            solve_all(persistent_chain(plant, self.resolution), self.aims, nodes_kept=1)


def run(options: Options, tell: Tell) -> SolverGrowth:
    """Time all sizes in turns."""
    config, machine = from_the_entrance(options.config), this_machine()
    ((_, plant), *_) = config.plants()
    grid = config.resolution
    if options.coarse:
        grid = replace(grid, path_step_m=4.0 * grid.path_step_m, speed_step_m_s=4.0 * grid.speed_step_m_s)
    base = Problem([plant], grid, spread_aims(config, TARGETS))

    def with_grid(**changed: Any) -> Problem:
        return replace(base, resolution=replace(grid, **changed))

    problems: dict[str, dict[int, Problem]] = {
        "classes of cuts": {n: replace(base, plants=[plant] * n) for n in (1, 2, 4)},
        "targets": {n: replace(base, aims=spread_aims(config, n)) for n in (1, 8, 16, 32)},
        "nodes of the path": by_size(nodes_of, [with_grid(path_step_m=f * grid.path_step_m) for f in FINER]),
        "speeds": by_size(speeds_of, [with_grid(speed_step_m_s=f * grid.speed_step_m_s) for f in FINER]),
        "scenarios of friction": {n: with_grid(friction_nodes=n) for n in (3, 6, 12)},
        "scenarios of resistance": {n: with_grid(resistance_nodes=n) for n in (1, 3, 6)},
    }
    calls: dict[str, Call] = {
        f"{quantity} {size}": each.solved for quantity, group in problems.items() for size, each in group.items()
    }
    times = in_turns(calls, options.rounds)
    tell(f"{len(calls)} sizes timed, {options.rounds} rounds")
    rows = (growth_of(quantity, tuple(group), times) for quantity, group in problems.items())
    return SolverGrowth(config.sha256, machine, tuple(rows))


def by_size(size: Callable[[Problem], int], problems: Sequence[Problem]) -> dict[int, Problem]:
    """The problems by their size."""
    return {size(problem): problem for problem in problems}


def nodes_of(problem: Problem) -> int:
    """Nodes of the path of its first class."""
    return len(persistent_chain(problem.plants[0], problem.resolution).drive_m_s2)


def speeds_of(problem: Problem) -> int:
    """Speeds of the grid of its first class."""
    return len(persistent_chain(problem.plants[0], problem.resolution).grid.speed_m_s)


def growth_of(quantity: str, sizes: tuple[int, ...], times: Mapping[str, Times]) -> Growth:
    """The times of one quantity."""
    return Growth(quantity, sizes, tuple(times[f"{quantity} {size}"].processor_s for size in sizes))


METHOD = Method(Options, Options(rounds=2, coarse=True), SolverGrowth, run)
