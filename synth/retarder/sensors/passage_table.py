"""A table for point sensors from tuned switching speeds."""

from __future__ import annotations

import numpy as np

from plant_models import Plant, PointSensors, every_axle
from plant_models.credible_motion import credible_motion
from plant_models.point_sensors import deciding_passages
from synth.retarder.sensors.tuned_passages import TunedPassages
from synth.solver.tabulate import LOWEST_VALID_SPEED_M_S, cut_of, prediction_of, retarder_of
from tuning_tables import Generator
from tuning_tables.approach import Approach
from tuning_tables.passages.passage_row import PassageRow
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.plausible_motion import PlausibleMotion
from tuning_tables.passages.sensor_layout import DecidesOn, SensorLayout

ABOVE_FASTEST_M_S = 2.0
"""Speeds are valid up to so much more than the position takes."""


def passage_table(tuned: TunedPassages, generator: Generator, table_id: str, created: str) -> PassageTable:
    """The table to export, predicted and not yet validated. Raises `tuning_tables.InvalidTable`."""
    plant, sensors = tuned.plant, tuned.sensors
    position = plant.position
    highest = float(np.ceil(position.max_entry_speed_m_s + ABOVE_FASTEST_M_S))
    met = deciding_passages(sensors, plant.cut, plant.exit_m)
    rows = with_forbidden_stages(tuned.speeds.switching_m_s, position.top_stage, highest)
    return PassageTable(
        id=table_id,
        created=created,
        generator=generator,
        retarder=retarder_of(plant),
        cut=cut_of(plant),
        target_speed_m_s=float(tuned.aim.target_speed_m_s),
        pressure_kpa=tuple(float(pressure) for pressure in position.stage_pressures_kpa),
        sensors=layout_of(sensors),
        approach=Approach(float(-plant.start_m), plant.entrance_stage),
        initial_stage=plant.approach.initial_stage,
        passages=tuple(
            PassageRow(each.sensor, each.axle, float(each.path_m), tuple(tuple(map(float, row)) for row in speeds))
            for each, speeds in zip(met, rows, strict=True)
        ),
        plausible=plausible_motion(plant, sensors),
        valid_v_m_s=(LOWEST_VALID_SPEED_M_S, highest),
        predicted=prediction_of(tuned.predicted, tuned.aim.target_speed_m_s),
    )


def with_forbidden_stages(switching_m_s: np.ndarray, top: int, highest_m_s: float) -> np.ndarray:
    """Rows of all stages 0 … `top` of the position, (M, top + 1, top), from those that the cut may use.

    A stage that it may not use is never entered, and is left for the highest allowed one at once.
    """
    passages, stages, used = switching_m_s.shape
    rows = np.full((passages, top + 1, top), np.inf)
    rows[:, :stages, :used] = switching_m_s
    for stage in range(stages, top + 1):
        rows[:, stage, :used] = switching_m_s[:, stages - 1]
        rows[:, stage, used:stage] = np.float32(highest_m_s + 1.0)
    return rows


def layout_of(sensors: PointSensors) -> SensorLayout:
    """The sensors as a table tells them."""
    return SensorLayout(
        path_m=tuple(float(place) for place in sensors.path_m),
        base_m=sensors.base_m,
        base_tolerance=sensors.base_tolerance,
        timer_noise_s=sensors.timer_noise_s,
        timer_resolution_s=sensors.timer_resolution_s,
        computing_delay_s=sensors.computing_delay_s,
        scan_period_s=sensors.scan_period_s,
        decides_on=DecidesOn.EVERY_AXLE if sensors.axles is every_axle else DecidesOn.FIRST_AXLE,
    )


def plausible_motion(plant: Plant, sensors: PointSensors) -> PlausibleMotion:
    """The limits of the tracker, as a table holds them."""
    limits = credible_motion(plant, sensors)
    return PlausibleMotion(
        limits.speed_m_s,
        limits.acceleration_m_s2,
        limits.deceleration_m_s2,
        limits.speed_tolerance,
        limits.path_tolerance_m,
    )
