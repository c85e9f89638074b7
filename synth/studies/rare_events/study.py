"""How often a cut leaves too fast by more than 0.2 … 2 m/s: four ways, down to a millionth and below.

P(exit speed > target + margin) by plain simulation, by importance sampling and by subset simulation of the closed loop,
and by the forward density. Besides, why the rms has a heavy tail in these cases: what the passes over by more than
0.2 m/s make of the mean square, and which cuts they are.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeVar

import numpy as np

from plant_models import Plant
from synth.configuration.resolved_config import ResolvedConfig
from synth.simulation.closed_loop import TableController, close_loop, simulate_many
from synth.simulation.exit_statistics import exit_statistics
from synth.simulation.random_passes import random_passes
from synth.studies.cases import Case, named_cases
from synth.studies.entrance import from_the_entrance
from synth.studies.options import option
from synth.studies.rare_events.cross_entropy import Pilot, learn, mixture_of
from synth.studies.rare_events.findings import (
    DENSITY,
    IMPORTANCE,
    PLAIN,
    SUBSET,
    CaseRow,
    HeavyTail,
    MethodTails,
    RareEvents,
)
from synth.studies.rare_events.importance_sampling import WeightedPasses, weighted_passes
from synth.studies.rare_events.pass_coordinates import path_work_coordinates
from synth.studies.rare_events.pass_score import exit_error
from synth.studies.rare_events.subset_simulation import SubsetPlan, subset_tails
from synth.studies.rare_events.tail_density import predicted_tails
from synth.studies.rare_events.tail_probability import TailProbability, crude_tail
from synth.studies.side_by_side import THREADS
from synth.studies.study import Method, Tell
from synth.studies.tuned_table import tuned_table

MARGINS_M_S = (0.2, 0.3, 0.5, 1.0, 1.5, 2.0)
CURVE_M_S = tuple(round(0.05 * i, 2) for i in range(2, 41))

HEAVY_M_S = 0.2
"""Over-speeds beyond this are told apart in the mean square."""

SHORT_PASSES = 20_000
"""Passes of the usual validation, whose interval of the rms is foretold."""

NORMAL_95 = 1.96
SEEDS = {"learning": 101, "importance": 102, "subset": 103, "plain": 104, "rms": 105}

_T = TypeVar("_T")


@dataclass(frozen=True)
class Options:
    """What is studied."""

    config: Path | None = option(None, "configuration; the built-in default book without it")
    cases: tuple[str, ...] = option(("22:2", "36:3", "52:3", "85:4"), "mass, t : target, m/s")
    passes: int = option(400_000, "of each run of importance sampling", (1000, 10**8))
    plain: int = option(1_000_000, "passes of plain simulation", (1000, 10**9))
    replicates: int = option(48, "of subset simulation", (3, 1000))
    particles: int = option(1000, "of each replicate", (20, 10**6))
    pilot: int = option(4000, "passes of a round of learning", (100, 10**6))
    coarser: float = option(1.0, "times the steps of the design, for the grid of the density", (0.5, 8.0))


def run(options: Options, tell: Tell) -> RareEvents:
    """All methods for every case."""
    config = from_the_entrance(options.config)
    rows = []
    for case in named_cases(config, options.cases):
        rows.append(studied(case, config, options))
        tell(f"{case.name}: {sum(method.seconds for method in rows[-1].methods):.0f} s")
    return RareEvents(config.sha256, SEEDS, CURVE_M_S, MARGINS_M_S, HEAVY_M_S, SHORT_PASSES, tuple(rows))


def studied(case: Case, config: ResolvedConfig, options: Options) -> CaseRow:
    """All methods for one table."""
    plant, target = case.plant, case.target_m_s
    table = tuned_table(config, plant, target)
    controller = TableController(table)
    loop = close_loop(plant, controller.stages)
    score, coordinates = exit_error(loop, controller, target), path_work_coordinates(loop)
    learnt = learn(score, coordinates, MARGINS_M_S, SEEDS["learning"], Pilot(options.pilot), THREADS)

    def weighted(nominal: float, seed: int) -> WeightedPasses:
        law = mixture_of(learnt, nominal=nominal)
        return weighted_passes(score, coordinates, law, seed, options.passes, threads=THREADS)

    importance, importance_s = timed(lambda: weighted(0.1, SEEDS["importance"]))
    plan = SubsetPlan(options.replicates, options.particles)
    cells = len(coordinates.direction)
    subset, subset_s = timed(lambda: subset_tails(score, cells, CURVE_M_S, SEEDS["subset"], plan, THREADS).tails)
    resolution = replace(
        config.resolution, path_step_m=options.coarser * config.resolution.path_step_m,
        speed_step_m_s=options.coarser * config.resolution.speed_step_m_s,
    )  # fmt: skip
    density, density_s = timed(lambda: predicted_tails(plant, table, CURVE_M_S, resolution, THREADS).tails)
    plain, plain_s = timed(
        lambda: simulate_many(plant, controller, SEEDS["plain"], options.plain, threads=THREADS, row=random_passes)
    )
    error = plain.exit_speed_m_s - target
    counted = [crude_tail(x, int(np.count_nonzero(error > x)), options.plain) for x in CURVE_M_S]
    statistics = exit_statistics(plain, target)
    for_rms = weighted(0.5, SEEDS["rms"])
    rms = for_rms.root_mean_square()
    return CaseRow(
        case=case.name,
        learning_passes=learnt.passes,
        mean_weight=importance.mean(np.ones(len(importance))),
        methods=(
            method_tails(PLAIN, counted, plain_s),
            method_tails(IMPORTANCE, [importance.tail(x) for x in CURVE_M_S], importance_s),
            method_tails(SUBSET, subset, subset_s),
            method_tails(DENSITY, density, density_s),
        ),
        plain_rms_m_s=statistics.rms_m_s,
        plain_rms_ci95_m_s=statistics.rms_ci95_m_s,
        weighted_rms_m_s=rms.rms_m_s,
        weighted_rms_ci95_m_s=rms.rms_ci95_m_s,
        weighted_gain=rms.gain,
        heavy_tail=heavy_tail(for_rms, plant),
    )


def timed(work: Callable[[], _T]) -> tuple[_T, float]:
    """(the result of `work`, its wall time in seconds)."""
    started = time.perf_counter()
    found = work()
    return found, time.perf_counter() - started


def method_tails(method: str, tails: Sequence[TailProbability], seconds: float) -> MethodTails:
    """The curve of one method as plain numbers."""
    return MethodTails(method, tails[0].passes, seconds, tuple((t.probability, t.low, t.high) for t in tails))


def heavy_tail(weighted: WeightedPasses, plant: Plant) -> HeavyTail:
    """What the rare fast passes do to the mean square, and which cuts they are."""
    square = weighted.score**2
    over = (weighted.score > HEAVY_M_S).astype(float)
    p, total = weighted.mean(over)[0], weighted.mean(square)[0]
    kurtosis = weighted.mean(square**2)[0] / total**2
    z = weighted.mean(over * weighted.coordinates[:, 0])[0] / p
    return HeavyTail(
        probability=p,
        share_of_mean_square=weighted.mean(over * square)[0] / total,
        rms_over_m_s=math.sqrt(weighted.mean(over * square)[0] / p),
        rms_of_the_rest_m_s=math.sqrt(weighted.mean((1.0 - over) * square)[0] / (1.0 - p)),
        kurtosis=kurtosis,
        relative_ci95=0.5 * NORMAL_95 * math.sqrt((kurtosis - 1.0) / SHORT_PASSES),
        mean_friction_factor=1.0 + plant.friction_cv * z,
    )


SMALLEST = Options(None, ("22:2",), passes=2000, plain=2000, replicates=3, particles=50, pilot=500, coarser=4.0)
METHOD = Method(Options, SMALLEST, RareEvents, run)
