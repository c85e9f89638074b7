"""A hump from a railML 3 file, whatever else the file holds."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import TypeVar
from xml.etree import ElementTree as Xml

from plant_models import PlantError
from plant_models.hump import (
    Branch,
    Curve,
    Edge,
    HumpErrors,
    HumpGraph,
    PointSensor,
    Radar,
    Retarder,
    Signal,
    Switch,
    TrackSection,
    Vertex,
)
from plant_models.library.hump_elements import zones_of
from plant_models.library.hump_entry import HumpEntry
from synth.frame.faults import InputError
from synth.hump.railml.agreement import require_agreement
from synth.hump.railml.tree import OWN_ZONES, SIDES, RailmlTree, net_element, own, railml_tree
from tuning_tables.errors import excerpt

_T = TypeVar("_T")


def from_railml(text: str, name: str, file: str) -> tuple[HumpEntry, tuple[str, ...]]:
    """The hump in the railML `text`, and what of the file was read over; `InputError` in one sentence for a fault."""
    tree = railml_tree(text, file)
    whole = tree.every_own("hump")
    if len(whole) != 1:
        raise InputError(f"{file}: it has {len(whole)} elements hump of the namespace of retarder-synth; one is needed")
    require_edges(tree)
    leads = tree.text(whole[0], "leads").split()
    if not all(lead.isascii() and lead.isdigit() and len(lead) < 10 for lead in leads):
        raise tree.fault(whole[0], f"leads is {excerpt(' '.join(leads))!r}; it must be numbers of signals")
    title = tree.text(whole[0], "title")
    notes = tuple(tree.text(note, "text") for note in tree.every_own("note"))
    vertices = tuple(vertices_of(tree))
    try:
        graph = HumpGraph(vertices, tuple(map(int, leads)))
    except HumpErrors as faults:
        raise InputError(*(f"{file}: {error}" for error in faults.errors)) from None
    hump = HumpEntry(name, title, notes, graph)
    return hump, (*tree.ignored, *require_agreement(tree, hump, edge_names(tree, graph)))


def require_edges(tree: RailmlTree) -> None:
    """`InputError` for what stands on an edge that is not there."""
    names = {each.get("id") for each in tree.every("netElement")}
    for told in tree.told:
        for each in (told, *told.iterfind(".//*[@netElementRef]")):
            name = each.get("netElementRef")
            if name is not None and name not in names:
                raise tree.fault(told, f"netElementRef is {excerpt(name)!r}; there is no netElement with this id")


def edge_names(tree: RailmlTree, graph: HumpGraph) -> dict[str, str]:
    """What the writer calls the edges of `graph`, by their identifiers in the file that it was read from."""
    branches = switch_branches(tree)
    names = {edge: net_element(graph.vertex(n), side) for n, two in branches.items() for side, edge in enumerate(two)}
    return names | {tree.text(at, "netElementRef"): net_element(graph.vertex(n), 0) for n, at, _ in begun_edges(tree)}


def begun_edges(tree: RailmlTree) -> list[tuple[int, Xml.Element, Xml.Element]]:
    """(number, what tells the edge, element) of what one edge begins in: signals, retarders, sections."""
    own_ones = [(tree.whole(e, "number"), e, e) for kind in ("retarder", "section") for e in tree.every_own(kind)]
    return [*((tree.named(e), tree.inner(e, "spotLocation"), e) for e in tree.every("signalIS")), *own_ones]


def vertices_of(tree: RailmlTree) -> Iterator[Vertex]:
    """Every element of the hump."""
    edges = Edges.of(tree)
    branches, begun = switch_branches(tree), begun_edges(tree)
    numbers = {name: number for number, names in branches.items() for name in names}
    numbers |= {tree.text(place, "netElementRef"): number for number, place, _ in begun}
    elements = {tree.whole(e, "number"): e for e in tree.every_own("switch")}
    fouling = fouling_points(tree)
    for number, names in branches.items():
        if number not in elements:
            raise InputError(f"{tree.file}: switchIS {number}: our namespace has no switch of this number; add one")
        for name in names:
            if name not in fouling:
                raise InputError(
                    f"{tree.file}: switchIS {number}: there is no clearancePoint on {excerpt(name)}; give the "
                    "fouling point of each branch"
                )
        yield switch_from(tree, elements[number], [(edges.edge(name, numbers), fouling[name]) for name in names])
    for number, place, element in begun:
        edge = edges.edge(tree.text(place, "netElementRef"), numbers)
        yield element_from(tree, number, element, edge)


def switch_branches(tree: RailmlTree) -> dict[int, tuple[str, str]]:
    """The edges (left, right) that begin in each switch."""
    relations = {tree.text(e, "id"): tree.text(tree.inner(e, "elementB"), "ref") for e in tree.every("netRelation")}
    found: dict[int, tuple[str, str]] = {}
    for element in tree.every("switchIS"):
        names = []
        for side in SIDES:
            relation = tree.text(tree.inner(element, f"{side}Branch"), "netRelationRef")
            if relation not in relations:
                raise tree.fault(element, f"{side}Branch names {excerpt(relation)}; there is no such netRelation")
            names.append(relations[relation])
        found[tree.named(element)] = (names[0], names[1])
    return found


def fouling_points(tree: RailmlTree) -> dict[str, float]:
    """Metres of the clearance point on each edge that has one."""
    places = [
        tree.inner(e, "spotLocation") for e in tree.every("trainDetectionElement") if e.get("type") == "clearancePoint"
    ]
    return {tree.text(place, "netElementRef"): tree.number(place, "pos") for place in places}


def switch_from(tree: RailmlTree, element: Xml.Element, sides: list[tuple[Edge, float]]) -> Switch:
    """A switch of its element of ours; `sides`: edge and fouling point of both branches."""

    def make() -> Switch:
        left, right = (
            Branch(edge, tree.number(element, f"{side}Turn"), fouling)
            for (edge, fouling), side in zip(sides, SIDES, strict=True)
        )
        entry, leave, throw, relay = (
            tree.number(element, key) for key in ("entryJoint", "exitJoint", "throw", "relay")
        )
        counted, number = tree.truth(element, "axleCounters"), tree.whole(element, "number")
        return Switch(number, left, right, entry, leave, throw, relay, counted, tree.called(element))

    return made(tree, element, make)


def element_from(tree: RailmlTree, number: int, element: Xml.Element, edge: Edge) -> Vertex:
    """A signal, retarder or section."""
    kind = element.tag.rpartition("}")[2]
    if kind == "signalIS":
        return made(tree, element, lambda: Signal(number, edge))
    if kind == "retarder":
        return made(tree, element, lambda: retarder_from(tree, number, element, edge))
    track = None if element.get("track") is None else tree.whole(element, "track")
    length, standing = tree.number(element, "length"), tree.number(element, "standing")
    counted, name = tree.truth(element, "axleCounters"), tree.called(element)
    return made(tree, element, lambda: TrackSection(number, edge, length, track, standing, counted, name))


def retarder_from(tree: RailmlTree, number: int, element: Xml.Element, edge: Edge) -> Retarder:
    """A retarder with its zones and its controller; one whose zones are not its own is of the library."""
    position = tree.text(element, "position")
    if tree.text(element, "zones") != OWN_ZONES:
        zones_of(position)
    zones = tuple((tree.number(e, "posBegin"), tree.number(e, "posEnd")) for e in element.findall(own("zone")))
    joints = tree.number(element, "entryJoint"), tree.number(element, "exitJoint")
    book = None if element.get("book") is None else tree.text(element, "book")
    exit_std = None if element.get("exitStd") is None else tree.number(element, "exitStd")
    files = tuple(tree.text(e, "file") for e in element.findall(own("aimTables")))
    counted = tree.truth(element, "axleCounters")
    return Retarder(number, edge, zones, *joints, position, book, files, counted, exit_std, tree.called(element))


@dataclass(frozen=True)
class Edges:
    """What the file tells of each edge, by its identifier; `behind`: the edges that begin where it ends."""

    tree: RailmlTree
    elements: dict[str, Xml.Element]
    behind: dict[str, list[str]]
    grades: dict[str, list[tuple[float, float]]]
    curves: dict[str, list[tuple[float, float, float]]]
    sensors: dict[str, list[PointSensor]]
    radars: dict[str, list[Radar]]

    @classmethod
    def of(cls, tree: RailmlTree) -> Edges:
        """All edges of the file."""
        behind: dict[str, list[str]] = {}
        for relation in tree.every("netRelation"):
            ahead, next_one = tree.ends(relation)
            behind.setdefault(ahead, []).append(next_one)
        grades: dict[str, list[tuple[float, float]]] = {}
        for element in tree.every("gradientCurve"):
            place = tree.inner(element, "associatedNetElement")
            told = (tree.number(place, "posBegin"), -tree.number(element, "gradient"))
            grades.setdefault(tree.text(place, "netElementRef"), []).append(told)
        curves: dict[str, list[tuple[float, float, float]]] = {}
        for element in tree.every("horizontalCurve"):
            place = tree.inner(element, "associatedNetElement")
            ends = tree.number(place, "posBegin"), tree.number(place, "posEnd")
            turn = -tree.number(element, "deltaAzimuth")
            curves.setdefault(tree.text(place, "netElementRef"), []).append((*ends, turn))
        sensors: dict[str, list[PointSensor]] = {}
        for element in tree.every_own("pointSensor"):
            sensor = made(tree, element, partial(PointSensor, tree.number(element, "pos")))
            sensors.setdefault(tree.text(element, "netElementRef"), []).append(sensor)
        radars: dict[str, list[Radar]] = {}
        for element in tree.every_own("radar"):
            ends = tree.number(element, "posBegin"), tree.number(element, "posEnd")
            radars.setdefault(tree.text(element, "netElementRef"), []).append(
                made(tree, element, partial(Radar, *ends))
            )
        elements = {tree.text(e, "id"): e for e in tree.every("netElement")}
        return cls(tree, elements, behind, grades, curves, sensors, radars)

    def edge(self, name: str, numbers: dict[str, int]) -> Edge:
        """The edge `name`; `numbers`: the element in which each edge begins."""
        tree = self.tree
        if name not in self.elements:
            raise InputError(f"{tree.file}: netElement {excerpt(name)}: it is named, but not there; add it")
        element, to = self.elements[name], None
        for behind in self.behind.get(name, []):
            if behind not in numbers:
                raise tree.fault(element, f"it leads to {excerpt(behind)}, in which nothing begins; add the element")
            if to not in (None, numbers[behind]):
                raise tree.fault(element, f"it leads to the elements {to} and {numbers[behind]}; it must lead to one")
            to = numbers[behind]

        def make() -> Edge:
            curves = tuple(Curve(*curve) for curve in sorted(self.curves.get(name, [])))
            grades = tuple(sorted(self.grades.get(name, [])))
            sensors, radars = tuple(self.sensors.get(name, [])), tuple(self.radars.get(name, []))
            return Edge(to, tree.number(element, "length"), grades, curves, sensors, radars)

        return made(tree, element, make)


def made(tree: RailmlTree, element: Xml.Element, make: Callable[[], _T]) -> _T:
    """What `make` gives; what the plant refuses is told of `element`."""
    try:
        return make()
    except PlantError as error:
        raise tree.fault(element, str(error)) from None
