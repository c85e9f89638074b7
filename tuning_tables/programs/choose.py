"""Which table of a book serves a cut, and what lies between two tables.

Candidates are the tables of the cut's category and number of axles; of several masses the largest. The command equal to
a target: that table. Between two targets: what lies between the two tables, if they are of one family, else the table
of the next target below the command: the cut never leaves faster than commanded. Below all targets, or
no number: no table.
"""

from __future__ import annotations

from typing import Annotated, Any, Final, NamedTuple

import numpy as np
import numpy.typing as npt

from tuning_tables.language.records import reading, real, whole
from tuning_tables.programs.held import LARGEST_NUMBER, MINUS_ONE, NOUGHT, Answer, LineTable, f32

TUNED: Final = 0
BETWEEN: Final = 1
SLOWER: Final = 2
NO_CLASS: Final = -1
NO_TARGET: Final = -2
"""How a choice ends: a table for this very speed; between two tables; the next slower one; no table of the category and
number of axles; no number, or below the lowest target, where every table would let the cut out too fast."""


class Tables(NamedTuple):
    """What the choice looks at of every table of a book."""

    category: Annotated[npt.NDArray[Any], whole("number of the weight category", "tables")]
    axles: Annotated[npt.NDArray[Any], whole("of the cut", "tables")]
    mass_t: Annotated[npt.NDArray[np.float32], real("of the cut, t", "tables")]
    target_m_s: Annotated[npt.NDArray[np.float32], real("exit speed aimed at, m/s", "tables")]


def choose(
    tables: Tables,
    category: Annotated[int, whole("number of the weight category")],
    axles: Annotated[int, whole("of the cut")],
    commanded_m_s: Annotated[Any, reading("exit speed wanted, m/s")],
) -> Answer:
    """How the choice ends, and the numbers of the next slower and the next faster table, -1 for none."""
    status = NO_CLASS
    slower = -1
    faster = -1
    slower_m_s = NOUGHT
    faster_m_s = NOUGHT
    heaviest = MINUS_ONE
    number = 0
    while number < tables.category.shape[0]:
        if tables.category[number] == category and tables.axles[number] == axles:
            status = NO_TARGET
            if tables.mass_t[number] > heaviest:
                heaviest = tables.mass_t[number]
                slower = -1
                faster = -1
            if tables.mass_t[number] >= heaviest:
                target = tables.target_m_s[number]
                # A later table of equal target does not replace an earlier one.
                if target <= commanded_m_s:
                    if slower < 0 or target > slower_m_s:
                        slower = number
                        slower_m_s = target
                elif faster < 0 or target < faster_m_s:
                    faster = number
                    faster_m_s = target
        number = number + 1
    # Every target is above 0, and so is a command that is not below one; no comparison with a NaN is true.
    if slower >= 0 and commanded_m_s <= LARGEST_NUMBER:
        status = SLOWER
        if slower_m_s >= commanded_m_s:
            status = TUNED
        elif faster >= 0:
            status = BETWEEN
    return status, slower, faster


def blend(
    table: LineTable, faster: LineTable, commanded_m_s: Annotated[Any, reading("exit speed wanted, m/s")]
) -> Answer:
    """The lines between two tables, in place of those of the slower one, and whether there are any: there are none, and
    the table stays as it is, unless both tables are of one family and the speed is between their targets.

    Every coefficient is low + w (high - low), w the part of the way from one target to the other: each line lies
    between its neighbours everywhere, and the lower below the upper.
    """
    is_between = table.family_no == faster.family_no and table.target_m_s < commanded_m_s < faster.target_m_s
    if is_between:
        span = faster.target_m_s - table.target_m_s
        weight = (f32(commanded_m_s) - table.target_m_s) / span
        stage = 0
        while stage < table.coefficient.shape[0]:
            side = 0
            while side < 2:
                power = 0
                while power < table.coefficient.shape[2]:
                    low = table.coefficient[stage, side, power]
                    rise = weight * (faster.coefficient[stage, side, power] - low)
                    table.coefficient[stage, side, power] = low + rise
                    power = power + 1
                slope = table.slope[stage, side]
                steeper = weight * (faster.slope[stage, side] - slope)
                table.slope[stage, side] = slope + steeper
                side = side + 1
            stage = stage + 1
    return is_between
