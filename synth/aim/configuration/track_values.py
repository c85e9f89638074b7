"""What a file says of track, position and stretch, as values of the library's track."""

from __future__ import annotations

from itertools import pairwise

from plant_models import PlantError
from plant_models.errors import require
from plant_models.library import TrackEntry, Value
from synth.aim.configuration.settings import AimFileSettings, BendSettings, ElementSettings


def track_with_settings(entry: TrackEntry, settings: AimFileSettings) -> TrackEntry:
    """`entry` with the values that the file sets; `PlantError` with their keys if they make no track."""
    elements, bends = settings.track.elements, settings.track.bends
    overrides: dict[str, Value] = {}
    if elements is not None:
        overrides |= element_values(elements)
    if bends is not None and not bends:
        entry = entry.without_bends()
    elif bends is not None:
        overrides |= bend_values(bends)
    sections = {"position": settings.position, "stretch": settings.stretch}
    for section, below in sections.items():
        for key, value in below.model_dump(exclude_none=True, exclude={"name"}).items():
            overrides[f"{section}.{key}"] = float(value)
    return entry.with_values(overrides)


def element_values(elements: tuple[ElementSettings, ...]) -> dict[str, Value]:
    """The profile and its end; `PlantError` where there is a gap, an overlap or no length."""
    first = elements[0].from_m
    require(first == 0.0, f"track.elements[0].from_m is {first:g}; the track begins at the crest: set it to 0")
    for place, element in enumerate(elements):
        require(
            element.to_m > element.from_m,
            f"track.elements[{place}].to_m is {element.to_m:g}; it must be more than its from_m, {element.from_m:g}",
        )
    for place, (ahead, behind) in enumerate(pairwise(elements), start=1):
        require(
            behind.from_m == ahead.to_m,
            f"track.elements[{place}].from_m is {behind.from_m:g}, but the element before ends at {ahead.to_m:g} m; "
            f"elements must follow one another without gap and overlap: set it to {ahead.to_m:g}",
        )
    pieces = tuple((element.from_m, element.grade_permille) for element in elements)
    return {"track.grade_permille": pieces, "track.end_m": elements[-1].to_m}


def bend_values(bends: tuple[BendSettings, ...]) -> dict[str, Value]:
    """The three lists of bends; `PlantError` where one has no length or two overlap."""
    for place, bend in enumerate(bends):
        if bend.from_m < 0.0 or bend.to_m <= bend.from_m:
            raise PlantError(
                f"track.bends[{place}] is from {bend.from_m:g} to {bend.to_m:g} m; it must begin at 0 m or more and "
                "have a length"
            )
    for place, (ahead, behind) in enumerate(pairwise(bends), start=1):
        require(
            behind.from_m >= ahead.to_m,
            f"track.bends[{place}].from_m is {behind.from_m:g}, but the bend before ends at {ahead.to_m:g} m; list "
            "them in order, without overlap",
        )
    return {
        "bends.zones_m": tuple((bend.from_m, bend.to_m) for bend in bends),
        "bends.switches": tuple(float(bend.switches) for bend in bends),
        "bends.turn_deg": tuple(bend.turn_deg for bend in bends),
    }
