"""All pictures of an aim: what is drawn, and what is said under it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from synth.book.case_names import file_stem
from synth.frame.picture.picture import Picture
from synth.present.plots.aim.chances import chances
from synth.present.plots.aim.commands import commands_by_cars, commands_by_resistance
from synth.present.plots.aim.gaps import gaps
from synth.present.plots.aim.track import track
from synth.present.plots.picture_book import picture
from synth.yard.aim.aim_book import AimBook
from synth.yard.aim.aim_curves import AimCurves, Runners


def aim_pictures(book: AimBook, curves: Sequence[AimCurves], rolled: Sequence[Runners]) -> Iterator[Picture]:
    """Every picture in the order of the report."""
    yield picture(
        gaps(book),
        "aim-gaps",
        "Gaps",
        "Mean gap over free distance",
        "Mean gap that a cut leaves before the standing cars where the tables are used, on cuts that their speeds were "
        "not chosen on. Cuts for which no exit speed keeps the chance are let go at the lowest speed.",
    )
    if "category" in book.config.aim.knowledge:
        yield picture(
            commands_by_cars(book),
            "aim-commands-by-cars",
            "Exit speeds",
            "Exit speed by category and cars",
            "Exit speeds of the tables by category: what the park position is told. No mark: no exit speed keeps the "
            "required chance.",
        )
    if "measured" in book.config.aim.knowledge:
        yield picture(
            commands_by_resistance(book),
            "aim-commands-by-resistance",
            "Exit speeds",
            "Exit speed by measured resistance",
            "Exit speeds of the tables by measured resistance, for the shortest cuts, at some resistances between "
            "the ends that each panel names. No mark: no exit speed keeps the required chance.",
        )
    for each in curves:
        yield picture(
            chances(each),
            file_stem("aim-chances", each.category.latin),
            "Chance and gap",
            f"Chance of over-speed and gap, category {each.category.name}",
            f"Category {each.category.name}: share of cuts that couple too fast and mean gap where all cuts are told "
            "one exit speed, and one against the other. Below its curve leads only what tells more of a single cut.",
        )
    yield picture(
        track(book.config.scene, rolled),
        "aim-track",
        "Track",
        "Track and runners",
        "Height of the track, and energy heads v²/(2g') of single cars that leave the bunch position and are not "
        "braked behind it. Where a line meets the track, the car stops.",
    )
