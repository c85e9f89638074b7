"""What is shown of a design test: four tiles, the way of each car of the worst triple, brakes, partings, pictures."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from synth.frame.exhibits import Chart, Column, Exhibit, Row, Sentence, Table, Tile, Tiles
from synth.frame.printed_numbers import decimals
from synth.hump.design.found_design import BETWEEN, FoundDesign, tightest_element
from synth.hump.design.intervals import NEARLY_M_S
from synth.hump.design.triples import CARS, PAIRS
from synth.hump.rolling.hump_routes import Mark

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from plant_models.hump import HumpGraph

HOW_TO_READ: Final = (
    "Single cars are pushed over the crest one behind another: a bad runner, a good one, a bad one. The bad ones go to "
    "one track, the good one to another; every two tracks are tried, and the worst are shown. Exit speeds are chosen "
    "so that the least interval is as long as it can be; the resistance of each car is known. A margin is the time "
    "from the last axle of a car out of an element to the first axle of the next one in, less what the points need."
)
WHERE_IT_AIMS: Final = (
    "Where a position aims at the standing cars, the good runner finds a full track, and leaves the position at the "
    "speed at which cuts may couple; the bad ones find empty tracks and are not braked."
)
POSITIONS: Final = (
    Column("number", "position"),
    Column("track", "worst way, to track", spare=2),
    Column("comes_m_s", "very good runner comes, nothing braked", "m/s", decimals(2), spare=1),
    Column("needed_m", "head to take so that it stops", "m", decimals(2)),
    Column("own_m", "brake counted upon", "m", decimals(2), spare=1),
    Column("there_m", "with those before", "m", decimals(2)),
    Column("left_m", "left", "m", decimals(2)),
    Column("fastest_m_s", "fastest of the triples", "m/s", decimals(2)),
    Column("allowed_m_s", "allowed", "m/s", decimals(2)),
)
ELEMENTS: Final = (
    Column("element", "element", words=True),
    Column("at_m", "from the crest", "m", decimals(1), spare=3),
    Column("needs_s", "points need", "s", decimals(2), spare=4),
    Column("bad_in_s", "bad in", "s", decimals(2)),
    Column("bad_out_s", "out", "s", decimals(2), spare=2),
    Column("good_in_s", "good in", "s", decimals(2)),
    Column("good_out_s", "out", "s", decimals(2), spare=2),
    Column("next_in_s", "bad in", "s", decimals(2)),
    Column("margin_01_s", "margin bad–good", "s", decimals(2)),
    Column("margin_12_s", "margin good–bad", "s", decimals(2)),
    Column("margin_02_s", "margin bad–bad", "s", decimals(2), spare=1),
)
PASSES: Final = (
    Column("car", "car", words=True, once=True),
    Column("position", "position"),
    Column("entry_m_s", "comes", "m/s", decimals(2)),
    Column("unbraked_m_s", "would leave, not braked", "m/s", decimals(2), spare=1),
    Column("exit_m_s", "leaves", "m/s", decimals(2)),
    Column("braked_m", "head that is braked", "m", decimals(2)),
    Column("usable_m", "counted upon", "m", decimals(2)),
)
PARTINGS: Final = (
    Column("depth", "tracks part at switch number"),
    Column("pairs", "pairs of tracks", spare=1),
    Column("bad_track", "worst: bad to track", spare=1),
    Column("good_track", "good to track", spare=1),
    Column("least_s", "least margin", "s", decimals(2)),
    Column("highest_m_s", "hump speed up to which none is short", "m/s", decimals(2)),
)


def design(found: FoundDesign) -> Iterator[Exhibit]:
    """The first chapter."""
    yield Tiles((speed_tile(found), interval_tile(found), fall_tile(found), brake_tile(found)))
    yield highest(found)
    yield Sentence(HOW_TO_READ)
    title = "By the switch of their ways at which the tracks part"
    yield Table("partings", title, PARTINGS, [parting_row(found, each) for each in found.intervals.partings])


def speed_tile(found: FoundDesign) -> Tile:
    """How fast the hump may be."""
    speed, asked = found.intervals.highest_m_s, found.hump.asked.hump_speed_m_s
    told = "none" if speed is None else f"{speed:.2f} m/s"
    return Tile(
        told, "hump speed up to which no interval of the triples is short", speed is not None and speed >= asked
    )


def interval_tile(found: FoundDesign) -> Tile:
    """The least interval."""
    least = found.worst.least_s
    told = f"{least:+.2f} s" if math.isfinite(least) else "stands"
    at = graph_of(found).element_called(tightest_element(found))
    of = f"least margin at {found.hump.asked.hump_speed_m_s:g} m/s, {BETWEEN[found.worst.tightest[0]]}, at {at}"
    return Tile(told, of, least >= 0.0)


def fall_tile(found: FoundDesign) -> Tile:
    """What the bad runner has left."""
    fall = found.unbraked.fall
    track = graph_of(found).track_called(fall.route.track)
    of = f"of energy head left to the bad runner {fall.into_m:.0f} m into track {track}"
    return Tile(f"{fall.left_m:+.2f} m", of, fall.left_m >= 0.0)


def brake_tile(found: FoundDesign) -> Tile:
    """What the brakes have left."""
    worst = min((each for each in found.unbraked.positions if each.last), key=lambda each: each.left_m)
    of = f"of brake head left when the very good runner stands in position {worst.number}"
    return Tile(f"{worst.left_m:+.2f} m", of, worst.left_m >= 0.0)


def highest(found: FoundDesign) -> Sentence:
    """Up to which hump speed the intervals do, and how exactly that is known."""
    speed, worst = found.intervals.highest_m_s, found.worst
    if speed is None:
        text = "At no hump speed the intervals of all triples are long enough."
    else:
        text = (
            f"Up to a hump speed of {speed:.2f} m/s (found to {NEARLY_M_S:g} m/s) no interval of the triples is short. "
        )
    if found.hump.choices > 1 and math.isfinite(worst.least_s):
        text += (
            f"Exit speeds are compared in {found.hump.choices} steps; twice as many change the least margin by "
            f"{worst.grid_s:+.2f} s."
        )
    figures = {"highest_hump_speed_m_s": speed, "least_margin_s": finite(worst.least_s), "grid_error_s": worst.grid_s}
    return Sentence(text.rstrip(), figures, brief=True)


def parting_row(found: FoundDesign, each: Any) -> Row:
    """A row of the partings."""
    bad, good, _ = found.hump.routes.tracks[found.intervals.pairs[each.worst]]
    least = each.least_s if math.isfinite(each.least_s) else None
    return {**vars(each), "bad_track": int(bad), "good_track": int(good), "least_s": least}


def fall_and_brakes(found: FoundDesign) -> Iterator[Exhibit]:
    """What the fall does for the bad runner, and the brakes against the good one."""
    fall = found.unbraked.fall
    figures = {
        "track": fall.route.track,
        "into_track_m": fall.into_m,
        "fall_m": fall.fall_m,
        "needed_m": fall.needed_m,
        "left_m": fall.left_m,
        "stop_m": fall.stop_m if math.isfinite(fall.stop_m) else None,
    }
    track = graph_of(found).track_called(fall.route.track)
    yield Sentence(
        f"From the crest to {fall.into_m:.0f} m into track {track}, where the bad runner fares worst, the track falls "
        f"{fall.fall_m:.2f} m; {fall.needed_m:.2f} m are needed.",
        figures,
        brief=True,
    )
    rows = [
        {**vars(need), "left_m": need.left_m, **vars(entry), "allowed_m_s": finite(entry.allowed_m_s)}
        for need, entry in zip(found.unbraked.positions, found.entries, strict=True)
    ]
    title = "Brake head that is needed, and that there is, and how fast cars come to the positions"
    yield Table("positions", title, POSITIONS, rows, brief=True)
    yield Sentence(
        f"Of the full brake at mean friction a share of "
        f"{found.asked.config.settings.exit_speeds.usable_share:g} is counted upon (exit_speeds.usable_share). A "
        f"position that is out of service takes nothing. {WHERE_IT_AIMS}"
    )
    yield Chart(
        "profile",
        "Plan and profile, with the energy heads of the runners where nothing brakes",
        f"Pushed at {found.hump.asked.hump_speed_m_s:g} m/s, on the way on which the bad runner fares worst. The "
        "distance of a line from the track is the speed head.",
        lambda: profile_picture(found),
    )


def triple(found: FoundDesign) -> Iterator[Exhibit]:
    """The worst triple, element by element."""
    bad, good = map(graph_of(found).track_called, found.worst.tracks)
    title = f"Bad runners to track {bad}, good one to track {good}; seconds since the first was at the crest"
    yield Table("elements", title, ELEMENTS, list(element_rows(found)), bad=too_close)
    title = "What the positions make of them, none of which meets another"
    yield Table("passes", title, PASSES, list(pass_rows(found)))
    yield Chart(
        "triple-time-path",
        "Time–path diagram of the worst triple",
        "Each band is a car from its end to its head. Boxes: an element is occupied, from the first axle in to the "
        "last axle out. Where points are too late the car goes the wrong way, behind the one ahead.",
        lambda: triple_picture(found),
    )


def too_close(row: Row) -> bool:
    """Whether a margin is short at this element."""
    return any((row[f"margin_{a}{b}_s"] or 0.0) < 0.0 for a, b in PAIRS)


def element_rows(found: FoundDesign) -> Iterator[Row]:
    """The elements on which two of the three can meet."""
    routes, worst = found.hump.routes, found.worst
    first, second = (int(row) for row in worst.cars.route[0, :2])
    comes, leaves = worst.plan.first_in_s[0], worst.plan.last_out_s[0]
    shared = int(routes.shared(np.array([first]), np.array([second]))[0])
    for column in range(routes.elements):
        vertex = int(routes.vertex[first, column])
        if vertex < 0:
            break
        both = column < shared
        parts = both and routes.points[first, column] != routes.points[second, column]
        yield {
            "element": routes.graph.element_called(routes.numbers[vertex]),
            "at_m": float(routes.place_m[first, column, Mark.FIRST_IN]),
            "needs_s": float(routes.throw_s[first, column]) if parts else 0.0,
            "bad_in_s": finite(comes[0, column]),
            "bad_out_s": finite(leaves[0, column]),
            "good_in_s": finite(comes[1, column]) if both else None,
            "good_out_s": finite(leaves[1, column]) if both else None,
            "next_in_s": finite(comes[2, column]),
            **{
                f"margin_{ahead}{behind}_s": finite(worst.margin_s[place, column])
                for place, (ahead, behind) in enumerate(PAIRS)
            },
        }


def pass_rows(found: FoundDesign) -> Iterator[Row]:
    """What each position makes of each of the three."""
    worst, names = found.worst, ("bad", "good", "bad, the second")
    gravity = worst.cars.trains.drawn.reduced_gravity_m_s2
    for car in range(CARS):
        for place in range(int(found.hump.routes.positions_of[worst.cars.route[0, car]])):
            kept = (worst.alone.entry_m_s, worst.alone.unbraked_m_s, worst.alone.exit_m_s)
            entry, free, leaves = (float(array[car, 0, place]) for array in kept)
            yield {
                "car": names[car],
                "position": place + 1,
                "entry_m_s": entry,
                "unbraked_m_s": free,
                "exit_m_s": leaves,
                "braked_m": max(free**2 - leaves**2, 0.0) / (2.0 * float(gravity[car])),
                "usable_m": float(worst.cars.known.braked_m2_s2[car, place] / (2.0 * gravity[car])),
            }


def graph_of(found: FoundDesign) -> HumpGraph:
    """The hump, which knows what its elements and tracks are called."""
    return found.hump.routes.graph


def finite(value: float) -> float | None:
    """The number; None for what is never, or nowhere."""
    return float(value) if math.isfinite(value) else None


def profile_picture(found: FoundDesign) -> Figure:
    """Plan and profile."""
    from synth.hump.hump_picture import hump_picture

    return hump_picture(found.asked.config.hump, found.unbraked.fall.route, found.unbraked.rolls)


def triple_picture(found: FoundDesign) -> Figure:
    """The time–path diagram of the three."""
    from synth.hump.trains.pictures.time_path import time_path
    from synth.kernels.cache import guarded

    bad, good = map(graph_of(found).track_called, found.worst.tracks)
    title = f"Bad runners to track {bad}, a good one to track {good}, {found.hump.asked.hump_speed_m_s:g} m/s"
    return time_path(guarded(found.worst.together), title)
