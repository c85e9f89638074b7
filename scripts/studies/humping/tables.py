"""Tables of the hump day: what a yard asks first, pairs, gains and curves, and the published figures of the hump
computer of the 1970s beside ours.
"""

from __future__ import annotations

from collections.abc import Iterator

from scripts.studies.humping.closed_loops import RegulatedCouplings
from scripts.studies.humping.day_figures import DayFigures, PairFigures, enough, metres, points, share, speed, whole
from scripts.studies.humping.frontier import (
    OPEN_LOOP,
    WITH_FEEDBACK,
    WITH_MEASURED,
    WITH_SLOWING,
    AtLimit,
    Curve,
    Gain,
    sigma,
)
from scripts.studies.humping.pairs import CAPS_M_S, CAREFUL, FREE, KNOWN, MEAN, SHARES, WORST, AimedFigures, capped
from scripts.studies.study import ABSENT, MarkdownTable, table

Days = dict[tuple[float, float], DayFigures]
"""By the free shares of the tracks."""

UNDECIDED = "not decidable with these trains"


def answer_table(
    curves: tuple[Curve, ...], couplings: tuple[AimedFigures, ...], regulated: tuple[RegulatedCouplings, ...]
) -> MarkdownTable:
    """A row for each kind of positions and control: normal ones, the least exact first, then regulators. Normal ones
    that are commanded as tables are left out."""
    limits = [f"cars an hour, catch-ups ≤ {100 * at.limit:g} %" for at in curves[0].at_limits]
    free = [f"gap a cut, tracks free {low:g}–{high:g}, m" for low, high in FREE]
    heads = ("positions", "control", *limits, "over-speeds, %", "above 2 m/s, %", *free)
    normal = dict.fromkeys(sigma(std) for std in sorted({c.aimed.std_m_s for c in couplings}, reverse=True))
    order = [*normal, *dict.fromkeys(each.positions for each in regulated)]
    told = sorted((c for c in curves if c.positions in order), key=lambda c: order.index(c.positions))
    days = (days_of(c, couplings) if c.positions in normal else regulated_days(c, regulated) for c in told)
    return table("the answer: cars an hour, over-speeds, gaps", heads, map(answer_row, told, days))


def answer_row(curve: Curve, days: Days) -> tuple[str, ...]:
    """Its cells. Couplings were not run with a train that is slowed down."""
    told = [ABSENT] * (2 + len(FREE))
    if curve.control != WITH_SLOWING:
        wide, gaps = days[FREE[-1]], [metres(days[free].gap_m) for free in FREE]
        told = [share(wide.overspeed), share(wide.classes[-1]), *gaps]
    return curve.positions, curve.control, *(cars_cell(at) for at in curve.at_limits), *told


def days_of(curve: Curve, couplings: tuple[AimedFigures, ...]) -> Days:
    """Figures of a control with normal positions that all have its exactness, with commands chosen for it and, where
    resistance is measured, by it."""
    own = [
        each
        for each in couplings
        if sigma(each.aimed.std_m_s) == sigma(each.aimed.aim_std_m_s) == curve.positions
        and each.aimed.measured == (curve.control == WITH_MEASURED)
    ]
    usual = max(each.aimed.p_overspeed for each in own)
    return {each.aimed.free: of_control(curve, each.found) for each in own if each.aimed.p_overspeed == usual}


def regulated_days(curve: Curve, regulated: tuple[RegulatedCouplings, ...]) -> Days:
    """The same with a regulator."""
    return {each.free: of_control(curve, each.found) for each in regulated if each.positions == curve.positions}


def of_control(curve: Curve, found: PairFigures) -> DayFigures:
    """Open loop or feedback."""
    return found.open_loop if curve.control == OPEN_LOOP else found.feedback


def cars_cell(at: AtLimit) -> str:
    """Cars an hour at a limit."""
    return UNDECIDED if at.cars_per_hour is None else whole(at.cars_per_hour)


def limit_cell(at: AtLimit) -> str:
    """Speed and cars at a limit, or why there are none."""
    if at.hump_speed_m_s is None or at.cars_per_hour is None:
        return f"{UNDECIDED}, between {at.least_m_s:.2f} and {at.most_m_s:.2f} m/s"
    return f"{speed(at.hump_speed_m_s)}; {whole(at.cars_per_hour)}"


def gains_table(title: str, gains: tuple[Gain, ...]) -> MarkdownTable:
    """A row a gain."""
    return table(
        title,
        ("share", "of", "than", "m/s", "cars an hour"),
        ((f"{100 * g.limit:g} %", g.more, g.than, *gain_cells(g)) for g in gains),
    )


def gain_cells(gain: Gain) -> tuple[str, str]:
    """Both gains."""
    if gain.hump_speed_m_s is None or gain.cars_per_hour is None:
        return UNDECIDED, ABSENT
    return speed(gain.hump_speed_m_s), whole(gain.cars_per_hour)


def curve_table(curve: Curve) -> MarkdownTable:
    """A row a program."""
    return table(
        f"{curve.name}: by the least interval of the program",
        ("least interval, s", *DAY_HEADS, "fewer catch-ups than open loop, points"),
        ((f"{p.least_s:g}", *day_cells(p.figures), ABSENT if p.fewer is None else points(p.fewer))
         for p in curve.points),
    )  # fmt: skip


DAY_HEADS = ("mean hump speed, m/s", "cars an hour", "catch-ups, %", "N for ± 0.1 %", "in the last position, %")


def day_cells(day: DayFigures) -> tuple[str, ...]:
    """Under `DAY_HEADS`."""
    return (
        speed(day.hump_speed_m_s), whole(day.cars_per_hour), share(day.catch_ups), enough(day), share(day.in_last),
    )  # fmt: skip


def pair_table(title: str, head: str, pairs: tuple[PairFigures, ...]) -> MarkdownTable:
    """A row a pair."""
    return table(
        f"{title}: with feedback where nothing else is told; shares with 95 % intervals",
        (head, "mean hump speed, m/s", "cars an hour", "catch-ups open loop, %", "with feedback, %",
         "fewer, all positions, points", "stopped, %", "over-speeds, %", "above 2 m/s, %", "gap a cut, m"),
        map(pair_cells, pairs),
    )  # fmt: skip


def pair_cells(pair: PairFigures) -> tuple[str, ...]:
    """The cells of a row."""
    day = pair.feedback
    return (
        pair.name, speed(day.hump_speed_m_s), whole(day.cars_per_hour), share(pair.open_loop.catch_ups),
        share(day.catch_ups), points(pair.fewer), share(day.stopped), share(day.overspeed), share(day.classes[2]),
        metres(day.gap_m),
    )  # fmt: skip


PUBLISHED_SPEEDS_M_S = (2.5, 2.7, 3.0)
"""Mean hump speeds of which the source tells catch-ups."""

Row = tuple[str, str, str]
"""What, published, ours."""


def speed_rows(programs: tuple[PairFigures, ...]) -> Iterator[Row]:
    """Mean hump speeds."""
    found = {pair.name: pair.open_loop.hump_speed_m_s for pair in programs}
    yield "mean hump speed, resistance known, m/s", "3.0", speed(found[KNOWN])
    yield "the same, mean of the category known", "–", speed(found[MEAN])
    yield "the same, worst pair", "2.5", speed(found[WORST])
    by_hand = "; ".join(f"{speed(found[capped(cap)])} (at most {cap:g})" for cap in CAPS_M_S)
    yield "the same, uncoupled by hand", "2.4", by_hand


def catch_up_rows(curves: tuple[Curve, ...], std_m_s: float) -> Iterator[Row]:
    """Catch-ups on the slope at the published speeds, with normal positions of this error."""
    of = {curve.control: curve for curve in curves if curve.positions == sigma(std_m_s)}
    for control, at, published in ((OPEN_LOOP, 3.0, "12–15"), (OPEN_LOOP, 2.5, "2.5"), (WITH_FEEDBACK, 2.7, "none")):
        yield f"catch-ups at mean {at:g} m/s, {control}, %", published, caught(of[control], at)


def caught(curve: Curve, at_m_s: float) -> str:
    """Share of catch-ups at a mean hump speed, or between which speeds the curve lies."""
    (found,) = (each.catch_ups for each in curve.at_speeds if each.hump_speed_m_s == at_m_s)
    if found is not None:
        return share(found)
    ends = [curve.points[0].figures, curve.points[-1].figures]
    told = " to ".join(f"{share(each.catch_ups)} at {speed(each.hump_speed_m_s)} m/s" for each in ends)
    return f"not reached: {told}"


def coupling_rows(couplings: tuple[AimedFigures, ...]) -> Iterator[Row]:
    """Over-speeds and gaps, with feedback; the first position of the couplings is the source's."""
    std = max(each.aimed.std_m_s for each in couplings)
    of = {
        (each.aimed.std_m_s, each.aimed.aim_std_m_s, each.aimed.p_overspeed, each.aimed.free): each.found.feedback
        for each in couplings
        if not each.aimed.measured
    }
    usual = next(each.aimed.p_overspeed for each in couplings)
    halved = SHARES[1] * std
    for free in FREE:
        where = f"tracks free {free[0]:g}–{free[1]:g}"
        first, kept = of[std, std, usual, free], of[halved, std, usual, free]
        careful = of[halved, halved, CAREFUL, free]
        yield f"over-speeds, {where}, %", "10–13", share(first.overspeed)
        yield f"of all cuts at 1.5 to 2 m/s, {where}, %", "8–10", share(first.classes[1])
        yield f"gap a cut, {where}, m", "25–30", metres(first.gap_m)
        yield (
            f"accuracy doubled, {where}: over-speeds, %", "5–6",
            f"{share(kept.overspeed)} same commands; {share(careful.overspeed)} chosen anew for {100 * CAREFUL:g} %",
        )  # fmt: skip
        yield (
            "the same: above 2 m/s, %", "0.2",
            f"{share(kept.classes[2])} same commands; {share(careful.classes[2])} chosen anew",
        )  # fmt: skip
        yield (
            "the same: gap smaller by the factor", "1.5",
            f"{first.gap_m.value / kept.gap_m.value:.2f} same commands; "
            f"{first.gap_m.value / careful.gap_m.value:.2f} chosen anew",
        )  # fmt: skip
