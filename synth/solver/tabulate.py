"""From polynomial lines to the table that a controller loads: rounded, ordered, with origin and prediction."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from plant_models import Plant
from plant_models.frozen_arrays import Bools, Floats
from synth.problem.problem import OVERSPEED_M_S
from synth.solver.exit_density import ExitDensity
from synth.solver.switching_lines import PolynomialLines, SwitchingLines
from tuning_tables import (
    Approach,
    ControllerTable,
    CutId,
    Decisions,
    Estimator,
    Generator,
    Predicted,
    RegulatorClock,
    RetarderId,
    Stage,
    ValidRange,
)
from tuning_tables.stage import round_coefficients

if TYPE_CHECKING:  # who asks a table for its lines needs no kernels
    from synth.solver.any_time.drive_modes import DriveModes
    from synth.solver.any_time.polynomial_surfaces import PolynomialSurfaces

LOWEST_VALID_SPEED_M_S = 0.3

UNPREDICTED = Predicted(0.0, 0.0, 0.0, 0.0)
"""Stands in a table that is about to be predicted: only a rounded table can be."""


def tabulate(
    plant: Plant, lines: PolynomialLines | PolynomialSurfaces, target_speed_m_s: float, predicted: Predicted,
    generator: Generator, table_id: str, created: str, estimator: Estimator | None = None,
) -> ControllerTable:  # fmt: skip
    """The exported table, with `estimator` for the estimated speed; of surfaces, for commands at any time.

    A stage that the cut may not use has a lower line above every speed: leave it at once.

    Raises `tuning_tables.InvalidTable` if rounding to float32 would let a pair of lines touch.
    """
    position = plant.position
    highest = max(9.0, float(np.ceil(position.max_entry_speed_m_s + 2.0)))
    if isinstance(lines, PolynomialLines):
        decisions, path_lines, slopes = Decisions.AT_REST, lines, None
    else:
        decisions, path_lines = Decisions.AT_ANY_TIME, lines.at_stage_pressures()
        slopes = lines.slopes_m_s_per_kpa() if lines.has_slopes else None
    powers = path_lines.powers_of_s()
    stages = []
    for k, pressure in enumerate(map(float, position.stage_pressures_kpa)):
        if k < len(powers):
            stages.append(
                rounded_stage(k, pressure, powers[k], lines.has_line[k], None if slopes is None else slopes[k])
            )
        else:
            leave = round_coefficients([highest + 1.0] + [0.0] * path_lines.degree)
            stages.append(Stage(k, pressure, leave, None, None if slopes is None else 0.0))
    return ControllerTable(
        id=table_id,
        created=created,
        generator=generator,
        retarder=retarder_of(plant),
        cut=cut_of(plant),
        target_speed_m_s=float(target_speed_m_s),
        clock=clock_of(plant),
        degree=path_lines.degree,
        stages=tuple(stages),
        valid=ValidRange((float(plant.start_m), float(plant.exit_m)), (LOWEST_VALID_SPEED_M_S, highest)),
        predicted=predicted,
        estimator=estimator,
        approach=approach_of(plant),
        decisions=decisions,
    )


def rounded_stage(k: int, pressure_kpa: float, powers: Floats, has_line: Bools, slopes: Floats | None) -> Stage:
    """Stage `k` with the lines, (2, r + 1), that it has, and their slopes (2,), as float32 numbers."""
    lower, upper = (round_coefficients(line) if here else None for line, here in zip(powers, has_line, strict=True))
    if slopes is None:
        return Stage(k, pressure_kpa, lower, upper)
    steep = (round_coefficients([slope])[0] if here else None for slope, here in zip(slopes, has_line, strict=True))
    return Stage(k, pressure_kpa, lower, upper, *steep)


def retarder_of(plant: Plant) -> RetarderId:
    """What a table says of the position that it is for."""
    position = plant.position
    return RetarderId(position.name, position.zones_m, float(plant.exit_m), float(position.pneumatics.dead_band_kpa))


def cut_of(plant: Plant) -> CutId:
    """What a table says of the cuts that it is for."""
    cut = plant.cut
    return CutId(cut.category, float(cut.mass_t), cut.axle_offsets_m, cut.category_number)


def clock_of(plant: Plant) -> RegulatorClock:
    """What a table says of the clock of its regulator."""
    return RegulatorClock(float(plant.sensor.sample_period_s), float(plant.sensor.computing_delay_s))


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


def surfaces_of(table: ControllerTable, nodes_m: Floats, modes: DriveModes) -> Floats:
    """The table's surfaces by side, path node and mode, (2, N, M), from its float32 numbers; ±inf as in `lines_of`."""
    lines = lines_of(table, nodes_m)
    lowest, highest = table.pressures[0], table.pressures[table.highest_raised]
    above = np.clip(modes.pressure_kpa, lowest, highest) - table.pressures[modes.stage]
    at_stage = np.stack([lines.lower_m_s[modes.stage].T, lines.upper_m_s[modes.stage].T])
    found: Floats = at_stage + (table.slopes[modes.stage].T * above)[:, None, :]
    return found
