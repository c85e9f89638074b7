"""What a solve costs against each size of the problem and on more threads; what float32 changes; a prediction.

Everything is compiled before it is timed; what is compared runs in turns, and the least processor time counts, as other
work on the machine would only wait for its turn in a wall time.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np

from plant_models import Plant
from synth.configuration.config_file import load_config
from synth.configuration.resolved_config import ResolvedConfig
from synth.problem.aim import Aim
from synth.problem.resolution import finer_for_check
from synth.solver.backward_induction import solve, solve_all
from synth.solver.chain.chain import Chain, check_chain, persistent_chain
from synth.solver.resolved_density import resolved_density
from synth.solver.switching_lines import SwitchingLines
from synth.studies.benchmark.study import spread_aims
from synth.studies.cases import of_masses
from synth.studies.options import option
from synth.studies.solver_scaling.findings import TARGETS, Growth, Prediction, SolverScaling
from synth.studies.solver_scaling.value_types import largest_changes, timed_types
from synth.studies.solver_scaling.whole_book import book_times
from synth.studies.study import Method, Tell
from synth.studies.timing.machine import this_machine
from synth.studies.timing.turns import Call, in_turns

STEPS, SCENARIOS = (2.0, 1.0, 0.5, 0.25), (1, 2, 4, 8)
NO_LINE = 1e9
"""m/s: stands for an infinite line where lines are interpolated."""


@dataclass(frozen=True)
class Options:
    """Which book, how often."""

    config: Path | None = option(None, "configuration; the built-in default book without it")
    masses_t: tuple[float, ...] = option((), "only cuts of these masses, t")
    rounds: int = option(5, "turns", (1, 1000))
    targets: int = option(16, "target speeds of the book", (2, 64))
    friction: int = option(5, "friction scenarios of the book", (1, 64))
    sizes: int = option(len(STEPS), "how many grids, from the coarsest on", (2, len(STEPS)))


def run(options: Options, tell: Tell) -> SolverScaling:
    """All parts, one after the other."""
    config = of_masses(load_config(options.config), options.masses_t)
    machine, resolution = this_machine(), config.resolution
    label, plant = config.plants()[len(config.plants()) // 2]
    aims = spread_aims(config, options.targets)
    growths = growths_of(config, plant, aims, options)
    tell("sizes timed")
    book = book_times(config, aims, options.friction, options.rounds)
    tell("book timed")
    chain = persistent_chain(plant, resolution)
    return SolverScaling(
        config_sha256=config.sha256,
        machine=machine,
        label=label,
        grid=f"grid of {resolution.path_step_m:g} m, {resolution.speed_step_m_s:g} m/s",
        growths=growths,
        book=book,
        types=timed_types(chain, aims, options.rounds),
        changes=largest_changes(config, [each for _, each in config.plants()]),
        predictions=predictions_of(config, options.rounds),
    )


def growths_of(config: ResolvedConfig, plant: Plant, aims: Sequence[Aim], options: Options) -> tuple[Growth, ...]:
    """One size at a time, all else at the configured grid and one target in the middle."""
    base, steps = config.resolution, STEPS[: options.sizes]
    middle = [Aim(config.targets_m_s[len(config.targets_m_s) // 2], config.criterion)]
    by_path = [persistent_chain(plant, replace(base, path_step_m=base.path_step_m * f)) for f in steps]
    by_speed = [persistent_chain(plant, replace(base, speed_step_m_s=base.speed_step_m_s * f)) for f in steps]
    by_friction = [persistent_chain(plant, replace(base, friction_nodes=n)) for n in SCENARIOS[: options.sizes]]
    chain = persistent_chain(plant, base)
    counts = [2**k for k in range(len(aims).bit_length()) if 2**k <= len(aims)]
    return (
        growth("path quanta", [len(c.drive_m_s2) for c in by_path], solves(by_path, middle), options.rounds),
        growth("energies", [len(c.grid.speed_m_s) for c in by_speed], solves(by_speed, middle), options.rounds),
        growth("friction scenarios", [len(c.scenarios.factor) for c in by_friction], solves(by_friction, middle),
               options.rounds),
        growth(TARGETS, counts, [partial(solve_all, chain, aims[:n], nodes_kept=1) for n in counts], options.rounds),
    )  # fmt: skip


def solves(chains: Sequence[Chain], aims: Sequence[Aim]) -> list[Call]:
    """One solve of each chain."""
    return [partial(solve_all, chain, aims, nodes_kept=1) for chain in chains]


def growth(name: str, sizes: Sequence[int], calls: Sequence[Call], rounds: int) -> Growth:
    """Time the calls in turns."""
    times = in_turns({str(i): call for i, call in enumerate(calls)}, rounds)
    return Growth(name, tuple(sizes), tuple(min(each.processor_s) for each in times.values()))


def predictions_of(config: ResolvedConfig, rounds: int) -> tuple[Prediction, ...]:
    """A prediction of the solver's lines for the middle target, by class."""
    target, calls = config.targets_m_s[len(config.targets_m_s) // 2], {}
    for label, plant in config.plants():
        aim = Aim(target, config.criterion)
        check = check_chain(plant, finer_for_check(config.resolution))
        lines = solve(persistent_chain(plant, config.resolution), aim).lines
        calls[label] = partial(resolved_density, check, on_nodes(lines, check), target)
    times = in_turns(calls, rounds)
    return tuple(Prediction(label, min(each.processor_s)) for label, each in times.items())


def on_nodes(lines: SwitchingLines, chain: Chain) -> SwitchingLines:
    """`lines` at the path nodes of another grid."""
    nodes = np.array(chain.grid.path_m)
    lower = np.nan_to_num(lines.lower_m_s, neginf=-NO_LINE)
    upper = np.nan_to_num(lines.upper_m_s, posinf=NO_LINE)
    both = (np.stack([np.interp(nodes, lines.nodes_m, row) for row in rows]) for rows in (lower, upper))
    return SwitchingLines(nodes, *both)


METHOD = Method(Options, Options(masses_t=(52.0,), rounds=1, targets=2, friction=1, sizes=2), SolverScaling, run)
