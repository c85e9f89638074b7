"""An aim table as Python asks it; the rule itself is `programs.aim_speed`."""

from __future__ import annotations

import numpy as np

from tuning_tables.aim.aim_table import AimTable
from tuning_tables.programs.aim_speed import exit_speed


def aim_exit_speed(
    table: AimTable, cars: int, free_distance_m: float, resistance_n_per_kn: float | None = None
) -> float | None:
    """Ask an aim table for a cut.

    Parameters
    ----------
    table
        The table of the category of the cut, and of what is known of it.
    cars
        Number of its cars.
    free_distance_m
        From the head of the cut to the standing cars, when its last axle leaves the position, m.
    resistance_n_per_kn
        Its rolling resistance as measured, N/kN. A table by category alone does not look at it; one by measured
        resistance has no answer without.

    Returns
    -------
    float or None
        The exit speed to command, m/s, a float32 number; None where the table has no answer.

    Raises
    ------
    TypeError
        `cars` is no whole number.

    Examples
    --------
    With `table` from the example of `AimTable`:

    >>> from tuning_tables.aim import aim_exit_speed
    >>> aim_exit_speed(table, cars=1, free_distance_m=200.0)
    2.0
    >>> aim_exit_speed(
    ...     table, cars=1, free_distance_m=50.0
    ... ) is None  # nearer than the table knows
    True
    """
    if not isinstance(cars, int | np.integer) or isinstance(cars, bool):
        raise TypeError(f"cars is {cars!r:.60}, but a cut has a whole number of cars.")
    with np.errstate(over="ignore"):  # what overflows gets no answer
        distance = np.float32(free_distance_m)
        resistance = np.float32(np.nan if resistance_n_per_kn is None else resistance_n_per_kn)
    speed = exit_speed(table.held, int(cars), distance, resistance)
    return float(speed) if speed >= 0.0 else None
