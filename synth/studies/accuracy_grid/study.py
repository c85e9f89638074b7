"""How near the tables are to what physics leaves, with and without an estimator, over a whole grid of cases.

5 masses × 4 targets × 3 spreads of friction × 2 positions, a cut of three cars and an eight-axle tank car. Of every
case that is served (who is told the friction keeps the rms limit, or comes too near to it to tell): the exported cubic
table, the same with the estimator, tuned baselines, and the references of both tables that are told the
friction of every cut, all on fresh common passes.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from plant_models import Plant, PlantError
from plant_models.frozen_arrays import frozen_arrays
from synth.book.comparison.baselines import tune_baselines
from synth.book.comparison.friction_bound import bound_of
from synth.book.comparison.told_regulator import by_lines
from synth.book.estimation.estimate_chain import estimate_chain
from synth.book.estimation.estimated_lines import estimated_lines
from synth.book.estimation.simulated_prediction import simulated_prediction
from synth.book.estimation.told_estimator import told_with_estimator
from synth.book.estimation.tuning_days import tuning_days
from synth.book.rounded_table import predict
from synth.book.work_queue import run_nested
from synth.configuration.config_file import parse_config
from synth.configuration.resolved_config import ResolvedConfig
from synth.problem.aim import Aim
from synth.problem.resolution import Resolution, finer_for_check
from synth.simulation.closed_loop import TableController
from synth.simulation.common_passes import CommonPasses, common_passes
from synth.simulation.exit_statistics import exit_statistics, rms_ratio
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses, random_passes
from synth.simulation.stratified_passes import stratified_passes
from synth.solver.backward_induction import solve
from synth.solver.chain.chain import Chain, check_chain, persistent_chain
from synth.solver.polynomial_lines import PolynomialLines
from synth.solver.told_lines import told_lines
from synth.solver.tuned_lines import fitted, polished
from synth.studies.accuracy_grid.figures import Errors, Figures, GridCase
from synth.studies.accuracy_grid.findings import Grid
from synth.studies.options import option
from synth.studies.side_by_side import THREADS
from synth.studies.study import Method, Tell
from synth.studies.tuned_table import rounded
from tuning_tables import ControllerTable

SEED, FRESH, TUNING, PREDICTION = 20261120, 86028121, 32452843, 49979687
TUNING_PASSES, BASELINE_PASSES, PREDICTION_PASSES = 3000, 600, 10_000
GRID_STEP_M_S = 0.015
"""As fine as the tool advises for the lowest target."""

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
    """What the targets of a class share; `seconds`: their part of the work on the grids; `fresh`: of `passes`."""

    config: ResolvedConfig
    plant: Plant
    design: Chain
    check: Chain
    seconds: float
    passes: Row
    fresh: CommonPasses


@frozen_arrays
@dataclass(frozen=True, eq=False)
class Plain:
    """The table for the measured speed, as designed on a grid; its fresh passes, its reference, seconds to make it."""

    resolution: Resolution
    lines: PolynomialLines
    curvature: NDArray[np.float64]
    table: ControllerTable
    sample: ExitSample
    told: ExitSample
    predicted_rms_m_s: float
    seconds: float


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
    shared = Class(config, plant, design, check, seconds, passes, common_passes(plant, passes.fresh))

    def task(target: float) -> GridCase:
        name = f"{order.named(label)} to {target:g} m/s"
        found = on_a_grid_fine_enough(shared, target, GridCase(name, order.cv, target, False, 0.0, None))
        tell(f"{name}: {'not served' if found.figures is None else f'{found.figures.table.rms_m_s:.4f} m/s'}")
        return found

    return [partial(task, target) for target in targets]


def on_a_grid_fine_enough(shared: Class, target_m_s: float, case: GridCase) -> GridCase:
    """`case` with what was found; on half the speed step where the grid is too coarse for it, as `tune` advises."""
    resolution = shared.config.resolution
    try:
        return found_in(shared, target_m_s, shared.design, resolution, case)
    except PlantError:
        finer = replace(resolution, speed_step_m_s=0.5 * resolution.speed_step_m_s)
        found = found_in(shared, target_m_s, persistent_chain(shared.plant, finer), finer, case)
        return replace(found, figures=found.figures and replace(found.figures, finer=True))


def found_in(shared: Class, target: float, design: Chain, resolution: Resolution, case: GridCase) -> GridCase:
    """`case` with what is reached with the friction known, and the figures if that is enough."""
    plain = plain_table(shared, target, design, resolution)
    known = errors(plain.told, target)
    served = known.ci95_m_s[0] <= shared.config.acceptance.rms_m_s
    figures = figures_of(shared, target, plain) if served else None
    return replace(case, served=served, known_rms_m_s=known.rms_m_s, figures=figures)


def plain_table(shared: Class, target: float, design: Chain, resolution: Resolution) -> Plain:
    """The table for the measured speed, designed on `design`."""
    plant, config, fresh = shared.plant, shared.config, shared.fresh
    started = time.perf_counter()
    solution = solve(design, Aim(target, config.criterion))
    fit = fitted(solution, config.fit.degree)
    lines = polished(solution, fit).lines
    table = rounded(config, plant, lines, target)
    predicted = predict(shared.check, table).rms_m_s(target)
    seconds = shared.seconds + time.perf_counter() - started
    sample = fresh.run(TableController(table))
    told = bound_of(fresh, [by_lines(told_lines(design, target, lines, fit.curvature))], sample, target)
    return Plain(resolution, lines, fit.curvature, table, sample, told, predicted, seconds)


def figures_of(shared: Class, target: float, plain: Plain) -> Figures:
    """All controllers of a case that is served on the same passes."""
    plant, config, passes, fresh = shared.plant, shared.config, shared.passes, shared.fresh
    started = time.perf_counter()
    chain = estimate_chain(plant, plain.resolution, target)
    solution, days = solve(chain, Aim(target, config.criterion)), tuning_days(plant, passes.trim)
    _, made = estimated_lines(plant, solution, config.fit.degree, passes.trim, days)
    estimated = rounded(config, plant, made.lines, target, made.estimator)
    promised = simulated_prediction(fresh.of_others(passes.prediction).run(TableController(estimated)), target).rms_m_s
    seconds = shared.seconds + time.perf_counter() - started
    by_estimated = fresh.run(TableController(estimated))
    regulator = told_with_estimator(made, fresh.of_others(passes.trim), target)
    told = bound_of(fresh, [regulator], by_estimated, target)
    ratio, ratio_ci95 = rms_ratio(by_estimated, plain.sample, target)
    tuned = tune_baselines(fresh.of_others(passes.tuning.part(0, BASELINE_PASSES)), target)
    return Figures(
        table=errors(plain.sample, target),
        estimated=errors(by_estimated, target),
        baselines={each.name: errors(fresh.run(each.controller), target) for each in tuned},
        told=errors(plain.told, target),
        told_estimated=errors(told, target),
        predicted_rms_m_s=plain.predicted_rms_m_s,
        estimated_predicted_rms_m_s=promised,
        ratio=ratio,
        ratio_ci95=ratio_ci95,
        table_s=plain.seconds,
        estimated_s=seconds,
    )


def errors(sample: ExitSample, target_m_s: float) -> Errors:
    """The figures of one controller."""
    found = exit_statistics(sample, target_m_s)
    return Errors(found.rms_m_s, found.rms_ci95_m_s, found.switchings)


SMALLEST = Options((52.0,), (3.0,), (0.15,), ("knp-5-bunch",), True, 200)
METHOD = Method(Options, SMALLEST, Grid, run)
