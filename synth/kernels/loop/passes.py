"""What passes of the closed loop are given and what they leave, the same for every kernel that runs them."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import Bools, Floats

LONGEST_PASS_S = 300.0
"""A cut that is still inside, at rest between two commands, after this time has stalled: it creeps."""


class Draws(NamedTuple):
    """What chance gives to n passes: ξ_cut, w0, speed at the beginning, first sample (n,); z of path and sensor (n, ·).

    `brake_m_s2_per_kpa` (n, C) follows from ξ_cut and path_z (`brake_rows`): worked out once for all controllers.
    `weight` (n,): how many cuts each pass stands for; no kernel reads it.
    """

    cut_factor: Floats
    resistance_n_kn: Floats
    entry_m_s: Floats
    first_sample_s: Floats
    path_z: NDArray[np.float32]
    noise_z: NDArray[np.float32]
    brake_m_s2_per_kpa: Floats
    weight: Floats

    def part(self, first: int, last: int) -> Draws:
        """Those of passes `first` … `last` − 1."""
        return Draws(*part_of(self, first, last))


class Exits(NamedTuple):
    """Results of n passes, filled by the kernel; a stalled pass leaves with speed 0 at the time it stops."""

    speed_m_s: Floats
    time_s: Floats
    stalled: Bools
    switchings: NDArray[np.int32]

    def part(self, first: int, last: int) -> Exits:
        """Where those of passes `first` … `last` − 1 stand."""
        return Exits(*part_of(self, first, last))


def part_of(arrays: tuple[NDArray[Any], ...], first: int, last: int) -> list[Any]:
    """Rows `first` … `last` − 1 of each."""
    return [each[first:last] for each in arrays]
