"""The track at a retarder position: its grade along the position, and the path before the entrance on which the
regulator already acts, with what it finds and may command there.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from plant_models.errors import require, require_between
from plant_models.frozen_arrays import Floats


@dataclass(frozen=True)
class TrackProfile:
    """Piecewise constant grade of the track along the position.

    Parameters
    ----------
    starts_m
        Where each grade begins, m from the entrance, rising; the first one also holds before.
    grades_permille
        The grades, permille, positive where the track falls.

    Raises
    ------
    PlantError
        Two rows that do not belong together, or a number out of range.

    Examples
    --------
    >>> import numpy as np
    >>> from plant_models import TrackProfile
    >>> TrackProfile(starts_m=(0.0, 20.0), grades_permille=(11.0, 7.0)).grade_permille(
    ...     np.array([5.0, 25.0])
    ... )
    array([11.,  7.])
    >>> TrackProfile.uniform(8.0).grades_permille
    (8.0,)
    """

    starts_m: tuple[float, ...]
    grades_permille: tuple[float, ...]

    def __post_init__(self) -> None:
        require(
            len(self.starts_m) == len(self.grades_permille) >= 1,
            "track profile: starts_m and grades_permille must be of one length, at least 1",
        )
        for grade in self.grades_permille:
            require_between("track profile: grades_permille", grade, -60.0, 60.0)
        for start in self.starts_m:
            require_between("track profile: starts_m", start, -1e4, 1e4)
        require(
            all(b > a for a, b in pairwise(self.starts_m)),
            f"track profile: starts_m is {self.starts_m}; it must increase",
        )

    @classmethod
    def uniform(cls, grade_permille: float) -> TrackProfile:
        """One grade everywhere."""
        return cls((0.0,), (grade_permille,))

    def grade_permille(self, s_m: Floats) -> Floats:
        """Grade at the positions `s_m`."""
        index = np.clip(np.searchsorted(self.starts_m, s_m, side="right") - 1, 0, None)
        return np.asarray(self.grades_permille)[index]


SHORTEST_APPROACH_M, LONGEST_APPROACH_M = 0.001, 100.0

ANY_STAGE = 31
"""No limit at the entrance: no retarder has more stages."""


@dataclass(frozen=True)
class Approach:
    """The path before the entrance on which the regulator already acts. Nothing brakes there.

    Parameters
    ----------
    length_m
        It acts from so far before the entrance, m; 0: from the entrance, as without a sensor ahead.
    entrance_stage
        The highest stage that it may command while the first axle is before the entrance, so that no cut runs into a
        retarder that is closed harder.
    initial_stage
        The stage at rest when it takes over the cut, left from the cut ahead.

    Raises
    ------
    PlantError
        A length or stage out of range.

    Notes
    -----
    That the cut ahead has left is the interlock of the permission to act there, and not part of the motion.

    Examples
    --------
    >>> from plant_models import Approach
    >>> Approach(length_m=4.0, entrance_stage=2).initial_stage
    0
    """

    length_m: float = 0.0
    entrance_stage: int = ANY_STAGE
    initial_stage: int = 0

    def __post_init__(self) -> None:
        require_between("regulator: approach_m", self.length_m, 0.0, LONGEST_APPROACH_M)
        require(
            self.length_m == 0.0 or self.length_m >= SHORTEST_APPROACH_M,
            f"regulator: approach_m is {self.length_m:g}; it must be 0, or from {SHORTEST_APPROACH_M:g} m up",
        )
        require(
            0 <= self.entrance_stage <= ANY_STAGE,
            f"cut: entrance_stage is {self.entrance_stage}; it must be a whole number from 0 to {ANY_STAGE}",
        )
        named = "" if self.entrance_stage == ANY_STAGE else "the stage allowed at the entrance, "
        require(
            0 <= self.initial_stage <= self.entrance_stage,
            f"regulator: initial_stage is {self.initial_stage}; it must be a whole number from 0 to "
            f"{named}{self.entrance_stage}",
        )


AT_THE_ENTRANCE = Approach()
"""The regulator acts from the entrance on, and finds the brake released."""
