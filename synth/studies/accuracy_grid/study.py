"""How near the tables are to what physics leaves, with and without an estimator, over a whole grid of cases.

5 masses × 4 targets × 3 spreads of friction × 2 positions, a cut of three cars and an eight-axle tank car. Of every
feasible case: the exported cubic table, the same with the estimator, full lines, tuned baselines, and lines told the
friction of every cut (polished, simulated), all on fresh common passes.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

from plant_models import Plant, PlantError
from synth.book.comparison.baselines import tune_baselines
from synth.book.comparison.friction_bound import friction_known_bounds
from synth.book.estimation.estimated_table import estimated_table, estimator_design
from synth.book.estimation.simulated_prediction import simulated_prediction
from synth.book.tuned_table import predict
from synth.book.work_queue import run_nested
from synth.configuration.config_file import parse_config
from synth.configuration.resolved_config import ResolvedConfig
from synth.problem.aim import Aim
from synth.problem.problem import Problem
from synth.problem.resolution import Resolution, finer_for_check
from synth.simulation.closed_loop import ClosedLoop, LineController, TableController, close_loop
from synth.simulation.common_passes import common_passes
from synth.simulation.exit_statistics import exit_statistics, rms_ratio
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses, random_passes
from synth.simulation.stratified_passes import stratified_passes
from synth.solver.backward_induction import solve
from synth.solver.chain.chain import Chain, check_chain, persistent_chain
from synth.studies.accuracy_grid.figures import Errors, Figures, GridCase
from synth.studies.accuracy_grid.findings import Grid
from synth.studies.options import option
from synth.studies.side_by_side import THREADS
from synth.studies.study import Method, Tell
from synth.studies.told_friction import Effort, told_friction
from synth.studies.tuned_table import lines_of_solution, rounded

SEED, FRESH, TUNING, PREDICTION = 20261120, 86028121, 32452843, 49979687
TUNING_PASSES, BASELINE_PASSES, PREDICTION_PASSES = 3000, 600, 10_000
GRID_STEP_M_S = 0.015
"""As fine as the tool advises for the lowest target."""

TOLD_EFFORT = Effort(iterations=40, tolerance=1e-3, rounds=1)
LONG_CUTS = (("gondola-4", 3, 156.0), ("tank-8", 1, 120.0))


@dataclass(frozen=True)
class Options:
    """The grid."""

    masses_t: tuple[float, ...] = option((22.0, 36.0, 52.0, 66.0, 85.0), "of a gondola, t", (22.0, 94.0))
    targets_m_s: tuple[float, ...] = option((1.5, 2.0, 3.0, 4.0), "exit speeds, m/s", (0.5, 5.0))
    spreads: tuple[float, ...] = option((0.05, 0.15, 0.25), "CV of friction", (0.001, 1.0))
    retarders: tuple[str, ...] = option(("knp-5-bunch", "rnz-2m-park"), "positions of the library")
    no_long_cuts: bool = option(False, "leave out the cut of three cars and the tank car")
    passes: int = option(20_000, "fresh common passes of each case", (200, 10**7))
    told_nodes: int = option(5, "factors of friction that the reference is told", (1, 31))


@dataclass(frozen=True)
class ClassOrder:
    """A position, a spread of friction and a cut; its targets share the grids."""

    retarder: str
    cv: float
    car: str
    cars: int
    mass_t: float

    def configuration(self, targets_m_s: tuple[float, ...]) -> ResolvedConfig:
        """The configuration of this class of cuts alone."""
        cut = f'[[cut]]\ncar = "{self.car}"\ncars = {self.cars}\nmass_t = {self.mass_t}\n'
        text = (
            f'[retarder]\nname = "{self.retarder}"\n[grid]\nspeed_step_m_s = {GRID_STEP_M_S}\n'
            f"[targets]\nexit_speeds_m_s = {list(targets_m_s)}\n{cut}"
        )
        return parse_config(text, "accuracy-grid")

    def named(self, label: str) -> str:
        """'knp-5-bunch gondola-4-22t, CV 0.15'."""
        cars = f" x{self.cars}" if self.cars > 1 else ""
        return f"{self.retarder} {label}{cars}, CV {self.cv:g}"


@dataclass(frozen=True)
class Row:
    """Passes of the grid: `fresh` for figures, `tuning` for baselines, `trim` for the estimator, others to predict."""

    fresh: RandomPasses
    tuning: RandomPasses
    trim: RandomPasses
    prediction: RandomPasses


@dataclass(frozen=True)
class Class:
    """What the targets of a class share; `seconds`: their part of the work on the grids."""

    config: ResolvedConfig
    plant: Plant
    design: Chain
    check: Chain
    seconds: float
    passes: Row
    told_nodes: int


def run(options: Options, tell: Tell) -> Grid:
    """All cases."""
    started = time.perf_counter()
    passes = Row(
        stratified_passes(SEED + FRESH, 0, options.passes), random_passes(SEED + TUNING, 0, TUNING_PASSES),
        stratified_passes(SEED + TUNING, 0, TUNING_PASSES),
        stratified_passes(SEED + PREDICTION, 0, PREDICTION_PASSES),
    )  # fmt: skip
    starts = [partial(class_tasks, order, options, passes, tell) for order in orders_of(options)]
    cases = tuple(case for cases in run_nested(starts, THREADS) for case in cases)
    return Grid(SEED + FRESH, options.passes, (time.perf_counter() - started) / 60.0, cases)


def orders_of(options: Options) -> list[ClassOrder]:
    """The long cuts first, because they take longest."""
    long = [] if options.no_long_cuts else [ClassOrder("knp-5-bunch", 0.15, *cut) for cut in LONG_CUTS]
    return long + [
        ClassOrder(retarder, cv, "gondola-4", 1, mass_t)
        for retarder in options.retarders for cv in options.spreads for mass_t in options.masses_t
    ]  # fmt: skip


def class_tasks(order: ClassOrder, options: Options, passes: Row, tell: Tell) -> list[Callable[[], GridCase]]:
    """Solve what the targets of a class share; a task for every target."""
    targets = options.targets_m_s
    config = order.configuration(targets)
    ((label, nominal),) = config.plants()
    plant = replace(nominal, friction=replace(nominal.friction, common_cv=order.cv))
    started = time.perf_counter()
    design = persistent_chain(plant, config.resolution)
    check = check_chain(plant, finer_for_check(config.resolution))
    seconds = (time.perf_counter() - started) / len(targets)
    shared = Class(config, plant, design, check, seconds, passes, options.told_nodes)
    aims = [Aim(target, config.criterion) for target in targets]
    bounds = friction_known_bounds(design, aims, passes.tuning, config.acceptance.rms_m_s)

    def task(target: float, known_rms_m_s: float, feasible: bool) -> GridCase:
        figures = figures_on_a_grid_fine_enough(shared, target) if feasible else None
        name = f"{order.named(label)} to {target:g} m/s"
        tell(f"{name}: {'infeasible' if figures is None else f'{figures.table.rms_m_s:.4f} m/s'}")
        return GridCase(name, order.cv, target, feasible, known_rms_m_s, figures)

    return [
        partial(task, target, known.statistics.rms_m_s, bool(found.feasible))
        for target, (known, found) in zip(targets, bounds, strict=True)
    ]


def figures_on_a_grid_fine_enough(shared: Class, target_m_s: float) -> Figures:
    """The figures; on half the speed step where the grid is too coarse for a low target, as `tune` advises."""
    resolution = shared.config.resolution
    try:
        return figures_of(shared, target_m_s, shared.design, resolution)
    except PlantError:
        finer = replace(resolution, speed_step_m_s=0.5 * resolution.speed_step_m_s)
        found = figures_of(shared, target_m_s, persistent_chain(shared.plant, finer), finer)
        return replace(found, finer=True)


def figures_of(shared: Class, target: float, design: Chain, resolution: Resolution) -> Figures:
    """All controllers of a feasible case on the same passes."""
    plant, config, passes = shared.plant, shared.config, shared.passes
    loop, used = close_loop(plant, plant.position.top_stage + 1), close_loop(plant, plant.top_stage + 1)
    started = time.perf_counter()
    solution = solve(design, Aim(target, config.criterion))
    lines = lines_of_solution(solution, config.fit.degree)
    table = rounded(config, plant, lines, target)
    predicted = predict(shared.check, table).rms_m_s(target)
    turned = time.perf_counter()
    problem = Problem(plant, Aim(target, config.criterion))
    made = estimated_table(problem, estimator_design(plant, resolution, target), lines, passes.trim)
    estimated = rounded(config, plant, made.lines, target, made.estimator)
    foreseen = loop.run(TableController(estimated), loop.draws(passes.prediction))
    promised = simulated_prediction(foreseen, target).rms_m_s
    ended = time.perf_counter()
    if not made.gains:  # as `tune` does
        estimated, promised = table, predicted
    draws = loop.draws(passes.fresh)
    by_table, by_estimated = (loop.run(TableController(each), draws) for each in (table, estimated))
    draws = used.draws(passes.fresh)
    ratio, ratio_ci95 = rms_ratio(by_estimated, by_table, target)
    tuned = tune_baselines(common_passes(plant, passes.tuning.part(0, BASELINE_PASSES)), target)
    return Figures(
        table=errors(by_table, target),
        estimated=errors(by_estimated, target),
        lines=errors(used.run(LineController(solution.lines), draws), target),
        baselines={each.name: errors(used.run(each.controller, draws), target) for each in tuned},
        known=known(shared, target, design),
        told=told(shared, target, design, used),
        predicted_rms_m_s=predicted,
        estimated_predicted_rms_m_s=promised,
        estimator_used=made.gains,
        ratio=ratio,
        ratio_ci95=ratio_ci95,
        table_s=shared.seconds + turned - started,
        estimated_s=shared.seconds + ended - turned,
    )


def known(shared: Class, target: float, design: Chain) -> Errors:
    """The solver's lines for each known friction."""
    config, aims = shared.config, [Aim(target, shared.config.criterion)]
    ((found, _),) = friction_known_bounds(design, aims, shared.passes.fresh, config.acceptance.rms_m_s)
    statistics = found.statistics
    return Errors(statistics.rms_m_s, statistics.rms_ci95_m_s, statistics.switchings)


def told(shared: Class, target: float, design: Chain, loop: ClosedLoop) -> Errors:
    """Lines for each known friction, simulated there, weighted by how probable it is."""
    config, nodes = shared.config, shared.told_nodes
    free = replace(config.criterion, switching_tolerance_m2_s2=0.0)
    found = told_friction(design, Aim(target, free), config.fit.degree, nodes, TOLD_EFFORT)
    return errors(found.sample(loop, shared.passes.fresh), target)


def errors(sample: ExitSample, target_m_s: float) -> Errors:
    """The figures of one controller."""
    found = exit_statistics(sample, target_m_s)
    return Errors(found.rms_m_s, found.rms_ci95_m_s, found.switchings)


SMALLEST = Options((52.0,), (3.0,), (0.15,), ("knp-5-bunch",), True, 200, 1)
METHOD = Method(Options, SMALLEST, Grid, run)
