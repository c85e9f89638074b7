"""What a point sensor measures, as the solver takes it."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from plant_models import PointSensors
from plant_models.frozen_arrays import Floats, frozen_arrays

SHARE_OF_CELL = 0.4
"""Std of a cell of the speed grid, as part of its width, about what a probability that is put into cells forgets."""

SLOWEST_M_S = 1e-2


@frozen_arrays
class PassageMeasurement:
    """Readings are ∫ dv/σ(v), so that every reading has std 1; σ: error of the sensor and width of a cell together.

    The errors of a good sensor are smaller than the cells of the grid. Without the width of the cell, a command would
    come or go for the mass of a whole cell at once, and the cost would be no smooth function of the lines.
    `speed_m_s` (E,) of the grid.
    """

    sensors: PointSensors
    speed_m_s: Floats

    @property
    def std(self) -> float:
        """1."""
        return 1.0

    @cached_property
    def _table(self) -> tuple[Floats, Floats]:
        """(speeds, readings): the integral at speeds much denser than the grid, from the slowest on."""
        v = np.linspace(SLOWEST_M_S, float(self.speed_m_s[-1]) + 1.0, 4000)
        energy_step = 0.5 * float(self.speed_m_s[1]) ** 2
        std = np.hypot(self.sensors.reading_std_m_s(v), SHARE_OF_CELL * np.minimum(energy_step / v, v))
        steps = 0.5 * (1.0 / std[1:] + 1.0 / std[:-1]) * np.diff(v)
        return v, np.concatenate([[0.0], np.cumsum(steps)])

    def readings(self, speed_m_s: Floats) -> Floats:
        """The integral up to the speeds; below the slowest as if the error were the same there."""
        v, integral = self._table
        below = np.minimum(speed_m_s - v[0], 0.0) * (integral[1] - integral[0]) / (v[1] - v[0])
        found: Floats = np.interp(speed_m_s, v, integral) + below
        found.setflags(write=False)  # as the speeds of the grid are: kernels are compiled once for both
        return found

    def thresholds(self, lines_m_s: Floats) -> tuple[Floats, float]:
        """Lines in readings; infinite ones stay so."""
        finite = np.isfinite(lines_m_s)
        found = np.array(lines_m_s)
        found[finite] = self.readings(lines_m_s[finite])
        return found, 1.0

    def slopes(self, lines_m_s: Floats) -> Floats:
        """Derivatives of the thresholds by the lines; 0 where a line is infinite."""
        v, integral = self._table
        finite = np.isfinite(lines_m_s)
        cell = np.clip(np.searchsorted(v, np.where(finite, lines_m_s, v[0])) - 1, 0, len(v) - 2)
        found: Floats = np.where(finite, (integral[cell + 1] - integral[cell]) / (v[cell + 1] - v[cell]), 0.0)
        return found

    def speeds(self, lines: Floats) -> Floats:
        """Lines in m/s of lines in readings."""
        v, integral = self._table
        finite = np.isfinite(lines)
        found: Floats = np.where(finite, np.interp(np.where(finite, lines, 0.0), integral, v), lines)
        return found

    def behind(self, first: int, speed_m_s: Floats) -> PassageMeasurement:
        """The same on another grid."""
        return PassageMeasurement(self.sensors, speed_m_s)
