"""A hump as a railML 3 file."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final
from xml.etree import ElementTree as Xml

from plant_models.hump import Edge, HumpGraph, Retarder, Signal, Switch, TrackSection, Vertex
from plant_models.library.hump_entry import HumpEntry
from synth.hump.hump_forms import is_of_library
from synth.hump.railml.tree import LIBRARY, OWN, OWN_ZONES, RAILML, SIDES, net_element, net_relation, own, railml

LANGUAGE: Final = "en"


def to_railml(hump: HumpEntry) -> bytes:
    """The bytes of the file; the origins of the numbers are not in it. Same hump, same bytes."""
    Xml.register_namespace("", RAILML)
    Xml.register_namespace("rs", OWN)
    root = railml_of(hump)
    Xml.indent(root, " ")
    return bytes(Xml.tostring(root, encoding="utf-8", xml_declaration=True)) + b"\n"


def railml_of(hump: HumpEntry) -> Xml.Element:
    """The root of the file."""
    root = Xml.Element(railml("railML"), {"version": "3.1"})
    infrastructure = below(root, "infrastructure", id="hump")
    write_topology(below(infrastructure, "topology"), hump.graph)
    write_geometry(below(infrastructure, "geometry"), hump.graph)
    write_elements(below(infrastructure, "functionalInfrastructure"), hump.graph)
    write_own(infrastructure, hump)
    return root


def below(parent: Xml.Element, name: str, /, **attributes: object) -> Xml.Element:
    """A new element of railML in `parent`; numbers in the shortest form that reads back the same."""
    return Xml.SubElement(parent, railml(name), {key: str(value) for key, value in attributes.items()})


def own_below(parent: Xml.Element, name: str, /, **attributes: object) -> Xml.Element:
    """A new element of our namespace in `parent`."""
    return Xml.SubElement(parent, own(name), {key: str(value) for key, value in attributes.items()})


def edges_of(graph: HumpGraph) -> Iterator[tuple[Vertex, int, Edge]]:
    """(element, branch, edge) of every edge, in the order of the elements."""
    for vertex in graph.vertices:
        for branch, edge in enumerate(vertex.edges):
            yield vertex, branch, edge


def relations_of(graph: HumpGraph) -> Iterator[tuple[str, str, str]]:
    """(identifier, edge ahead, edge behind) of every way from one edge to the next."""
    for vertex, branch, edge in edges_of(graph):
        if edge.to is not None:
            behind = graph.vertex(edge.to)
            for side in range(len(behind.edges)):
                ahead, next_one = net_element(vertex, branch), net_element(behind, side)
                yield net_relation(ahead, next_one), ahead, next_one


def write_topology(topology: Xml.Element, graph: HumpGraph) -> None:
    """An element for each edge, a relation for each way from one to the next, one network with all of them."""
    elements = below(topology, "netElements")
    for vertex, branch, edge in edges_of(graph):
        below(elements, "netElement", id=net_element(vertex, branch), length=edge.length_m)
    relations = below(topology, "netRelations")
    for name, ahead, behind in relations_of(graph):
        relation = below(relations, "netRelation", id=name, positionOnA="1", positionOnB="0", navigability="AB")
        below(relation, "elementA", ref=ahead)
        below(relation, "elementB", ref=behind)
    level = below(below(below(topology, "networks"), "network", id="nw"), "level", id="lv", descriptionLevel="Micro")
    for vertex, branch, _ in edges_of(graph):
        below(level, "networkResource", ref=net_element(vertex, branch))


def write_geometry(geometry: Xml.Element, graph: HumpGraph) -> None:
    """Grades (a fall is negative in railML) and curves (to the right is positive there)."""
    gradients, curves = below(geometry, "gradientCurves"), below(geometry, "horizontalCurves")
    for vertex, branch, edge in edges_of(graph):
        name = net_element(vertex, branch)
        ends = [*(start for start, _ in edge.grades[1:]), edge.length_m]
        for place, ((start, grade), end) in enumerate(zip(edge.grades, ends, strict=True)):
            told = below(
                gradients, "gradientCurve", id=f"gc_{name}_{place}", curveType="straight", gradient=0.0 - grade
            )
            write_stretch(told, name, start, end)
        for place, curve in enumerate(edge.curves):
            turn = 0.0 - curve.turn_deg
            told = below(curves, "horizontalCurve", id=f"hc_{name}_{place}", curveType="arc", deltaAzimuth=turn)
            write_stretch(told, name, curve.from_m, curve.to_m)


def write_stretch(parent: Xml.Element, name: str, begin: float, end: float) -> None:
    """The stretch of an edge on which something is."""
    location = below(parent, "linearLocation", id=f"{parent.get('id')}_l", applicationDirection="normal")
    below(location, "associatedNetElement", netElementRef=name, keepsOrientation="true", posBegin=begin, posEnd=end)


def write_spot(parent: Xml.Element, name: str, at: float) -> None:
    """The place of an edge at which something is."""
    below(parent, "spotLocation", id=f"{parent.get('id')}_s", netElementRef=name, applicationDirection="normal", pos=at)


def write_elements(functional: Xml.Element, graph: HumpGraph) -> None:
    """Signals, switches, joints and fouling points, tracks."""
    signals, switches = below(functional, "signalsIS"), below(functional, "switchesIS")
    detection, tracks = below(functional, "trainDetectionElements"), below(functional, "tracks")
    for vertex in graph.vertices:
        if isinstance(vertex, Signal):
            told = below(signals, "signalIS", id=f"sig_{vertex.number}")
            below(told, "name", name=vertex.number, language=LANGUAGE)
            write_spot(told, net_element(vertex, 0), 0.0)
        elif isinstance(vertex, Switch):
            write_switch(switches, graph, vertex)
            for branch, side in enumerate(SIDES):
                fouling = f"fp_{vertex.number}_{side}"
                told = below(detection, "trainDetectionElement", id=fouling, type="clearancePoint")
                write_spot(told, net_element(vertex, branch), vertex.branches[branch].fouling_m)
        elif isinstance(vertex, TrackSection) and vertex.is_last:
            told = below(tracks, "track", id=f"tr_{vertex.track}", type="sidingTrack")
            below(told, "name", name=vertex.track, language=LANGUAGE)
            write_stretch(told, net_element(vertex, 0), 0.0, vertex.length_m)
        write_joints(detection, graph, vertex)


def write_switch(switches: Xml.Element, graph: HumpGraph, switch: Switch) -> None:
    """A switch, its points at the end of the first edge that leads to it."""
    told = below(switches, "switchIS", id=f"sw_{switch.number}", type="ordinarySwitch")
    below(told, "name", name=switch.number, language=LANGUAGE)
    ahead, branch, edge = edge_to(graph, switch.number)
    write_spot(told, net_element(ahead, branch), edge.length_m)
    for place, side in enumerate(SIDES):
        below(
            told, f"{side}Branch", netRelationRef=net_relation(net_element(ahead, branch), net_element(switch, place))
        )


def write_joints(detection: Xml.Element, graph: HumpGraph, vertex: Vertex) -> None:
    """The joints of the insulated section of an element, with its number."""
    if isinstance(vertex, Signal):
        return
    ahead_m, behind_m = vertex.section_m
    kind = "axleCounter" if vertex.axle_counters else "insulatedRailJoint"
    ahead, branch, edge = edge_to(graph, vertex.number)
    places = [("entry", net_element(ahead, branch), edge.length_m - ahead_m)]
    places += [(f"exit_{side}", net_element(vertex, side), behind_m) for side in range(len(vertex.edges))]
    for joint, name, at in places:
        told = below(detection, "trainDetectionElement", id=f"jt_{vertex.number}_{joint}", type=kind)
        write_spot(told, name, at)


def edge_to(graph: HumpGraph, number: int) -> tuple[Vertex, int, Edge]:
    """The first edge that leads to the element `number`, which is at no crest."""
    return next(found for found in edges_of(graph) if found[2].to == number)


def write_own(infrastructure: Xml.Element, hump: HumpEntry) -> None:
    """What railML has no word for."""
    leads = " ".join(map(str, hump.graph.leads))
    told = own_below(infrastructure, "hump", title=hump.title, leads=leads)
    for note in hump.notes:
        own_below(told, "note", text=note)
    for vertex in hump.graph.vertices:
        name = net_element(vertex, 0)
        if isinstance(vertex, Switch):
            told_of_switch = own_below(told, "switch", number=vertex.number, throw=vertex.throw_s, relay=vertex.relay_s)
            joints = {"entryJoint": vertex.entry_joint_m, "exitJoint": vertex.exit_joint_m}
            turns = {f"{side}Turn": branch.turn_deg for side, branch in zip(SIDES, vertex.branches, strict=True)}
            for key, value in (joints | turns | {"axleCounters": yes(vertex.axle_counters)} | named(vertex)).items():
                told_of_switch.set(key, str(value))
        elif isinstance(vertex, Retarder):
            write_retarder(told, vertex)
        elif isinstance(vertex, TrackSection):
            track = {} if vertex.track is None else {"track": vertex.track}
            own_below(told, "section", number=vertex.number, netElementRef=name, length=vertex.length_m, **track,
                      standing=vertex.standing_m, axleCounters=yes(vertex.axle_counters), **named(vertex))  # fmt: skip
        for branch, edge in enumerate(vertex.edges):
            for sensor in edge.point_sensors:
                own_below(told, "pointSensor", netElementRef=net_element(vertex, branch), pos=sensor.at_m)
            for radar in edge.radars:
                place = net_element(vertex, branch)
                own_below(told, "radar", netElementRef=place, posBegin=radar.from_m, posEnd=radar.to_m)


def write_retarder(parent: Xml.Element, retarder: Retarder) -> None:
    """A retarder with its zones and its controller."""
    told = own_below(parent, "retarder", number=retarder.number, netElementRef=net_element(retarder, 0),
                     position=retarder.position, entryJoint=retarder.entry_joint_m, exitJoint=retarder.exit_joint_m,
                     axleCounters=yes(retarder.axle_counters), **named(retarder))  # fmt: skip
    if retarder.book is not None:
        told.set("book", retarder.book)
    if retarder.exit_std_m_s is not None:
        told.set("exitStd", str(retarder.exit_std_m_s))
    told.set("zones", LIBRARY if is_of_library(retarder) else OWN_ZONES)
    for begin, end in retarder.zones_m:
        own_below(told, "zone", posBegin=begin, posEnd=end)
    for file in retarder.aim_tables:
        own_below(told, "aimTables", file=file)


def named(element: Switch | Retarder | TrackSection) -> dict[str, str]:
    """The attribute of an element that has a name."""
    return {} if element.name is None else {"name": element.name}


def yes(truth: bool) -> str:
    """A truth value of XML."""
    return "true" if truth else "false"
