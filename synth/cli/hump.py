"""`retarder-synth hump`: check a hump file, tell its routes, draw it, write it in another form."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from synth.frame.printed_numbers import ranges
from synth.frame.terminal.manner import Manner
from synth.frame.terminal.printed_page import Printed
from synth.frame.terminal.telling import OK

if TYPE_CHECKING:
    from plant_models.hump import HumpGraph, Route
    from plant_models.library.hump_entry import HumpEntry


MOST_TOLD = 30
"""Kinds of elements that were read over; `--json` tells all."""


def check_command(source: Path, manner: Manner) -> int:
    """Tell what the hump in `source` has, where everything stands, and what is likely a mistake; `InputError` with all
    faults of it."""
    from synth.frame.told import brief_exhibits, figures_of, plain, tables_of
    from synth.hump.checked_hump import checked_hump
    from synth.hump.hump_file import read_hump
    from synth.retarder.configuration.plant_fault import in_file

    read = read_hump(source)
    with in_file(str(source)):
        checked = checked_hump(read.entry)
    found = checked.exhibits()

    def document() -> Any:
        return plain({"path": str(source), **figures_of(found), **tables_of(found), "ignored": read.ignored})

    def page() -> Iterator[Printed]:
        yield from brief_exhibits(found, "--json")
        yield from (f"warning: {each.sentence}" for each in checked.warnings)
        if read.ignored:
            more = len(read.ignored) - MOST_TOLD
            rest = f" and {more} more" if more > 0 else ""
            yield f"  read over: {', '.join(read.ignored[:MOST_TOLD])}{rest}"

    manner.give(document, page)
    return OK


def routes_command(source: Path, manner: Manner) -> int:
    """Print every route of the hump in `source`, and the lists of tracks of its switches."""
    from synth.hump.hump_file import read_hump, routes_document

    graph = read_hump(source).entry.graph
    manner.give(partial(routes_document, graph), partial(routes_page, graph))
    return OK


def routes_page(graph: HumpGraph) -> Iterator[str]:
    """The routes, then the switches, in a line each."""
    yield "Elements with their metres from the crest; switches with the position that they need. Code: 0 left, 1 right."
    for lead in graph.leads:
        yield from (route_words(route, graph) for route in graph.routes(lead).values())
    for switch in graph.switches:
        left, right = graph.left_tracks(switch.number), graph.right_tracks(switch.number)
        yield f"{graph.element_called(switch.number)}: left to tracks {ranges(left)}; right to tracks {ranges(right)}"


def route_words(route: Route, graph: HumpGraph) -> str:
    """A route of `graph` in one line."""
    sides = {0: " left", 1: " right", None: ""}
    steps = [f"{graph.called(element.number)}{sides[element.position]} {element.at_m:g}" for element in route.elements]
    name = f"signal {route.lead}, track {graph.track_called(route.track)}, code {route.code or 'none'}"
    return f"{name}: {', '.join(steps)}, end {route.length_m:g}"


def draw_command(source: Path, output: Path, track: int | None, manner: Manner) -> int:
    """Draw the hump in `source` into the directory `output`; the profile is that of `track`."""
    from synth.frame.results_directory import results_directory
    from synth.hump.hump_file import read_hump

    hump = read_hump(source).entry
    route = drawn_route(hump.graph, track)
    from synth.frame.picture.house_style import figure_files
    from synth.hump.design_runners import roll_runners
    from synth.hump.hump_picture import hump_picture
    from synth.kernels.cache import guarded

    with results_directory(output, "hump draw", [source]) as directory:
        rolls = guarded(roll_runners, route)
        manner.step("a good, a mean and a bad runner rolled")
        files = directory.write_all(figure_files(hump_picture(hump, route, rolls), f"{hump.name}-hump"))
    names = [str(file) for file in files]
    manner.give(lambda: {"track": route.track, "files": names}, lambda: names)
    return OK


def export_command(source: Path, form: str, output: Path, manner: Manner) -> int:
    """Write the hump in `source` as `form` into the directory `output`."""
    from synth.frame.faults import InputError
    from synth.frame.results_directory import results_directory
    from synth.hump.hump_file import read_hump
    from synth.hump.hump_forms import to_csv, to_xlsx, tree_toml
    from synth.hump.railml.write import to_railml

    forms: dict[str, Callable[[HumpEntry], bytes]] = {
        "railml": to_railml,
        "csv": lambda hump: to_csv(hump).encode(),
        "xlsx": to_xlsx,
        "toml": lambda hump: tree_toml(hump).encode(),
    }
    if form not in forms:
        raise InputError(f"--format {form}: there is no such form; give {', '.join(forms)}")
    hump = read_hump(source).entry
    content = forms[form](hump)
    with results_directory(output, "hump export", [source]) as directory:
        name = str(directory.write(f"{hump.name}.{form}", content))
    manner.give(lambda: {"files": [name]}, lambda: [name])
    return OK


def drawn_route(graph: HumpGraph, track: int | None) -> Route:
    """The route to `track` from the first crest that reaches it; without a track, to the one with the most turning."""
    from synth.hump.hump_file import route_to

    if track is None:
        routes = [route for lead in graph.leads for route in graph.routes(lead).values()]
        return max(routes, key=lambda route: round(sum(bend.turn_deg for bend in route.roll_track.bends), 6))
    return route_to(graph, track)
