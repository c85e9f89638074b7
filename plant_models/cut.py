"""Cars and the cuts that they form: mass, axles, inertia of the rotating wheels."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

from plant_models.errors import require, require_between

GRAVITY_M_S2 = 9.81
"""Acceleration of gravity g."""

ROTATING_MASS_PER_AXLE_T = 0.42
"""Equivalent mass of one rotating wheel set, J/r²; the usual figure for the design of humps, engineering judgement."""

LONGEST_CAR_M = 200.0
"""Over couplers: an articulated car of five units has 81 m."""


@dataclass(frozen=True)
class Car:
    """One car type, where its axles stand and what it may weigh.

    Parameters
    ----------
    name
        Its name.
    axle_offsets_m
        Distances of the axles behind the first axle, m; the first is 0, and they rise.
    length_m
        Length over couplers, m.
    tare_t
        Mass of the empty car, t.
    gross_t
        Mass of the full car, t.

    Raises
    ------
    PlantError
        A length or mass that no car has.

    Examples
    --------
    >>> from plant_models import Car
    >>> gondola = Car(
    ...     "gondola",
    ...     axle_offsets_m=(0.0, 1.85, 8.65, 10.5),
    ...     length_m=13.92,
    ...     tare_t=22.0,
    ...     gross_t=94.0,
    ... )
    >>> gondola.axle_offsets_m[-1]
    10.5
    """

    name: str
    axle_offsets_m: tuple[float, ...]
    length_m: float
    tare_t: float
    gross_t: float

    def __post_init__(self) -> None:
        require_offsets(f"car {self.name}: axle_offsets_m", self.axle_offsets_m)
        require_between(f"car {self.name}: length_m", self.length_m, self.axle_offsets_m[-1], LONGEST_CAR_M)
        require_between(f"car {self.name}: tare_t", self.tare_t, 1.0, 600.0)
        require_between(f"car {self.name}: gross_t", self.gross_t, self.tare_t, 1500.0)


@dataclass(frozen=True)
class Cut:
    """A cut as the retarder sees it.

    Parameters
    ----------
    category
        Name of its weight category.
    mass_t
        Mass of the whole cut, Q, t.
    axle_offsets_m
        Distances of all axles behind the first, m; the first is 0, and they rise.
    allowed_stage
        The highest braking stage that the category may be given; light wheels slide or are squeezed out under the high
        ones.
    category_number
        What stands for the category in controllers, None where it has no number.

    Raises
    ------
    PlantError
        A mass, offsets or a stage that no cut has.

    Examples
    --------
    >>> from plant_models import Cut
    >>> cut = Cut(
    ...     "С",
    ...     mass_t=52.0,
    ...     axle_offsets_m=(0.0, 1.85, 8.65, 10.5),
    ...     allowed_stage=3,
    ...     category_number=3,
    ... )
    >>> cut.axles, cut.axle_load_t, round(cut.reduced_gravity_m_s2, 3)
    (4, 13.0, 9.503)
    """

    category: str
    mass_t: float
    axle_offsets_m: tuple[float, ...]
    allowed_stage: int
    category_number: int | None = None

    def __post_init__(self) -> None:
        require_between("cut: mass_t", self.mass_t, 1.0, 20_000.0)
        require_offsets("cut: axle_offsets_m", self.axle_offsets_m)
        require(self.allowed_stage >= 1, f"cut: allowed_stage is {self.allowed_stage}; it must be at least 1")

    @property
    def axles(self) -> int:
        """Number of axles n."""
        return len(self.axle_offsets_m)

    @property
    def inertia_t(self) -> float:
        """Mass plus the equivalent mass of the wheel sets, Q + 0.42 n, tonnes."""
        return self.mass_t + ROTATING_MASS_PER_AXLE_T * self.axles

    @property
    def reduced_gravity_m_s2(self) -> float:
        """Acceleration of gravity less the share of the rotating wheels, g' = g/(1 + 0.42 n/Q), m/s²."""
        return GRAVITY_M_S2 * self.mass_t / self.inertia_t

    @property
    def axle_load_t(self) -> float:
        """Mean mass per axle, tonnes."""
        return self.mass_t / self.axles


def couple(
    cars: tuple[Car, ...], mass_t: float, category: str, allowed_stage: int, category_number: int | None = None
) -> Cut:
    """Couple cars to a cut.

    Parameters
    ----------
    cars
        The cars, the first one ahead.
    mass_t
        What they weigh together, t.
    category
        Name of the weight category.
    allowed_stage
        The highest braking stage that the category may be given.
    category_number
        What stands for the category in controllers, or None.

    Returns
    -------
    Cut
        The cut, with the axles of all cars.

    Raises
    ------
    PlantError
        No car, or a mass that no cut has.

    Examples
    --------
    >>> from plant_models import couple
    >>> from plant_models.library import load_car
    >>> gondola = load_car("gondola-4").car
    >>> cut = couple((gondola, gondola), mass_t=60.0, category="ЛС", allowed_stage=2)
    >>> cut.axles, cut.axle_offsets_m[4]
    (8, 13.92)
    """
    require(len(cars) > 0, "cut: cars is empty; a cut has at least one car")
    offsets: list[float] = []
    front_coupler = 0.0
    for car in cars:
        overhang = (car.length_m - car.axle_offsets_m[-1]) / 2.0
        offsets += [front_coupler + overhang + x for x in car.axle_offsets_m]
        front_coupler += car.length_m
    return Cut(category, mass_t, tuple(round(x - offsets[0], 6) for x in offsets), allowed_stage, category_number)


def require_offsets(name: str, offsets_m: tuple[float, ...]) -> None:
    """Raise unless the offsets start at 0 and increase."""
    require(len(offsets_m) >= 1 and offsets_m[0] == 0.0, f"{name} is {offsets_m}; it must start with 0")
    require(
        all(b > a for a, b in pairwise(offsets_m)) and offsets_m[-1] < 2000.0,
        f"{name} is {offsets_m}; it must increase and stay under 2000 m",
    )
