"""Reading a short hump file: what its keys must be to each other, and every fault at once, each a sentence that begins
with a key; and one to start from.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

from pydantic import ValidationError

from plant_models.errors import close_name, near_miss
from plant_models.hump import RETARDERS
from plant_models.hump.edge import grade_faults
from plant_models.hump.ranges import MOST_TRACKS
from plant_models.library import BUILT_IN, POSITIONS
from plant_models.library.data_file import keyed
from plant_models.library.hump_elements import zones_of
from plant_models.rolling.roll_track import LONGEST_TRACK_M
from synth.frame.faults import InputError
from synth.frame.settings.settings_file import faults_in
from synth.frame.settings.template import NOTHING, template
from synth.frame.settings.toml_file import read_toml
from synth.hump.hump_file import FileKind, require_kind
from synth.hump.making.hump_plan import HumpPlan, levels_needed
from synth.hump.making.short_hump import EXAMPLE, ShortHump, ShortPosition

SHORTEST_CURVE_M: Final = 1.0


@dataclass(frozen=True)
class Rule:
    """`check` tells the faults; it looks at `keys` alone, so that it means nothing where one of them is at fault."""

    keys: frozenset[str]
    check: Callable[[ShortHump], Iterator[str]]


@dataclass(frozen=True)
class Stretch:
    """What nothing else may overlap, metres from the crest: an insulated section."""

    name: str
    from_m: float
    to_m: float


def end_m(position: ShortPosition) -> float:
    """Where it ends; its `type` must be of the library."""
    return position.from_m + zones_of(position.type)[-1][1] if position.to_m is None else position.to_m


def of_counts(short: ShortHump) -> Iterator[str]:
    """Tracks and bunches must agree, and the elements must have numbers."""
    bunches = short.of_bunches
    count = sum(bunches)
    if short.tracks is None and short.bunches is None:
        yield "tracks is missing; give the number of tracks, or bunches, the number of tracks of each bunch"
        return
    if short.tracks is not None and count != short.tracks:
        yield f"tracks is {short.tracks}; the bunches have {count} tracks together: correct one of the two"
    if count > MOST_TRACKS:
        yield f"bunches have {count} tracks together; a hump has at most {MOST_TRACKS}"


def of_levels(short: ShortHump) -> Iterator[str]:
    """There must be a place for every level of switches."""
    if short.tracks is None and short.bunches is None:
        return
    need, given = levels_needed(short.of_bunches), len(short.switches_m)
    if need != given:
        what = f"{short.tracks} tracks" if short.bunches is None else f"bunches of {list(short.bunches)} tracks"
        yield (
            f"switches_m has {given} places; {what} need {need}, for at each place every track parts into two: "
            + ("add those that are missing" if given < need else "take those out that are too many")
        )


def of_profile(short: ShortHump) -> Iterator[str]:
    """The profile must begin at the crest and increase in metres."""
    ends_m = short.tracks_from_m + short.track_length_m
    for sentence in grade_faults(short.profile_from_crest, ends_m):
        yield keyed(sentence, {"grades: ": "profile_from_crest: "})


def of_positions(short: ShortHump) -> Iterator[str]:
    """Positions must be of the library and have a length."""
    for place, each in enumerate(short.position):
        if each.type not in BUILT_IN.names(POSITIONS):
            hint = near_miss(each.type, BUILT_IN.names(POSITIONS))
            yield f"position[{place}].type is {each.type!r}, which is no position of the library; {hint}"
        if each.to_m is not None and not each.from_m + 0.1 <= each.to_m <= each.from_m + 200.0:
            yield (f"position[{place}].to_m is {each.to_m:g}; it must be 0.1 to 200 m behind from_m, {each.from_m:g}")


def of_places(short: ShortHump) -> Iterator[str]:
    """Sections must lie between the crest and the tracks, and not overlap."""
    if any(of_positions(short)):
        return
    if list(short.switches_m) != sorted(set(short.switches_m)):
        yield f"switches_m is {list(short.switches_m)}; each place must be farther from the crest than the one before"
        return
    ahead, behind = short.section_ahead_m, short.section_behind_m
    switches = (Stretch(f"the switch at {at:g} m", at - ahead, at + behind) for at in short.switches_m)
    positions = (
        Stretch(f"position[{place}]", each.from_m - each.margin_m, end_m(each) + each.margin_m)
        for place, each in enumerate(short.position)
    )
    stretches = sorted((*switches, *positions), key=lambda each: each.from_m)
    for each in stretches:
        if each.from_m < 0.0:
            yield f"{each.name}: its section begins {-each.from_m:g} m ahead of the crest; it must begin behind it"
    for first, second in pairwise(stretches):
        if second.from_m < first.to_m:
            yield (
                f"{first.name}: its section ends at {first.to_m:g} m, and that of {second.name} begins at "
                f"{second.from_m:g} m; sections must not overlap"
            )
    last = max(stretches, key=lambda each: each.to_m, default=Stretch("the crest", 0.0, 0.1))
    if last.to_m > short.tracks_from_m:
        yield (
            f"tracks_from_m is {short.tracks_from_m:g}; {last.name} with its section ends at {last.to_m:g} m, and "
            "tracks must begin behind that"
        )


def of_ends(short: ShortHump) -> Iterator[str]:
    """Fouling points must lie on the tracks, and no way may be too long."""
    ends_m = short.tracks_from_m + short.track_length_m
    fouling_m = max(short.switches_m, default=0.0) + short.fouling_m
    if short.switches_m and fouling_m > ends_m:
        told = f"the point would be at {fouling_m:g} m, and the tracks end at {ends_m:g} m"
        yield f"fouling_m is {short.fouling_m:g}; {told}"
    if ends_m > LONGEST_TRACK_M:
        yield (
            f"track_length_m is {short.track_length_m:g}; the tracks would end {ends_m:g} m from the crest, and ways "
            f"have at most {LONGEST_TRACK_M:g} m"
        )


def of_numbers(short: ShortHump) -> Iterator[str]:
    """There must be numbers for all retarders, and room for the curves that turn back."""
    if any(any(rule(short)) for rule in (of_counts, of_levels, of_positions, of_places)):
        return
    plan = HumpPlan(short)
    most = RETARDERS.last - RETARDERS.first + 1
    if plan.retarders > most:
        yield f"position: all positions have {plan.retarders} retarders together; there are numbers for {most}"
        return
    narrow = {
        element.at_m: edge.curve_m
        for element in plan.elements()
        for edge in element.edges
        if edge.turn_back_deg and edge.curve_m[1] - edge.curve_m[0] < SHORTEST_CURVE_M
    }
    for at_m, (from_m, to_m) in sorted(narrow.items()):
        yield (
            f"parallel_tracks: behind the switch at {at_m:g} m a curve must turn the track back, and there are "
            f"{to_m - from_m:g} m for it; leave {SHORTEST_CURVE_M:g} m or more between the sections, or set "
            "parallel_tracks = false"
        )


RULES: Final = (
    Rule(frozenset({"tracks", "bunches"}), of_counts),
    Rule(frozenset({"tracks", "bunches", "switches_m"}), of_levels),
    Rule(frozenset({"profile_from_crest", "tracks_from_m", "track_length_m"}), of_profile),
    Rule(frozenset({"position"}), of_positions),
    Rule(frozenset({"position", "switches_m", "section_ahead_m", "section_behind_m", "tracks_from_m"}), of_places),
    Rule(frozenset(ShortHump.model_fields) - {"title", "output", "throw_s", "relay_s"}, of_numbers),
    Rule(frozenset({"switches_m", "fouling_m", "tracks_from_m", "track_length_m"}), of_ends),
)


KEYS: Final = tuple(ShortHump.model_fields)


def read_short_hump(text: str, place: str) -> ShortHump:
    """The short hump that `text` describes; `place` is what messages call the file. `InputError`."""
    read = read_toml(text, place)
    tree = read.tree
    if tree is None:
        raise InputError(*read.faults)
    require_kind(tree, place, FileKind.SHORT)
    wrong: set[str] = set()
    told: list[str] = []
    try:
        short = ShortHump.model_validate(tree)
    except ValidationError as error:
        told += faults_in(error, ShortHump)
        wrong = {str(fault["loc"][0]) for fault in error.errors(include_url=False)}
        meant = {name for key in wrong - set(KEYS) if (name := close_name(key, KEYS)) is not None}
        sound = {key: value for key, value in tree.items() if key not in wrong}
        wrong |= meant
        short = ShortHump.model_validate({**{key: getattr(EXAMPLE, key) for key in NEEDED}, **sound})
    told += [sentence for rule in RULES if not rule.keys & wrong for sentence in rule.check(short)]
    if read.faults or told:
        raise InputError(*read.faults, *(f"{place}: {sentence}" for sentence in told))
    return short


NEEDED: Final = tuple(key for key, field in ShortHump.model_fields.items() if field.is_required())
"""Keys that stand in every short file."""

EXAMPLE_LINES = (
    "An example: put the numbers of your hump in place of its own.\n"
    f"# What may not be left out: tracks or bunches, {', '.join(NEEDED)}; of a position type and from_m."
)


def example_short_toml() -> str:
    """The hump `medium` of the library as a short file."""
    return template(EXAMPLE, "Short hump file", "hump make", NOTHING, (), EXAMPLE_LINES)
