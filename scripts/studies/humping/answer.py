"""What a yard asks first: cars an hour, over-speeds, gaps."""

from __future__ import annotations

from scripts.studies.humping.closed_loops import RegulatedCouplings
from scripts.studies.humping.couplings import FREE, AimedFigures
from scripts.studies.humping.day_figures import DayFigures, PairFigures, metres, share, speed, whole
from scripts.studies.humping.frontier import OPEN_LOOP, WITH_MEASURED, WITH_SLOWING, AtLimit, Curve, sigma
from scripts.studies.markdown_table import ABSENT, MarkdownTable, table

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
