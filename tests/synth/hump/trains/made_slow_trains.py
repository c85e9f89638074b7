"""Humps and trains for the slow simulator: bare cars on flat track, for work by hand, and drawn cuts on real humps."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from plant_models.hump import Branch, Edge, HumpGraph, Retarder, Route, Signal, Switch, TrackSection, Vertex
from plant_models.rolling.random_cuts import DrawnCuts
from tests.synth.hump.trains.slow_train import Heads, SlowBody, SlowCar, SlowCut, SlowTrain

LENGTH_M, FIRST_M, LAST_M = 14.0, 1.5, 12.5
"""The bare car: its length, and where its axles are behind its head."""

LEAD, SWITCH, POSITION = 201, 1, 401
LEFT_TRACK, RIGHT_TRACK = 1, 2
TRACK_M = 400.0
POINTS_M, JOINT_AHEAD_M, JOINT_BEHIND_M, FOULING_M, THROW_S, RELAY_S = 46.0, 6.0, 5.0, 26.0, 0.6, 0.2
ENTRANCE_M, BRAKED_M = 86.0, 20.0
SECTION, SECTION_FROM_M, SECTION_TO_M = 603, 10.0, 30.0

POOR_SHARE = 0.15
"""Share of cuts of random trains that have four times their resistance."""


def bare_cut(
    track: int, crest_s: float, speed_m_s: float, exits_m_s: Sequence[float] = (9.0,), cars: int = 1
) -> SlowCut:
    """Cars without any resistance."""
    car = SlowCar(LENGTH_M, 80.0, (FIRST_M, LAST_M))
    return SlowCut(SlowBody((car,) * cars), track, crest_s, speed_m_s, tuple(exits_m_s))


def edge(to: int | None, length_m: float, grade_permille: float = 0.0) -> Edge:
    return Edge(to, length_m, ((0.0, grade_permille),))


def last_section(number: int, track: int, grade_permille: float = 0.0) -> TrackSection:
    return TrackSection(number, edge(None, TRACK_M, grade_permille), TRACK_M, track)


def straight(grade_permille: float = 0.0) -> HumpGraph:
    """A crest, 20 m, a section of 30 m, and a track."""
    section = TrackSection(602, edge(601, 60.0, grade_permille), 30.0)
    signal = Signal(LEAD, edge(602, 20.0, grade_permille))
    return HumpGraph((signal, section, last_section(601, LEFT_TRACK, grade_permille)), (LEAD,))


def one_switch(grade_permille: float = 0.0) -> HumpGraph:
    """A switch to track 1 (left) and, by a position, to track 2; flat unless a test says otherwise."""
    left = Branch(edge(601, 40.0, grade_permille), 4.73, FOULING_M)
    right = Branch(edge(POSITION, 40.0, grade_permille), 4.73, FOULING_M)
    vertices: tuple[Vertex, ...] = (
        Signal(LEAD, edge(SWITCH, POINTS_M, grade_permille)),
        Switch(SWITCH, left, right, JOINT_AHEAD_M, JOINT_BEHIND_M, THROW_S, RELAY_S),
        Retarder(
            POSITION, edge(602, 24.0, grade_permille), ((0.0, BRAKED_M),), 1.0, 22.0, "knp-5-bunch", exit_std_m_s=0.0
        ),
        last_section(601, LEFT_TRACK, grade_permille),
        last_section(602, RIGHT_TRACK, grade_permille),
    )
    return HumpGraph(vertices, (LEAD,))


def with_section_ahead(graph: HumpGraph) -> HumpGraph:
    """`one_switch` with a section from 10 to 30 m between the crest and the switch."""
    rest = [vertex for vertex in graph.vertices if vertex.number != LEAD]
    section = TrackSection(SECTION, edge(SWITCH, POINTS_M - SECTION_FROM_M), SECTION_TO_M - SECTION_FROM_M)
    return HumpGraph((Signal(LEAD, edge(SECTION, SECTION_FROM_M)), section, *rest), (LEAD,))


def with_falling_left(graph: HumpGraph, grade_permille: float) -> HumpGraph:
    """`one_switch` whose left branch falls."""
    switch = graph.vertex(SWITCH)
    assert isinstance(switch, Switch)
    left = replace(switch.left, edge=edge(601, switch.left.edge.length_m, grade_permille))
    rest = [vertex for vertex in graph.vertices if vertex.number != SWITCH]
    return HumpGraph((replace(switch, left=left), *rest), (LEAD,))


def without_positions(graph: HumpGraph) -> HumpGraph:
    """The same hump with sections of track in the place of its positions."""
    number = {retarder.number: 799 - k for k, retarder in enumerate(graph.retarders)}

    def led(old: Edge) -> Edge:
        return old if old.to not in number else replace(old, to=number[old.to])

    vertices: list[Vertex] = []
    for vertex in graph.vertices:
        if isinstance(vertex, Retarder):
            vertices.append(TrackSection(number[vertex.number], led(vertex.next), vertex.exit_joint_m))
        elif isinstance(vertex, Switch):
            left, right = (replace(branch, edge=led(branch.edge)) for branch in vertex.branches)
            vertices.append(replace(vertex, left=left, right=right))
        else:
            vertices.append(replace(vertex, next=led(vertex.next)))
    return HumpGraph(tuple(vertices), graph.leads)


def heads_in_order(drawn: DrawnCuts, i: int, routes: Mapping[int, Route]) -> dict[int, Heads]:
    """A drawn cut meets the bends of every route with the heads of its own, in order."""
    heads: Heads = tuple(zip(drawn.bend_v2_m_s2[i].tolist(), drawn.bend_head_m[i].tolist(), strict=True))
    return {track: heads[: len(route.roll_track.bends)] for track, route in routes.items()}


def slow_body(drawn: DrawnCuts, i: int, bend_heads: Mapping[int, Heads]) -> SlowBody:
    """The numbers of one drawn cut, whose row may have room for more cars; heads of bends by track."""
    cars = []
    for place, mass_t in zip(drawn.types[i], drawn.mass_t[i], strict=True):
        car = drawn.mix.cars[place].car
        overhang = (car.length_m - car.axle_offsets_m[-1]) / 2.0
        if mass_t > 0.0:
            cars.append(SlowCar(car.length_m, float(mass_t), tuple(overhang + a for a in car.axle_offsets_m)))
    return SlowBody(
        tuple(cars),
        float((drawn.mass_t[i] * drawn.basic_n_per_kn[i]).sum() / drawn.mass_t[i].sum()),
        float(drawn.head_wind_m_s[i]),
        float(drawn.air_n_per_kn[i]),
        bend_heads,
    )


def crest_times_s(bodies: Sequence[SlowBody], speeds_m_s: Sequence[float]) -> list[float]:
    """When the middles of coupled cuts are at the crest; the train gets faster evenly between two releases."""
    times = [0.0]
    for k in range(1, len(bodies)):
        path = 0.5 * (bodies[k - 1].length_m + bodies[k].length_m)
        times.append(times[-1] + path / (0.5 * (speeds_m_s[k - 1] + speeds_m_s[k])))
    return times


def random_train(graph: HumpGraph, drawn: Sequence[DrawnCuts], seed: int, tracks: Sequence[int]) -> SlowTrain:
    """One cut of each of `drawn`, to random `tracks`, at hump speeds of 1.6 to 3.2 m/s and random commands; some
    cuts roll so badly that they stop and foul. So cuts meet in every way."""
    rng, lead = np.random.default_rng(seed), graph.leads[0]
    routes = graph.routes(lead)
    bodies = [slow_body(each, 0, heads_in_order(each, 0, routes)) for each in drawn]
    bodies = [replace(b, w0_n_per_kn=b.w0_n_per_kn * (4.0 if rng.random() < POOR_SHARE else 1.0)) for b in bodies]
    speeds = np.clip(rng.uniform(1.8, 3.0) + np.cumsum(rng.uniform(-0.2, 0.2, len(drawn))), 1.6, 3.2).tolist()
    crests = crest_times_s(bodies, speeds)
    cuts = [
        SlowCut(
            body, int(rng.choice(tracks)), crest_s, speed,
            tuple(rng.uniform((3.0, 2.5, 0.8), (6.0, 5.0, 2.0)).tolist()), (0.9, 0.9, 0.5),
        )
        for body, crest_s, speed in zip(bodies, crests, speeds, strict=True)
    ]  # fmt: skip
    free = {t: float(rng.uniform(r.elements[-1].from_m + 60.0, r.length_m)) for t, r in routes.items()}
    return SlowTrain(tuple(cuts), lead, free)
