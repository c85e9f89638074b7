"""The hump as a graph: routes and lists of tracks against enumeration, and every planted fault."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from plant_models.hump import (
    Branch,
    Curve,
    Edge,
    HumpError,
    HumpGraph,
    PointSensor,
    Radar,
    Retarder,
    Signal,
    Switch,
    TrackSection,
    Vertex,
)
from tests.effort import sized
from tests.plant_models.hump.random_humps import edge, random_hump, retarder, small_hump, small_vertices, switch, track

Path = list[tuple[int, int | None]]


def every_path(graph: HumpGraph, number: int) -> Iterator[tuple[int, Path]]:
    """Brute force: (track, [(element, branch)]) of every way from an element, by plain recursion."""
    vertex = next(v for v in graph.vertices if v.number == number)
    if isinstance(vertex, Switch):
        for branch, taken in enumerate((vertex.left, vertex.right)):
            assert taken.edge.to is not None
            for end, path in every_path(graph, taken.edge.to):
                yield end, [(number, branch), *path]
    elif vertex.next.to is None:
        assert isinstance(vertex, TrackSection)
        assert vertex.track is not None
        yield vertex.track, [(number, None)]
    else:
        for end, path in every_path(graph, vertex.next.to):
            yield end, [(number, None), *path]


def test_routes_and_lists_of_tracks_are_those_of_enumeration() -> None:
    sizes, joined = [], 0
    for seed in range(sized(200, 1000)):
        graph = random_hump(seed)
        left: dict[int, set[int]] = {}
        right: dict[int, set[int]] = {}
        for lead in graph.leads:
            paths = dict(every_path(graph, lead))
            routes = graph.routes(lead)
            assert list(routes) == sorted(paths)
            for end, path in paths.items():
                assert [(e.number, e.position) for e in routes[end].elements] == path
                assert routes[end].code == "".join(str(branch) for _, branch in path if branch is not None)
                for number, branch in path:
                    if branch is not None:
                        (right if branch else left).setdefault(number, set()).add(end)
            sizes.append(len(paths))
        for each in graph.switches:
            assert graph.left_tracks(each.number) == tuple(sorted(left[each.number]))
            assert graph.right_tracks(each.number) == tuple(sorted(right[each.number]))
        if len(graph.leads) == 2:
            joined += bool(set(graph.routes(graph.leads[0])) & set(graph.routes(graph.leads[1])))
    assert max(sizes) > 20  # else the humps are too small to prove anything
    assert joined > 20


def test_metres_of_a_route_are_sums_over_its_edges() -> None:
    for seed in range(100):
        graph = random_hump(seed)
        for route in graph.routes(graph.leads[0]).values():
            at = 0.0
            for element in route.elements:
                vertex = element.vertex
                assert element.at_m == pytest.approx(at)
                ahead, behind = vertex.section_m
                assert (element.from_m, element.to_m) == (element.at_m - ahead, element.at_m + behind)
                taken = vertex.edges[element.position] if element.position is not None else vertex.edges[0]
                at += taken.length_m
            assert route.length_m == pytest.approx(at)
            ends = [(element.from_m, element.to_m) for element in route.elements]
            assert all(later[0] >= earlier[1] - 1e-9 for earlier, later in pairwise(ends))


def test_the_track_that_a_cut_rolls_on_falls_as_the_edges_do() -> None:
    rng = np.random.default_rng(5)
    for seed in range(100):
        graph = random_hump(seed)
        for route in graph.routes(graph.leads[0]).values():
            x = rng.uniform(0.0, route.length_m, 20)
            assert route.roll_track.fall_m(x) == pytest.approx([fall_by_steps(route.elements, at) for at in x])
            turns = [each for each in route.elements if each.position is not None]
            assert len(route.roll_track.bends) == len(turns)


def fall_by_steps(elements: tuple[object, ...], at_m: float) -> float:
    """How far a route falls to `at_m`, edge by edge and element by element."""
    fall, begin = 0.0, 0.0
    for element in elements:
        taken: Edge = element.edge  # type: ignore[attr-defined]  # a RouteElement
        starts = [start for start, _ in taken.grades]
        for (start, grade), end in zip(taken.grades, (*starts[1:], taken.length_m), strict=True):
            fall += max(0.0, min(at_m, begin + end) - (begin + start)) * grade * 1e-3
        begin += taken.length_m
    return fall


def test_the_vectors_of_the_published_model() -> None:
    graph = small_hump()
    assert graph.incidence == {201: (1,), 1: (601, 401), 401: (2,), 2: (602, 603), 601: (), 602: (), 603: ()}
    assert (graph.left_tracks(1), graph.right_tracks(1)) == ((1,), (2, 3))
    assert {t: r.code for t, r in graph.routes(201).items()} == {1: "0", 2: "10", 3: "11"}
    assert graph.route(201, 3).fouling_m(2) == 40.0 + 60.0 + 60.0 + 27.0


def test_bends_of_a_route_are_its_switches_and_curves() -> None:
    turned = Edge(
        603, 200.0, ((0.0, 1.0), (80.0, 0.5)), (Curve(20.0, 70.0, -14.0),), (PointSensor(90.0),), (Radar(90.0, 120.0),)
    )
    last = replace(switch(2, 602, 603), right=Branch(turned, 4.73, 27.0))
    graph = HumpGraph(tuple(last if v.number == 2 else v for v in small_vertices()), (201,))
    route = graph.route(201, 3)
    assert [(b.from_m, b.to_m, b.switches, b.turn_deg) for b in route.roll_track.bends] == [
        (40.0, 52.0, 1, 4.73),
        (160.0, 172.0, 1, 4.73),
        (180.0, 230.0, 0, 14.0),
    ]
    assert route.roll_track.profile.starts_m == (0.0, 40.0, 160.0, 240.0, 360.0)
    assert route.radars_m == ((250.0, 280.0),)
    assert route.free_to_m == route.length_m == 960.0


def changed(number: int, new: Vertex) -> Callable[[], HumpGraph]:
    return lambda: HumpGraph(tuple(new if v.number == number else v for v in small_vertices()), (201,))


def added(*more: Vertex, leads: tuple[int, ...] = (201,)) -> Callable[[], HumpGraph]:
    return lambda: HumpGraph((*small_vertices(), *more), leads)


FAULTS: list[tuple[Callable[[], object], int | None, str]] = [
    (changed(2, switch(2, 602, 1)), 1, "form a circle"),
    (changed(401, retarder(401, 401)), 401, "form a circle"),
    (changed(401, retarder(401, 3)), 401, "leads to 3, but there is no such element"),
    (changed(401, replace(retarder(401, 3), next=edge(None))), 401, "only a section may be the last"),
    (changed(2, switch(2, 603, 603)), 2, "both branches lead to section 603"),
    (changed(2, replace(switch(2, 3, 603), left=Branch(edge(None), 4.0, 27.0))), 2, "only a section may be the last"),
    (added(track(603, 4)), 603, "there are two of this number"),
    (lambda: switch(200, 601, 602), 200, "switch 200: the number is not in its group"),
    (lambda: switch(0, 601, 602), 0, "from 1 to 199"),
    (lambda: Signal(200, edge(1)), 200, "from 201 to 399"),
    (lambda: retarder(400, 1), 400, "from 401 to 599"),
    (lambda: track(800, 1), 800, "from 601 to 799"),
    (added(track(604, 9)), 604, "track 9, which begins there, is reached from no crest"),
    (added(Signal(202, edge(2))), 202, "reached from no crest"),
    (added(Signal(202, edge(201)), leads=(201, 202)), 201, "nothing may lead to a crest"),
    (added(leads=()), None, "leads is empty"),
    (added(leads=(1,)), 1, "is no number of a signal"),
    (added(leads=(202,)), 202, "there is no signal 202"),
    (added(leads=(201, 201)), 201, "there twice"),
    (changed(603, track(603, 2)), 603, "track 2 ends here and in section 602"),
    (changed(1, switch(1, 602, 401)), 602, "two ways lead to it from signal 201"),
    (changed(401, replace(retarder(401, 2), exit_joint_m=55.0)), 401, "sections must not overlap"),
    (changed(201, Signal(201, edge(1, 5.0))), 201, "sections must not overlap"),
    (changed(2, replace(switch(2, 602, 603), left=Branch(edge(602), 4.0, 290.0))), None, ""),
    (changed(602, track(602, 2, 200.0)), None, ""),
    (changed(603, track(603, 3, 5000.0)), None, ""),
]
"""What is built, the element that the message names, and words of it; '' where the hump is right."""


@pytest.mark.parametrize(("build", "element", "words"), FAULTS)
def test_a_planted_fault_is_told_with_its_element(build: Callable[[], object], element: int | None, words: str) -> None:
    if not words:
        build()
        return
    with pytest.raises(HumpError) as caught:
        build()
    assert words in str(caught.value)
    assert caught.value.element == element
    assert "\n" not in str(caught.value)


def test_a_curve_may_not_begin_within_a_switch() -> None:
    curved = Edge(602, 60.0, ((0.0, 1.0),), (Curve(11.0, 20.0, 3.0),))
    with pytest.raises(HumpError, match="a curve begins 11 m behind the points"):
        changed(2, replace(switch(2, 602, 603), left=Branch(curved, 4.0, 27.0)))()


def test_a_fouling_point_must_be_on_the_track() -> None:
    short = track(602, 2, 30.0)
    far = replace(switch(2, 602, 603), left=Branch(edge(602), 4.0, 95.0))
    swapped: dict[int, Vertex] = {2: far, 602: short}
    vertices = [swapped.get(v.number, v) for v in small_vertices()]
    with pytest.raises(HumpError, match="shortest track behind that branch ends at 90 m"):
        HumpGraph(tuple(vertices), (201,))


def test_sections_of_a_track_belong_to_it() -> None:
    ahead = TrackSection(604, edge(2), 40.0, track=2)
    vertices = [switch(1, 601, 604) if v.number == 1 else v for v in small_vertices() if v.number != 401]
    with pytest.raises(HumpError, match="routes of other tracks lead over it"):
        HumpGraph((*vertices, ahead), (201,))


@pytest.mark.parametrize(
    ("build", "words"),
    [
        (lambda: Edge(1, -3.0, ((0.0, 1.0),)), "length_m is -3.0"),
        (lambda: Edge(1, float("nan"), ((0.0, 1.0),)), "length_m is nan"),
        (lambda: Edge(1, 30.0, ((0.0, 60.5),)), "from -60 to 60"),
        (lambda: Edge(1, 30.0, ()), "there is none"),
        (lambda: Edge(1, 30.0, ((1.0, 1.0),)), "must begin at 0"),
        (lambda: Edge(1, 30.0, ((0.0, 1.0), (30.0, 2.0))), "at least 0.001 m long"),
        (lambda: Edge(1, 30.0, ((0.0, 1.0),), (Curve(0.0, 31.0, 2.0),)), "must not be beyond the end"),
        (lambda: Edge(1, 30.0, ((0.0, 1.0),), (Curve(0.0, 9.0, 2.0), Curve(8.0, 10.0, 2.0))), "before the one ahead"),
        (lambda: Edge(1, 30.0, ((0.0, 1.0),), (), (PointSensor(31.0),)), "must not be beyond the end"),
        (lambda: Curve(3.0, 3.0, 2.0), "must be more than from_m"),
        (lambda: Curve(0.0, 3.0, 0.0), "must turn the track"),
        (lambda: Radar(5.0, 4.0), "must be more than from_m"),
        (lambda: Retarder(401, edge(1), (), 0.0, 30.0, "a"), "at least one braking zone"),
        (lambda: Retarder(401, edge(1), ((0.0, 9.0), (8.0, 20.0)), 0.0, 30.0, "a"), "before the one ahead"),
        (lambda: Retarder(401, edge(1), ((0.0, 9.0),), 0.0, 8.0, "a"), "must not be before the end of the last zone"),
        (lambda: Retarder(401, edge(1), ((0.0, 9.0),), 0.0, 9.0, "a"), "nothing controls it; give book"),
        (lambda: Retarder(401, edge(1), ((0.0, 9.0),), 0.0, 9.0, "a", "b", exit_std_m_s=0.1), "both given"),
        (lambda: Retarder(401, edge(1), ((0.0, 9.0),), 0.0, 9.0, "a", exit_std_m_s=1.01), "from 0 to 1"),
        (lambda: TrackSection(601, edge(None), 60.0), "track is missing"),
        (lambda: TrackSection(601, edge(None), 50.0, 1), "as long as its edge"),
        (lambda: TrackSection(601, edge(None), 60.0, 1, 61.0), "at most the length"),
        (lambda: TrackSection(601, edge(1), 60.0, 1, 1.0), "in the last section of a track alone"),
    ],
)
def test_an_impossible_value_is_refused_in_one_sentence(build: Callable[[], object], words: str) -> None:
    with pytest.raises(ValueError, match=words) as caught:
        build()
    assert "\n" not in str(caught.value)
