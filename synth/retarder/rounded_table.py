"""A table as a controller holds it, and what is computed of it without sampling."""

from __future__ import annotations

from dataclasses import replace

from plant_models.frozen_arrays import frozen_arrays
from synth.retarder.any_time.surface_table import surface_density
from synth.retarder.class_setup import ClassSetup
from synth.solver.any_time.polynomial_surfaces import PolynomialSurfaces
from synth.solver.chain.chain import Chain
from synth.solver.exit_density import ExitDensity
from synth.solver.polynomial_lines import PolynomialLines
from synth.solver.resolved_density import resolved_density
from synth.solver.switching_lines import SwitchingLines
from synth.solver.tabulate import UNPREDICTED, lines_of, prediction_of, tabulate
from tuning_tables import ControllerTable, Decisions


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
