"""The one way from an aim to a validated table: solve, fit, polish, round, predict, simulate; and a table as a
controller holds it, with what is computed of it without sampling.

`tune` adds comparison and studies to it, a sweep adds nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Generic, TypeVar

from plant_models.frozen_arrays import frozen_arrays
from synth.problem.problem import Aim
from synth.problem.resolution import design_resolution
from synth.retarder.checked_design import (
    NODES_KEPT,
    CheckedDesign,
    checked_design,
    polished_surfaces,
    starting_surfaces,
    surface_density,
)
from synth.retarder.class_setup import ClassSetup, EstimatorSetup
from synth.retarder.epochs import Store, ValidatedTable, validated
from synth.retarder.estimation.estimated_lines import SimulatedRms, estimated_lines, estimated_surfaces
from synth.retarder.estimation.estimated_table import EstimatedTable, trimmed_on
from synth.retarder.estimation.tuning_days import density_of, simulated_prediction
from synth.simulation.closed_loop import TableController
from synth.simulation.passes import ExitSample
from synth.solver.any_time.polynomial_surfaces import PolynomialSurfaces
from synth.solver.backward_induction import Solution, solve_all
from synth.solver.chain.chain import Chain
from synth.solver.descent import Descent
from synth.solver.exit_density import ExitDensity
from synth.solver.resolved_density import resolved_density
from synth.solver.switching_lines import PolynomialLines, SwitchingLines
from synth.solver.tabulate import UNPREDICTED, lines_of, prediction_of, tabulate
from tuning_tables import ControllerTable, Decisions, from_json, to_json


def rounded(setup: ClassSetup, lines: PolynomialLines | PolynomialSurfaces, target_speed_m_s: float) -> ControllerTable:
    """The table of `lines` for the measured speed, not yet predicted."""
    return tabulate(setup.plant, lines, target_speed_m_s, UNPREDICTED, *setup.stamp(target_speed_m_s))


@frozen_arrays
class PredictedTable:
    """A rounded table with its prediction, and the exit density behind it."""

    table: ControllerTable
    density: ExitDensity

    @property
    def rms_m_s(self) -> float:
        """The predicted rms."""
        return self.table.predicted.rms_m_s

    @property
    def most_off(self) -> float:
        """A grid is not believed where the exact figure differs by more."""
        return 1.25


def with_prediction(check: Chain, table: ControllerTable) -> PredictedTable:
    """`table` with the figures of its exit-speed density; as `predict`."""
    density = predict(check, table)
    return PredictedTable(replace(table, predicted=prediction_of(density, table.target_speed_m_s)), density)


def predict(check: Chain, table: ControllerTable) -> ExitDensity:
    """Exit-speed density of an exported table for the measured speed, resolved near its target.

    On `check` if it decides at rest; at any time on a chain of its own of the same plant.
    """
    if table.decisions is Decisions.AT_ANY_TIME:
        return surface_density(check.plant, table)
    lines = lines_of(table, check.grid.path_m)
    stages = check.actuator.stages
    used = SwitchingLines(lines.nodes_m, lines.lower_m_s[:stages], lines.upper_m_s[:stages])
    return resolved_density(check, used, table.target_speed_m_s)


Lines = TypeVar("Lines", PolynomialLines, PolynomialSurfaces)

AnyEstimate = EstimatedTable[PolynomialLines] | EstimatedTable[PolynomialSurfaces]

ValidatedLines = ValidatedTable[ControllerTable, ExitSample]

AnyDesign = CheckedDesign[PredictedTable] | CheckedDesign[SimulatedRms]


@dataclass(frozen=True)
class Designed(Generic[Lines]):
    """Lines or surfaces as a table has them: how they were polished, and with an estimator how they were trimmed."""

    lines: Lines
    polish: Descent[Lines]
    estimate: EstimatedTable[Lines] | None


@frozen_arrays
class TunedTable:
    """The rounded table with its prediction, not yet simulated.

    `predicted`: the exit density behind the prediction; `design`: of lines for commands at rest, and for the speed that
    the regulator compares with them; `at_rest`: these lines; `at_any_time`: the surfaces that were polished from them,
    None for a regulator that commands at rest.
    """

    table: ControllerTable
    predicted: ExitDensity
    design: AnyDesign
    at_rest: Designed[PolynomialLines]
    at_any_time: Designed[PolynomialSurfaces] | None

    @property
    def designed(self) -> Designed[PolynomialLines] | Designed[PolynomialSurfaces]:
        """What the table has."""
        return self.at_any_time or self.at_rest


def solutions(chain: Chain, aims: Sequence[Aim]) -> tuple[Solution, ...]:
    """Solutions for several aims at once, with no more values than anybody reads."""
    return solve_all(chain, aims, nodes_kept=NODES_KEPT)


def tuned_table(setup: ClassSetup, solution: Solution) -> TunedTable:
    """The table of one solution on `setup.design`: fitted, polished, trimmed where it has an estimator, rounded, and
    predicted.

    Raises `PlantError` where the grid is too coarse for lines, `InvalidTable` where rounding would let lines touch.
    """
    if setup.estimator is None:
        at_rest = measuring_table(setup, solution)
    else:
        at_rest = estimating_table(setup, setup.estimator, solution)
    return at_any_time(setup, solution.aim, at_rest) if setup.regulator.at_any_time else at_rest


def measuring_table(setup: ClassSetup, solution: Solution) -> TunedTable:
    """The table of lines for the measured speed, predicted without sampling."""

    def judge(lines: PolynomialLines) -> PredictedTable:
        return with_prediction(setup.check, rounded(setup, lines, solution.aim.target_speed_m_s))

    design = checked_design(solution, setup.check, setup.degree, judge)
    lines = Designed(design.kept.lines, design.kept.polish, None)
    return TunedTable(design.verdict.table, design.verdict.density, design, lines, None)


def estimating_table(setup: ClassSetup, estimator: EstimatorSetup, solution: Solution) -> TunedTable:
    """The table of lines for the estimated speed: trimmed on days of another mean friction, predicted by passes."""
    design, made = estimated_lines(setup.plant, solution, setup.degree, estimator.tuning, estimator.days)
    target_m_s = solution.aim.target_speed_m_s
    lines = Designed(made.lines, design.kept.polish, made)
    return TunedTable(*predicted_by_passes(setup, made, estimator, target_m_s), design, lines, None)


def at_any_time(setup: ClassSetup, aim: Aim, made: TunedTable) -> TunedTable:
    """The table of surfaces for commands at any time, polished from the lines of a table that was `made` for commands
    at rest."""
    plant, target_m_s, gauge, lines = setup.plant, aim.target_speed_m_s, setup.regulator.has_gauge, made.at_rest
    if setup.estimator is None or lines.estimate is None:
        steps = design_resolution(plant, target_m_s)
        polish = polished_surfaces(plant, aim, starting_surfaces(plant, lines.lines, gauge), steps)
        told = with_prediction(setup.check, rounded(setup, polish.best, target_m_s))
        surfaces = Designed(polish.best, polish, None)
        return replace(made, table=told.table, predicted=told.density, at_any_time=surfaces)
    polish, untrimmed = estimated_surfaces(plant, aim, lines.estimate, gauge, setup.estimator.tuning)
    trimmed = trimmed_on(setup.estimator.days, target_m_s, untrimmed)
    table, predicted = predicted_by_passes(setup, trimmed, setup.estimator, target_m_s)
    surfaces = Designed(trimmed.lines, polish, trimmed)
    return replace(made, table=table, predicted=predicted, at_any_time=surfaces)


def read_back(table: ControllerTable) -> ControllerTable:
    """A store that keeps nothing: the table as a controller would read it from its file."""
    return from_json(to_json(table))


def validated_table(setup: ClassSetup, table: ControllerTable, store: Store[ControllerTable]) -> ValidatedLines:
    """`table` simulated on the setup's passes as it is read back, and stored with the figures."""
    return validated(table, store, lambda kept: setup.passes.run(TableController(kept)), setup.passes.at_full_brake)


def predicted_by_passes(
    setup: ClassSetup, made: AnyEstimate, estimator: EstimatorSetup, target_speed_m_s: float
) -> tuple[ControllerTable, ExitDensity]:
    """The rounded table for the estimated speed, with what passes that nothing else uses say of it."""
    stamp = setup.stamp(target_speed_m_s)
    table = tabulate(setup.plant, made.lines, target_speed_m_s, UNPREDICTED, *stamp, made.estimator)
    sample = estimator.prediction.run(TableController(table))
    density = density_of(sample, setup.design.grid.speed_m_s)
    return replace(table, predicted=simulated_prediction(sample, target_speed_m_s)), density
