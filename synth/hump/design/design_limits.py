"""What the design test asks of a hump: fall, brakes, speeds at the entrances, intervals."""

from __future__ import annotations

import math
from collections.abc import Iterator

from synth.frame.command import Limit
from synth.hump.design.found_design import KEPT_M_S, FoundDesign
from synth.hump.design_runners import bad_runner, very_good_runner

BETWEEN = ("bad and good", "good and bad", "bad and bad")
"""What the intervals of a triple lie between, as its pairs are ordered."""


def design_limits(found: FoundDesign) -> Iterator[Limit]:
    """All of them, a sentence each."""
    yield of_fall(found)
    yield from of_brakes(found)
    yield from of_entries(found)
    yield of_intervals(found)


def of_fall(found: FoundDesign) -> Limit:
    """The bad runner must come into its track."""
    fall, runner = found.unbraked.fall, bad_runner(found.hump.asked)
    where = f"{fall.into_m:.0f} m into track {found.hump.routes.graph.track_called(fall.route.track)}"
    who = f"the bad runner ({runner.mass_t:g} t, {runner.resistance_n_per_kn:g} N/kN)"
    if fall.left_m >= 0.0:
        return Limit(f"{who} comes {where} with {fall.left_m:.2f} m of energy head left", True)
    return Limit(
        f"{who} stops {fall.stop_m:.0f} m behind the crest and does not come {where}: {fall.needed_m:.2f} m of fall "
        f"are needed, and there are {fall.fall_m:.2f} m",
        False,
    )


def of_brakes(found: FoundDesign) -> Iterator[Limit]:
    """The brakes must stop the very good runner at the exit of a last position."""
    runner = very_good_runner(found.hump.asked)
    for need in found.unbraked.positions:
        if need.last:
            words = (
                f"up to the exit of position {need.number} the brakes can take {need.there_m:.2f} m of energy head "
                f"from the very good runner ({runner.mass_t:g} t, {runner.resistance_n_per_kn:g} N/kN) on the way to "
                f"track {found.hump.routes.graph.track_called(need.track)}, which has {need.needed_m:.2f} m there"
            )
            yield Limit(words, need.left_m >= 0.0)


def of_entries(found: FoundDesign) -> Iterator[Limit]:
    """Cars must come to positions as slowly as is allowed there, and leave them as commanded."""
    for each in found.entries:
        if math.isfinite(each.allowed_m_s):
            words = (
                f"cars of the test come to position {each.number} at {each.fastest_m_s:.2f} m/s or less; "
                f"{each.allowed_m_s:g} m/s are allowed"
            )
            yield Limit(words, each.kept)
        if each.beyond_m_s > KEPT_M_S:
            words = f"the good runner leaves position {each.number} up to {each.beyond_m_s:.2f} m/s faster than it may"
            yield Limit(f"{words}, for want of brake", False)


def of_intervals(found: FoundDesign) -> Limit:
    """No car may come before the points are right, and the retarder free."""
    worst, asked = found.worst, found.hump.asked
    graph, (pair, _) = found.hump.routes.graph, worst.tightest
    there, tracks = graph.element_called(tightest_element(found)), " and ".join(map(graph.track_called, worst.tracks))
    where = f"between {BETWEEN[pair]} at {there}, to tracks {tracks}, pushed at {asked.hump_speed_m_s:g} m/s"
    if worst.least_s >= 0.0:
        return Limit(f"the least interval is {worst.least_s:.2f} s longer than needed, {where}", True)
    if math.isinf(worst.least_s):
        return Limit(f"a car stands in the way of the next one, {where}", False)
    return Limit(f"the least interval is {-worst.least_s:.2f} s too short, {where}", False)


def tightest_element(found: FoundDesign) -> int:
    """Number of the element of the least margin."""
    routes, (pair, column) = found.hump.routes, found.worst.tightest
    row = found.worst.cars.route[0, 0 if pair != 1 else 1]
    return routes.numbers[int(routes.vertex[row, column])]
