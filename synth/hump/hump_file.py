"""A hump from a user's file or from the library: TOML, railML, CSV or workbook → `ReadHump`, each fault a sentence.

People give a file to the command that reads another kind; which kind it is, is told here, too. So are the route to one
track of a hump, and all its routes for programs.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from typing import Any, Final

from plant_models.errors import near_miss
from plant_models.hump import HumpGraph, Route, Switch
from plant_models.library import BUILT_IN
from plant_models.library.hump_entry import FORMAT, HumpEntry, hump_from, hump_names
from plant_models.library.hump_entry import load_hump as load_of_library
from plant_models.library.library import HUMPS
from synth.frame.faults import InputError
from synth.frame.printed_numbers import ranges
from synth.frame.settings.toml_file import read_content, read_text, read_toml
from synth.frame.sheet import first_sheet_csv
from synth.hump.configuration.settings import HumpTrialSettings
from synth.hump.hump_forms import from_csv
from synth.hump.making.short_hump import ShortHump
from synth.hump.railml.read import from_railml
from synth.retarder.configuration.plant_fault import in_file


class FileKind(Enum):
    """What messages call it."""

    HUMP = "hump file"
    TRIAL = "hump trial"
    SHORT = "short hump file"


READ_BY = {FileKind.HUMP: "check", FileKind.TRIAL: "simulate", FileKind.SHORT: "make"}
"""The command behind `hump` that reads each kind."""


def require_kind(tree: Mapping[str, Any], file: str, wanted: FileKind) -> None:
    """`InputError` where the tables `tree` of `file` are of another kind, which tells the command that reads it."""
    found = kind_of(tree)
    if found not in (None, wanted):
        raise InputError(
            f"{file}: this is a {found.value}, not a {wanted.value}; use 'retarder-synth hump {READ_BY[found]} {file}'"
        )


def kind_of(tree: Mapping[str, Any]) -> FileKind | None:
    """By the keys at the top; None where they tell nothing."""
    if tree.get("format") == FORMAT or isinstance(tree.get("hump"), dict):
        return FileKind.HUMP
    trial, short = set(HumpTrialSettings.model_fields), set(ShortHump.model_fields)
    if tree.keys() & (short - trial):
        return FileKind.SHORT
    return FileKind.TRIAL if tree.keys() & (trial - short) else None


RAILML_SUFFIXES: Final = (".railml", ".xml")
CSV_SUFFIX: Final = ".csv"
WORKBOOK_SUFFIX: Final = ".xlsx"
TABLE_SUFFIXES: Final = (CSV_SUFFIX, WORKBOOK_SUFFIX)
OTHER_SUFFIXES: Final = (*RAILML_SUFFIXES, *TABLE_SUFFIXES)
"""Of files of humps that are no TOML."""


@dataclass(frozen=True)
class ReadHump:
    """The hump of a file; `ignored`: what a railML file holds besides, which was read over."""

    entry: HumpEntry
    ignored: tuple[str, ...] = ()


def load_hump(source: Path | str) -> HumpEntry:
    """Read a hump.

    Parameters
    ----------
    source
        A file (.toml, .railml, .csv, .xlsx), or the name of a hump of the library.

    Returns
    -------
    HumpEntry
        `graph` has the elements, `graph.route(201, 7)` is the route from the crest at signal 201 to track 7.

    Raises
    ------
    InputError
        A sentence for each fault of the file.

    Examples
    --------
    >>> import synth
    >>> hump = synth.load_hump("medium")
    >>> len(hump.graph.tracks), hump.graph.route(hump.graph.leads[0], 7).code
    (16, '...')
    """
    return read_hump(Path(source)).entry


def read_hump(source: Path) -> ReadHump:
    """The same with what was read over; the files that its retarders name must be there."""
    read = read_graph(source)
    if source.exists():
        require_files(read.entry, source)
    return read


def read_graph(source: Path) -> ReadHump:
    """The hump in the file `source`, or the one of that name in the library, whatever files it names."""
    name = str(source)
    there = os.path.exists(source)  # pathlib would raise for a name that is too long to ask for
    if name in hump_names() and not source.is_file():
        with in_file(name):
            return ReadHump(load_of_library(name))
    if not there:
        hint = near_miss(name, hump_names())
        raise InputError(f"{name}: there is no such file, and no such hump in the library; {hint}")
    if source.suffix == WORKBOOK_SUFFIX:
        return ReadHump(from_csv(first_sheet_csv(read_content(source), name), source.stem, name))
    text = read_text(source)
    if source.suffix in RAILML_SUFFIXES:
        return ReadHump(*from_railml(text, source.stem, name))
    read = from_csv if source.suffix == CSV_SUFFIX else parse_hump
    return ReadHump(read(text, source.stem, name))


def hump_text(source: Path) -> str:
    """The text of the file `source`, or of the hump of that name in the library."""
    if str(source) in hump_names() and not source.is_file():
        return BUILT_IN.file(HUMPS, str(source)).text
    return read_text(source)


def parse_hump(text: str, name: str, file: str) -> HumpEntry:
    """The hump `name` written as TOML in `text`; `file`: what messages call it. `InputError` with all that is at fault:
    what is no TOML, and where it is known what was meant there, what would be at fault then."""
    read = read_toml(text, file)
    told = read.faults
    if read.tree is not None:
        require_kind(read.tree, file, FileKind.HUMP)
        try:
            with in_file(file):
                hump = hump_from(read.tree, read.text, name, file)
        except InputError as fault:
            told += fault.sentences
        else:
            if not told:
                return hump
    raise InputError(*told)


def require_files(hump: HumpEntry, source: Path) -> None:
    """`InputError` for files that retarders name and that are not there; paths begin at the folder of `source`."""
    missing = []
    for retarder in hump.graph.retarders:
        books = [("book", retarder.book)] if retarder.book is not None else []
        for key, file in (*books, *(("aim_tables", file) for file in retarder.aim_tables)):
            if not (source.parent / file).is_file():
                missing.append(
                    f"{source}: retarder {retarder.number}: {key} names {file}, and there is no such file; make it, or "
                    "take it out"
                )
    if missing:
        raise InputError(*missing)


def route_to(graph: HumpGraph, track: int) -> Route:
    """The route to `track` from the first crest that reaches it; `InputError` where there is no such track."""
    for lead in graph.leads:
        routes = graph.routes(lead)
        if track in routes:
            return routes[track]
    raise InputError(f"--track is {track}; the hump has the tracks {ranges(graph.tracks)}")


def routes_document(graph: HumpGraph) -> dict[str, Any]:
    """Every route, and the lists of tracks of every switch."""
    return {
        "routes": [route_document(route, graph) for lead in graph.leads for route in graph.routes(lead).values()],
        "switches": [
            {
                "number": switch.number,
                "name": switch.name,
                "left_tracks": list(graph.left_tracks(switch.number)),
                "right_tracks": list(graph.right_tracks(switch.number)),
            }
            for switch in graph.switches
        ],
    }


def route_document(route: Route, graph: HumpGraph) -> dict[str, Any]:
    """A route of `graph` with its elements in order, metres from the crest."""
    elements: list[dict[str, Any]] = []
    for element in route.elements:
        told: dict[str, Any] = {"number": element.number, "name": graph.names.get(element.number)}
        told |= {"at_m": round(element.at_m, 6), "section_m": [round(element.from_m, 6), round(element.to_m, 6)]}
        if isinstance(element.vertex, Switch):
            told |= {"position": element.position, "fouling_m": round(route.fouling_m(element.number), 6)}
        elements.append(told)
    return {
        "lead": route.lead,
        "track": route.track,
        "track_name": graph.track_names.get(route.track),
        "code": route.code,
        "length_m": round(route.length_m, 6),
        "free_to_m": round(route.free_to_m, 6),
        "elements": elements,
    }
