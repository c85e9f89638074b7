"""From polynomial lines to the table that a controller loads: rounded, ordered, with origin and prediction."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from plant_models import Plant
from synth.solver.exit_density import ExitDensity
from synth.solver.switching_lines import SwitchingLines
from tuning_tables import (
    Approach,
    ControllerTable,
    CutId,
    Estimator,
    Generator,
    Predicted,
    RetarderId,
    Stage,
    ValidRange,
    round_coefficients,
)

if TYPE_CHECKING:  # who asks a table for its lines needs no kernels
    from synth.solver.polynomial_lines import PolynomialLines

OVERSPEED_M_S = 0.3
"""Over-speed counted in `predicted`: exit faster than the target by more than this."""

LOWEST_VALID_SPEED_M_S = 0.3

UNPREDICTED = Predicted(0.0, 0.0, 0.0, 0.0)
"""Stands in a table that is about to be predicted: only a rounded table can be."""


def tabulate(
    plant: Plant, lines: PolynomialLines, target_speed_m_s: float, predicted: Predicted, generator: Generator,
    table_id: str, created: str, estimator: Estimator | None = None,
) -> ControllerTable:  # fmt: skip
    """The exported table, with `estimator` for the estimated speed.

    A stage that the cut may not use has a lower line above every speed: leave it at once.

    Raises `tuning_tables.InvalidTable` if rounding to float32 would let a pair of lines touch.
    """
    position = plant.position
    highest = max(9.0, float(np.ceil(position.max_entry_speed_m_s + 2.0)))
    powers = lines.powers_of_s()
    stages = []
    for k, pressure in enumerate(position.stage_pressures_kpa):
        lower: tuple[float, ...] | None
        upper: tuple[float, ...] | None
        if k < len(powers):
            lower = round_coefficients(powers[k, 0]) if lines.has_line[k, 0] else None
            upper = round_coefficients(powers[k, 1]) if lines.has_line[k, 1] else None
        else:
            lower, upper = round_coefficients([highest + 1.0] + [0.0] * lines.degree), None
        stages.append(Stage(k, float(pressure), lower, upper))
    return ControllerTable(
        id=table_id,
        created=created,
        generator=generator,
        retarder=RetarderId(
            position.name, position.zones_m, float(plant.exit_m), float(position.pneumatics.dead_band_kpa)
        ),
        cut=CutId(plant.cut.category, float(plant.cut.mass_t), plant.cut.axle_offsets_m, plant.cut.category_number),
        target_speed_m_s=float(target_speed_m_s),
        degree=lines.degree,
        stages=tuple(stages),
        valid=ValidRange((float(plant.start_m), float(plant.exit_m)), (LOWEST_VALID_SPEED_M_S, highest)),
        predicted=predicted,
        estimator=estimator,
        approach=approach_of(plant),
    )


def approach_of(plant: Plant) -> Approach | None:
    """What a table says of the path before the entrance; None where the regulator acts from the entrance on."""
    if plant.start_m == 0.0:
        return None
    return Approach(float(-plant.start_m), plant.entrance_stage)


def prediction_of(density: ExitDensity, target_speed_m_s: float) -> Predicted:
    """The figures of an exit density that a table carries."""
    return Predicted(
        rms_m_s=density.rms_m_s(target_speed_m_s),
        bias_m_s=density.bias_m_s(target_speed_m_s) + 0.0,  # no -0.0
        p_overspeed=min(density.p_overspeed(target_speed_m_s + OVERSPEED_M_S), 1.0),
        switchings=max(density.switchings, 0.0),
        p_stall=min(max(density.stalled, 0.0), 1.0),
    )


def lines_of(table: ControllerTable, nodes_m: np.ndarray) -> SwitchingLines:
    """The table's lines at path nodes, from its float32 coefficients; ±inf where it has none, or may not raise."""
    powers = np.vander(nodes_m, table.degree + 1, increasing=True)
    values = np.nan_to_num(table.coefficients.astype(np.float64)) @ powers.T
    lower = np.where(table.has_line[:, 0, None], values[:, 0], -np.inf)
    upper = np.where(table.has_line[:, 1, None], values[:, 1], np.inf)
    upper[table.entrance_stage :, nodes_m < 0.0] = np.inf
    return SwitchingLines(np.array(nodes_m, dtype=np.float64), lower, upper)
