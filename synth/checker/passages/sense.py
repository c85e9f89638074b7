"""What a table for point sensors must fulfil beside its form, and whether its claims agree with one another."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import Final

from synth.checker.document_shape import origin_faults
from synth.checker.float32 import is_float32
from synth.checker.passages.table import PassageTable, passages_heard, wanted

PATH_ERROR_M: Final = 1e-6
PLAUSIBLE_SPEED_M_S: Final = 30.0
RANGES: Final = {
    ("sensors", "base_m"): (0.05, 1.0),
    ("sensors", "base_tolerance"): (0.0, 0.2),
    ("sensors", "timer_noise_s"): (0.0, 0.05),
    ("sensors", "timer_resolution_s"): (0.0, 0.05),
    ("sensors", "computing_delay_s"): (0.0, 2.0),
    ("sensors", "scan_period_s"): (0.001, 0.5),
    ("approach", "length_m"): (0.001, 100.0),
    ("plausible", "acceleration_m_s2"): (0.001, 10.0),
    ("plausible", "deceleration_m_s2"): (0.001, 10.0),
    ("plausible", "speed_tolerance"): (0.0, 0.9),
    ("plausible", "path_tolerance_m"): (0.0, 10.0),
}
"""Allowed numbers, by section and key."""


def sense(table: PassageTable) -> Iterator[str]:
    """Every way in which the table makes no sense."""
    yield from purpose_faults(table)
    yield from number_faults(table)
    yield from passage_faults(table)
    yield from row_faults(table)
    yield from deed_faults(table)


def purpose_faults(table: PassageTable) -> Iterator[str]:
    """Faults of what it says that it is for."""
    document = table.document
    zones = [edge for zone in document["retarder"]["zones_m"] for edge in zone]
    if zones[0] != 0.0 or any(not a < b for a, b in pairwise(zones)):
        yield "its zones do not follow one another from 0"
    offsets = table.axle_offsets_m
    if offsets[0] != 0.0 or any(not a < b for a, b in pairwise(offsets)):
        yield f"its axle offsets {offsets} do not rise from 0"
    last_m = zones[-1] + offsets[-1]
    if abs(table.exit_m - last_m) > PATH_ERROR_M:
        yield f"its exit is at {table.exit_m:g} m, but the last axle leaves the last zone at {last_m:g} m"
    if not document["cut"]["mass_t"] > 0.0 or not document["retarder"]["dead_band_kpa"] >= 0.0:
        yield "its mass or its dead band is impossible"
    pressures = table.pressures_kpa
    if pressures[0] < 0.0 or any(not a < b for a, b in pairwise(pressures)):
        yield f"its stage pressures {pressures} do not rise from 0 or more"
    low, high = document["valid_v_m_s"]
    if not 0.0 <= low < table.target_m_s < high:
        yield f"its target of {table.target_m_s:g} m/s is not within its valid speeds, {low:g} to {high:g} m/s"
    yield from origin_faults(document)


def number_faults(table: PassageTable) -> Iterator[str]:
    """Faults of sensors, approach and limits."""
    document, top = table.document, len(table.pressures_kpa) - 1
    for (section, key), (low, high) in RANGES.items():
        if not low <= document[section][key] <= high:
            yield f"its {section}.{key} of {document[section][key]:g} is not within {low:g} to {high:g}"
    base = document["sensors"]["base_m"]
    sections = [b - a for a, b in pairwise(table.sensors_m)]
    if not -100.0 <= table.sensors_m[0] < table.sensors_m[-1] + 1.0 <= 501.0 or len(table.sensors_m) > 32:
        yield f"its sensors at {table.sensors_m} m are too many or out of the track"
    if any(length < 0.3 - 1e-9 or length <= base for length in sections):  # 1.2 - 0.9 is less than 0.3
        yield f"two of its sensors at {table.sensors_m} m are too near each other"
    approach = document["approach"]
    if approach["length_m"] != -table.sensors_m[0]:
        yield f"its approach of {approach['length_m']:g} m does not begin at the first sensor, {table.sensors_m[0]:g} m"
    first, most = document["initial_stage"], approach["entrance_stage"]
    if not 0 <= first <= most <= top:
        yield f"its stages {first} and {most} before the entrance are impossible"
    slow, fast = document["plausible"]["speed_m_s"]
    if not 0.01 <= slow < fast <= 40.0:
        yield f"its credible speeds, {slow:g} to {fast:g} m/s, are impossible"


def passage_faults(table: PassageTable) -> Iterator[str]:
    """Whether the passages are those of sensors and axles before the exit."""
    axles = table.axle_offsets_m if table.every_axle else table.axle_offsets_m[:1]
    due = [each for each in passages_heard(table.sensors_m, axles) if each[0] < table.exit_m - 1e-9]
    if len(due) != len(table.passages):
        yield f"it has {len(table.passages)} passages, but its sensors and axles give {len(due)} before the exit"
        return
    for index, (passage, (path_m, sensor, axle)) in enumerate(zip(table.passages, due, strict=True)):
        if (passage.sensor, passage.axle) != (sensor, axle) or abs(passage.path_m - path_m) > PATH_ERROR_M:
            yield f"passage {index} must be of axle {axle} over sensor {sensor} at {path_m:g} m"
            return
    if any(after.path_m < before.path_m for before, after in pairwise(table.passages)):
        yield "its passages are not in the order of the path"


def row_faults(table: PassageTable) -> Iterator[str]:
    """Rows that are no float32 numbers or out of order; of each passage the first."""
    for index, passage in enumerate(table.passages):
        for k, row in enumerate(passage.rows):
            told = f"passage {index}, stage {k}"
            odd = [speed for speed in row if not math.isinf(speed) and not (is_float32(speed) and speed >= 0.0)]
            if odd:
                yield f"{told}: {odd[0]!r} is no float32 number of 0 or more"
                break
            if any(after < before for before, after in pairwise(row)):
                yield f"{told}: its switching speeds fall"
                break
            if 0 < k < len(row) and not row[k - 1] < row[k]:
                yield f"{told}: the rule would want to lower and to raise at {row[k]:g} m/s"
                break


def deed_faults(table: PassageTable) -> Iterator[str]:
    """Whether the table ever does something: brakes a fast cut, releases a slow one."""
    low, high = table.document["valid_v_m_s"]
    top = len(table.pressures_kpa) - 1
    places = range(len(table.passages))
    if not any(wanted(table, index, 0, high) > 0 for index in places):
        yield f"at no passage is the brake applied, not even at {high:g} m/s"
    if not any(wanted(table, index, top, low) < top for index in places):
        yield f"at no passage is the highest stage left, not even at {low:g} m/s"
    speeds = [v for passage in table.passages for row in passage.rows for v in row if not math.isinf(v)]
    if speeds and min(speeds) > PLAUSIBLE_SPEED_M_S:
        yield f"all its switching speeds lie above {PLAUSIBLE_SPEED_M_S:g} m/s"
