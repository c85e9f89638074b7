"""What is likely a mistake in a hump, though nothing forbids it: each as one sentence."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from plant_models.errors import near_miss
from plant_models.hump import Retarder, Route, TrackSection
from plant_models.library import load_car
from plant_models.library.hump_elements import zones_of
from plant_models.library.hump_entry import HumpEntry
from plant_models.library.library import BUILT_IN, POSITIONS
from synth.frame.printed_numbers import ranges
from synth.hump.configuration.sections import DesignSettings
from synth.hump.configuration.settings import TrainSettings
from synth.hump.design_runners import CAR, HUMP_SPEED_M_S, RolledRoute

MOST_RISE_M: Final = 0.3
"""Rise ahead of the last switch or position that is not told; engineering judgement."""

LEAST_FIRST_FALL_M: Final = 0.5
"""From the crest to the first switch; engineering judgement: the library's humps have 1.3 to 1.9 m."""

LEAST_FIRST_M: Final = 30.0
"""From the crest to the joint of the first switch ([tb-10062], 5.3.6)."""

LEAST_POSITION_PERMILLE: Final = 5.0
"""Under a position that is not the last ([hump-grades]: 7 or more, about 5 on automated humps)."""

INTO_TRACK_M: Final = DesignSettings().into_track_m
"""How far a bad runner still rolls into its track."""

OTHER_LENGTH: Final = 0.05
"""Share of its length by which a retarder may differ from its position in the library untold."""

FRACTION: Final = 0.1
PER_CENT: Final = 8.0
"""A hump whose steepest grade is at most this has fractions, or per cent, in place of per mille."""


@dataclass(frozen=True)
class HumpWarning:
    """`about`: one word for programs; `sentence`: what is likely wrong, and what to do."""

    about: str
    sentence: str


Rule = Callable[[HumpEntry, Sequence[RolledRoute]], Iterator[HumpWarning]]


def warnings_of(hump: HumpEntry, rolled: Sequence[RolledRoute]) -> tuple[HumpWarning, ...]:
    """Every warning of `hump`, whose routes are `rolled`."""
    return tuple(warning for rule in RULES for warning in rule(hump, rolled))


def of_grades(hump: HumpEntry, rolled: Sequence[RolledRoute]) -> Iterator[HumpWarning]:
    """Grades that are told in another unit, or with the other sign."""
    edges = [edge for vertex in hump.graph.vertices for edge in vertex.edges]
    grades = [grade for edge in edges for _, grade in edge.grades]
    steepest = max(map(abs, grades))
    if steepest <= PER_CENT:
        unit, factor = ("fractions", 1000) if steepest <= FRACTION else ("per cent", 10)
        yield HumpWarning(
            "grades",
            f"the steepest grade of the hump is {steepest:g} permille; if the file has its grades in {unit}, multiply "
            f"them by {factor}",
        )
    first = rolled[0].route.elements[0].edge
    turned = sum(grade < 0.0 for grade in grades) > 0.5 * len(grades)
    if first.grades[0][1] < 0.0 or turned:
        yield HumpWarning(
            "sign",
            f"the grade behind the crest is {first.grades[0][1]:g} permille, and the track rises there; a grade is "
            "positive where the track falls: turn the signs",
        )


def of_rises(hump: HumpEntry, rolled: Sequence[RolledRoute]) -> Iterator[HumpWarning]:
    """A rise ahead of the last switch or position, and a first fall that is too low."""
    rises = [(rise_of(each.route, each.last_m), each) for each in rolled]
    (rise, from_m, to_m), worst = max(rises, key=lambda found: found[0][0])
    if rise > MOST_RISE_M:
        yield HumpWarning(
            "rise",
            f"on the way to track {hump.graph.track_called(worst.route.track)} the track rises by {rise:.2f} m from "
            f"{from_m:g} m to {to_m:g} m, ahead of its last switch or position; a grade is positive where the track "
            "falls",
        )
    falls = [(each.fall_m(each.switches[0].at_m), each.switches[0]) for each in rolled if each.switches]
    fall, switch = min(falls, key=lambda found: found[0], default=(LEAST_FIRST_FALL_M, None))
    if switch is not None and fall < LEAST_FIRST_FALL_M:
        yield HumpWarning(
            "first-fall",
            f"from the crest to {hump.graph.element_called(switch.number)} the track falls {fall:.2f} m; "
            f"{LEAST_FIRST_FALL_M:g} m or more are usual, so that cuts part before they come to it",
        )


def rise_of(route: Route, to_m: float) -> tuple[float, float, float]:
    """The largest rise on the way up to `to_m`: (m, from m, to m)."""
    track = route.roll_track
    places = np.unique(np.concatenate(([0.0], np.minimum(track.breaks_m, to_m), [to_m])))
    falls = track.fall_m(places)
    deepest = np.maximum.accumulate(falls)
    end = int(np.argmax(deepest - falls))
    begin = int(np.argmax(falls[: end + 1]))
    return float(deepest[end] - falls[end]), float(places[begin]), float(places[end])


def of_runners(hump: HumpEntry, rolled: Sequence[RolledRoute]) -> Iterator[HumpWarning]:
    """The bad runner must roll into its track."""
    stops = [
        (each.bad.stop_m - each.track_m, each) for each in rolled if each.route.length_m > each.track_m + INTO_TRACK_M
    ]
    into_m, worst = min(stops, key=lambda found: found[0], default=(INTO_TRACK_M, rolled[0]))
    if into_m < INTO_TRACK_M:
        where = f"{into_m:.0f} m behind" if into_m >= 0.0 else f"{-into_m:.0f} m ahead of"
        yield HumpWarning(
            "height",
            f"the bad runner ({worst.bad.runner.mass_t:g} t, {worst.bad.runner.resistance_n_per_kn:g} N/kN, head wind "
            f"{worst.bad.runner.head_wind_m_s:g} m/s), let go at {HUMP_SPEED_M_S:g} m/s and not braked, stands {where} "
            f"the beginning of track {hump.graph.track_called(worst.route.track)}; the fall of a hump lets it roll "
            f"{INTO_TRACK_M:g} m into its track or more [hump-height]",
        )


def of_layout(hump: HumpEntry, rolled: Sequence[RolledRoute]) -> Iterator[HumpWarning]:
    """Rules of layout that have a source."""
    firsts = {each.switches[0].number: each.switches[0].from_m for each in rolled if each.switches}
    for number, from_m in sorted(firsts.items()):
        if from_m < LEAST_FIRST_M:
            yield HumpWarning(
                "first-switch",
                f"the section of switch {number} begins {from_m:g} m behind the crest; {LEAST_FIRST_M:g} m or more are "
                "asked for [tb-10062]",
            )
    flat: dict[float, set[int]] = {}
    for each in rolled:
        for element in each.retarders:
            assert isinstance(element.vertex, Retarder)
            ahead_of_switch = any(switch.at_m > element.at_m for switch in each.switches)
            ends = [start for start, _ in element.edge.grades[1:]] + [element.edge.length_m]
            under = [
                grade
                for (start, grade), _ in zip(element.edge.grades, ends, strict=True)
                if start < element.vertex.exit_m
            ]
            if ahead_of_switch and min(under) < LEAST_POSITION_PERMILLE:
                flat.setdefault(min(under), set()).add(element.number)
    for grade, numbers in sorted(flat.items()):
        yield HumpWarning(
            "position-grade",
            f"the grade under retarders {ranges(sorted(numbers))} is {grade:g} permille; 7 or more are asked for, "
            f"about {LEAST_POSITION_PERMILLE:g} on automated humps, so that a cut that stands there starts again "
            "[hump-grades]",
        )


def of_retarders(hump: HumpEntry, rolled: Sequence[RolledRoute]) -> Iterator[HumpWarning]:
    """Positions that the library does not have, or that are of another length; a hump without any."""
    if not all(each.retarders for each in rolled):
        tracks = ranges(sorted({each.route.track for each in rolled if not each.retarders}))
        some = any(each.retarders for each in rolled)
        told = "nothing brakes cuts there" if some else "nothing brakes cuts, and hump simulate needs a position"
        yield HumpWarning("no-retarder", f"on the way to tracks {tracks} there is no retarder; {told}")
    unknown: dict[str, list[int]] = {}
    for each in hump.graph.retarders:
        if each.position not in BUILT_IN.names(POSITIONS):
            unknown.setdefault(each.position, []).append(each.number)
    for position, numbers in unknown.items():
        yield HumpWarning(
            "position",
            f"the position {position!r} of retarders {ranges(numbers)} is not in the library, which has no brake for "
            f"it; hump simulate refuses it unless the trial has a type of that name; "
            f"{near_miss(position, BUILT_IN.names(POSITIONS))}",
        )
    other: dict[tuple[str, float, float], list[int]] = {}
    for each in hump.graph.retarders:
        if each.position not in unknown:
            usual_m = zones_of(each.position)[-1][1]
            if abs(each.exit_m - usual_m) > OTHER_LENGTH * usual_m:
                other.setdefault((each.position, each.exit_m, usual_m), []).append(each.number)
    for (position, own_m, usual_m), numbers in other.items():
        yield HumpWarning(
            "zones",
            f"retarders {ranges(numbers)} are {own_m:g} m long; hump simulate brakes with all of the position "
            f"{position}, which is {usual_m:g} m long",
        )


def of_tracks(hump: HumpEntry, rolled: Sequence[RolledRoute]) -> Iterator[HumpWarning]:
    """Tracks on which the longest cut has no room."""
    longest_m = TrainSettings().most_cars * load_car(CAR).car.length_m
    short: dict[float, list[int]] = {}
    for each in rolled:
        last = each.route.elements[-1].vertex
        assert isinstance(last, TrackSection)
        free_m = each.route.free_to_m - each.track_m
        if free_m < longest_m:
            short.setdefault(round(free_m, 3), []).append(each.route.track)
    for free_m, tracks in sorted(short.items()):
        yield HumpWarning(
            "short-track",
            f"on tracks {ranges(sorted(set(tracks)))} {free_m:g} m are free; a cut of {TrainSettings().most_cars} "
            f"cars, the most of a usual train, has {longest_m:.0f} m",
        )


def of_file(hump: HumpEntry, rolled: Sequence[RolledRoute]) -> Iterator[HumpWarning]:
    """Keys of the file that have no effect."""
    return (HumpWarning("no-effect", remark) for remark in hump.remarks)


RULES: Final[tuple[Rule, ...]] = (of_grades, of_rises, of_runners, of_layout, of_retarders, of_tracks, of_file)
