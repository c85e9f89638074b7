"""Random humps of any shape, and small ones that single faults are planted in."""

from __future__ import annotations

import tomllib
from dataclasses import replace

import numpy as np

from plant_models.hump import Branch, Edge, HumpGraph, Retarder, Signal, Switch, TrackSection, Vertex
from plant_models.library.hump_entry import HumpEntry, hump_from


def edge(to: int | None, length_m: float = 60.0, grade_permille: float = 10.0) -> Edge:
    return Edge(to, length_m, ((0.0, grade_permille),))


def switch(number: int, left: int, right: int) -> Switch:
    branches = Branch(edge(left), 4.73, 27.0), Branch(edge(right), 4.73, 27.0)
    return Switch(number, *branches, entry_joint_m=6.0, exit_joint_m=12.0, throw_s=0.6, relay_s=0.2)


def retarder(number: int, to: int) -> Retarder:
    return Retarder(number, edge(to), ((0.0, 12.0), (14.0, 26.0)), 2.0, 28.0, "knp-5-bunch", exit_std_m_s=0.15)


def track(number: int, of: int, length_m: float = 600.0) -> TrackSection:
    return TrackSection(number, edge(None, length_m, 1.0), length_m, of)


def small_vertices() -> tuple[Vertex, ...]:
    """Three tracks behind two switches: signal 201, switch 1, retarder 401, switch 2; tracks 1 (left) to 3."""
    return (
        Signal(201, edge(1, 40.0, 45.0)),
        switch(1, 601, 401),
        retarder(401, 2),
        switch(2, 602, 603),
        track(601, 1),
        track(602, 2),
        track(603, 3),
    )


def small_hump() -> HumpGraph:
    return HumpGraph(small_vertices(), (201,))


class Growing:
    """A hump that grows from its crests by drawn elements; numbers are drawn from their groups, too."""

    def __init__(self, seed: int) -> None:
        self.random = np.random.default_rng(seed)
        self.for_names = np.random.default_rng((seed, 1))
        self.free = [list(self.random.permutation(np.arange(a, a + 199))) for a in (1, 201, 401, 601)]
        self.tracks = list(self.random.permutation(np.arange(1, 200)))
        self.vertices: list[Vertex] = []

    def number(self, group: int) -> int:
        return int(self.free[group].pop())

    def name(self) -> str | None:
        """What a yard may call an element, or no name; a number, too."""
        return [None, "East 4", "12", 'стрелка "103"; 1,5'][self.for_names.integers(4)]

    def edge(self, to: int | None) -> Edge:
        length = float(self.random.uniform(60.0, 200.0))
        grades = [(0.0, float(self.random.uniform(-2.0, 50.0)))]
        if self.random.random() < 0.5:
            grades.append((length / 3.0, float(self.random.uniform(-2.0, 50.0))))
        return Edge(to, length, tuple(grades))

    def grow(self, depth: int) -> int:
        """Add what begins here, and return the number of its first element."""
        kind = self.random.random()
        if depth == 0 or kind < 0.1:
            last = self.edge(None)
            number = self.number(3)
            name = self.name()
            self.vertices.append(TrackSection(number, last, last.length_m, int(self.tracks.pop()), name=name))
        elif kind < 0.7:
            number = self.number(0)
            left, right = (Branch(self.edge(self.grow(depth - 1)), 4.73, 27.0) for _ in range(2))
            self.vertices.append(Switch(number, left, right, 6.0, 12.0, 0.6, 0.2, name=self.name()))
        elif kind < 0.8:
            number = self.number(1)
            self.vertices.append(Signal(number, self.edge(self.grow(depth - 1))))
        elif kind < 0.9:
            number = self.number(2)
            to = self.grow(depth - 1)
            self.vertices.append(replace(retarder(number, to), next=self.edge(to), name=self.name()))
        else:
            number = self.number(3)
            self.vertices.append(TrackSection(number, self.edge(self.grow(depth - 1)), 10.0))
        return number


def random_hump(seed: int) -> HumpGraph:
    """A hump with one or two crests; with two, the second joins the first one's tracks or has its own."""
    growing = Growing(seed)
    depth = int(growing.random.integers(1, 7))
    first = growing.grow(depth)
    leads = [growing.number(1)]
    growing.vertices.append(Signal(leads[0], growing.edge(first)))
    if growing.random.random() < 0.4:
        # a place of the first hump to join: anything but its crest
        places = [v.number for v in growing.vertices if v.number != leads[0]]
        joined = int(growing.random.choice(places)) if growing.random.random() < 0.5 else growing.grow(depth)
        leads.append(growing.number(1))
        growing.vertices.append(Signal(leads[1], growing.edge(joined)))
    order = growing.random.permutation(len(growing.vertices))
    return HumpGraph(tuple(growing.vertices[place] for place in order), tuple(leads))


SMALL = """\
format = "hump"
version = 1
title = "Small"
source = "engineering judgement: a test"
confidence = "L"

[type.turnout]
entry_joint_m = 6
exit_joint_m = 5
throw_s = { value = 0.6, source = "a data sheet", confidence = "H" }
relay_s = 0.2
left = { turn_deg = 4.73, fouling_m = 26, length_m = 60, grade_permille = 10 }
right = { turn_deg = 4.73, fouling_m = 26, length_m = 60, grade_permille = 10 }

[type.track]
next = { length_m = 300, grade_permille = [[0, 1], [200, 0]] }

[hump]
leads = [201]
signal = [{ number = 201, next = { to = 1, length_m = 42, grade_permille = 45 } }]
switch = [
    { number = 1, type = "turnout", left = { to = 401 }, right = { to = 602 } },
]
section = [
    { number = 601, type = "track", track = 1 },
    { number = 602, type = "track", track = 2, standing_m = 20 },
]

[[hump.retarder]]
number = 401
position = "knp-5-bunch"
entry_joint_m = 1
exit_joint_m = 28
next = { to = 601, length_m = 40, grade_permille = 8, curves = [[30, 40, -14]], radars_m = [[0, 27]] }
exit_std_m_s = 0.15
"""


def read(text: str) -> HumpEntry:
    return hump_from(tomllib.loads(text), text, "small", "small.toml")
