"""The one way from an aim to a validated table: solve, fit, polish, round, predict, simulate.

`tune` adds comparison and studies to it, a sweep adds nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from plant_models.frozen_arrays import frozen_arrays
from synth.book.any_time.surface_table import polished_surfaces, starting_surfaces
from synth.book.checked_design import NODES_KEPT, CheckedDesign, checked_design
from synth.book.class_setup import ClassSetup, EstimatorSetup
from synth.book.estimation.estimated_surfaces import estimated_surfaces
from synth.book.estimation.estimated_table import EstimatedTable, estimated_table
from synth.book.estimation.simulated_prediction import density_of, simulated_prediction
from synth.book.rounded_table import rounded, with_prediction
from synth.problem.aim import Aim
from synth.problem.any_time_resolution import design_resolution
from synth.problem.problem import Problem
from synth.simulation.closed_loop import TableController
from synth.simulation.exit_statistics import BrakePower, ExitStatistics, brake_power, exit_statistics
from synth.simulation.passes import ExitSample
from synth.solver.any_time.polynomial_surfaces import PolynomialSurfaces
from synth.solver.any_time.surface_polish import SurfacePolish
from synth.solver.backward_induction import Solution, solve_all
from synth.solver.chain.chain import Chain
from synth.solver.exit_density import ExitDensity
from synth.solver.polynomial_lines import PolynomialLines
from synth.solver.tabulate import UNPREDICTED, tabulate
from tuning_tables import ControllerTable, Validated, from_json, to_json

AnyEstimate = EstimatedTable[PolynomialLines] | EstimatedTable[PolynomialSurfaces]

Store = Callable[[ControllerTable], ControllerTable]
"""Keeps a table, and gives it back as a controller will read it."""


@dataclass(frozen=True)
class SurfaceDesign:
    """How surfaces were polished for the measured speed, and where an estimator is asked for, how those for it."""

    polish: SurfacePolish
    estimate: EstimatedTable[PolynomialSurfaces] | None


@frozen_arrays
@dataclass(frozen=True, eq=False)
class TunedTable:
    """The rounded table with its prediction, not yet simulated.

    `predicted`: the exit density behind the prediction; `design`: of lines for the measured speed and commands at rest;
    `estimate`: where an estimator is asked for, how its lines were designed; `surfaces`: those of a regulator that
    commands at any time.
    """

    table: ControllerTable
    predicted: ExitDensity
    design: CheckedDesign
    estimate: EstimatedTable[PolynomialLines] | None
    surfaces: SurfaceDesign | None


@dataclass(frozen=True)
class ValidatedTable:
    """The table as stored, with what the closed loop on the common passes says of it."""

    table: ControllerTable
    sample: ExitSample
    statistics: ExitStatistics
    brake_power: BrakePower


def solutions(chain: Chain, aims: Sequence[Aim]) -> tuple[Solution, ...]:
    """Solutions for several aims at once, with no more values than anybody reads."""
    return solve_all(chain, aims, nodes_kept=NODES_KEPT)


def tuned_table(setup: ClassSetup, solution: Solution) -> TunedTable:
    """The table of one solution on `setup.design`: fitted, polished, rounded, and predicted.

    Raises `PlantError` where the grid is too coarse for lines, `InvalidTable` where rounding would let lines touch.
    """
    problem, target_m_s = Problem(setup.plant, solution.aim), solution.aim.target_speed_m_s
    design = checked_design(solution, setup.check, setup.degree, lambda lines: rounded(setup, lines, target_m_s))
    lines, made = design.kept.lines, None
    if setup.estimator is not None:
        made = estimated_table(problem, setup.estimator.design, lines, setup.estimator.tuning)
    surfaces = surface_design(setup, solution.aim, lines, made) if setup.regulator.at_any_time else None
    estimate: AnyEstimate | None = made if surfaces is None else surfaces.estimate
    table, predicted = design.table, design.predicted
    if setup.estimator is not None and estimate is not None and estimate.gains:
        table, predicted = predicted_by_passes(setup, estimate, setup.estimator, target_m_s)
    elif surfaces is not None:
        table = rounded(setup, surfaces.polish.surfaces, target_m_s)
        table, predicted = with_prediction(setup.check, table)
    return TunedTable(table, predicted, design, made, surfaces)


def surface_design(
    setup: ClassSetup, aim: Aim, lines: PolynomialLines, made: EstimatedTable[PolynomialLines] | None
) -> SurfaceDesign:
    """Surfaces for commands at any time from `lines`; with an estimator also from those that were `made` for it."""
    plant, gauge = setup.plant, setup.regulator.has_gauge
    steps = design_resolution(plant, aim.target_speed_m_s)
    polish = polished_surfaces(plant, aim, starting_surfaces(plant, lines, gauge), steps)
    if made is None or setup.estimator is None:
        return SurfaceDesign(polish, None)
    return SurfaceDesign(polish, estimated_surfaces(Problem(plant, aim), made, polish.surfaces, setup.estimator.tuning))


def read_back(table: ControllerTable) -> ControllerTable:
    """A store that keeps nothing: the table as a controller would read it from its file."""
    return from_json(to_json(table))


def validated_table(setup: ClassSetup, table: ControllerTable, store: Store) -> ValidatedTable:
    """`table` stored, simulated on the setup's passes as it is read back, and stored with the figures."""
    target, kept = table.target_speed_m_s, store(table)
    sample = setup.passes.run(TableController(kept))
    found = exit_statistics(sample, target)
    figures = Validated(found.passes, found.rms_m_s, found.rms_ci95_m_s)
    power = brake_power(sample, setup.passes.at_full_brake, target)
    return ValidatedTable(store(kept.with_validated(figures)), sample, found, power)


def predicted_by_passes(
    setup: ClassSetup, made: AnyEstimate, estimator: EstimatorSetup, target_speed_m_s: float
) -> tuple[ControllerTable, ExitDensity]:
    """The rounded table for the estimated speed, with what passes that nothing else uses say of it."""
    origin = (setup.origin.generator, setup.table_id(target_speed_m_s), setup.origin.created)
    table = tabulate(setup.plant, made.lines, target_speed_m_s, UNPREDICTED, *origin, made.estimator)
    sample = estimator.prediction.run(TableController(table))
    density = density_of(sample, estimator.design.grid.speed_m_s)
    return replace(table, predicted=simulated_prediction(sample, target_speed_m_s)), density
