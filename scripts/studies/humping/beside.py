"""The published figures of the hump computer of the 1970s beside ours."""

from __future__ import annotations

from collections.abc import Iterator

from scripts.studies.humping.couplings import CAREFUL, FREE, SHARES, AimedFigures
from scripts.studies.humping.day_figures import PairFigures, metres, share, speed
from scripts.studies.humping.frontier import OPEN_LOOP, WITH_FEEDBACK, Curve, sigma
from scripts.studies.humping.programs import CAPS_M_S, KNOWN, MEAN, WORST, capped

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
