"""What a controller holds of a table with switching lines, declared once for Python, numba, C99 and Structured Text."""

from __future__ import annotations

from typing import Annotated, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from tuning_tables.language.records import real, record_of, whole

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
