"""Grade of the track along the retarder position."""

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
