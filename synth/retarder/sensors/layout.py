"""Where point sensors stand: equal sections, and the rule that a change of stage ends inside its section."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from plant_models import Plant, PointSensors
from plant_models.stage_regulator import stage_locked_actuator

LAST_SECTION_M = 0.5
"""No sensor that decides stands nearer to the exit."""

BEHIND_EXIT_M = 1.0
"""The sensor that logs the exit speed stands so far behind the exit."""


def longest_change_s(plant: Plant, sensors: PointSensors) -> float:
    """Time from the second pulse until the longest change of stage has ended."""
    actuator = stage_locked_actuator(plant.position, sensors, plant.top_stage, 1)
    return float(actuator.chain_samples.max()) * sensors.scan_period_s


def fastest_m_s(plant: Plant, target_speed_m_s: float, path_m: float, share: float) -> float:
    """Speed at `path_m` of a cut at the quantile `share` of entry, slowed down evenly to its target at the exit."""
    entry = float(plant.entry.speed_m_s(np.array([share]))[0])
    part = min(max(path_m / plant.exit_m, 0.0), 1.0)
    return math.sqrt(entry**2 + (min(target_speed_m_s, entry) ** 2 - entry**2) * part)


def rule_layout(plant: Plant, sensors: PointSensors, target_speed_m_s: float, share: float = 0.99) -> tuple[float, ...]:
    """Places of the deciding sensors by zhukovitsky-2012: each section as long as the longest change of stage needs.

    The speed at the beginning of a section is that of `fastest_m_s`; so the share of passages that find a change
    unfinished is less than 1 − `share` as far as cuts slow down evenly. The first section ends at the entrance.
    """
    time_s = longest_change_s(plant, sensors)
    place = -fastest_m_s(plant, target_speed_m_s, 0.0, share) * time_s - 0.5 * sensors.base_m
    places = []
    while place < plant.exit_m - LAST_SECTION_M:
        places.append(round(place, 3))
        length = fastest_m_s(plant, target_speed_m_s, place, share) * time_s
        place = max(place + length + 0.5 * sensors.base_m, 0.0 if place < 0.0 else place)
    return tuple(places)


def first_sensor_m(plant: Plant, sensors: PointSensors, target_speed_m_s: float) -> float:
    """Place of the first sensor by the rule: its command is in force when the first axle enters."""
    return rule_layout(plant, sensors, target_speed_m_s)[0]


def equal_layout(first_m: float, exit_m: float, count: int) -> tuple[float, ...]:
    """`count` deciding sensors: one at `first_m`, the others at equal sections from the entrance to the exit."""
    behind = np.arange(count - 1) * (exit_m / max(count - 1, 1))
    return (round(first_m, 3), *(round(float(place), 3) for place in behind))


def with_layout(sensors: PointSensors, deciding_m: tuple[float, ...], exit_m: float) -> PointSensors:
    """Sensors at the deciding places, and the last one behind the exit, which logs."""
    return replace(sensors, path_m=(*deciding_m, round(exit_m + BEHIND_EXIT_M, 3)))
