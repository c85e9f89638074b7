"""Humps of 2ⁿ tracks: a switch, a retarder behind the first and the second one, and a park retarder on every track."""

from __future__ import annotations

from plant_models.hump import Branch, Edge, HumpGraph, Retarder, Signal, Switch, TrackSection, Vertex


def edge(to: int | None, length_m: float) -> Edge:
    return Edge(to, length_m, ((0.0, 5.0),))


class Building:
    """Numbers are given in the order of building."""

    def __init__(self) -> None:
        self.switches, self.retarders, self.tracks = 0, 400, 0
        self.vertices: list[Vertex] = []

    def retarder(self, to: int) -> int:
        self.retarders += 1
        zones = ((0.0, 12.0),)
        self.vertices.append(
            Retarder(self.retarders, edge(to, 40.0), zones, 2.0, 14.0, "knp-5-bunch", exit_std_m_s=0.15)
        )
        return self.retarders

    def grow(self, levels: int, below: int) -> int:
        """The first element of what has so many levels of switches, below so many."""
        if levels == 0:
            self.tracks += 1
            self.vertices.append(TrackSection(600 + self.tracks, edge(None, 600.0), 600.0, self.tracks))
            return self.retarder(600 + self.tracks)
        self.switches += 1
        number = self.switches
        left, right = (Branch(edge(self.grow(levels - 1, below + 1), 32.0), 4.73, 27.0) for _ in range(2))
        self.vertices.append(Switch(number, left, right, 6.0, 5.0, 0.6, 0.2))
        return self.retarder(number) if below in (1, 2) else number


def full_hump(levels: int) -> HumpGraph:
    """2 to the power of `levels` tracks."""
    building = Building()
    first = building.grow(levels, 0)
    return HumpGraph((*building.vertices, Signal(201, edge(first, 42.0))), (201,))
