"""How fast the kernels that a tune runs solve the tool's own problem, beside numpy and the machine's limit.

`solve_all` of one class of the book as a tune calls it, but for eight targets, which fill a pack; the same recursion in
numpy; and loops that do nothing but multiply and add, or load. All run in turns, so every ratio is of one moment.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from plant_models.frozen_arrays import Floats
from scripts.studies.benchmark.by_numpy import Swept, sweep_by_numpy
from scripts.studies.benchmark.findings import (
    LANES,
    Benchmark,
    Limit,
    SweepWork,
    Way,
    load_loop,
    multiply_add_loop,
    sweep_work,
)
from scripts.studies.cases import from_the_entrance, of_masses
from scripts.studies.study import Method, Tell, option
from scripts.studies.timing import Call, in_turns, this_machine
from synth.problem.problem import Aim
from synth.problem.resolution import Resolution
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.solver.backward_induction import Solution, solve_all
from synth.solver.chain.chain import Chain, persistent_chain

COARSE = Resolution(path_step_m=2.0, speed_step_m_s=0.2, friction_nodes=2, resistance_nodes=1)


@dataclass(frozen=True)
class Options:
    """What is timed."""

    config: Path | None = option(None, "configuration; the built-in default book without it")
    mass_t: float = option(52.0, "the class of cuts, by its mass, t")
    targets: int = option(8, "targets at once", (1, 64))
    rounds: int = option(15, "turns", (1, 1000))
    slow_rounds: int = option(3, "turns of numpy", (1, 1000))
    coarse: bool = option(False, "a coarse grid, to see that it runs")


def run(options: Options, tell: Tell) -> Benchmark:
    """Compare the results, then the times."""
    config = of_masses(from_the_entrance(options.config), (options.mass_t,))
    machine = this_machine()
    ((label, plant),) = config.plants()
    chain = persistent_chain(plant, COARSE if options.coarse else config.resolution)
    aims = spread_aims(config, options.targets)
    swept = sweep_by_numpy(chain, aims)
    exact = solve_all(chain, aims, nodes_kept=1, value_type=np.float64)
    tell(f"{label}: kernels and numpy solved it")
    work = sweep_work(chain, swept)
    together = f"{options.targets} targets"
    calls: dict[str, tuple[int, Call]] = {
        f"kernels, {together}": (options.targets, lambda: solve_all(chain, aims, nodes_kept=1)),
        "kernels, 1 target": (1, lambda: solve_all(chain, aims[:1], nodes_kept=1)),
        f"kernels in float64, {together}": (
            options.targets, lambda: solve_all(chain, aims, nodes_kept=1, value_type=np.float64)
        ),
        f"numpy, {together}": (options.targets, lambda: sweep_by_numpy(chain, aims)),
    }  # fmt: skip
    packed = -(-options.targets // 8) * 8
    loops = {
        "multiply-adds": multiply_add_loop(),
        "loads from the nearest cache": load_loop(),
        "loads from where the values lie": load_loop(work.value_floats * packed),
    }
    slow = list(calls)[-1]
    times = in_turns(
        {name: call for name, (_, call) in calls.items()} | {name: loop.call for name, loop in loops.items()},
        options.rounds,
        {slow: options.slow_rounds},
    )
    tell(f"{options.rounds} rounds timed")
    needed = vectors_needed(work, options.targets)
    return Benchmark(
        config_sha256=config.sha256,
        machine=machine,
        label=f"{label}, {together}",
        size=size_of(chain),
        work=work,
        largest_value_difference=value_difference(swept, exact),
        largest_line_difference_m_s=line_difference(swept, exact),
        ways=tuple(Way(name, targets, times[name]) for name, (targets, _) in calls.items()),
        limits=tuple(Limit(name, loop.operations, needed, times[name]) for name, loop in loops.items()),
    )


def spread_aims(config: ResolvedConfig, count: int) -> list[Aim]:
    """`count` target speeds over the configured range, with the configured criterion."""
    low, high = min(config.targets_m_s), max(config.targets_m_s)
    return [Aim(float(target), config.criterion) for target in np.linspace(low, high, count)]


def vectors_needed(work: SweepWork, targets: int) -> int:
    """Vectors of sixteen that hold all factors of the products: each is loaded once and multiplied once."""
    return -(-work.products * targets // LANES)


def size_of(chain: Chain) -> str:
    """'75 path quanta, 278 energies, 4 scenarios, 8 resting modes, 2 noise levels'."""
    return (
        f"{len(chain.drive_m_s2)} path quanta, {len(chain.grid.speed_m_s)} energies, "
        f"{len(chain.scenarios.factor)} scenarios, {len(chain.actuator.mode_stage)} resting modes, "
        f"{len(chain.path_noise.levels)} noise levels"
    )


def value_difference(swept: Swept, exact: Sequence[Solution]) -> float:
    """Largest difference of the values at entry over the largest value."""
    values = np.stack([each.values[:, 0] for each in exact], axis=-1)
    return float(np.abs(values - swept.values).max() / np.abs(values).max())


def line_difference(swept: Swept, exact: Sequence[Solution]) -> float:
    """Largest difference of the lines, m/s; infinite lines must be the same ones."""
    pairs = [
        (mine.T[:-1], theirs[..., i])
        for i, each in enumerate(exact)
        for mine, theirs in ((each.lines.lower_m_s, swept.lower_m_s), (each.lines.upper_m_s, swept.upper_m_s))
    ]
    return max(apart(mine, theirs) for mine, theirs in pairs)


def apart(one: Floats, other: Floats) -> float:
    """Largest distance where both are finite; a large number where one alone is, or where the infinities differ."""
    both = np.isfinite(one) & np.isfinite(other)
    if not np.array_equal(one[~both], other[~both]):
        return float(np.finfo(float).max)
    return float(np.abs(one[both] - other[both]).max()) if both.any() else 0.0


METHOD = Method(Options, Options(targets=2, rounds=2, slow_rounds=1, coarse=True), Benchmark, run)
