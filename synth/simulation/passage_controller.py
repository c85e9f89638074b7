"""A regulator that decides at passages over point sensors, as the closed loop runs it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays
from synth.kernels.loop.passage_regulator import PassageLaw
from synth.simulation.controllers import fixed

LIMITS = 6
"""Numbers that the tracker's `limits` has."""


class SwitchingTable(Protocol):
    """What a regulator takes from a table for point sensors, as in `tuning_tables.passages`."""

    @property
    def switching_m_s(self) -> NDArray[np.float32]:
        """Switching speeds, (M, K + 1, K)."""
        ...

    @property
    def path_m(self) -> NDArray[np.float32]:
        """Path of the passages, (M,)."""
        ...

    @property
    def sensor_of(self) -> NDArray[np.int64]:
        """Sensor of each passage, (M,)."""
        ...

    @property
    def limits(self) -> NDArray[np.float32]:
        """Limits of the tracker, (6,)."""
        ...

    @property
    def entrance_stage(self) -> int:
        """Highest stage that may be entered before the entrance."""
        ...


@frozen_arrays
@dataclass(frozen=True, eq=False)
class PassageController:
    """Switching speeds for every passage and stage in force, and what the regulator knows of the passages.

    `switching_m_s` float32 (M, K + 1, K), rows not falling, −∞ and +∞ allowed (`tuning_tables.passages.rule`);
    `path_m` (M,) not falling and `sensor_of` (M,) of the passages in the order of the path; `entrance_stage`: the
    highest that is entered at path below 0. `limits` (6,) of `tuning_tables.passages.tracker`, or (0,): the regulator
    is told which passage a pulse pair is, as if no sensor ever failed. `ValueError` for arrays that do not fit.
    """

    switching_m_s: NDArray[np.float32]
    path_m: NDArray[np.float32]
    sensor_of: NDArray[np.int64]
    entrance_stage: int
    limits: NDArray[np.float32]

    def __post_init__(self) -> None:
        shape = self.switching_m_s.shape
        if len(shape) != 3 or shape[1] != shape[2] + 1 or shape[2] < 1:
            raise ValueError(f"passage controller: switching_m_s has shape {shape}; it must be (M, K + 1, K), K >= 1")
        if np.isnan(self.switching_m_s).any() or (self.switching_m_s[..., 1:] < self.switching_m_s[..., :-1]).any():
            raise ValueError("passage controller: switching_m_s must not fall along a row and have no NaN")
        if self.path_m.shape != shape[:1] or self.sensor_of.shape != shape[:1] or (np.diff(self.path_m) < 0.0).any():
            raise ValueError(f"passage controller: path_m (rising) and sensor_of must have {shape[0]} entries")
        if self.limits.shape not in ((0,), (LIMITS,)) or not np.all(np.isfinite(self.limits) & (self.limits >= 0.0)):
            raise ValueError("passage controller: limits must be six numbers that are not negative, or none")

    @property
    def stages(self) -> int:
        """Number of stages K + 1."""
        return int(self.switching_m_s.shape[1])

    @property
    def tracks(self) -> bool:
        """Whether the regulator finds out itself which passage a pulse pair is."""
        return self.limits.size > 0

    def law(self) -> PassageLaw:
        """The rule as the kernel takes it."""
        return self._law

    @cached_property
    def _law(self) -> PassageLaw:
        return PassageLaw(
            fixed(self.switching_m_s, np.float32),
            self.entrance_stage,
            int(np.count_nonzero(self.path_m < 0.0)),
            fixed(self.path_m, np.float32),
            fixed(self.sensor_of, np.int64),
            fixed(self.limits, np.float32),
        )


def of_table(table: SwitchingTable, tracking: bool) -> PassageController:
    """The regulator that runs `table`; `tracking`: with the tracker, as in a controller, else told each passage."""
    limits = table.limits if tracking else np.empty(0, dtype=np.float32)
    return PassageController(table.switching_m_s, table.path_m, table.sensor_of, table.entrance_stage, limits)
