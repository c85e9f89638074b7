"""An aim table as Python asks it; the rule itself is `programs.aim_speed`."""

from __future__ import annotations

import numpy as np

from tuning_tables.aim.aim_table import AimTable
from tuning_tables.programs.aim_speed import exit_speed


def aim_exit_speed(
    table: AimTable, cars: int, free_distance_m: float, resistance_n_per_kn: float | None = None
) -> float | None:
    """The exit speed in m/s, a float32 number, for a cut of so many cars; None where the table has no answer.

    `resistance_n_per_kn`: as measured; a table by category alone does not look at it, one by measured resistance has no
    answer without. Raises `TypeError` where `cars` is no whole number.
    """
    if not isinstance(cars, int | np.integer) or isinstance(cars, bool):
        raise TypeError(f"cars is {cars!r:.60}, but a cut has a whole number of cars.")
    with np.errstate(over="ignore"):  # what overflows gets no answer
        distance = np.float32(free_distance_m)
        resistance = np.float32(np.nan if resistance_n_per_kn is None else resistance_n_per_kn)
    speed = exit_speed(table.held, int(cars), distance, resistance)
    return float(speed) if speed >= 0.0 else None
