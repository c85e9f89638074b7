"""What a yard asks first: cars an hour, over-speeds, gaps."""

from __future__ import annotations

from collections.abc import Iterator

from synth.studies.humping.couplings import FREE, AimedFigures
from synth.studies.humping.day_figures import DayFigures, metres, share, speed, whole
from synth.studies.humping.frontier import OPEN_LOOP, WITH_MEASURED, WITH_SLOWING, AtLimit, Curve
from synth.studies.markdown_table import ABSENT, MarkdownTable, table

UNDECIDED = "not decidable with these trains"


def answer_table(curves: tuple[Curve, ...], couplings: tuple[AimedFigures, ...]) -> MarkdownTable:
    """A row an exactness and control, the least exact first."""
    limits = [f"cars an hour, catch-ups ≤ {100 * at.limit:g} %" for at in curves[0].at_limits]
    free = [f"gap a cut, tracks free {low:g}–{high:g}, m" for low, high in FREE]
    heads = ("σ, m/s", "control", *limits, "over-speeds, %", "above 2 m/s, %", *free)
    return table("the answer: cars an hour, over-speeds, gaps", heads, rows(curves, couplings))


def rows(curves: tuple[Curve, ...], couplings: tuple[AimedFigures, ...]) -> Iterator[tuple[str, ...]]:
    """The rows. Couplings are those of positions that all have this exactness, with commands chosen for it and, where
    resistance is measured, by it; they were not run with a train that is slowed down."""
    for curve in sorted(curves, key=lambda c: -c.std_m_s):
        told = [ABSENT] * (2 + len(FREE))
        if curve.control != WITH_SLOWING:
            days = days_of(curve, couplings)
            wide, gaps = days[FREE[-1]], [metres(days[free].gap_m) for free in FREE]
            told = [share(wide.overspeed), share(wide.classes[-1]), *gaps]
        yield f"{curve.std_m_s:g}", curve.control, *(cars_cell(at) for at in curve.at_limits), *told


def days_of(curve: Curve, couplings: tuple[AimedFigures, ...]) -> dict[tuple[float, float], DayFigures]:
    """Figures of a control by the free shares of the tracks."""
    own = [
        each
        for each in couplings
        if each.aimed.std_m_s == each.aimed.aim_std_m_s == curve.std_m_s
        and each.aimed.measured == (curve.control == WITH_MEASURED)
    ]
    usual = max(each.aimed.p_overspeed for each in own)
    return {
        each.aimed.free: each.found.open_loop if curve.control == OPEN_LOOP else each.found.feedback
        for each in own
        if each.aimed.p_overspeed == usual
    }


def cars_cell(at: AtLimit) -> str:
    """Cars an hour at a limit."""
    return UNDECIDED if at.cars_per_hour is None else whole(at.cars_per_hour)


def limit_cell(at: AtLimit) -> str:
    """Speed and cars at a limit, or why there are none."""
    if at.hump_speed_m_s is None or at.cars_per_hour is None:
        return f"{UNDECIDED}, between {at.least_m_s:.2f} and {at.most_m_s:.2f} m/s"
    return f"{speed(at.hump_speed_m_s)}; {whole(at.cars_per_hour)}"
