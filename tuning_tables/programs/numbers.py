"""Numbers that several rules name, and the kinds of their parameters."""

from __future__ import annotations

from typing import Annotated, Any, Final, TypeAlias

import numpy as np

from tuning_tables.language.records import reading, real, whole

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
