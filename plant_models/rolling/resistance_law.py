"""Basic rolling resistance of single cars: the Soviet norm and TB 10062, two laws of one interface."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from scipy.special import gammaincinv, ndtri

from plant_models.errors import require_between
from plant_models.frozen_arrays import Floats
from plant_models.rolling.roll_track import Bend
from plant_models.rolling_resistance import RollingResistance

LARGEST_ERLANG_ORDER = 50


class ResistanceLaw(Protocol):
    """What a norm says of rolling: every method takes uniform numbers `u` in (0, 1), and gives N/kN or metres."""

    @property
    def linear_n_per_kn(self) -> float:
        """Coefficient of the speed in the basic resistance, N/kN per m/s."""

    @property
    def slope_extra_n_per_kn(self) -> float:
        """What the basic resistance is more on the hump slope than in the yard behind the park position, N/kN."""

    def basic_n_per_kn(self, resistance: RollingResistance, mass_t: Floats, temperature_c: float, u: Floats) -> Floats:
        """Basic resistance of cars in the yard at standstill, one a number `u`; `resistance`: of their category;
        `mass_t`: of a 4-axle car of their axle load."""

    def mean_basic_n_per_kn(self, resistance: RollingResistance, mass_t: Floats, temperature_c: float) -> Floats:
        """Mean of `basic_n_per_kn`, as `mass_t`."""

    def bend_scale_m(self, bend: Bend) -> tuple[float, float]:
        """Energy head that the bend takes from a cut whose draw is 1: (per (m/s)², whatever the speed)."""

    def bend_draws(self, u: Floats) -> Floats:
        """By how much more than its scale a bend takes, as `u` without its last axis of `bend_numbers`."""

    @property
    def bend_numbers(self) -> int:
        """Uniform numbers that a bend needs."""

    @property
    def mean_bend_draw(self) -> float:
        """Mean of `bend_draws`."""

    @property
    def std_bend_draw(self) -> float:
        """Standard deviation of `bend_draws`."""

    def std_basic_n_per_kn(self, resistance: RollingResistance, mass_t: Floats, temperature_c: float) -> Floats:
        """Standard deviation of `basic_n_per_kn`, as `mass_t`."""


@dataclass(frozen=True)
class HumpNormLaw:
    """Gamma law by weight category, whatever temperature and speed; bends by an Erlang law ([hump-norm]).

    A bend takes C·v² metres of head, C = −(m/K)·ln ∏ R_k over K uniform numbers, mean m = 0.56e-3 a switch and
    0.23e-3 a degree ([kozachenko-aimed] has the law; its formula is lost, and the order K was found nowhere).
    """

    erlang_order: int = 3
    per_switch_m_s2: float = 0.56e-3
    per_degree_m_s2: float = 0.23e-3

    def __post_init__(self) -> None:
        require_between("resistance: erlang_order", self.erlang_order, 1, LARGEST_ERLANG_ORDER)
        require_between("resistance: per_switch_m_s2", self.per_switch_m_s2, 0.0, 0.1)
        require_between("resistance: per_degree_m_s2", self.per_degree_m_s2, 0.0, 0.1)

    linear_n_per_kn = 0.0
    slope_extra_n_per_kn = 0.0

    def basic_n_per_kn(self, resistance: RollingResistance, mass_t: Floats, temperature_c: float, u: Floats) -> Floats:
        """w0 by the quantiles of the gamma law of the category; its mean where the law has no spread."""
        if resistance.std_n_per_kn == 0.0:
            return np.full(u.shape, resistance.mean_n_per_kn)
        return np.asarray(gammaincinv(resistance.shape, u) * resistance.scale_n_per_kn)

    def mean_basic_n_per_kn(self, resistance: RollingResistance, mass_t: Floats, temperature_c: float) -> Floats:
        """Mean of the category."""
        return np.full(mass_t.shape, resistance.mean_n_per_kn)

    @property
    def bend_numbers(self) -> int:
        """The order K."""
        return self.erlang_order

    @property
    def mean_bend_draw(self) -> float:
        """The order K, too."""
        return float(self.erlang_order)

    @property
    def std_bend_draw(self) -> float:
        """√K."""
        return math.sqrt(self.erlang_order)

    def std_basic_n_per_kn(self, resistance: RollingResistance, mass_t: Floats, temperature_c: float) -> Floats:
        """That of the category."""
        return np.full(mass_t.shape, resistance.std_n_per_kn)

    def bend_scale_m(self, bend: Bend) -> tuple[float, float]:
        """m/K."""
        mean = self.per_switch_m_s2 * bend.switches + self.per_degree_m_s2 * bend.turn_deg
        return mean / self.erlang_order, 0.0

    def bend_draws(self, u: Floats) -> Floats:
        """C·K/m of one bend for each row of `u`, shape (…, K)."""
        return np.asarray(-np.log(u).sum(axis=-1))


@dataclass(frozen=True)
class Tb10062Law:
    """The Chinese norm TB 10062-99 [tb-10062]: normal spread, grows in the cold.

    r = 2.439 + (0.00008 Q − 0.01743) t − 0.015 Q + 0.00017 t² + 0.1 v + 0.39 (1 − k), k = 1 in the yard and 0 on the
    slope; standard deviation 0.602 − (0.0012 + 0.00002 Q) t − 0.003 Q + 0.00002 t². Bends take 8 N·m/kN a degree and 24
    a facing switch, whatever the speed. Resistance is cut off at `least_n_per_kn`, which the norm does not say.
    """

    least_n_per_kn: float = 0.2

    linear_n_per_kn = 0.1
    slope_extra_n_per_kn = 0.39
    bend_numbers = 1
    mean_bend_draw = 1.0
    std_bend_draw = 0.0

    def __post_init__(self) -> None:
        require_between("resistance: least_n_per_kn", self.least_n_per_kn, 0.0, 2.0)

    def basic_n_per_kn(self, resistance: RollingResistance, mass_t: Floats, temperature_c: float, u: Floats) -> Floats:
        """r at v = 0 and k = 1 by the quantiles of the normal law; the category does not count, the mass does."""
        q, t = mass_t, temperature_c
        mean = self.mean_basic_n_per_kn(resistance, q, t)
        std = self.std_basic_n_per_kn(resistance, q, t)
        return np.asarray(np.maximum(mean + std * ndtri(u), self.least_n_per_kn))

    def mean_basic_n_per_kn(self, resistance: RollingResistance, mass_t: Floats, temperature_c: float) -> Floats:
        """r at v = 0 and k = 1 without its spread; what the cut-off adds is left out."""
        q, t = mass_t, temperature_c
        return np.asarray(2.439 + (0.00008 * q - 0.01743) * t - 0.015 * q + 0.00017 * t**2)

    def std_basic_n_per_kn(self, resistance: RollingResistance, mass_t: Floats, temperature_c: float) -> Floats:
        """As the norm says it; what the cut-off takes away is left out."""
        q, t = mass_t, temperature_c
        return np.asarray(0.602 - (0.0012 + 0.00002 * q) * t - 0.003 * q + 0.00002 * t**2)

    def bend_scale_m(self, bend: Bend) -> tuple[float, float]:
        """The head of every cut."""
        return 0.0, 24e-3 * bend.switches + 8e-3 * bend.turn_deg

    def bend_draws(self, u: Floats) -> Floats:
        """1 for every cut."""
        return np.ones(u.shape[:-1])
