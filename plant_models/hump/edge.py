"""An edge of the hump graph: the track from one element to the next, with its falls, curves and speed sensors."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

from plant_models.errors import require, require_none
from plant_models.hump.ranges import CURVE_DEG, GRADE_PERMILLE, LENGTH_M, PLACE_M

SHORTEST_GRADE_M: Final = 0.001
"""Shortest piece of a profile: metres from the crest still tell its ends apart."""

Grades = tuple[tuple[float, float], ...]
"""(from_m, permille) of each piece of a profile, downhill positive."""


def grade_faults(grades: Sequence[tuple[float, float]], ends_m: float) -> Iterator[str]:
    """A sentence for each fault of `grades` on a track that ends at `ends_m`; the first must begin at 0 m."""
    if not grades:
        yield "grades: there is none; there must be at least one, from 0 m on"
        return
    starts = [start for start, _ in grades]
    if starts[0] != 0.0:
        yield f"grades: the first begins at {starts[0]:g} m; it must begin at 0"
    for ahead, behind in pairwise((*starts, ends_m)):
        if not behind - ahead >= SHORTEST_GRADE_M:
            yield (
                f"grades: the one from {ahead:g} m ends at {behind:g} m; each must be at least {SHORTEST_GRADE_M:g} m "
                f"long, in order, and begin on the track, which ends at {ends_m:g} m"
            )
    for _, grade in grades:
        yield from GRADE_PERMILLE.faults("grades: a grade", grade)


@dataclass(frozen=True)
class Curve:
    """A curve from `from_m` to `to_m` of its edge; it turns the track by `turn_deg` degrees, to the left positive."""

    from_m: float
    to_m: float
    turn_deg: float

    def __post_init__(self) -> None:
        PLACE_M.require("curve: from_m", self.from_m)
        PLACE_M.require("curve: to_m", self.to_m)
        require(self.to_m > self.from_m, f"curve: to_m is {self.to_m:g}; it must be more than from_m, {self.from_m:g}")
        CURVE_DEG.require("curve: turn_deg", self.turn_deg)
        require(self.turn_deg != 0.0, "curve: turn_deg is 0; a curve must turn the track")


@dataclass(frozen=True)
class PointSensor:
    """Two wheel sensors close together, `at_m` of the edge: they tell that a wheel passes, its direction and speed."""

    at_m: float

    def __post_init__(self) -> None:
        PLACE_M.require("point sensor: at_m", self.at_m)


@dataclass(frozen=True)
class Radar:
    """A radar that measures the speed of what is between `from_m` and `to_m` of the edge."""

    from_m: float
    to_m: float

    def __post_init__(self) -> None:
        PLACE_M.require("radar: from_m", self.from_m)
        PLACE_M.require("radar: to_m", self.to_m)
        require(self.to_m > self.from_m, f"radar: to_m is {self.to_m:g}; it must be more than from_m, {self.from_m:g}")


@dataclass(frozen=True)
class Edge:
    """Track of `length_m` from an element to the element with the number `to`, or, where that is None, to its end.

    `grades`: (from_m, permille) of each element of the profile, downhill positive, the first from 0. All metres count
    from the element in which the edge begins: the points of a switch, the entrance of a retarder, the beginning of a
    section, a signal. Raises `PlantError`.
    """

    to: int | None
    length_m: float
    grades: Grades
    curves: tuple[Curve, ...] = ()
    point_sensors: tuple[PointSensor, ...] = ()
    radars: tuple[Radar, ...] = ()

    def __post_init__(self) -> None:
        LENGTH_M.require("length_m", self.length_m)
        require_none(self._faults())

    def _faults(self) -> Iterator[str]:
        yield from grade_faults(self.grades, self.length_m)
        for first, second in pairwise(self.curves):
            if not second.from_m >= first.to_m:
                yield f"curves: one begins at {second.from_m:g} m, before the one ahead of it ends at {first.to_m:g} m"
        places = [
            *(("curves: one ends at", curve.to_m) for curve in self.curves),
            *(("point_sensors: one is at", sensor.at_m) for sensor in self.point_sensors),
            *(("radars: one ends at", radar.to_m) for radar in self.radars),
        ]
        for words, place_m in places:
            if not place_m <= self.length_m:
                yield f"{words} {place_m:g} m; it must not be beyond the end of the edge, {self.length_m:g} m"
