"""What `hump check` tells of a hump: what it holds, where everything stands, and what is likely a mistake."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

from plant_models.errors import PlantError
from plant_models.hump import HumpGraph, Signal
from plant_models.library.hump_entry import HumpEntry
from plant_models.library.sourced_value import SourcedValue
from synth.frame.exhibits import Column, Exhibit, Sentence, Table
from synth.frame.printed_numbers import decimals, ranges
from synth.hump.design_runners import HUMP_SPEED_M_S, Place, RolledRoute, places_of, rolled_routes
from synth.hump.hump_warnings import HumpWarning, of_grades, warnings_of

PLACES: Final = (
    Column("kind", "what", words=True),
    Column("numbers", "number", words=True),
    Column("names", "names", words=True, spare=1),
    Column("at_m", "points, entrance or beginning", "m", decimals(1)),
    Column("from_m", "section from", "m", decimals(1)),
    Column("to_m", "to", "m", decimals(1)),
    Column("fall_m", "fall from the crest", "m", decimals(2)),
    Column("good_m_s", "good runner", "m/s", decimals(1)),
    Column("bad_m_s", "bad runner", "m/s", decimals(1)),
)

WARNINGS: Final = (Column("about", "about", code=True, words=True), Column("sentence", "warnings", words=True))


@dataclass(frozen=True)
class CheckedHump:
    """A `hump` without faults, over which cars can roll; its `warnings` tell what is likely a mistake."""

    hump: HumpEntry
    rolled: tuple[RolledRoute, ...]
    warnings: tuple[HumpWarning, ...]

    def exhibits(self) -> tuple[Exhibit, ...]:
        """What is told of it."""
        warnings = Table("warnings", "What is likely a mistake", WARNINGS, [vars(each) for each in self.warnings])
        return (*held(self.hump), falls(self.rolled), places_table(places_of(self.rolled), self.hump.graph), warnings)


def checked_hump(hump: HumpEntry) -> CheckedHump:
    """The hump with its warnings; `PlantError` where no car can roll over it."""
    rolled = rolled_routes(hump.graph)
    require_rolling(hump, rolled)
    return CheckedHump(hump, rolled, warnings_of(hump, rolled))


def require_rolling(hump: HumpEntry, rolled: Sequence[RolledRoute]) -> None:
    """`PlantError` where the good runner stands ahead of the last switch or position of a route."""
    worst = min(rolled, key=lambda each: each.good.stop_m - each.last_m)
    if worst.good.stop_m < worst.last_m:
        ahead = next(element for element in worst.route.elements if element.to_m > worst.good.stop_m)
        likely = next((each.sentence for each in of_grades(hump, rolled)), "give the track more fall")
        track = hump.graph.track_called(worst.route.track)
        raise PlantError(
            f"cuts stand before {hump.graph.element_called(ahead.number)}: the good runner, let go at "
            f"{HUMP_SPEED_M_S:g} m/s and not braked, stands {worst.good.stop_m:.0f} m behind the crest on the way to "
            f"track {track}; {likely}"
        )


def held(hump: HumpEntry) -> Iterator[Sentence]:
    """What the hump has, and what its file leaves open."""
    graph = hump.graph
    routes = [route for lead in graph.leads for route in graph.routes(lead).values()]
    edges = [edge for vertex in graph.vertices for edge in vertex.edges]
    yield Sentence(f"{hump.title}: a hump without faults", {"title": hump.title}, brief=True)
    yield said(
        "  tracks: {tracks}; switches: {switches}; retarder positions: {retarders}; sections of track: {sections}; "
        "signals: {signals}",
        tracks=len(graph.tracks),
        switches=len(graph.switches),
        retarders=len(graph.retarders),
        sections=len(graph.sections),
        signals=len(graph.signals),
    )
    yield said(
        "  elements with axle counters at their joints: {axle_counters}; point sensors: {point_sensors}; radars: "
        "{radars}",
        axle_counters=sum(not isinstance(v, Signal) and v.axle_counters for v in graph.vertices),
        point_sensors=sum(len(edge.point_sensors) for edge in edges),
        radars=sum(len(edge.radars) for edge in edges),
    )
    lengths, switches = [route.length_m for route in routes], [len(route.positions) for route in routes]
    yield Sentence(
        f"  routes from signal {' and '.join(map(str, graph.leads))}: {len(routes)}; {span(lengths, ' m')}, "
        f"{span(switches, ' switches')} each",
        {
            "leads": list(graph.leads),
            "routes": len(routes),
            "route_length_m": [min(lengths), max(lengths)],
            "switches_on_a_route": [min(switches), max(switches)],
        },
        brief=True,
    )
    yield origins(hump.provenance)
    yield from controllers(graph)


def said(text: str, **figures: Any) -> Sentence:
    """A sentence with its figures in it."""
    return Sentence(text.format(**figures), figures, brief=True)


def span(values: Sequence[float], unit: str) -> str:
    """'5 switches', or '3 to 5 switches'."""
    low, high = min(values), max(values)
    return f"{low:g}{unit}" if low == high else f"{low:g} to {high:g}{unit}"


def origins(numbers: Sequence[SourcedValue]) -> Sentence:
    """How many of the numbers of a file are cited, assumed, and told without a source."""
    told = [value for value in numbers if value.source]
    assumed = sum(value.assumed for value in told)
    counts = {"cited": len(told) - assumed, "assumed": assumed, "without_source": len(numbers) - len(told)}
    text = (
        f"  numbers of the file: {counts['cited']} cited, {assumed} assumed, {counts['without_source']} without a "
        "source"
        if numbers
        else "  the file does not tell where its numbers are from"
    )
    return Sentence(text, {"numbers": counts}, brief=True)


def controllers(graph: HumpGraph) -> Iterator[Sentence]:
    """What controls each retarder."""
    booked = [each.number for each in graph.retarders if each.book is not None]
    yield Sentence(
        f"  retarders with a book of controller tables: {ranges(booked) or 'none'}",
        {"retarders_with_book": booked},
        brief=True,
    )
    by_std = retarders_by_exit_std(graph)
    for std, numbers in by_std.items():
        text = f"  retarders without a book, standard deviation of their exit speeds {std} m/s: {ranges(numbers)}"
        yield Sentence(text, {}, brief=True)
    without = [each.number for each in graph.retarders if not each.aim_tables]
    yield Sentence(
        f"  retarders without aim tables: {ranges(without) or 'none'}",
        {"retarders_by_exit_std_m_s": by_std, "retarders_without_aim_tables": without},
        brief=True,
    )


def retarders_by_exit_std(graph: HumpGraph) -> dict[str, list[int]]:
    """Retarders of whose controller only the standard deviation of the exit speeds is known, by that (m/s)."""
    found: dict[str, list[int]] = {}
    for each in sorted(graph.retarders, key=lambda each: (each.exit_std_m_s or 0.0, each.number)):
        if each.exit_std_m_s is not None:
            found.setdefault(f"{each.exit_std_m_s:g}", []).append(each.number)
    return found


def falls(rolled: Sequence[RolledRoute]) -> Sentence:
    """The fall from the crest by place, the least of all ways."""
    found: dict[str, list[float]] = {}
    for each in rolled:
        for switch in each.switches[:1]:
            found.setdefault("the first switch", []).append(each.fall_m(switch.at_m))
        for number, retarder in enumerate(each.retarders, start=1):
            found.setdefault(f"position {number}", []).append(each.fall_m(retarder.at_m))
        found.setdefault("the tracks", []).append(each.fall_m(each.track_m))
    least = {name: min(of_routes) for name, of_routes in found.items()}
    words = ", ".join(f"to {name} {fall:.2f} m" for name, fall in sorted(least.items(), key=lambda item: item[1]))
    return Sentence(f"  fall from the crest: {words}", {"fall_m": least}, brief=True)


def places_table(places: Sequence[Place], graph: HumpGraph) -> Table:
    """Where everything stands, with the names that the elements of `graph` have."""
    rows: list[Mapping[str, Any]] = [
        {**vars(place), "numbers": ranges(place.numbers), "names": names_in(place, graph)} for place in places
    ]
    title = (
        f"From the crest; speeds of the design runners, let go at {HUMP_SPEED_M_S:g} m/s and not braked: the fastest "
        "good one and the slowest bad one of all ways, with the middle there."
    )
    return Table("places", title, PLACES, rows, brief=True)


def names_in(place: Place, graph: HumpGraph) -> tuple[str, ...]:
    """Those of the elements, or tracks, of a place that have one, each behind its number."""
    names = graph.track_names if place.kind == "track" else graph.names
    return tuple(f"{number}: {names[number]}" for number in place.numbers if number in names)
