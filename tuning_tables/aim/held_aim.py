"""What a controller holds of an aim table, from its parts: the value that `programs.aim_speed` takes."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from tuning_tables.aim.axes import AimAxes
from tuning_tables.aim.purpose import FASTEST_M_S
from tuning_tables.held_table import read_only
from tuning_tables.programs.aim_table import AimGrid

NO_ANSWER = np.float32(-1.0)


def aim_grid(
    axes: AimAxes,
    exit_speed_m_s: npt.NDArray[np.float64],
    bounds_m_s: tuple[float, float] = (0.0, FASTEST_M_S),
    category: int = 0,
    p_overspeed: float = 0.0,
    coupling_m_s: float = 0.0,
) -> AimGrid:
    """The exit speeds at the nodes of `axes`, in their shape, NaN for none. Raises `ValueError`."""
    if exit_speed_m_s.shape != axes.shape:
        raise ValueError(f"aim: speeds have the shape {exit_speed_m_s.shape}, their axes {axes.shape}")
    if (exit_speed_m_s < 0.0).any():
        raise ValueError("aim: an exit speed is below 0, which would stand for none")
    resistance = axes.resistance_n_per_kn
    columns = np.zeros(1) if resistance is None else resistance
    speeds = exit_speed_m_s.astype(np.float32).reshape(*axes.shape[:2], -1)
    return AimGrid(
        category=category,
        is_measured=int(resistance is not None),
        listed=len(axes.cars),
        distances=len(axes.free_distance_m),
        resistances=len(columns),
        p_overspeed=np.float32(p_overspeed),
        coupling_m_s=np.float32(coupling_m_s),
        lowest_m_s=np.float32(bounds_m_s[0]),
        highest_m_s=np.float32(bounds_m_s[1]),
        cars=read_only(axes.cars, np.int32),
        distance_m=read_only(axes.free_distance_m, np.float32),
        resistance_n_per_kn=read_only(columns, np.float32),
        speed_m_s=read_only(np.where(np.isnan(speeds), NO_ANSWER, speeds), np.float32),
    )
