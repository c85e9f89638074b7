"""The way to one track of a hump as aim tables need it: falls and bends, the last position, the stretch ahead of it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from plant_models.hump import Route
from plant_models.library import SourcedValue, TrackEntry, load_track
from plant_models.library.hump_entry import HumpEntry
from plant_models.library.sourced_value import JUDGEMENT, SourcedTable, Value
from plant_models.library.track_entry import BENDS, END, GRADES, POSITION, PROFILE, STRETCH, entry_of
from synth.aim.configuration.track_settings import DEFAULT_TRACK
from synth.hump.trains.aim_choice import last_retarder
from synth.hump.trains.aim_design import positions_m

NAME: Final = "track of a hump"

CAR_M: Final = 15.0
"""Behind the position before it a first axle is measured when the last one of a single car has left that."""

AHEAD_M: Final = 6.0
"""So far ahead of the last position it is measured again."""

ON_A_HUMP: Final = f"{JUDGEMENT}: {CAR_M:g} m behind the position before it, where one car has left that"
BEFORE_IT: Final = f"{JUDGEMENT}: {AHEAD_M:g} m before the position"


def hump_track(hump: HumpEntry, route: Route) -> TrackEntry:
    """The track of `route`, which has a position. Numbers are assumed where any number of the hump is; how fast cuts
    come on the stretch no hump file tells, so that is as on the track of the library."""
    told = f"hump {hump.name}, track {route.track}"
    confidence = "L" if any(value.assumed for value in hump.provenance) else ""
    units = {**PROFILE, **BENDS, **POSITION, **STRETCH}
    of_hump = (SourcedValue(key, value, units[key].unit, None, told, confidence) for key, value in values_of(route))
    values = (*of_hump, *stretch_values(route))
    title = f"track {route.track} of: {hump.title}"
    return entry_of(NAME, title, hump.notes, last_retarder(route).position, SourcedTable(values))


def values_of(route: Route) -> Iterator[tuple[str, Value]]:
    """What the hump file tells, by the keys of a track."""
    track, (entrance, leave) = route.roll_track, positions_m(route)[-1]
    yield GRADES, tuple(zip(track.profile.starts_m, track.profile.grades_permille, strict=True))
    yield END, track.end_m
    if track.bends:
        zones, switches, turns = BENDS
        yield zones, tuple((bend.from_m, bend.to_m) for bend in track.bends)
        yield switches, tuple(float(bend.switches) for bend in track.bends)
        yield turns, tuple(bend.turn_deg for bend in track.bends)
    begins, ends = POSITION
    yield begins, entrance
    yield ends, leave


def stretch_values(route: Route) -> Iterator[SourcedValue]:
    """Where cuts are measured, and how fast they come."""
    places = positions_m(route)
    before = places[-2][1] if len(places) > 1 else 0.0
    begins, ends, *_ = STRETCH
    yield SourcedValue(begins, before + CAR_M, "m", None, ON_A_HUMP, "L")
    yield SourcedValue(ends, places[-1][0] - AHEAD_M, "m", None, BEFORE_IT, "L")
    of_library = {value.key: value for value in load_track(DEFAULT_TRACK).provenance}
    yield from (value for key, value in of_library.items() if key.startswith("stretch.speed_"))
