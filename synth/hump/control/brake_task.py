"""What a retarder is to do with a cut: the modes of the published model, and an exported table. Strobing: a computed
speed is compared with the greatest and the least that is possible ([hump-computer-1970s]).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import ClassVar, Protocol

from plant_models.cut import GRAVITY_M_S2
from plant_models.errors import require, require_between
from synth.hump.control.models import Braking, ExitSpeed, Resistance


@dataclass(frozen=True)
class Strobe:
    """The least and the greatest possible speed, m/s."""

    least_m_s: float = 0.5
    greatest_m_s: float = 8.5

    def __post_init__(self) -> None:
        require_between("strobe: least_m_s", self.least_m_s, 0.0, 20.0)
        require_between("strobe: greatest_m_s", self.greatest_m_s, 0.0, 20.0)
        require(
            self.least_m_s < self.greatest_m_s,
            f"strobe: least_m_s is {self.least_m_s:g}; it must be less than greatest_m_s, {self.greatest_m_s:g}",
        )

    def holds(self, speed_m_s: float) -> bool:
        """Whether `speed_m_s` is possible; NaN and infinity are not."""
        return math.isfinite(speed_m_s) and self.least_m_s <= speed_m_s <= self.greatest_m_s

    def bounded(self, speed_m_s: float) -> float:
        """The possible speed next to `speed_m_s`; the least where it is no number, since a slow cut does the least
        harm."""
        if math.isnan(speed_m_s):
            return self.least_m_s
        return min(max(speed_m_s, self.least_m_s), self.greatest_m_s)


STRONGEST_N_PER_KN = 200.0
HEAVIEST_DEGREE = 1.0


class BrakeTask(Protocol):
    """A mode of braking for one cut on one retarder; `way` is k of the published model."""

    way: ClassVar[int]

    def braking(self, place_m: float) -> Braking | None:
        """What the retarder is told while the first axle of the cut is at `place_m` from the crest; None: open."""


@dataclass(frozen=True)
class ManualBraking:
    """An operator is asked at every tick: from the place of the first axle to a resistance in N/kN, or None."""

    operator: Callable[[float], float | None]
    way: ClassVar[int] = 0

    def braking(self, place_m: float) -> Braking | None:
        """What the operator says."""
        told = self.operator(place_m)
        if told is None:
            return None
        require_between("braking by hand: resistance in N/kN", told, 0.0, STRONGEST_N_PER_KN)
        return Resistance(told)


@dataclass(frozen=True)
class UniformBraking:
    """The resistance w_г over the whole zone: {k, N_об, w_г}."""

    n_per_kn: float
    way: ClassVar[int] = 1

    def __post_init__(self) -> None:
        require_between("uniform braking: n_per_kn", self.n_per_kn, 0.0, STRONGEST_N_PER_KN)

    def braking(self, place_m: float) -> Braking | None:
        """Always the same."""
        return Resistance(self.n_per_kn) if self.n_per_kn > 0.0 else None


@dataclass(frozen=True)
class ZoneBraking:
    """Braking over a variable zone: {k, N_об, l_пг, l_з, q_у}.

    The retarder brakes with `degree` (q_у) of its power from `from_m` (l_пг) over `length_m` (l_з). `from_m` counts
    from the crest; `power_n_per_kn` is the resistance at degree 1.
    """

    from_m: float
    length_m: float
    degree: float
    power_n_per_kn: float
    way: ClassVar[int] = 2

    def __post_init__(self) -> None:
        require_between("braking zone: from_m", self.from_m, 0.0, 10_000.0)
        require_between("braking zone: length_m", self.length_m, 0.0, 200.0)
        require_between("braking zone: degree", self.degree, 0.0, HEAVIEST_DEGREE)
        require_between("braking zone: power_n_per_kn", self.power_n_per_kn, 0.0, STRONGEST_N_PER_KN)

    def braking(self, place_m: float) -> Braking | None:
        """Power within the zone."""
        within = self.from_m <= place_m < self.from_m + self.length_m
        return Resistance(self.degree * self.power_n_per_kn) if within else None


@dataclass(frozen=True)
class TableBraking:
    """An exported table brakes the cut to an exit speed, which an aim table or an interval rule gave.

    The control strobes the speed before a retarder is told it, since it was computed.
    """

    exit_speed_m_s: float
    way: ClassVar[int] = 3

    def braking(self, place_m: float) -> Braking | None:
        """The table does the rest."""
        return ExitSpeed(self.exit_speed_m_s)


@dataclass(frozen=True)
class LeastInterval:
    """Braking of a cut that came too close: it shall leave a zone `interval_s` later than it would unbraked.

    Uniform braking from v to v₂ over the zone l takes 2·l/(v + v₂), so v₂ = 2·l/(l/v + interval) − v, and the
    resistance is (v² − v₂²)·10³/(2·g·l). The law is ours; grade and rolling resistance are left out. v₂ is strobed.
    """

    interval_s: float = 2.0
    strobe: Strobe = field(default_factory=Strobe)

    def __post_init__(self) -> None:
        require_between("least interval: interval_s", self.interval_s, 0.1, 60.0)

    def task(self, speed_m_s: float, zone_m: float) -> UniformBraking:
        """The task of a cut that enters a zone of `zone_m` with `speed_m_s`."""
        if speed_m_s <= self.strobe.least_m_s:
            return UniformBraking(0.0)
        leaves = 2.0 * zone_m / (zone_m / speed_m_s + self.interval_s) - speed_m_s
        bounded = min(self.strobe.bounded(leaves), speed_m_s)
        resistance = (speed_m_s**2 - bounded**2) * 1e3 / (2.0 * GRAVITY_M_S2 * zone_m)
        return UniformBraking(min(resistance, STRONGEST_N_PER_KN))
