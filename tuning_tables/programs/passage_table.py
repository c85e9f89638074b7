"""What a controller holds of a table for point sensors, declared once for Python, numba, C99 and Structured Text."""

from __future__ import annotations

from typing import Annotated, Final, NamedTuple

import numpy as np

from tuning_tables.language.records import real, record_of, whole
from tuning_tables.programs.line_table import Floats, Whole

NONE: Final = -1
"""No passage."""


class HeldPassages(NamedTuple):
    """One table for point sensors. Closed: RETARDER_SELECT_PASSAGES fills it.

    Python holds it with the arrays of a table as they are; a controller with room for the largest table of its book.
    """

    category: Annotated[int, whole("number of the weight category")]
    axles: Annotated[int, whole("of the cut")]
    stages: Annotated[int, whole("stages 0 to stages - 1; 0: no table")]
    heard: Annotated[int, whole("passages of axles over sensors, each of which gives a pair of pulses")]
    passages: Annotated[int, whole("of them, those at which is decided, numbered from 0")]
    before_entrance: Annotated[int, whole("of these, so many lie before the entrance: the first ones")]
    entrance_stage: Annotated[int, whole("highest stage that may be commanded before the entrance")]
    initial_stage: Annotated[int, whole("stage at rest when the regulator takes over a cut")]
    mass_t: Annotated[np.float32, real("of the cut, t")]
    target_m_s: Annotated[np.float32, real("exit speed aimed at, m/s")]
    base_m: Annotated[np.float32, real("distance of the two coils of a sensor, m")]
    scan_period_s: Annotated[np.float32, real("step of the clock, s; with another the table is not valid")]
    computing_delay_s: Annotated[np.float32, real("from the second pulse to the command on the wires, s")]
    least_m_s: Annotated[np.float32, real("least credible speed, m/s")]
    greatest_m_s: Annotated[np.float32, real("greatest credible speed, m/s")]
    acceleration_m_s2: Annotated[np.float32, real("greatest of a cut, m/s2")]
    deceleration_m_s2: Annotated[np.float32, real("greatest of a cut, m/s2")]
    speed_tolerance: Annotated[np.float32, real("relative error allowed of a speed")]
    path_tolerance_m: Annotated[np.float32, real("error allowed of a path, m")]
    path_m: Annotated[Floats, real("of the first axle at each passage heard, not falling, m", "heard", part="heard")]
    sensor: Annotated[Whole, whole("its number, from 0 in the order of the path", "heard", part="heard")]
    deciding: Annotated[Whole, whole("number of the passage at which is decided; -1: none", "heard", part="heard")]
    switching_m_s: Annotated[
        Floats,
        real("by passage, stage in force and threshold, m/s", "passages", "stages", "thresholds", part="passages"),
    ]


HELD_PASSAGES = record_of(HeldPassages)
