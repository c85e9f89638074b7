"""The axes of an aim table: for which numbers of cars, free distances and measured resistances it has nodes; and
what a controller holds of it: the value that `programs.aim_speed` takes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Final

import numpy as np
import numpy.typing as npt

from tuning_tables.aim.nodes import Nodes, nodes_of
from tuning_tables.aim.purpose import FASTEST_M_S
from tuning_tables.declared.numbers import Count, Number, Row
from tuning_tables.errors import InvalidTable
from tuning_tables.held_table import read_only
from tuning_tables.programs.aim_speed import AimGrid

MOST_CARS: Final = 1000
MOST_NUMBERS_OF_CARS: Final = 64
LONGEST_FREE_DISTANCE_M: Final = 1e4
LARGEST_RESISTANCE_N_PER_KN: Final = 1e3
LEAST_STEP: Final = 1e-3
"""Between neighbours of an axis, as float32: m, N/kN."""

MOST_NODES_OF_A_CUT: Final = 999
"""Free distances times resistances: what one constant array of Structured Text holds."""

MOST_NODES: Final = 20_000
"""So that a JSON file stays below its limit, and an INT of Structured Text counts them."""


@dataclass(frozen=True, eq=False)
class AimAxes:
    """The axes of the nodes, each rising; read-only copies of what is given.

    Free distances and resistances are 0.001 apart at least, as float32; D times R is 999 at most, C times that
    20 000.

    Raises `InvalidTable`.

    Examples
    --------
    >>> from tuning_tables.aim import AimAxes
    >>> AimAxes(cars=[1, 3], free_distance_m=[20.0, 100.0, 400.0]).shape
    (2, 3)
    """

    cars: Annotated[npt.NDArray[np.int64], Row(Count("numbers of cars", 1, MOST_CARS), "cars", 1, MOST_NUMBERS_OF_CARS)]
    free_distance_m: Annotated[
        Nodes,
        Row(
            Number(
                "from the head of the cut to the standing cars, when its last axle leaves the position",
                0.0,
                LONGEST_FREE_DISTANCE_M,
            ),
            "free_distance",
            1,
            MOST_NODES_OF_A_CUT,
        ),
    ]
    resistance_n_per_kn: Annotated[
        Nodes | None,
        Row(
            Number(
                "measured rolling resistance; null by category alone",
                -LARGEST_RESISTANCE_N_PER_KN,
                LARGEST_RESISTANCE_N_PER_KN,
            ),
            "resistance",
            1,
            MOST_NODES_OF_A_CUT,
        ),
    ] = None

    def __post_init__(self) -> None:
        cars = np.array(self.cars)
        if cars.dtype.kind not in "iu" or cars.ndim != 1 or not 1 <= len(cars) <= MOST_NUMBERS_OF_CARS:
            raise InvalidTable(f"axes.cars must hold 1 to {MOST_NUMBERS_OF_CARS} whole numbers.")
        if cars[0] < 1 or cars[-1] > MOST_CARS or not (cars[1:] > cars[:-1]).all():
            raise InvalidTable(f"axes.cars is {cars.tolist()!r:.60}, but it must rise strictly, from 1 to {MOST_CARS}.")
        cars = cars.astype(np.int64)
        cars.setflags(write=False)
        object.__setattr__(self, "cars", cars)
        distance_m = _axis(self.free_distance_m, "axes.free_distance_m", (0.0, LONGEST_FREE_DISTANCE_M))
        object.__setattr__(self, "free_distance_m", distance_m)
        if self.resistance_n_per_kn is not None:
            limits = (-LARGEST_RESISTANCE_N_PER_KN, LARGEST_RESISTANCE_N_PER_KN)
            resistance = _axis(self.resistance_n_per_kn, "axes.resistance_n_per_kn", limits)
            object.__setattr__(self, "resistance_n_per_kn", resistance)
        count = int(np.prod(self.shape[1:]))
        if count > MOST_NODES_OF_A_CUT or count * len(cars) > MOST_NODES:
            raise InvalidTable(
                f"axes give {count} nodes for each of {len(cars)} numbers of cars, but at most {MOST_NODES_OF_A_CUT} "
                f"are allowed, and {MOST_NODES} in all: take fewer free distances or resistances."
            )

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of everything at the nodes, (C, D), or (C, D, R) of a table by measured resistance."""
        both = (len(self.cars), len(self.free_distance_m))
        return both if self.resistance_n_per_kn is None else (*both, len(self.resistance_n_per_kn))


def _axis(values: npt.ArrayLike, key: str, limits: tuple[float, float]) -> Nodes:
    """The axis at `key`, checked."""
    shape = np.shape(values)
    if len(shape) != 1 or shape[0] < 1:
        raise InvalidTable(f"{key} must hold one number at least, in one row.")
    axis = nodes_of(values, key, shape)
    if not (np.isfinite(axis).all() and limits[0] <= axis.min() and axis.max() <= limits[1]):
        raise InvalidTable(f"{key} must hold numbers in [{limits[0]:g}, {limits[1]:g}].")
    steps = np.diff(axis.astype(np.float32))
    if (np.diff(axis) <= 0.0).any() or (steps < np.float32(LEAST_STEP)).any():
        raise InvalidTable(f"{key} is {axis.tolist()!r:.60}, but it must rise, by {LEAST_STEP:g} at least.")
    return axis


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
