"""The members of a table for point sensors in Structured Text: their names, and the values of a table."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from tuning_tables.passages.passage_block import PassageBlockSize, finite_speeds
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.st_literals import LONGEST_ARRAY

NUMBERS: Final = (
    "Target_m_s", "Base_m", "Least_m_s", "Greatest_m_s", "Acceleration_m_s2", "Deceleration_m_s2", "SpeedTolerance",
    "PathTolerance_m",
)  # fmt: skip
COUNTS: Final = ("Stages", "Heard", "Passages", "BeforeEntrance", "EntranceStage", "InitialStage")


def numbers_of(table: PassageTable) -> npt.NDArray[np.float32]:
    """The numbers of a table in the order of `NUMBERS`."""
    return np.array([table.target_speed_m_s, table.sensors.base_m, *table.limits], dtype=np.float32)


def counts_of(table: PassageTable) -> tuple[int, ...]:
    """The whole numbers of a table in the order of `COUNTS`."""
    sizes = (len(table.pressure_kpa), len(table.heard_path_m), len(table.passages))
    return (*sizes, table.before_entrance, table.entrance_stage, table.initial_stage)


def arrays_of(
    table: PassageTable, size: PassageBlockSize
) -> Iterator[tuple[str, npt.NDArray[np.float32] | npt.NDArray[np.int64]]]:
    """The arrays of a table by their members, switching speeds with room for all stages of the export."""
    passages, stages = len(table.passages), len(table.pressure_kpa)
    speeds = np.zeros((passages, size.stages, size.stages - 1), dtype=np.float32)
    speeds[:, :stages, : stages - 1] = finite_speeds(table)
    yield "Path_m", table.heard_path_m
    yield "Sensor", table.heard_sensor
    yield "Deciding", table.heard_passage
    yield "Switching_m_s", speeds.ravel()


def parts_of(values: npt.NDArray[Any]) -> Iterator[tuple[int, int, npt.NDArray[Any]]]:
    """(number, first index, values) of the pieces, none longer than a constant array may be."""
    for part, start in enumerate(range(0, len(values), LONGEST_ARRAY)):
        yield part, start, values[start : start + LONGEST_ARRAY]
