"""What a controller holds, declared once for Python, numba, C99 and Structured Text: of a table with switching
lines, of a table for point sensors, and of a cut in the retarder; and the numbers that several rules name.
"""

from __future__ import annotations

from typing import Annotated, Any, Final, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from tuning_tables.language.records import Record, reading, real, record_of, whole

f32 = np.float32
"""Rounds a reading."""

NOUGHT: Final = np.float32(0.0)
HALF: Final = np.float32(0.5)
ONE: Final = np.float32(1.0)
TWO: Final = np.float32(2.0)
MINUS_ONE: Final = np.float32(-1.0)

LARGEST_NUMBER: Final = np.finfo(np.float32).max
LEAST_NUMBER: Final = np.finfo(np.float32).min
"""A reading beyond these is infinite, or no number."""

Stage: TypeAlias = Annotated[int, whole("the stage commanded last; 0: released")]
PathReading: TypeAlias = Annotated[Any, reading("of the first axle, from the entrance of the first retarder, m")]
MeasuredSpeed: TypeAlias = Annotated[Any, reading("as measured; a missing reading is -1, m/s")]
ObservedSpeed: TypeAlias = Annotated[Any, reading("that of `observe`, m/s")]
Pressure: TypeAlias = Annotated[
    Any, reading("gauge pressure in the cylinders; no number (NaN): the gauge is silent, kPa")
]
Overpressure: TypeAlias = Annotated[Any, reading("mean of max(0, P - touch pressure) since the sample before, kPa")]
Path: TypeAlias = Annotated[Any, real("path, m")]
Speed: TypeAlias = Annotated[Any, real("speed, m/s")]
"""Numbers that are rounded already."""

Answer: TypeAlias = Any
"""What a rule gives: the kinds follow from its text."""


Floats = npt.NDArray[np.float32]
Whole = npt.NDArray[Any]

LOWER, UPPER = 0, 1
"""The two lines of a stage."""


class LineTable(NamedTuple):
    """One table of switching lines. Closed: `select` fills it.

    Python holds it with the arrays of a table as they are; a controller with room for the largest table of its book.
    """

    category: Annotated[int, whole("number of the weight category")]
    axles: Annotated[int, whole("of the cut")]
    family_no: Annotated[int, whole("tables of one family of a book differ in nothing but target and lines")]
    stages: Annotated[int, whole("stages 0 to stages - 1; 0: no table")]
    powers: Annotated[int, whole("coefficients of a line: its degree + 1")]
    at_any_time: Annotated[int, whole("1: decides at every sample; 0: only at rest, the pressure of the stage reached")]
    entrance_stage: Annotated[int, whole("highest stage that may be commanded before the entrance")]
    mass_t: Annotated[np.float32, real("of the cut, t")]
    target_m_s: Annotated[np.float32, real("exit speed aimed at, m/s")]
    path_min_m: Annotated[np.float32, real("the path is clamped into this range, m")]
    path_max_m: Annotated[np.float32, real("m")]
    approach_m: Annotated[np.float32, real("acts from so far before the entrance, m; 0: from the entrance on")]
    sample_period_s: Annotated[np.float32, real("from sample to sample, s; with another the table is not valid")]
    computing_delay_s: Annotated[np.float32, real("from the sample to the command on the wires of the valves, s")]
    touch_kpa: Annotated[np.float32, real("pressure above which cylinders brake, kPa; 0 without estimator")]
    has_line: Annotated[Whole, whole("1 where the stage has a lower, an upper line", "stages", 2)]
    coefficient: Annotated[
        Floats, real("of lower and upper line, ascending powers, m/s per m^power", "stages", 2, "powers")
    ]
    has_gauge: Annotated[int, whole("1: the lines depend on the pressure", part="gauge")]
    highest_kpa: Annotated[np.float32, real("of the highest stage that the table raises to, kPa", part="gauge")]
    pressure_kpa: Annotated[Floats, real("of the stages, kPa", "stages", part="gauge")]
    slope: Annotated[Floats, real("of lower and upper line over the pressure, m/s per kPa", "stages", 2, part="gauge")]
    breaks: Annotated[int, whole("of the estimator's work; 0: no estimator", part="breaks")]
    speed_variance: Annotated[np.float32, real("of a measured speed, m2/s2", part="breaks")]
    factor_variance: Annotated[np.float32, real("of the friction factor of cuts", part="breaks")]
    path_variance: Annotated[np.float32, real("of the friction along the path, times its length, m", part="breaks")]
    excess_variance: Annotated[np.float32, real("of the excess resistance of cuts, m2/s4", part="breaks")]
    leap_m_s: Annotated[np.float32, real("between two readings, what noise cannot explain, m/s", part="breaks")]
    frozen: Annotated[np.float32, real("repetitions of a reading of a frozen sensor", part="breaks")]
    doubted: Annotated[np.float32, real("doubted readings after which the estimate begins anew", part="breaks")]
    lost_variance: Annotated[np.float32, real("of the speed, beyond which the cut is lost, m2/s2", part="breaks")]
    caution: Annotated[np.float32, real("of the answer for a lost cut, s/m", part="breaks")]
    unlikely: Annotated[
        np.float32, real("deviation of the friction factor that no cut of the category has", part="breaks")
    ]
    place_m: Annotated[Floats, real("breaks of the path, m", "breaks", part="breaks")]
    drive: Annotated[Floats, real("work of grade and resistance up to a break, m2/s2", "breaks", part="breaks")]
    brake: Annotated[
        Floats, real("work of the brake for each kPa up to a break, m2/s2 per kPa", "breaks", part="breaks")
    ]


LINE_TABLE = record_of(LineTable)


(
    BEGUN, PATH_M, SPEED_M_S, FACTOR, EXCESS, SPEED_VARIANCE, FACTOR_COVARIANCE, EXCESS_COVARIANCE, FACTOR_VARIANCE,
    CROSS_COVARIANCE, EXCESS_VARIANCE, UNSEEN, READING_M_S, REPEATED, BELIEVED, DOUBTED,
) = range(16)  # fmt: skip

ESTIMATE: Final = Record(
    "estimate",
    "What is known of the cut in the retarder. Closed: all 0 before its first sample, one for each cut.",
    {
        "begun": real("0: no speed was measured yet; 1"),
        "path_m": real("of the last sample, m"),
        "speed_m_s": real("m/s"),
        "factor": real("of the friction of this cut"),
        "excess": real("of its running resistance over the mean, m/s2"),
        "speed_variance": real("m2/s2"),
        "factor_covariance": real("of speed and factor"),
        "excess_covariance": real("of speed and excess"),
        "factor_variance": real("of the factor"),
        "cross_covariance": real("of factor and excess"),
        "excess_variance": real("of the excess"),
        "unseen": real("samples since the last reading that was believed"),
        "reading_m_s": real("the last that can be true, m/s"),
        "repeated": real("how often it was the same again"),
        "believed": real("readings since the estimate began"),
        "doubted": real("readings in a row"),
    },
    is_state=True,
)

Estimate: TypeAlias = Annotated[npt.NDArray[np.float32], ESTIMATE]
"""float32 (16,)."""


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
