"""What an aim configuration may say of the track: elements and bends in place of those of the library."""

from __future__ import annotations

from itertools import pairwise

from pydantic import model_validator

from plant_models.errors import require
from plant_models.library import TRACKS
from synth.frame.settings.section import Section, many, needed, setting
from synth.retarder.configuration.top_keys import named_type

DEFAULT_TRACK = "large-hump"
MOST_PIECES = 200
"""Elements, or bends, of a track."""

LONGEST_M = 1e5
"""Of a track."""


class ElementSettings(Section):
    """A piece of the track with one grade."""

    from_m: float = needed("m", 0.0, LONGEST_M, "where it begins, from the crest")
    to_m: float = needed("m", 0.0, LONGEST_M, "where it ends")
    grade_permille: float = needed("permille", -60.0, 60.0, "downhill positive")


class BendSettings(Section):
    """Switches and degrees of turn within a piece of the track."""

    from_m: float = needed("m", 0.0, LONGEST_M, "where it begins, from the crest")
    to_m: float = needed("m", 0.0, LONGEST_M, "where it ends")
    switches: int = setting(0, "1", 0, 20, "switches in it")
    turn_deg: float = setting(0.0, "degrees", 0.0, 360.0, "turn of its curves")


class AimTrackSettings(Section):
    """The track from the crest on; elements and bends, where given, stand in place of its own."""

    name: str = named_type(DEFAULT_TRACK, TRACKS, "the track")
    elements: tuple[ElementSettings, ...] | None = many(
        None,
        1,
        MOST_PIECES,
        "tables {from_m = …, to_m = …, grade_permille = …}",
        "pieces of one grade each, metres from the crest, downhill positive",
    )
    bends: tuple[BendSettings, ...] | None = many(
        None,
        0,
        MOST_PIECES,
        "tables {from_m = …, to_m = …, switches = …, turn_deg = …}",
        "pieces with switches or curves; [] for none",
    )

    @model_validator(mode="after")
    def _pieces_in_order(self) -> AimTrackSettings:
        require_elements(self.elements or ())
        require_bends(self.bends or ())
        return self


def require_elements(elements: tuple[ElementSettings, ...]) -> None:
    """`PlantError` where there is a gap, an overlap or no length."""
    for place, element in enumerate(elements):
        require(
            place > 0 or element.from_m == 0.0,
            f"elements[0].from_m is {element.from_m:g}; the track begins at the crest: set it to 0",
        )
        require(
            element.to_m > element.from_m,
            f"elements[{place}].to_m is {element.to_m:g}; it must be more than its from_m, {element.from_m:g}",
        )
    for place, (ahead, behind) in enumerate(pairwise(elements), start=1):
        require(
            behind.from_m == ahead.to_m,
            f"elements[{place}].from_m is {behind.from_m:g}, but the element before ends at {ahead.to_m:g} m; "
            f"elements must follow one another without gap and overlap: set it to {ahead.to_m:g}",
        )


def require_bends(bends: tuple[BendSettings, ...]) -> None:
    """`PlantError` where one has no length or two overlap."""
    for place, bend in enumerate(bends):
        require(
            bend.from_m < bend.to_m,
            f"bends[{place}] is from {bend.from_m:g} to {bend.to_m:g} m; it must have a length",
        )
    for place, (ahead, behind) in enumerate(pairwise(bends), start=1):
        require(
            behind.from_m >= ahead.to_m,
            f"bends[{place}].from_m is {behind.from_m:g}, but the bend before ends at {ahead.to_m:g} m; list them in "
            "order, without overlap",
        )
