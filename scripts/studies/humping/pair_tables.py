"""Tables of pairs, gains and curves."""

from __future__ import annotations

from scripts.studies.humping.answer import UNDECIDED
from scripts.studies.humping.day_figures import DayFigures, PairFigures, enough, metres, points, share, speed, whole
from scripts.studies.humping.frontier import Curve, Gain
from scripts.studies.markdown_table import ABSENT, MarkdownTable, table


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
