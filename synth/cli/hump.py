"""`retarder-synth hump`: check a hump file, tell its routes, draw it, write it in another form."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from synth.frame.terminal.printed_page import print_page
from synth.frame.terminal.telling import OK
from synth.hump.control.number_ranges import ranges

if TYPE_CHECKING:
    from plant_models.hump import HumpGraph, Route
    from plant_models.library.hump_entry import HumpEntry


MOST_TOLD = 30
"""Kinds of elements that were read over; `--json` tells all."""


def check_command(source: Path, as_json: bool) -> int:
    """Tell what the hump in `source` has, where everything stands, and what is likely a mistake; `InputError` with all
    faults of it."""
    from synth.frame.summary import figures_of, plain, tables_of
    from synth.frame.terminal.told_print import brief_exhibits
    from synth.hump.checking.checked_hump import checked_hump
    from synth.hump.hump_file import read_hump
    from synth.retarder.configuration.plant_fault import in_file

    read = read_hump(source)
    with in_file(str(source)):
        checked = checked_hump(read.entry)
    found = checked.exhibits()
    if as_json:
        document = {"path": str(source), **figures_of(found), **tables_of(found), "ignored": read.ignored}
        print(json.dumps(plain(document), indent=1, ensure_ascii=False))
        return OK
    page = [*brief_exhibits(found, "--json"), *(f"warning: {each.sentence}" for each in checked.warnings)]
    if read.ignored:
        more = len(read.ignored) - MOST_TOLD
        rest = f" and {more} more" if more > 0 else ""
        page.append(f"  read over: {', '.join(read.ignored[:MOST_TOLD])}{rest}")
    print_page(*page)
    return OK


def routes_command(source: Path, as_json: bool) -> int:
    """Print every route of the hump in `source`, and the lists of tracks of its switches."""
    from synth.hump.control.hump_document import routes_document
    from synth.hump.hump_file import read_hump

    graph = read_hump(source).entry.graph
    if as_json:
        print(json.dumps(routes_document(graph), indent=1, ensure_ascii=False))
        return OK
    page = [
        "Elements with their metres from the crest; switches with the position that they need. Code: 0 left, 1 right."
    ]
    for lead in graph.leads:
        page += (route_words(route, graph) for route in graph.routes(lead).values())
    for switch in graph.switches:
        left, right = graph.left_tracks(switch.number), graph.right_tracks(switch.number)
        page.append(
            f"{graph.element_called(switch.number)}: left to tracks {ranges(left)}; right to tracks {ranges(right)}"
        )
    print_page(*page)
    return OK


def route_words(route: Route, graph: HumpGraph) -> str:
    """A route of `graph` in one line."""
    sides = {0: " left", 1: " right", None: ""}
    steps = [f"{graph.called(element.number)}{sides[element.position]} {element.at_m:g}" for element in route.elements]
    name = f"signal {route.lead}, track {graph.track_called(route.track)}, code {route.code or 'none'}"
    return f"{name}: {', '.join(steps)}, end {route.length_m:g}"


def draw_command(source: Path, output: Path, track: int | None, as_json: bool) -> int:
    """Draw the hump in `source` into the directory `output`; the profile is that of `track`."""
    from synth.frame.results_directory import results_directory
    from synth.hump.hump_file import read_hump

    hump = read_hump(source).entry
    route = drawn_route(hump.graph, track)
    from synth.frame.picture.figure_file import figure_files
    from synth.hump.control.pictures.hump_picture import hump_picture
    from synth.hump.design_runners import roll_runners
    from synth.kernels.cache import guarded

    with results_directory(output, "hump draw", [source]) as directory:
        rolls = guarded(roll_runners, route)
        files = directory.write_all(figure_files(hump_picture(hump, route, rolls), f"{hump.name}-hump"))
    if as_json:
        print(json.dumps({"track": route.track, "files": [str(file) for file in files]}, indent=1))
    else:
        print(*files, sep="\n")
    return OK


def export_command(source: Path, output: Path) -> int:
    """Write the hump in `source` into the file `output`: railML, CSV, workbook or TOML, as its name ends."""
    from synth.frame.input_error import InputError
    from synth.frame.new_file import require_new
    from synth.hump.forms.hump_csv import to_csv, to_xlsx
    from synth.hump.forms.hump_tree import tree_toml
    from synth.hump.hump_file import CSV_SUFFIX, RAILML_SUFFIXES, WORKBOOK_SUFFIX, read_hump
    from synth.hump.railml.write import to_railml
    from tuning_tables.atomic_file import write_atomically

    forms: dict[str, Callable[[HumpEntry], bytes]] = {
        **dict.fromkeys(RAILML_SUFFIXES, to_railml),
        CSV_SUFFIX: lambda hump: to_csv(hump).encode(),
        WORKBOOK_SUFFIX: to_xlsx,
        ".toml": lambda hump: tree_toml(hump).encode(),
    }
    if output.suffix not in forms:
        *others, last = forms
        raise InputError(f"--output is {output}; its name must end with {', '.join(others)} or {last}")
    require_new(output)
    write_atomically(output, forms[output.suffix](read_hump(source).entry))
    print(output)
    return OK


def drawn_route(graph: HumpGraph, track: int | None) -> Route:
    """The route to `track` from the first crest that reaches it; without a track, to the one with the most turning."""
    from synth.hump.route_to import route_to

    if track is None:
        routes = [route for lead in graph.leads for route in graph.routes(lead).values()]
        return max(routes, key=lambda route: round(sum(bend.turn_deg for bend in route.roll_track.bends), 6))
    return route_to(graph, track)
