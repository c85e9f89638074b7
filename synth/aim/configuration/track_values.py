"""What a file says of track, position and stretch, as values of the library's track, and the other way round."""

from __future__ import annotations

from typing import Any

from plant_models.library import TrackEntry, Value
from plant_models.rolling.roll_track import RollTrack
from synth.aim.configuration.settings import AimFileSettings
from synth.frame.settings.numbers import library_values


def track_with_settings(entry: TrackEntry, settings: AimFileSettings) -> TrackEntry:
    """`entry` with the values that the file sets; `PlantError` with their keys if they make no track."""
    elements, bends = settings.track.elements, settings.track.bends
    overrides: dict[str, Value] = {}
    if elements is not None:
        overrides["track.grade_permille"] = tuple((each.from_m, each.grade_permille) for each in elements)
        overrides["track.end_m"] = elements[-1].to_m
    if bends is not None and not bends:
        entry = entry.without_bends()
    elif bends is not None:
        overrides["bends.zones_m"] = tuple((bend.from_m, bend.to_m) for bend in bends)
        overrides["bends.switches"] = tuple(float(bend.switches) for bend in bends)
        overrides["bends.turn_deg"] = tuple(bend.turn_deg for bend in bends)
    overrides |= dict(library_values(settings.position, "position"))
    overrides |= dict(library_values(settings.stretch, "stretch"))
    return entry.with_values(overrides)


def elements_of(track: RollTrack) -> list[dict[str, Any]]:
    """The elements of a track as a file has them."""
    pieces = zip(track.breaks_m[:-1], track.breaks_m[1:], track.profile.grades_permille, strict=True)
    return [{"from_m": begins, "to_m": ends, "grade_permille": grade} for begins, ends, grade in pieces]


def bends_of(track: RollTrack) -> list[dict[str, Any]]:
    """The bends of a track as a file has them."""
    return [
        {"from_m": bend.from_m, "to_m": bend.to_m, "switches": bend.switches, "turn_deg": bend.turn_deg}
        for bend in track.bends
    ]
