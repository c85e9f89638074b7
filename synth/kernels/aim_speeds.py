"""The rule of aim tables for whole arrays: compiled unchanged (`compiled_rules`)."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from synth.kernels.compiled_rules import compiled_rule
from synth.kernels.compiling import raising
from tuning_tables.programs.aim_speed import AimGrid, exit_speed

speed_by_table = compiled_rule(exit_speed)


@raising
def all_speeds(table, cars, free_distance_m, resistance_n_per_kn, speeds) -> None:
    """The answer to each question, -1 for none, into `speeds`; all arrays (n,)."""
    for place in range(len(speeds)):
        speeds[place] = speed_by_table(table, cars[place], free_distance_m[place], resistance_n_per_kn[place])


def aim_exit_speeds(
    table: AimGrid, cars: npt.ArrayLike, free_distance_m: npt.ArrayLike, resistance_n_per_kn: npt.ArrayLike = np.nan
) -> npt.NDArray[np.float32]:
    """Exit speeds in m/s, float32 of the shape that the questions broadcast to, NaN for no answer."""
    asked = (np.asarray(cars, np.int64), *(np.asarray(x, np.float64) for x in (free_distance_m, resistance_n_per_kn)))
    whole, distance, resistance = (np.ascontiguousarray(each).ravel() for each in np.broadcast_arrays(*asked))
    speeds = np.empty(len(whole), dtype=np.float32)
    all_speeds(table, whole, distance, resistance, speeds)
    return np.where(speeds < 0.0, np.float32(np.nan), speeds).reshape(np.broadcast_shapes(*(x.shape for x in asked)))
