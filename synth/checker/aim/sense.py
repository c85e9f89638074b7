"""What an aim table must fulfil beside its form, and what it claims of its own quality."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from statistics import NormalDist
from typing import Final

from synth.checker.aim.table import Aim, NodeValues
from synth.checker.document_shape import OWN, YARD, origin_faults
from synth.checker.float32 import rounded

MOST_NODES_OF_A_CUT: Final = 999
MOST_NODES: Final = 20_000
ALLOWED_EXCESS: Final = 1.1
"""The reported p of a node, less what its interval allows for, stays below so many times the required one."""

ONE_SIDED: Final = 0.025
"""Chance that a share lies below its 95 % interval."""


def sense(aim: Aim) -> Iterator[str]:
    """Every way in which the table makes no sense."""
    yield from purpose_faults(aim)
    yield from axis_faults(aim)
    yield from speed_faults(aim)
    yield from figure_faults(aim)


def purpose_faults(aim: Aim) -> Iterator[str]:
    """Faults of what it says that it is for."""
    document, measured = aim.document, aim.document["measured"]
    known = YARD.get(aim.category_name)
    if aim.category != known if known is not None else aim.category not in OWN:
        yield f"its category {aim.category_name} has the number {aim.category}, which is not its own"
    if not 0.0 < aim.p_overspeed < 1.0:
        yield f"its required p of {aim.p_overspeed:g} does not lie within (0, 1)"
    if not 0.01 <= aim.coupling_m_s <= 40.0:
        yield f"its coupling speed of {aim.coupling_m_s:g} m/s is impossible"
    if not 0.01 <= aim.bounds_m_s[0] < aim.bounds_m_s[1] <= 40.0:
        yield f"its bounds {aim.bounds_m_s} do not rise within 0.01 to 40 m/s"
    if not 0.0 <= document["interpolation_error_m_s"] <= 40.0 or document["reported"]["passes"] < 1:
        yield "its interpolation error or its number of passes is impossible"
    if not 0.0 <= document["position"]["exit_at_m"] <= 1e5:
        yield f"its position ends at {document['position']['exit_at_m']:g} m"
    if measured is not None and not (
        0.0 <= measured["from_m"] < measured["to_m"] <= 1e5 and 0.0 <= measured["speed_std_m_s"] <= 40.0
    ):
        yield f"its resistance is measured from {measured['from_m']:g} to {measured['to_m']:g} m, which is impossible"
    yield from origin_faults(document)


def axis_faults(aim: Aim) -> Iterator[str]:
    """Faults of the axes."""
    if not aim.cars[0] >= 1 or aim.cars[-1] > 1000 or len(aim.cars) > 64 or any(b <= a for a, b in pairwise(aim.cars)):
        yield f"its numbers of cars {aim.cars} do not rise within 1 to 1000"
    for name, axis, (low, high) in (
        ("free distances", aim.distances_m, (0.0, 1e4)),
        ("resistances", aim.resistances, (-1e3, 1e3)),
    ):
        steps = [rounded(b) - rounded(a) for a, b in pairwise(axis)]
        if any(not low <= x <= high for x in axis) or any(step < rounded(0.001) for step in steps):
            yield f"its {name} do not rise by 0.001 at least within {low:g} to {high:g}"
    of_a_cut = len(aim.distances_m) * max(1, len(aim.resistances))
    if of_a_cut > MOST_NODES_OF_A_CUT or of_a_cut * len(aim.cars) > MOST_NODES:
        yield f"it has {of_a_cut} nodes for each of {len(aim.cars)} numbers of cars, which is too many"


def speed_faults(aim: Aim) -> Iterator[str]:
    """Speeds out of their bounds, and speeds that fall with the resistance; of each kind the first."""
    low, high = aim.bounds_m_s
    for place in aim.places():
        speed = at(aim.speeds, place)
        if speed is not None and not low <= speed <= high:
            yield f"{named(aim, place)}: the exit speed of {speed:.9g} m/s is out of its bounds {low:g} to {high:g} m/s"
            break
    for c, rows in enumerate(aim.speeds):
        for d, row in enumerate(rows):
            least = -1.0
            for r, speed in enumerate(row):
                if speed is not None and speed < least:
                    yield f"{named(aim, (c, d, r))}: the exit speed is less than for a smaller resistance"
                    return
                least = least if speed is None else speed


def figure_faults(aim: Aim) -> Iterator[str]:
    """Figures where there is no exit speed, some without the others, shares that are none, negative gaps."""
    for place in aim.places():
        p, low, high, gap = (at(nodes, place) for nodes in aim.figures.values())
        if p is None or low is None or high is None or gap is None:
            if (p, low, high, gap) != (None,) * 4:
                yield f"{named(aim, place)}: some figures are reported without the others"
                return
            continue
        if at(aim.speeds, place) is None:
            yield f"{named(aim, place)}: figures are reported where there is no exit speed"
            return
        if not (0.0 <= low <= p <= high <= 1.0 and gap >= 0.0):
            yield f"{named(aim, place)}: p of {p:g} in [{low:g}, {high:g}], or a gap of {gap:g} m, is impossible"
            return


def claim_faults(aim: Aim) -> Iterator[str]:
    """Whether cuts over-speed more often than required, as the table itself reports.

    Of many nodes some lie above their intervals by chance. So the intervals are widened until the chance that any of
    them does is that of a single one.
    """
    reported = sum(at(aim.figures["p_overspeed"], place) is not None for place in aim.places())
    wider = normal_quantile(ONE_SIDED / max(reported, 1)) / normal_quantile(ONE_SIDED)
    wrong = []
    for place in aim.places():
        p, low, high = (
            at(aim.figures[name], place) for name in ("p_overspeed", "p_overspeed_low95", "p_overspeed_high95")
        )
        if p is not None and low is not None and p - wider * (p - low) > ALLOWED_EXCESS * aim.p_overspeed:
            wrong.append((p, low, high, place))
    if wrong:
        p, low, high, place = max(wrong)
        yield (
            f"at {len(wrong)} nodes more cuts over-speed than required, p = {aim.p_overspeed:g}; most at "
            f"{named(aim, place)}: {p:.4f} [{low:.4f}, {high:.4f}]"
        )


def normal_quantile(tail: float) -> float:
    """What a standard normal number exceeds with the probability `tail`."""
    return NormalDist().inv_cdf(1.0 - tail)


def at(nodes: NodeValues, place: Sequence[int]) -> float | None:
    """The number at a node."""
    c, d, r = place
    return nodes[c][d][r]


def named(aim: Aim, place: Sequence[int]) -> str:
    """A node as messages call it."""
    c, d, r = place
    of = f" and {aim.resistances[r]:g} N/kN" if aim.is_measured else ""
    return f"{aim.cars[c]} cars at {aim.distances_m[d]:g} m{of}"
