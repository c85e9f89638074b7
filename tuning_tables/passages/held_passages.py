"""What a controller holds of a table for point sensors: the value that the programs take."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from tuning_tables.held_table import read_only
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.programs.passage_table import HeldPassages

LIMITS = ("least_m_s", "greatest_m_s", "acceleration_m_s2", "deceleration_m_s2", "speed_tolerance", "path_tolerance_m")
"""The members that are limits of the tracker, as `PassageTable.limits` and `PlausibleMotion.numbers` have them."""

LARGEST = np.finfo(np.float32).max


def held_passages(
    switching_m_s: npt.NDArray[np.floating],
    path_m: npt.NDArray[np.floating],
    sensor: npt.NDArray[np.integer],
    deciding: npt.NDArray[np.integer],
    limits: Sequence[float] | npt.NDArray[np.floating],
    *,
    base_m: float = 0.0,
    entrance_stage: int = 0,
    before_entrance: int = 0,
) -> HeldPassages:
    """The table of these parts; arrays become read-only. What no rule looks at is 0.

    switching_m_s (M, K + 1, K); path_m, sensor, deciding (T,) as `PassageTable` has them of all passages heard. An
    infinite switching speed becomes the largest number of its sign: no credible reading is beyond either.
    """
    numbers: dict[str, Any] = {name: np.float32(limit) for name, limit in zip(LIMITS, limits, strict=True)}
    return HeldPassages(
        category=0,
        axles=0,
        stages=switching_m_s.shape[1],
        heard=len(path_m),
        passages=len(switching_m_s),
        before_entrance=before_entrance,
        entrance_stage=entrance_stage,
        initial_stage=0,
        mass_t=np.float32(0.0),
        target_m_s=np.float32(0.0),
        base_m=np.float32(base_m),
        scan_period_s=np.float32(0.0),
        computing_delay_s=np.float32(0.0),
        **numbers,
        path_m=read_only(path_m, np.float32),
        sensor=read_only(sensor, np.int64),
        deciding=read_only(deciding, np.int64),
        switching_m_s=read_only(np.clip(switching_m_s, -LARGEST, LARGEST), np.float32),
    )


def held_by(table: PassageTable) -> HeldPassages:
    """The table as a controller holds it; its category is 0, as not every one has a number."""
    return held_passages(
        table.switching_m_s, table.heard_path_m, table.heard_sensor, table.heard_passage, table.limits,
        base_m=table.sensors.base_m, entrance_stage=table.entrance_stage, before_entrance=table.before_entrance,
    )._replace(
        axles=len(table.cut.axle_offsets_m),
        initial_stage=table.initial_stage,
        mass_t=np.float32(table.cut.mass_t),
        target_m_s=np.float32(table.target_speed_m_s),
        scan_period_s=np.float32(table.sensors.scan_period_s),
        computing_delay_s=np.float32(table.sensors.computing_delay_s),
    )  # fmt: skip
