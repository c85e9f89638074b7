"""What a controller holds of an aim table, declared once, and which one of several serves a cut."""

from __future__ import annotations

from typing import Annotated, Any, Final, NamedTuple

import numpy as np
import numpy.typing as npt

from tuning_tables.language.records import flag, real, record_of, whole
from tuning_tables.programs.numbers import Answer

Floats = npt.NDArray[np.float32]
Whole = npt.NDArray[Any]


class AimGrid(NamedTuple):
    """The exit speeds of one aim table at the nodes of its axes. Closed.

    Python holds it with the axes of a table as they are; a controller with room for the largest table of its set.
    """

    category: Annotated[int, whole("number of the weight category")]
    is_measured: Annotated[
        int, whole("1: by measured resistance; 0: by category alone, the resistance is not looked at")
    ]
    listed: Annotated[int, whole("numbers of cars; 0: no table")]
    distances: Annotated[int, whole("free distances")]
    resistances: Annotated[int, whole("measured resistances; 1 by category alone")]
    p_overspeed: Annotated[np.float32, real("allowed probability of a coupling faster than coupling_m_s")]
    coupling_m_s: Annotated[np.float32, real("m/s")]
    lowest_m_s: Annotated[np.float32, real("no exit speed is less, m/s")]
    highest_m_s: Annotated[np.float32, real("none is greater, m/s")]
    cars: Annotated[Whole, whole("listed numbers of cars", "listed")]
    distance_m: Annotated[Floats, real("free distances, m", "distances")]
    resistance_n_per_kn: Annotated[Floats, real("resistances, N/kN; 0 by category alone", "resistances")]
    speed_m_s: Annotated[
        Floats,
        real("exit speeds by cars, distance and resistance, m/s; -1: no answer", "listed", "distances", "resistances"),
    ]


AIM_GRID: Final = record_of(AimGrid)


class Tables(NamedTuple):
    """What the choice looks at of every table of a set."""

    category: Annotated[Whole, whole("number of the weight category", "tables")]
    is_measured: Annotated[Whole, whole("1: by measured resistance", "tables")]


def select(
    tables: Tables,
    category: Annotated[int, whole("number of the weight category")],
    measured: Annotated[bool, flag("the table by measured resistance, else that by category alone")],
) -> Answer:
    """Once for a cut, the number of the table for its category, by measured resistance or not; -1: there is none."""
    wanted = 0
    if measured:
        wanted = 1
    table_no = -1
    number = 0
    while number < tables.category.shape[0]:
        if tables.category[number] == category and tables.is_measured[number] == wanted:
            table_no = number
        number = number + 1
    return table_no
