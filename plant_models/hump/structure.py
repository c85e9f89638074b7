"""What makes elements a hump: every rule that needs more than one element."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from plant_models.hump.elements import Switch, TrackSection
from plant_models.hump.ranges import SIGNALS, HumpError, HumpErrors, NumberGroup, element_name, fault_of
from plant_models.hump.route import Vertex
from plant_models.rolling.roll_track import LONGEST_TRACK_M

if TYPE_CHECKING:
    import networkx as nx


def require_hump(vertices: Sequence[Vertex], leads: Sequence[int]) -> None:
    """Raise `HumpErrors` unless `vertices` are a hump whose crests are at the signals `leads`."""
    faults = tuple(structure_faults(vertices, leads, {}))
    if faults:
        raise HumpErrors(*faults)


def structure_faults(
    vertices: Sequence[Vertex],
    leads: Sequence[int],
    unmade: Mapping[int, Sequence[int]],
    unnumbered: Collection[NumberGroup] = (),
    unsure: bool = False,
) -> Iterator[HumpError]:
    """Everything for which `vertices` are no hump, but for what follows from another fault.

    `unmade`: further elements, which have faults of their own: by number, where they lead. `unnumbered`: groups
    in which the number of an element is not known. `unsure`: of some element it is not known where it leads.
    """
    import networkx as nx

    by_number = {vertex.number: vertex for vertex in vertices}
    known = {*by_number, *unmade}
    unsure = unsure or len(unnumbered) > 0
    named = {*leads, *(edge.to for vertex in vertices for edge in vertex.edges if edge.to is not None)}
    there = known | {number for number in named for group in unnumbered if number in group}
    twice = list(repeated(vertices))
    first = [
        *twice,
        *lead_faults(there, leads),
        *(fault for vertex in vertices for fault in exit_faults(vertex, there)),
    ]
    yield from first
    if twice:
        return
    ways = [(vertex.number, edge.to) for vertex in vertices for edge in vertex.edges]
    ways += [(number, to) for number, exits in unmade.items() for to in exits]
    network: nx.DiGraph[int] = nx.DiGraph([(start, to) for start, to in ways if to in known])
    network.add_nodes_from(sorted(known))
    circles = list(circle_faults(network))
    yield from circles
    for vertex in vertices:
        yield from apart_faults(vertex, by_number)
    yield from track_end_faults(vertices)
    if circles:
        return
    crests = [lead for lead in leads if lead in known]
    yield from way_faults(network, crests)
    if not first and not unsure:
        yield from unreached_faults(network, by_number, crests)
    if not first and not unsure and not unmade:
        yield from track_faults(vertices)
        yield from length_faults(network, by_number, leads)


def repeated(vertices: Sequence[Vertex]) -> Iterator[HumpError]:
    """Numbers must be unique."""
    met: set[int] = set()
    for vertex in vertices:
        if vertex.number in met:
            yield fault_of(vertex.number, "there are two of this number; numbers must be unique")
        met.add(vertex.number)


def lead_faults(known: Collection[int], leads: Sequence[int]) -> Iterator[HumpError]:
    """Every lead must be a signal of the hump, and there must be one at least."""
    if not leads:
        yield HumpError("leads is empty; give the number of the signal at each crest")
    for place, lead in enumerate(leads):
        if lead not in SIGNALS:
            yield HumpError(
                f"leads: {lead} is no number of a signal; a lead must be the signal at a crest, "
                f"{SIGNALS.first} to {SIGNALS.last}",
                lead,
            )
        elif lead not in known:
            yield HumpError(f"leads: there is no signal {lead}; add it, or take it from the list", lead)
        if lead in leads[:place]:
            yield HumpError(f"leads: signal {lead} is there twice; name each crest once", lead)


def exit_faults(vertex: Vertex, known: Collection[int]) -> Iterator[HumpError]:
    """Every edge must lead to an element; only a section may be the last; a switch must have two exits."""
    number = vertex.number
    for edge in vertex.edges:
        if edge.to is None:
            if not isinstance(vertex, TrackSection):
                yield fault_of(number, "an edge leads nowhere; only a section may be the last")
        elif edge.to not in known:
            yield fault_of(
                number, f"an edge leads to {edge.to}, but there is no such element; add it or change the edge"
            )
    if isinstance(vertex, Switch):
        left, right = vertex.edges
        if left.to is not None and left.to == right.to:
            yield fault_of(number, f"both branches lead to {element_name(left.to)}; a switch must have two exits")


def circle_faults(network: nx.DiGraph[int]) -> Iterator[HumpError]:
    """No way may come back to where it began."""
    import networkx as nx

    for circle in nx.strongly_connected_components(network):
        start = min(circle)
        if len(circle) == 1 and not network.has_edge(start, start):
            continue
        ring = [number for number, _ in nx.find_cycle(network.subgraph(circle), start)]
        shown = " → ".join(map(str, (*ring[:8], *(["…"] if len(ring) > 8 else []), ring[0])))
        yield fault_of(
            ring[0], f"the way from it comes back to it ({shown}); the edges of a hump must not form a circle"
        )


def way_faults(network: nx.DiGraph[int], leads: Sequence[int]) -> Iterator[HumpError]:
    """Nothing may lead to a crest, and from each crest one way at most to every element."""
    import networkx as nx

    told: set[int] = set()
    for lead in leads:
        before = next(iter(network.predecessors(lead)), None)
        if before is not None:
            yield fault_of(lead, f"{element_name(before)} leads to it; nothing may lead to a crest")
        here = {lead, *nx.descendants(network, lead)}
        for number in sorted(here - told):
            ways = [start for start in network.predecessors(number) if start in here]
            if len(ways) > 1:
                told.add(number)
                yield fault_of(
                    number,
                    f"two ways lead to it from signal {lead}, by {' and by '.join(map(str, ways[:2]))}; the route from "
                    "a crest to a track must be the only one",
                )


def unreached_faults(
    network: nx.DiGraph[int], by_number: Mapping[int, Vertex], leads: Sequence[int]
) -> Iterator[HumpError]:
    """Every element must be reached from a crest; of those that are not, the first of each way is told."""
    import networkx as nx

    reached = {*leads, *(number for lead in leads for number in nx.descendants(network, lead))}
    for number in sorted(set(network) - reached):
        if next(iter(network.predecessors(number)), None) is not None:
            continue
        vertex = by_number.get(number)
        of_track = isinstance(vertex, TrackSection) and vertex.track is not None
        what = f"track {vertex.track}, which begins there," if of_track else "it"  # type: ignore[union-attr]  # a section
        yield fault_of(number, f"{what} is reached from no crest; join it to the hump or take it out")


def track_end_faults(vertices: Sequence[Vertex]) -> Iterator[HumpError]:
    """A track must have one last section."""
    ends: dict[int, int] = {}
    for vertex in vertices:
        if isinstance(vertex, TrackSection) and vertex.is_last and vertex.track is not None:
            if vertex.track in ends:
                yield fault_of(
                    vertex.number,
                    f"track {vertex.track} ends here and in section {ends[vertex.track]}; a track must end once",
                )
            ends[vertex.track] = vertex.number


def track_faults(vertices: Sequence[Vertex]) -> Iterator[HumpError]:
    """The sections of a track must lead to it alone."""
    behind = tracks_behind(vertices)
    for vertex in vertices:
        if isinstance(vertex, TrackSection) and vertex.track is not None and behind[vertex.number] != (vertex.track,):
            yield fault_of(
                vertex.number,
                f"it is of track {vertex.track}, but routes of other tracks lead over it; take its track out",
            )


def apart_faults(vertex: Vertex, by_number: Mapping[int, Vertex]) -> Iterator[HumpError]:
    """Insulated sections must not overlap, nor a curve the part of a switch that turns."""
    number, (_, behind_m) = vertex.number, vertex.section_m
    for edge in vertex.edges:
        if edge.to is not None and edge.to in by_number:
            ahead_m = by_number[edge.to].section_m[0]
            if not behind_m + ahead_m <= edge.length_m + 1e-9:
                yield fault_of(
                    number,
                    f"its insulated section ends {behind_m:g} m behind it and that of {element_name(edge.to)} begins "
                    f"{ahead_m:g} m ahead of that one, but only {edge.length_m:g} m lie between them; sections must "
                    "not overlap",
                )
        if isinstance(vertex, Switch) and edge.curves and not edge.curves[0].from_m >= behind_m:
            yield fault_of(
                number,
                f"a curve begins {edge.curves[0].from_m:g} m behind the points; it must begin behind the exit joint, "
                f"{behind_m:g} m",
            )


def length_faults(
    network: nx.DiGraph[int], by_number: Mapping[int, Vertex], leads: Sequence[int]
) -> Iterator[HumpError]:
    """Fouling points must lie on every route behind their switch, and no route may be longer than cuts can roll."""
    import networkx as nx

    shortest: dict[int, float] = {}
    longest: dict[int, float] = {}
    for number in reversed(list(nx.topological_sort(network))):
        edges = by_number[number].edges
        rests = [(e.length_m, e.length_m) for e in edges if e.to is None]
        rests += [(e.length_m + shortest[e.to], e.length_m + longest[e.to]) for e in edges if e.to is not None]
        shortest[number], longest[number] = min(rest for rest, _ in rests), max(rest for _, rest in rests)
        vertex = by_number[number]
        if isinstance(vertex, Switch):
            for branch, (rest, _) in zip(vertex.branches, rests, strict=True):
                if not branch.fouling_m <= rest:
                    yield fault_of(
                        number,
                        f"a fouling point is {branch.fouling_m:g} m behind the points; the shortest track behind that "
                        f"branch ends at {rest:g} m",
                    )
    for lead in leads:
        if not longest[lead] <= LONGEST_TRACK_M:
            yield fault_of(
                lead, f"a route from it is {longest[lead]:g} m long; routes must have at most {LONGEST_TRACK_M:g} m"
            )


def tracks_behind(vertices: Sequence[Vertex]) -> Mapping[int, tuple[int, ...]]:
    """Numbers of the tracks that end behind each element, in order, by its number; no way may form a circle."""
    import networkx as nx

    by_number = {vertex.number: vertex for vertex in vertices}
    network = nx.DiGraph([(v.number, edge.to) for v in vertices for edge in v.edges if edge.to is not None])
    network.add_nodes_from(by_number)
    found: dict[int, set[int]] = {}
    for number in reversed(list(nx.topological_sort(network))):
        vertex = by_number[number]
        found[number] = set().union(*(found[edge.to] for edge in vertex.edges if edge.to is not None))
        if isinstance(vertex, TrackSection) and vertex.is_last and vertex.track is not None:
            found[number] = {vertex.track}
    return {number: tuple(sorted(tracks)) for number, tracks in found.items()}
