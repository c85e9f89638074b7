"""Other switches: slower machines, longer sections, another place of the king switch."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from plant_models.hump import HumpGraph, Signal, Switch
from scripts.studies.humping.day_figures import Pair
from synth.hump.trains.hump_routes import hump_routes
from synth.hump.trains.route_ways import route_ways
from synth.hump.trains.trial import HumpTrial

THROWS_S = (0.8, 1.0)
SECTIONS_M = (9.0, 15.0)
KING_M = (36.0, 50.0)

Change = Callable[[Switch], Switch]


def sensitivity_pairs(base: HumpTrial) -> list[Pair]:
    """A pair a change, the hump as it is first."""
    graph, lead = base.routes.graph, base.routes.lead
    changed = [("as it is", graph)]
    changed += [(f"throw {each:g} s", with_switches(graph, thrown_in(each))) for each in THROWS_S]
    changed += [(f"sections {each:g} m", with_switches(graph, on_section(each))) for each in SECTIONS_M]
    changed += [(f"king switch at {each:g} m", with_king_switch(graph, lead, each)) for each in KING_M]
    return [Pair(name, on_graph(base, each)) for name, each in changed]


def thrown_in(throw_s: float) -> Change:
    """Switches with slower machines."""
    return lambda switch: replace(switch, throw_s=throw_s)


def on_section(length_m: float) -> Change:
    """Switches with longer or shorter sections: the joint behind the points is elsewhere."""
    return lambda switch: replace(switch, exit_joint_m=length_m - switch.entry_joint_m)


def with_switches(graph: HumpGraph, change: Change) -> HumpGraph:
    """The hump with every switch changed."""
    vertices = tuple(change(each) if isinstance(each, Switch) else each for each in graph.vertices)
    return HumpGraph(vertices, graph.leads)


def with_king_switch(graph: HumpGraph, lead: int, from_crest_m: float) -> HumpGraph:
    """The first switch at another place; the fall to it is the same, on a first grade that is steeper or less steep."""
    signal = graph.vertex(lead)
    assert isinstance(signal, Signal)
    edge = signal.next
    (_, steep), (turns_m, flat) = edge.grades
    rest_m = edge.length_m - turns_m
    begins_m = from_crest_m - rest_m
    moved = replace(edge, length_m=from_crest_m, grades=((0.0, steep * turns_m / begins_m), (begins_m, flat)))
    vertices = tuple(replace(signal, next=moved) if each is signal else each for each in graph.vertices)
    return HumpGraph(vertices, graph.leads)


def on_graph(base: HumpTrial, graph: HumpGraph) -> HumpTrial:
    """The trial on another hump with the same tracks behind the last position, for which its aims were chosen."""
    routes, source = hump_routes(graph, base.routes.lead), base.source
    return replace(
        base,
        source=replace(source, routes=routes.routes),
        routes=routes,
        ways=route_ways(source.people, routes.routes),
        planner=replace(base.planner, routes=routes),
    )
