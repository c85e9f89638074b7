"""Friction factor ξ of a cut: persistent per cut, and correlated along the path."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from plant_models.errors import require_between
from plant_models.frozen_arrays import Floats

MOST_CV, MOST_MEAN_CV = 0.6, 0.3


@dataclass(frozen=True)
class Friction:
    """Friction factor ξ(s) = ξ_cut·(1 + η(s)) of a cut.

    ξ_cut ~ N(1, CV²) is drawn once for a cut and kept, `CV² = common_cv² + axle_cv²/N̄`. η is stationary and Gaussian.

    Parameters
    ----------
    common_cv
        Part of the coefficient of variation of ξ_cut that all axles share.
    axle_cv
        Part of each axle, which is less for more braked axles N̄.
    path_std
        Standard deviation of η.
    correlation_length_m
        Length over which the correlation of η falls to 1/e, m.
    floor
        ξ_cut never falls under this.
    mean_cv
        How far the mean of ξ_cut, taken as 1, may itself be off on a day, by weather, the oil of the day, a wrong
        weight; a standard deviation. No pass is drawn with it. What must keep a reserve is designed for `of_any_day`.

    Raises
    ------
    PlantError
        A number out of range.

    Examples
    --------
    >>> import numpy as np
    >>> from plant_models import Friction
    >>> friction = Friction(
    ...     common_cv=0.15, axle_cv=0.2, path_std=0.1, correlation_length_m=2.0
    ... )
    >>> round(friction.cut_cv(mean_braked_axles=4.0), 4)
    0.1803
    >>> friction.cut_factor(np.array([-1.0, 0.0, 1.0]), cv=0.18)
    array([0.82, 1.  , 1.18])
    """

    common_cv: float
    axle_cv: float
    path_std: float
    correlation_length_m: float
    floor: float = 0.3
    mean_cv: float = 0.0

    def __post_init__(self) -> None:
        for name in ("common_cv", "axle_cv", "path_std"):
            require_between(f"friction: {name}", getattr(self, name), 0.0, MOST_CV)
        require_between("friction: correlation_length_m", self.correlation_length_m, 0.01, 1000.0)
        require_between("friction: floor", self.floor, 0.05, 0.9)
        require_between("friction: mean_cv", self.mean_cv, 0.0, MOST_MEAN_CV)

    @property
    def of_any_day(self) -> Friction:
        """The friction of a cut on an unknown day, where the spread of the mean is part of that of ξ_cut.

        Its `common_cv` is never above the highest that one may have.
        """
        return replace(self, common_cv=min(math.hypot(self.common_cv, self.mean_cv), MOST_CV), mean_cv=0.0)

    def cut_cv(self, mean_braked_axles: float) -> float:
        """Coefficient of variation of ξ_cut with N̄ = `mean_braked_axles`."""
        return math.sqrt(self.common_cv**2 + self.axle_cv**2 / max(mean_braked_axles, 1.0))

    def cut_factor(self, z: Floats, cv: float) -> Floats:
        """The friction factor ξ_cut.

        Parameters
        ----------
        z
            Standard normal numbers, of any shape.
        cv
            Its coefficient of variation, as of `cut_cv`.

        Returns
        -------
        ndarray
            Factors of that shape, `floor` or more.
        """
        return np.maximum(self.floor, 1.0 + cv * z)

    def path_cell_std(self, cell_m: Floats | float) -> Floats:
        """Std of η as a constant per path cell of length `cell_m`.

        Chosen so that the work of η over many cells has the variance of the continuous process:
        σ²·(2ℓ/ΔS)·tanh(ΔS/2ℓ); it tends to σ for short cells and to the white equivalent
        σ·sqrt(2ℓ/ΔS) for long ones.
        """
        x = np.asarray(cell_m, dtype=np.float64) / (2.0 * self.correlation_length_m)
        return self.path_std * np.sqrt(np.tanh(x) / x)

    def path_correlation(self, distance_m: Floats | float) -> Floats:
        """Correlation of η over `distance_m`."""
        return np.exp(-np.asarray(distance_m, dtype=np.float64) / self.correlation_length_m)
