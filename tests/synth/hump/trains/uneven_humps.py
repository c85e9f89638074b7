"""Copies of the large hump whose routes have different numbers of positions."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

from synth.hump.hump_file import hump_text, parse_hump
from synth.hump.trains.hump_routes import HumpRoutes, hump_routes

SHORT_TRACKS = tuple(range(1, 9))
OWN_TRACK = 33


def bunch_without_park() -> str:
    """Tracks 1 to 8 have no park retarders: what led to one leads to the section behind it."""
    text = hump_text(Path("large"))
    for track in SHORT_TRACKS:
        park, section = 420 + track, 600 + track
        text = without_rows(text, {park})
        text, swaps = re.subn(rf"to = {park}\b", f"to = {section}", text)
        assert swaps == 1
    return text


def track_behind_the_second_position() -> str:
    """The bunch of retarder 414 is gone: one track stands in its place, right behind that retarder."""
    text = hump_text(Path("large"))
    text = without_rows(text, behind(text, 7))
    own = f"""{{ number = 654, type = "track", track = {OWN_TRACK}, next = {{ length_m = 720.0 }} }},"""
    section = "section = [\n"
    assert text.count(section) == 1
    text, swaps = re.subn(r"to = 7\b", "to = 654", text)
    assert swaps == 1
    return text.replace(section, f"{section}    {own}\n")


def without_rows(text: str, numbers: set[int]) -> str:
    """`text` without the rows of these elements."""
    kept = [line for line in text.splitlines() if not any(line.startswith(f"    {{ number = {n},") for n in numbers)]
    assert len(kept) == len(text.splitlines()) - len(numbers)
    return "\n".join(kept) + "\n"


def behind(text: str, number: int) -> set[int]:
    """`number` and the elements behind it."""
    hump = tomllib.loads(text)["hump"]
    rows = {row["number"]: row for kind in ("signal", "switch", "retarder", "section") for row in hump[kind]}
    found, ahead = {number}, [number]
    while ahead:
        row = rows[ahead.pop()]
        to = [row[key]["to"] for key in ("left", "right", "next") if "to" in row.get(key, {})]
        ahead += to
        found |= set(to)
    return found


UNEVEN = {"bunch": bunch_without_park, "own track": track_behind_the_second_position}


def routes_of(name: str) -> HumpRoutes:
    """The routes of one of them."""
    return hump_routes(parse_hump(UNEVEN[name](), "uneven", "uneven.toml").graph, 201)
