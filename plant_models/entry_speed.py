"""How fast cuts enter a retarder position: uniform, normal between two limits, or a histogram of measured speeds."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from statistics import NormalDist
from typing import ClassVar, Protocol

import numpy as np

from plant_models.errors import require, require_between
from plant_models.frozen_arrays import Floats

LEAST_INSIDE = 1e-3
"""A normal law must have this share of its cuts between its limits, else the limits say more than the law."""


class EntryLaw(Protocol):
    """Distribution of the speed of the first axle at the entrance, m/s.

    No cut is slower than `low_m_s` or faster than `high_m_s`.

    Examples
    --------
    >>> from plant_models import EntryLaw, EntrySpeed
    >>> law: EntryLaw = EntrySpeed(5.0, 6.5)
    >>> law.high_m_s
    6.5
    """

    @property
    def low_m_s(self) -> float:
        """The lowest speed."""
        ...

    @property
    def high_m_s(self) -> float:
        """The highest speed."""
        ...

    high_key: ClassVar[str]
    """Where files have the highest speed."""

    @property
    def sentence(self) -> str:
        """The law in words."""
        ...

    def speed_m_s(self, u: Floats) -> Floats:
        """Entry speeds: the inverse of the distribution function.

        Parameters
        ----------
        u
            Uniform numbers in [0, 1), of any shape.

        Returns
        -------
        ndarray
            Speeds, m/s, of that shape.
        """
        ...

    def stretched(self, low_m_s: float, high_m_s: float) -> EntryLaw:
        """The law of the same shape between other limits."""
        ...


@dataclass(frozen=True)
class EntrySpeed:
    """Speed of the first axle at the entrance, uniform between two limits.

    Parameters
    ----------
    low_m_s
        Lowest speed, m/s.
    high_m_s
        Highest speed, m/s.

    Raises
    ------
    PlantError
        Limits that are no speeds, or in the wrong order.

    Examples
    --------
    >>> import numpy as np
    >>> from plant_models import EntrySpeed
    >>> entry = EntrySpeed(5.0, 6.5)
    >>> entry.sentence, entry.speed_m_s(np.array([0.0, 0.5]))
    ('uniform from 5 to 6.5 m/s', array([5.  , 5.75]))
    """

    low_m_s: float
    high_m_s: float
    high_key: ClassVar[str] = "high_m_s"

    def __post_init__(self) -> None:
        require_limits(self.low_m_s, self.high_m_s)

    @property
    def sentence(self) -> str:
        """See `EntryLaw`."""
        return f"uniform from {self.low_m_s:g} to {self.high_m_s:g} m/s"

    def speed_m_s(self, u: Floats) -> Floats:
        """Entry speed for uniform `u` in [0, 1)."""
        return self.low_m_s + (self.high_m_s - self.low_m_s) * u

    def stretched(self, low_m_s: float, high_m_s: float) -> EntrySpeed:
        """See `EntryLaw`."""
        return EntrySpeed(low_m_s, high_m_s)


@dataclass(frozen=True)
class NormalEntrySpeed:
    """Speed of the first axle at the entrance, normal, of which only the part between two limits is taken.

    Parameters
    ----------
    low_m_s
        Lowest speed, m/s.
    high_m_s
        Highest speed, m/s.
    mean_m_s
        Mean of the whole law, m/s.
    std_m_s
        Standard deviation of the whole law, m/s.

    Raises
    ------
    PlantError
        Numbers that are no speeds, or a law that has hardly a cut between the limits.

    Examples
    --------
    >>> import numpy as np
    >>> from plant_models import NormalEntrySpeed
    >>> entry = NormalEntrySpeed(low_m_s=4.0, high_m_s=7.0, mean_m_s=5.5, std_m_s=0.5)
    >>> entry.speed_m_s(np.array([0.5])).round(3)
    array([5.5])
    """

    low_m_s: float
    high_m_s: float
    mean_m_s: float
    std_m_s: float
    high_key: ClassVar[str] = "high_m_s"

    def __post_init__(self) -> None:
        require_limits(self.low_m_s, self.high_m_s)
        require(
            self.low_m_s < self.high_m_s,
            f"entry: high_m_s is {self.high_m_s!r}; with mean_m_s it must be above low_m_s = {self.low_m_s:g}",
        )
        require_between("entry: mean_m_s", self.mean_m_s, 0.3, 20.0)
        require_between("entry: std_m_s", self.std_m_s, 0.001, 10.0)
        _, inside = self._shares()
        require(
            inside >= LEAST_INSIDE,
            f"entry: mean_m_s is {self.mean_m_s:g}; with std_m_s = {self.std_m_s:g} only {inside:.1g} of the cuts "
            f"would enter at {self.low_m_s:g} to {self.high_m_s:g} m/s; that share must be at least {LEAST_INSIDE:g}",
        )

    @property
    def sentence(self) -> str:
        """See `EntryLaw`."""
        return (
            f"normal, mean {self.mean_m_s:g} and std {self.std_m_s:g} m/s, cut off below {self.low_m_s:g} and above "
            f"{self.high_m_s:g} m/s"
        )

    def speed_m_s(self, u: Floats) -> Floats:
        """See `EntryLaw`."""
        below, inside = self._shares()
        law = NormalDist(self.mean_m_s, self.std_m_s)
        share = np.clip(below + inside * u, 1e-300, 1.0 - 2.0**-53)
        speed = np.fromiter(map(law.inv_cdf, share.ravel().tolist()), np.float64, share.size).reshape(share.shape)
        return np.clip(speed, self.low_m_s, self.high_m_s)

    def stretched(self, low_m_s: float, high_m_s: float) -> EntryLaw:
        """See `EntryLaw`; where nothing is left between the limits, the one speed."""
        if low_m_s == high_m_s:
            return EntrySpeed(low_m_s, high_m_s)
        scale = (high_m_s - low_m_s) / (self.high_m_s - self.low_m_s)
        mean = low_m_s + (self.mean_m_s - self.low_m_s) * scale
        return replace(self, low_m_s=low_m_s, high_m_s=high_m_s, mean_m_s=mean, std_m_s=self.std_m_s * scale)

    def _shares(self) -> tuple[float, float]:
        """(share of the untruncated law below the lowest speed, share between the limits)."""
        law = NormalDist(self.mean_m_s, self.std_m_s)
        below = law.cdf(self.low_m_s)
        return below, law.cdf(self.high_m_s) - below


@dataclass(frozen=True)
class HistogramEntrySpeed:
    """Speed of the first axle at the entrance, uniform within each of n bins.

    Parameters
    ----------
    edges_m_s
        Edges of the bins, m/s, (n + 1,), rising.
    shares
        How many cuts enter in each bin, (n,), counts or probabilities: only their ratios matter. Bins without cuts at
        both ends are allowed.

    Raises
    ------
    PlantError
        Edges that do not rise, or shares that do not belong to them.

    Examples
    --------
    >>> import numpy as np
    >>> from plant_models import HistogramEntrySpeed
    >>> entry = HistogramEntrySpeed(edges_m_s=(4.0, 5.0, 6.0), shares=(1.0, 3.0))
    >>> entry.speed_m_s(np.array([0.0, 0.25, 0.625]))
    array([4. , 5. , 5.5])
    """

    edges_m_s: tuple[float, ...]
    shares: tuple[float, ...]
    high_key: ClassVar[str] = "the last of edges_m_s"

    def __post_init__(self) -> None:
        edges, shares = self.edges_m_s, self.shares
        require(
            len(edges) >= 2 and all(b > a for a, b in pairwise(edges)),
            f"entry: edges_m_s is {list(edges)}; give at least two edges, each above the one before",
        )
        for edge in edges:
            require_between("entry: edges_m_s", edge, 0.3, 20.0)
        require(
            len(shares) == len(edges) - 1,
            f"entry: shares has {len(shares)} numbers; with {len(edges)} edges_m_s it must have {len(edges) - 1}",
        )
        for share in shares:
            require_between("entry: shares", share, 0.0, 1e12)
        require(sum(shares) > 0.0, "entry: shares are all 0; at least one must be above 0")

    @property
    def low_m_s(self) -> float:
        """Lower edge of the first bin that has cuts."""
        return next(edge for edge, share in zip(self.edges_m_s, self.shares, strict=False) if share > 0.0)

    @property
    def high_m_s(self) -> float:
        """Upper edge of the last bin that has cuts."""
        last = max(i for i, share in enumerate(self.shares) if share > 0.0)
        return self.edges_m_s[last + 1]

    @property
    def sentence(self) -> str:
        """See `EntryLaw`."""
        return f"a histogram of {len(self.shares)} bins from {self.low_m_s:g} to {self.high_m_s:g} m/s"

    def speed_m_s(self, u: Floats) -> Floats:
        """See `EntryLaw`."""
        filled = [i for i, share in enumerate(self.shares) if share > 0.0]
        share = np.array([self.shares[i] for i in filled]) / sum(self.shares)
        low = np.array([self.edges_m_s[i] for i in filled])
        width = np.array([self.edges_m_s[i + 1] - self.edges_m_s[i] for i in filled])
        below = np.concatenate([[0.0], np.cumsum(share)[:-1]])
        place = np.searchsorted(below, u, side="right") - 1
        speed: Floats = low[place] + width[place] * np.minimum((u - below[place]) / share[place], 1.0)
        return speed

    def stretched(self, low_m_s: float, high_m_s: float) -> EntryLaw:
        """See `EntryLaw`; where nothing is left between the limits, the one speed."""
        if low_m_s == high_m_s:
            return EntrySpeed(low_m_s, high_m_s)
        scale, low = (high_m_s - low_m_s) / (self.high_m_s - self.low_m_s), self.low_m_s
        filled = [i for i, share in enumerate(self.shares) if share > 0.0]
        first, last = filled[0], filled[-1]
        edges = tuple(low_m_s + (edge - low) * scale for edge in self.edges_m_s[first : last + 2])
        return HistogramEntrySpeed(edges, self.shares[first : last + 1])


def require_limits(low_m_s: float, high_m_s: float) -> None:
    """Raise unless the limits are speeds, the lower one first."""
    require_between("entry: low_m_s", low_m_s, 0.3, 20.0)
    require(
        low_m_s <= high_m_s <= 20.0,
        f"entry: high_m_s is {high_m_s!r}; it must be from low_m_s = {low_m_s:g} to 20",
    )
