"""What the study `hump-day` has found, and its tables."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from synth.studies.aiming.trial import Value
from synth.studies.humping.answer import UNDECIDED, answer_table, limit_cell
from synth.studies.humping.beside import catch_up_rows, coupling_rows, speed_rows
from synth.studies.humping.causes import Causes
from synth.studies.humping.couplings import AimedFigures
from synth.studies.humping.day_figures import (
    DayFigures,
    PairFigures,
    enough,
    metres,
    points,
    share,
    speed,
    whole,
)
from synth.studies.humping.frontier import Curve, Gain
from synth.studies.markdown_table import ABSENT, MarkdownTable, table
from synth.studies.study import Findings


@dataclass(frozen=True)
class Inputs:
    """What all variants share; `table_trains`: trains where positions run tables; `least_s`: least interval of the
    programs where nothing else is told."""

    trains: int
    table_trains: int
    cuts: int
    seed: int
    least_s: float

    def table(self) -> MarkdownTable:
        """How much was simulated."""
        heads = ("trains of a variant", "where positions run tables", "cuts of a train", "cuts of a variant",
                 "least interval where nothing else is told, s", "seed")  # fmt: skip
        numbers = (self.trains, self.table_trains, self.cuts, self.trains * self.cuts, self.least_s, self.seed)
        return table("size of the study", heads, [tuple(f"{number:g}" for number in numbers)])


@dataclass(frozen=True)
class HumpDay(Findings):
    """All parts."""

    inputs: Inputs
    curves: tuple[Curve, ...]
    gains: tuple[Gain, ...]
    programs: tuple[PairFigures, ...]
    couplings: tuple[AimedFigures, ...]
    causes: Causes
    disturbances: tuple[PairFigures, ...]
    sensitivity: tuple[PairFigures, ...]
    tables_beside: tuple[PairFigures, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """See the titles."""
        beside = (*speed_rows(self.programs), *catch_up_rows(self.curves), *coupling_rows(self.couplings))
        found = {
            "answer": answer_table(self.curves, self.couplings),
            "beside": table("published figures beside ours", ("figure", "published", "ours"), beside),
            "limits": table(
                "mean hump speed, m/s, and cars an hour at a share of catch-ups, with bootstrap intervals",
                ("σ, m/s", "control", *(f"≤ {100 * at.limit:g} %" for at in self.curves[0].at_limits)),
                ((f"{c.std_m_s:g}", c.control, *map(limit_cell, c.at_limits)) for c in self.curves),
            ),
            "gains": table(
                "mean hump speed and cars an hour more at a share of catch-ups, same trains",
                ("share", "of", "than", "m/s", "cars an hour"),
                ((f"{100 * g.limit:g} %", g.more, g.than, *gain_cells(g)) for g in self.gains),
            ),
            "programs": pair_table("programs of hump speeds", "program", self.programs),
            "disturbances": pair_table("bad days", "day", self.disturbances),
            "sensitivity": pair_table("other switches", "hump", self.sensitivity),
            "causes": table(
                "cuts that coupled above 2 m/s, σ 0.35, with feedback",
                ("cuts", "above 2 m/s", "to a cut that still rolled", "not held by the last position",
                 "commanded the lowest speed", "rest"),
                [tuple(str(n) for n in vars(self.causes).values())],
            ),
            "couplings": table(
                "couplings and gaps with feedback; shares of the cuts that reached their track, %",
                ("σ, m/s", "commands for", "resistance", "share asked", "tracks free", "over-speeds", "to 1.5 m/s",
                 "1.5 to 2 m/s", "above 2 m/s", "gap a cut, m", "open loop: over-speeds", "gap, m"),
                map(coupling_cells, self.couplings),
            ),
        }  # fmt: skip
        found["feedback"], found["size"] = self.feedback_table(), self.inputs.table()
        if self.tables_beside:
            found["tables"] = pair_table("our tables", "positions", self.tables_beside)
        for curve in self.curves:
            found[f"curve-{curve.std_m_s:g}-{curve.control.replace(', ', '-').replace(' ', '-')}"] = curve_table(curve)
        return found

    def feedback_table(self) -> MarkdownTable:
        """How often feedback was better and worse than open loop."""
        rows = self.compared()
        better, worse = [n for n, f in rows if f.ci95[0] > 0.0], [n for n, f in rows if f.ci95[1] < 0.0]
        cells = (str(len(rows)), str(len(better)), str(len(rows) - len(better) - len(worse)), str(len(worse)))
        return table(
            "feedback beside open loop: share of catch-ups in all positions, paired by train",
            (
                "variants compared",
                "better beyond its interval",
                "no difference told",
                "worse beyond its interval",
                "where",
            ),
            [(*cells, "; ".join(worse) or ABSENT)],
        )

    def sentences(self) -> tuple[str, ...]:
        """How much was simulated."""
        at = self.inputs
        return (
            f"{at.trains} trains of {at.cuts} cuts for every variant ({at.table_trains} where positions run tables), "
            f"the same trains with the same draws, seed {at.seed}; least interval of the programs {at.least_s:g} s "
            "where nothing else is told",
        )

    def faults(self) -> tuple[str, ...]:
        """Feedback must not be worse than open loop beyond its interval."""
        return tuple(
            f"{name}: feedback has {points(Value(-f.value, (-f.ci95[1], -f.ci95[0])))} percentage points more "
            "catch-ups than open loop"
            for name, f in self.compared()
            if f.ci95[1] < 0.0
        )

    def compared(self) -> list[tuple[str, Value]]:
        """Every variant that ran with feedback and open loop."""
        aimed = (each.found for each in self.couplings)
        pairs = (*self.programs, *aimed, *self.disturbances, *self.sensitivity, *self.tables_beside)
        found = [(pair.name, pair.fewer) for pair in pairs]
        for curve in self.curves:
            name = f"σ {curve.std_m_s:g}, {curve.control}"
            found += [(f"{name}, {p.least_s:g} s", p.fewer) for p in curve.points if p.fewer is not None]
        return found


def gain_cells(gain: Gain) -> tuple[str, str]:
    """Both gains."""
    if gain.hump_speed_m_s is None or gain.cars_per_hour is None:
        return UNDECIDED, ABSENT
    return speed(gain.hump_speed_m_s), whole(gain.cars_per_hour)


def curve_table(curve: Curve) -> MarkdownTable:
    """A row a program."""
    return table(
        f"σ {curve.std_m_s:g} m/s, {curve.control}: by the least interval of the program",
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


def coupling_cells(each: AimedFigures) -> tuple[str, ...]:
    """The cells of a row."""
    aimed, day, opened = each.aimed, each.found.feedback, each.found.open_loop
    return (
        f"{aimed.std_m_s:.3g}", f"σ {aimed.aim_std_m_s:.3g}",
        "measured" if aimed.measured else "category", f"{100 * aimed.p_overspeed:g} %",
        f"{aimed.free[0]:g}–{aimed.free[1]:g}", share(day.overspeed), *map(share, day.classes), metres(day.gap_m),
        share(opened.overspeed), metres(opened.gap_m),
    )  # fmt: skip
