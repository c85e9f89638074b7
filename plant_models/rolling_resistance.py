"""Specific rolling resistance of a cut: one gamma-distributed draw per cut (hump-norm)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from plant_models.errors import require_between
from plant_models.frozen_arrays import Floats


@dataclass(frozen=True)
class RollingResistance:
    """Specific resistance w of cuts, gamma distributed; it is drawn once for a cut ([hump-norm]).

    Parameters
    ----------
    mean_n_per_kn
        Mean of the weight category, N/kN, that is permille of the weight.
    std_n_per_kn
        Standard deviation of the category, N/kN; 0: w is known.

    Raises
    ------
    PlantError
        A number out of range.

    Examples
    --------
    >>> import numpy as np
    >>> from plant_models import RollingResistance
    >>> resistance = RollingResistance(mean_n_per_kn=1.5, std_n_per_kn=0.5)
    >>> values, probabilities = resistance.nodes(3)
    >>> (
    ...     float((values @ probabilities).round(9)),
    ...     resistance.sample(np.random.default_rng(1), 4).shape,
    ... )
    (1.5, (4,))
    """

    mean_n_per_kn: float
    std_n_per_kn: float

    def __post_init__(self) -> None:
        require_between("rolling resistance: mean_n_per_kn", self.mean_n_per_kn, 0.01, 50.0)
        require_between("rolling resistance: std_n_per_kn", self.std_n_per_kn, 0.0, 50.0)

    @property
    def shape(self) -> float:
        """Gamma shape (mean/std)²; infinite when w0 is known."""
        return (self.mean_n_per_kn / self.std_n_per_kn) ** 2 if self.std_n_per_kn > 0.0 else math.inf

    @property
    def scale_n_per_kn(self) -> float:
        """Gamma scale std²/mean, N/kN."""
        return self.std_n_per_kn**2 / self.mean_n_per_kn

    def sample(self, rng: np.random.Generator, size: int) -> Floats:
        """Independent draws.

        Parameters
        ----------
        rng
            Where random numbers come from.
        size
            How many.

        Returns
        -------
        ndarray
            N/kN, (size,).
        """
        if self.std_n_per_kn == 0.0:
            return np.full(size, self.mean_n_per_kn)
        return rng.gamma(self.shape, self.scale_n_per_kn, size)

    def nodes(self, count: int) -> tuple[Floats, Floats]:
        """Gauss quadrature of the gamma law.

        Parameters
        ----------
        count
            Number of nodes.

        Returns
        -------
        tuple of two ndarray
            Values, N/kN, and probabilities, each (count,).
        """
        if count == 1 or self.std_n_per_kn == 0.0:
            return np.array([self.mean_n_per_kn]), np.array([1.0])
        # Golub–Welsch for the generalised Laguerre polynomials: Γ(shape) never appears, so that a narrow law
        # (a large shape) does not overflow as scipy's roots_genlaguerre does.
        i = np.arange(count)
        beside = np.sqrt(i[1:] * (i[1:] + self.shape - 1.0))
        x, vectors = np.linalg.eigh(np.diag(2.0 * i + self.shape) + np.diag(beside, 1) + np.diag(beside, -1))
        return x * self.scale_n_per_kn, vectors[0] ** 2
