"""The configuration of a book for one position of a trial: its classes and targets, its place, and how cuts come to it.

Entry speeds are those of the cuts of the trial itself, of which some trains are humped with positions that work as
exactly as the hump file says.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from plant_models.hump import Retarder, RouteElement
from plant_models.library.position_entry import APPROACH, PositionEntry
from synth.frame.faults import InputError
from synth.frame.settings.template import toml_text
from synth.frame.settings.toml_file import toml_tree
from synth.hump.book_needs import BEYOND, LOWEST_M_S, Entering, NeededClass, entering_at, fewest_classes
from synth.hump.configuration.sections import HumpPositionSettings
from synth.hump.configuration.trial_file import TrialFile, parse_trial_file, trial_text
from synth.hump.planning.position_roles import Fixed
from synth.hump.rolling.hump_routes import hump_routes
from synth.hump.trial.made_trial import site_of
from synth.hump.trial.position_choice import retarders_at
from synth.hump.trial.resolved_trial import ResolvedTrial, lead_of, resolve_trial
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.configuration.plant_fault import in_file

USUAL_STD_M_S: Final = 0.15
"""Accuracy of a position whose book is yet to be made: [hump-computer-1970s] asks 0.15 to 0.2 m/s."""

BELOW_ENTRY_M_S: Final = 0.1
"""How far a target lies below the highest entry speed at least."""

APART_ROOT_M_S: Final = 0.25
"""Neighbouring targets differ so much in the root of their speed at most: 1 m/s at 4 m/s, 0.4 m/s at 0.6 m/s."""


def tables_toml(source: Path, number: int | None) -> str:
    """The configuration of a book for position `number` of the trial or hump `source`, as TOML with comments.

    `number` None: the only position of the hump, or the only one for which the trial names a book. `InputError`.
    """
    text = trial_text(source)
    file = parse_trial_file(text, str(source))
    chosen = position_number(file, number)
    config = resolve_trial(without_books(file))
    choice = config.positions[chosen - 1]
    if choice.out_of_service:
        raise InputError(f"{source}: position {chosen} is out of service; it needs no tables")
    entry = site_of(choice, config)
    with in_file(str(source)):
        classes = tuple(fewest_classes(config.needs[chosen - 1].kinds, config.people))
    entering, most_m_s = entering_at(chosen - 1, config), entry.position.max_entry_speed_m_s
    speeds = speeds_of(chosen - 1, config, entering, most_m_s)
    least_high_m_s = speeds["targets"]["exit_speeds_m_s"][-1] + BELOW_ENTRY_M_S
    tree = {
        "title": f"Position {chosen} of: {config.hump.title}",
        **own_types_of(toml_tree(text, str(source))),
        **place_of(chosen - 1, config, entry),
        **speeds,
        "cut": [
            class_tree(each, entering.law(each.category.number, round(least_high_m_s, 6), most_m_s)) for each in classes
        ],
    }
    high = high_origin(source.name, chosen, entering, tree["entry"]["high_m_s"], most_m_s)
    origins = {**origins_of(source.name, chosen, entering), "entry.high_m_s": high}
    sources = {key: why for key, why in origins.items() if is_set(tree, key)}
    said = {each.number: each for each in file.settings.position}.get(chosen, HumpPositionSettings(number=chosen))
    written = head(source, said, config, entering) + toml_text({**tree, "sources": sources})
    parse_config(written, str(file.folder / f"tables of position {chosen}"))
    return written


def position_number(file: TrialFile, number: int | None) -> int:
    """The position that is asked for; `InputError` where that is not said, or there is none."""
    places = retarders_at(hump_routes(file.hump.graph, lead_of(file)).routes)
    with_book = [each.number for each in file.settings.position if each.tables is not None]
    if number is None and len(places) == 1:
        return 1
    if number is None and len(with_book) == 1:
        return with_book[0]
    if number is None or number > len(places):
        held = ", ".join(f"{place} ({held[0].position})" for place, held in enumerate(places, start=1))
        said = "--position-number is missing" if number is None else f"--position-number is {number}"
        raise InputError(f"{file.place}: {said}; the hump has the positions {held}: give the number of one of them")
    return number


def without_books(file: TrialFile) -> TrialFile:
    """The trial with positions that work as exactly as told; of those with a book that is not known yet."""
    places = retarders_at(hump_routes(file.hump.graph, lead_of(file)).routes)
    said = {each.number: each for each in file.settings.position}
    bare = []
    for number, held in enumerate(places, start=1):
        each = said.pop(number, None) or HumpPositionSettings(number=number)
        booked = each.tables is not None or any(retarder.book is not None for retarder in held)
        std = USUAL_STD_M_S if booked and each.exit_std_m_s is None else each.exit_std_m_s
        bare.append(each.model_copy(update={"tables": None, "tables_config": None, "exit_std_m_s": std}))
    position = (*bare, *said.values())  # those that the hump has not are refused as ever
    return replace(file, settings=file.settings.model_copy(update={"position": position}))


def own_types_of(tree: dict[str, Any]) -> dict[str, Any]:
    """What the trial says of the user's own types, in its words: paths begin at the same folder."""
    return {key: tree[key] for key in ("library", "weight_categories") if key in tree}


def place_of(place: int, config: ResolvedTrial, entry: PositionEntry) -> dict[str, Any]:
    """Position, retarders, track and radar, as they are on the first route that has the position."""
    row = int(np.flatnonzero(config.routes.positions_of > place)[0])
    route = config.routes.routes[row]
    element = [each for each in route.elements if isinstance(each.vertex, Retarder)][place]
    assert isinstance(element.vertex, Retarder)
    begin, end = element.at_m, element.at_m + element.vertex.exit_m
    found: dict[str, Any] = {"position": {"name": config.positions[place].site}}
    zones = [list(zone) for zone in element.vertex.zones_m]
    if np.shape(zones) != np.shape(entry.position.zones_m) or not np.allclose(zones, entry.position.zones_m):
        found["retarder"] = {"zones_m": zones}
    track = route.roll_track
    pieces = zip(track.breaks_m[:-1], track.breaks_m[1:], track.profile.grades_permille, strict=True)
    grades = [
        [round(max(float(start) - begin, 0.0), 6), float(grade)]
        for start, to, grade in pieces
        if to > begin and start < end
    ]
    found["track"] = {"grade_permille": grades[0][1] if len(grades) == 1 else grades}
    ahead = seen_ahead_m(element, route.radars_m)
    return found if ahead is None else {**found, "regulator": {"approach_m": ahead}}


def seen_ahead_m(element: RouteElement, radars_m: tuple[tuple[float, float], ...]) -> float | None:
    """From how far ahead of the entrance a radar of the hump file sees the cut; None where no radar is told of."""
    begins = [low for low, high in radars_m if low <= element.at_m < high]
    return round(element.at_m - min(begins), 6) if begins else None


def speeds_of(place: int, config: ResolvedTrial, entering: Entering, most_m_s: float) -> dict[str, Any]:
    """Entry speeds and targets; `InputError` where exit speeds are asked for that cuts cannot have which come no faster
    than they do, or than `most_m_s`, which the retarders take."""
    low, high = commanded_m_s(place, config, entering)
    said = {each.number: each for each in config.settings.position}[place + 1]
    wanted = isinstance(config.roles.exits[place], Fixed) or said.highest_m_s is not None
    fastest = min(entering.high_m_s, most_m_s)
    fastest = max(fastest, round(high + BELOW_ENTRY_M_S, 6)) if wanted else fastest
    top, named = round(min(high, fastest - BELOW_ENTRY_M_S), 6), f"{config.place}: position {place + 1}"
    if fastest > most_m_s:
        raise InputError(
            f"{named} commands up to {high:g} m/s, but its retarders take cuts of at most {most_m_s:g} m/s: set its "
            f"highest exit speed to {most_m_s - BELOW_ENTRY_M_S:g} m/s or less"
        )
    if top < low:
        raise InputError(
            f"{named} commands {low:g} m/s or more, but cuts come to it with {fastest:g} m/s at most: set its lowest "
            "exit speed lower"
        )
    return {
        "entry": {"low_m_s": entering.low_m_s, "high_m_s": fastest},
        "targets": {"exit_speeds_m_s": list(targets_m_s(low, top))},
    }


def commanded_m_s(place: int, config: ResolvedTrial, entering: Entering) -> tuple[float, float]:
    """Lowest and highest exit speed that may be commanded. The highest of an aim is that of [aim] if the trial gives
    it; else that of the simulated cuts, for the usual one is meant as no limit."""
    need, aim = config.needs[place], config.settings.aim
    ends = [speed for speed in (need.lowest_m_s, need.highest_m_s) if speed is not None]
    if config.roles.aims[place].any():
        said = "highest_m_s" in aim.model_fields_set or entering.command_m_s is None
        ends += [aim.lowest_m_s, aim.highest_m_s if said else entering.command_m_s or 0.0]
    return max(min(ends), LOWEST_M_S), max(ends)


def targets_m_s(low_m_s: float, high_m_s: float) -> Iterator[float]:
    """The fewest targets from one speed to the other, two at least, closer to each other where cuts are slow; where
    both speeds are one, the other target is a step lower."""
    high = math.sqrt(high_m_s)
    first_m_s = low_m_s if low_m_s < high_m_s else max((high - APART_ROOT_M_S) ** 2, LOWEST_M_S)
    low = math.sqrt(first_m_s)
    steps = max(math.ceil((high - low) / APART_ROOT_M_S - 1e-9), 1)
    between = (float(root) ** 2 for root in np.linspace(low, high, steps + 1)[1:-1])
    return (round(speed_m_s, 2) for speed_m_s in (first_m_s, *between, high_m_s))


def class_tree(each: NeededClass, entry: dict[str, Any]) -> dict[str, Any]:
    """A class as a configuration has it, with its entry speeds if it has own ones."""
    tree = {
        "label": each.label,
        "car": each.car,
        "cars": each.cars,
        "mass_t": each.mass_t,
        "category": each.category.name,
    }
    return {**tree, "entry": entry} if entry else tree


def is_set(tree: dict[str, Any], key: str) -> bool:
    """Whether the configuration has the dotted `key`."""
    section, _, name = key.partition(".")
    return name in tree.get(section, {})


def high_origin(trial: str, number: int, entering: Entering, high_m_s: float, most_m_s: float) -> str:
    """Where the highest entry speed is from."""
    if high_m_s == most_m_s:
        return "the retarders take no faster cuts"
    if high_m_s > entering.high_m_s:
        return "just above the highest exit speed that is asked for"
    return humped(trial, number, entering, "faster")


def humped(trial: str, number: int, entering: Entering, side: str) -> str:
    """What was simulated."""
    return f"{entering.cuts} simulated cuts of {trial}: {100.0 * BEYOND:g} % of them come to position {number} {side}"


def origins_of(trial: str, number: int, entering: Entering) -> dict[str, str]:
    """Where the other numbers are from, by their keys; `trial`: the name of its file."""
    return {
        "retarder.zones_m": f"the hump of {trial}",
        "track.grade_permille": f"the hump of {trial}",
        APPROACH: f"the radars of the hump of {trial}",
        "entry.low_m_s": humped(trial, number, entering, "slower"),
        "targets.exit_speeds_m_s": f"exit speeds that {trial} may command at position {number}",
    }


def head(source: Path, said: HumpPositionSettings, config: ResolvedTrial, entering: Entering) -> str:
    """What the file is for, and how to use what is made of it, as comments; `said`: what the trial says of the
    position, which may name the files already."""
    number = said.number
    book, configuration = said.tables or f"out/position-{number}/book.h5", said.tables_config or "tables.toml"
    return f"""\
# Tables for position {number} of {source.name}:
# {config.needs[number - 1].words}.
# The classes are the fewest that stand for all its cuts; a class weighs what cars of its category weigh on the mean,
# and comes as fast as {entering.cuts} simulated cuts of the trial did.
# Keep this file, as {configuration}, in the folder of the trial, and make its book there by
#     retarder-synth tune {configuration} -o {Path(book).parent.as_posix()}
# In the trial the position names both:
#     [[position]]
#     number = {number}
#     tables = "{book}"
#     tables_config = "{configuration}"
# All other keys, with what they are unless given: retarder-synth init
"""
