"""railML: an independent reading of what is written gives the hump again, and equal text means an equal hump."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from xml.etree import ElementTree as Xml

import pytest

from plant_models.hump import Edge, HumpGraph, Retarder, Switch, TrackSection, Vertex
from plant_models.library.hump_entry import HumpEntry, hump_names, load_hump
from synth.hump.forms.hump_railml import to_railml
from tests.plant_models.hump.random_humps import random_hump, small_hump, small_vertices

RAILML, OWN = "{https://www.railml.org/schemas/3.1}", "{urn:retarder-synth:hump:1}"


def entry(graph: HumpGraph) -> HumpEntry:
    return HumpEntry("small", "Small", ("One note.",), graph)


def numbers(element: Xml.Element, *keys: str) -> tuple[float, ...]:
    return tuple(float(element.get(key, "nan")) for key in keys)


def on_edge(root: Xml.Element, path: str, name: str) -> Iterator[tuple[Xml.Element, Xml.Element]]:
    """(element, its place) of those elements of railML whose place is on the edge `name`."""
    for element in root.iterfind(f".//{path}"):
        yield from ((element, place) for place in element.iterfind(f".//*[@netElementRef='{name}']"))


def require_edge(root: Xml.Element, edge: Edge, name: str) -> None:
    """What is told of one edge, read by its identifier alone."""
    grades = on_edge(root, f"{RAILML}gradientCurve", name)
    curves = on_edge(root, f"{RAILML}horizontalCurve", name)
    told = [(*numbers(place, "posBegin", "posEnd"), -float(each.get("gradient", ""))) for each, place in grades]
    ends = [*(start for start, _ in edge.grades[1:]), edge.length_m]
    assert told == [(start, end, grade) for (start, grade), end in zip(edge.grades, ends, strict=True)]
    told = [(*numbers(place, "posBegin", "posEnd"), -float(each.get("deltaAzimuth", ""))) for each, place in curves]
    assert told == [(each.from_m, each.to_m, each.turn_deg) for each in edge.curves]
    [element] = root.findall(f".//{RAILML}netElement[@id='{name}']")
    assert numbers(element, "length") == (edge.length_m,)
    sensors = root.iterfind(f".//{OWN}pointSensor[@netElementRef='{name}']")
    assert [numbers(each, "pos") for each in sensors] == [(each.at_m,) for each in edge.point_sensors]
    radars = root.iterfind(f".//{OWN}radar[@netElementRef='{name}']")
    assert [numbers(each, "posBegin", "posEnd") for each in radars] == [
        (each.from_m, each.to_m) for each in edge.radars
    ]


def require_element(root: Xml.Element, vertex: Vertex) -> None:
    """What our namespace tells of one element."""
    match vertex:
        case Switch():
            [told] = root.findall(f".//{OWN}switch[@number='{vertex.number}']")
            turns = [branch.turn_deg for branch in vertex.branches]
            expected = (vertex.entry_joint_m, vertex.exit_joint_m, vertex.throw_s, vertex.relay_s, *turns)
            assert numbers(told, "entryJoint", "exitJoint", "throw", "relay", "leftTurn", "rightTurn") == expected
        case Retarder():
            [told] = root.findall(f".//{OWN}retarder[@number='{vertex.number}']")
            zones = tuple(numbers(each, "posBegin", "posEnd") for each in told.findall(f"{OWN}zone"))
            files = tuple(each.get("file") for each in told.findall(f"{OWN}aimTables"))
            assert (zones, files) == (vertex.zones_m, vertex.aim_tables)
            assert (told.get("position"), told.get("book")) == (vertex.position, vertex.book)
            assert numbers(told, "entryJoint", "exitJoint") == (vertex.entry_joint_m, vertex.exit_joint_m)
        case TrackSection():
            [told] = root.findall(f".//{OWN}section[@number='{vertex.number}']")
            assert numbers(told, "length", "standing") == (vertex.length_m, vertex.standing_m)
            assert told.get("track") == (None if vertex.track is None else str(vertex.track))


def require_written(hump: HumpEntry) -> None:
    root = Xml.fromstring(to_railml(hump))
    relations = {
        (each[0].get("ref"), each[1].get("ref")): each.get("id") for each in root.iterfind(f".//{RAILML}netRelation")
    }
    begins = {
        vertex.number: [f"ne_{vertex.number}_{side}" for side in ("left", "right")]
        if isinstance(vertex, Switch)
        else [f"ne_{vertex.number}"]
        for vertex in hump.graph.vertices
    }
    expected = set()
    for vertex in hump.graph.vertices:
        require_element(root, vertex)
        for name, edge in zip(begins[vertex.number], vertex.edges, strict=True):
            require_edge(root, edge, name)
            expected |= {(name, behind) for behind in begins.get(edge.to or 0, [])}
        if isinstance(vertex, Switch):
            for side, name, branch in zip(("left", "right"), begins[vertex.number], vertex.branches, strict=True):
                [place] = [p for e, p in spots(root, name) if e.get("type") == "clearancePoint"]
                assert numbers(place, "pos") == (branch.fouling_m,)
                [named] = root.findall(f".//{RAILML}switchIS[@id='sw_{vertex.number}']/{RAILML}{side}Branch")
                assert named.get("netRelationRef") in [v for (_, to), v in relations.items() if to == name]
    assert set(relations) == expected


def spots(root: Xml.Element, name: str) -> Iterator[tuple[Xml.Element, Xml.Element]]:
    return on_edge(root, f"{RAILML}trainDetectionElement", name)


@pytest.mark.parametrize("name", hump_names())
def test_a_hump_of_the_library_is_written_whole(name: str) -> None:
    require_written(load_hump(name))


def test_random_humps_are_written_whole() -> None:
    for seed in range(20):
        require_written(entry(random_hump(seed)))


def test_whatever_changes_in_a_hump_changes_its_text() -> None:
    """The hash of a hump is that of this text."""
    changes = {"book": "b.h5", "exit_std_m_s": None, "aim_tables": ("a.json", "b.json")}
    of_retarder = [{**changes}, {"exit_std_m_s": 0.2}, {"name": "1A"}, {"axle_counters": False}, {"exit_joint_m": 29.0}]
    texts = {to_railml(entry(small_hump())), to_railml(replace(entry(small_hump()), notes=()))}
    for change in of_retarder:
        vertices = [replace(v, **change) if isinstance(v, Retarder) else v for v in small_vertices()]  # type: ignore[arg-type]  # of these fields
        texts.add(to_railml(entry(HumpGraph(tuple(vertices), (201,)))))
    assert len(texts) == 2 + len(of_retarder)
