"""What makes elements a hump: every rule that needs more than one element."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from plant_models.hump.element_number import SIGNALS, HumpError, demand, element_name
from plant_models.hump.route import Vertex
from plant_models.hump.switch import Switch
from plant_models.hump.track_section import TrackSection
from plant_models.rolling.roll_track import LONGEST_TRACK_M

if TYPE_CHECKING:
    import networkx as nx


def require_hump(vertices: Sequence[Vertex], leads: Sequence[int]) -> None:
    """Raise `HumpError` unless `vertices` are a hump whose crests are at the signals `leads`."""
    import networkx as nx

    by_number = unique(vertices)
    require_leads(by_number, leads)
    for vertex in vertices:
        require_exits(vertex, by_number)
    network = nx.DiGraph([(v.number, edge.to) for v in vertices for edge in v.edges if edge.to is not None])
    network.add_nodes_from(by_number)
    require_no_circle(network)
    for lead in leads:
        before = next(iter(network.predecessors(lead)), None)
        demand(before is None, lead, f"{element_name(before or 0)} leads to it; nothing may lead to a crest")
    require_ways(network, by_number, leads)
    require_tracks(vertices)
    for vertex in vertices:
        require_apart(vertex, by_number)
    require_lengths(network, by_number, leads)


def unique(vertices: Sequence[Vertex]) -> Mapping[int, Vertex]:
    """The elements by number."""
    by_number: dict[int, Vertex] = {}
    for vertex in vertices:
        demand(vertex.number not in by_number, vertex.number, "there are two of this number; numbers must be unique")
        by_number[vertex.number] = vertex
    return by_number


def require_leads(by_number: Mapping[int, Vertex], leads: Sequence[int]) -> None:
    """Every lead must be a signal of the hump, and there must be one at least."""
    if not leads:
        raise HumpError("leads is empty; give the number of the signal at each crest")
    for place, lead in enumerate(leads):
        if lead not in SIGNALS:
            raise HumpError(
                f"leads: {lead} is no number of a signal; a lead must be the signal at a crest, "
                f"{SIGNALS.first} to {SIGNALS.last}",
                lead,
            )
        if lead not in by_number:
            raise HumpError(f"leads: there is no signal {lead}; add it, or take it from the list", lead)
        if lead in leads[:place]:
            raise HumpError(f"leads: signal {lead} is there twice; name each crest once", lead)


def require_exits(vertex: Vertex, by_number: Mapping[int, Vertex]) -> None:
    """Every edge must lead to an element; only a section may be the last; a switch must have two exits."""
    number = vertex.number
    for edge in vertex.edges:
        if edge.to is None:
            demand(isinstance(vertex, TrackSection), number, "an edge leads nowhere; only a section may be the last")
            continue
        demand(
            edge.to in by_number,
            number,
            f"an edge leads to {edge.to}, but there is no such element; add it or change the edge",
        )
    if isinstance(vertex, Switch):
        left, right = vertex.edges
        demand(
            left.to != right.to,
            number,
            f"both branches lead to {element_name(right.to or 0)}; a switch must have two exits",
        )


def require_no_circle(network: nx.DiGraph[int]) -> None:
    """No way may come back to where it began."""
    import networkx as nx

    if nx.is_directed_acyclic_graph(network):
        return
    circle = [start for start, _ in nx.find_cycle(network)]
    shown = " → ".join(map(str, (*circle[:8], *(["…"] if len(circle) > 8 else []), circle[0])))
    demand(False, circle[0], f"the way from it comes back to it ({shown}); the edges of a hump must not form a circle")


def require_ways(network: nx.DiGraph[int], by_number: Mapping[int, Vertex], leads: Sequence[int]) -> None:
    """Every element must be reached from a crest, and from each crest in one way at most."""
    import networkx as nx

    reached: set[int] = set()
    for lead in leads:
        here = {lead, *nx.descendants(network, lead)}
        reached |= here
        for number in sorted(here):
            ways = [start for start in network.predecessors(number) if start in here]
            demand(
                len(ways) <= 1,
                number,
                f"two ways lead to it from signal {lead}, by {' and by '.join(map(str, ways[:2]))}; the route from a "
                "crest to a track must be the only one",
            )
    for number in sorted(by_number.keys() - reached):
        vertex = by_number[number]
        what = (
            f"track {vertex.track}, which begins there," if isinstance(vertex, TrackSection) and vertex.track else "it"
        )
        demand(False, number, f"{what} is reached from no crest; join it to the hump or take it out")


def require_tracks(vertices: Sequence[Vertex]) -> None:
    """A track must have one last section, and the sections of a track must lead to it alone."""
    ends: dict[int, int] = {}
    for vertex in vertices:
        if isinstance(vertex, TrackSection) and vertex.is_last and vertex.track is not None:
            demand(
                vertex.track not in ends,
                vertex.number,
                f"track {vertex.track} ends here and in section {ends.get(vertex.track)}; a track must end once",
            )
            ends[vertex.track] = vertex.number
    behind = tracks_behind(vertices)
    for vertex in vertices:
        if isinstance(vertex, TrackSection) and vertex.track is not None:
            demand(
                behind[vertex.number] == (vertex.track,),
                vertex.number,
                f"it is of track {vertex.track}, but routes of other tracks lead over it; take its track out",
            )


def require_apart(vertex: Vertex, by_number: Mapping[int, Vertex]) -> None:
    """Insulated sections must not overlap, nor a curve the part of a switch that turns."""
    number, (_, behind_m) = vertex.number, vertex.section_m
    for edge in vertex.edges:
        if edge.to is not None:
            ahead_m = by_number[edge.to].section_m[0]
            demand(
                behind_m + ahead_m <= edge.length_m + 1e-9,
                number,
                f"its insulated section ends {behind_m:g} m behind it and that of {element_name(edge.to)} begins "
                f"{ahead_m:g} m ahead of that one, but only {edge.length_m:g} m lie between them; sections must not "
                "overlap",
            )
        if isinstance(vertex, Switch) and edge.curves:
            demand(
                edge.curves[0].from_m >= behind_m,
                number,
                f"a curve begins {edge.curves[0].from_m:g} m behind the points; it must begin behind the exit joint, "
                f"{behind_m:g} m",
            )


def require_lengths(network: nx.DiGraph[int], by_number: Mapping[int, Vertex], leads: Sequence[int]) -> None:
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
                demand(
                    branch.fouling_m <= rest,
                    number,
                    f"a fouling point is {branch.fouling_m:g} m behind the points; the shortest track behind that "
                    f"branch ends at {rest:g} m",
                )
    for lead in leads:
        demand(
            longest[lead] <= LONGEST_TRACK_M,
            lead,
            f"a route from it is {longest[lead]:g} m long; routes must have at most {LONGEST_TRACK_M:g} m",
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
