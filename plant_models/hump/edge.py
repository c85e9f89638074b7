"""An edge of the hump graph: the track from one element to the next, with its falls, curves and speed sensors."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

from plant_models.errors import require, require_between

LONGEST_EDGE_M = 5000.0
STEEPEST_PERMILLE = 60.0
SHORTEST_GRADE_M = 0.1
"""Shortest element of a profile; metres from the crest still tell shorter ones apart, but nobody builds them."""


@dataclass(frozen=True)
class Curve:
    """A curve from `from_m` to `to_m` of its edge; it turns the track by `turn_deg` degrees, to the left positive."""

    from_m: float
    to_m: float
    turn_deg: float

    def __post_init__(self) -> None:
        require_between("curve: from_m", self.from_m, 0.0, LONGEST_EDGE_M)
        require_between("curve: to_m", self.to_m, 0.0, LONGEST_EDGE_M)
        require(self.to_m > self.from_m, f"curve: to_m is {self.to_m:g}; it must be more than from_m, {self.from_m:g}")
        require_between("curve: turn_deg", self.turn_deg, -180.0, 180.0)
        require(self.turn_deg != 0.0, "curve: turn_deg is 0; a curve must turn the track")


@dataclass(frozen=True)
class PointSensor:
    """Two wheel sensors close together, `at_m` of the edge: they tell that a wheel passes, its direction and speed."""

    at_m: float

    def __post_init__(self) -> None:
        require_between("point sensor: at_m", self.at_m, 0.0, LONGEST_EDGE_M)


@dataclass(frozen=True)
class Radar:
    """A radar that measures the speed of what is between `from_m` and `to_m` of the edge."""

    from_m: float
    to_m: float

    def __post_init__(self) -> None:
        require_between("radar: from_m", self.from_m, 0.0, LONGEST_EDGE_M)
        require_between("radar: to_m", self.to_m, 0.0, LONGEST_EDGE_M)
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
    grades: tuple[tuple[float, float], ...]
    curves: tuple[Curve, ...] = ()
    point_sensors: tuple[PointSensor, ...] = ()
    radars: tuple[Radar, ...] = ()

    def __post_init__(self) -> None:
        require_between("length_m", self.length_m, 0.1, LONGEST_EDGE_M)
        require(len(self.grades) > 0, "grades: there is none; an edge must have at least one, from 0 m on")
        starts = [start for start, _ in self.grades]
        require(starts[0] == 0.0, f"grades: the first begins at {starts[0]:g} m; it must begin at 0")
        for ahead, behind in pairwise((*starts, self.length_m)):
            require(
                behind - ahead >= SHORTEST_GRADE_M,
                f"grades: the one from {ahead:g} m ends at {behind:g} m; each must be at least {SHORTEST_GRADE_M:g} m "
                f"long, in order, and begin on the edge, which ends at {self.length_m:g} m",
            )
        for _, grade in self.grades:
            require_between("grades: a grade", grade, -STEEPEST_PERMILLE, STEEPEST_PERMILLE)
        for first, second in pairwise(self.curves):
            require(
                second.from_m >= first.to_m,
                f"curves: one begins at {second.from_m:g} m, before the one ahead of it ends at {first.to_m:g} m",
            )
        for curve in self.curves:
            self._require_on_edge("curves: one ends at", curve.to_m)
        for sensor in self.point_sensors:
            self._require_on_edge("point_sensors: one is at", sensor.at_m)
        for radar in self.radars:
            self._require_on_edge("radars: one ends at", radar.to_m)

    def _require_on_edge(self, words: str, place_m: float) -> None:
        require(
            place_m <= self.length_m,
            f"{words} {place_m:g} m; it must not be beyond the end of the edge, {self.length_m:g} m",
        )
