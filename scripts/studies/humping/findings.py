"""What the study `hump-day` has found, and its tables."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from scripts.studies.aiming.trial import Value
from scripts.studies.humping.answer import answer_table, limit_cell
from scripts.studies.humping.beside import catch_up_rows, coupling_rows, speed_rows
from scripts.studies.humping.causes import Causes
from scripts.studies.humping.couplings import FREE, AimedFigures
from scripts.studies.humping.day_figures import PairFigures, metres, points, share
from scripts.studies.humping.frontier import Curve, Gain
from scripts.studies.humping.pair_tables import curve_table, gains_table, pair_table
from scripts.studies.humping.regulated_day import RegulatedDay
from scripts.studies.markdown_table import ABSENT, MarkdownTable, table
from scripts.studies.study import Findings


@dataclass(frozen=True)
class Inputs:
    """What all variants share; `least_s`: least interval of the programs where nothing else is told; `stds_m_s`: errors
    of normal interval positions."""

    trains: int
    cuts: int
    seed: int
    least_s: float
    stds_m_s: tuple[float, ...]

    def table(self) -> MarkdownTable:
        """How much was simulated."""
        heads = ("trains of a variant", "cuts of a train", "cuts of a variant",
                 "least interval where nothing else is told, s", "seed")  # fmt: skip
        numbers = (self.trains, self.cuts, self.trains * self.cuts, self.least_s, self.seed)
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
    regulated: RegulatedDay | None

    def tables(self) -> Mapping[str, MarkdownTable]:
        """See the titles."""
        beside = (
            *speed_rows(self.programs),
            *catch_up_rows(self.curves, max(self.inputs.stds_m_s)),
            *coupling_rows(self.couplings),
        )
        regulated = () if self.regulated is None else self.regulated.couplings
        found = {
            "answer": answer_table(self.curves, self.couplings, regulated),
            "beside": table("published figures beside ours", ("figure", "published", "ours"), beside),
            "limits": table(
                "mean hump speed, m/s, and cars an hour at a share of catch-ups, with bootstrap intervals",
                ("positions", "control", *(f"≤ {100 * at.limit:g} %" for at in self.curves[0].at_limits)),
                ((c.positions, c.control, *map(limit_cell, c.at_limits)) for c in self.curves),
            ),
            "gains": gains_table("mean hump speed and cars an hour more, same trains", self.gains),
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
        if self.regulated is not None:
            found |= self.regulated.tables()
        for curve in self.curves:
            found[f"curve-{words(curve.positions.removeprefix('σ '))}-{words(curve.control)}"] = curve_table(curve)
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
            f"{at.trains} trains of {at.cuts} cuts for every variant, the same trains with the same draws, seed "
            f"{at.seed}; least interval of the programs {at.least_s:g} s where nothing else is told",
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
        pairs = (*self.programs, *aimed, *self.disturbances, *self.sensitivity)
        if self.regulated is not None:
            few = self.regulated.couplings
            pairs = (*pairs, *self.regulated.beside, *(each.found for each in few if each.free != FREE[-1]))
        found = [(pair.name, pair.fewer) for pair in pairs]
        for curve in self.curves:
            found += [(f"{curve.name}, {p.least_s:g} s", p.fewer) for p in curve.points if p.fewer is not None]
        return found


def coupling_cells(each: AimedFigures) -> tuple[str, ...]:
    """The cells of a row."""
    aimed, day, opened = each.aimed, each.found.feedback, each.found.open_loop
    return (
        f"{aimed.std_m_s:.3g}", f"σ {aimed.aim_std_m_s:.3g}",
        "measured" if aimed.measured else "category", f"{100 * aimed.p_overspeed:g} %",
        f"{aimed.free[0]:g}–{aimed.free[1]:g}", share(day.overspeed), *map(share, day.classes), metres(day.gap_m),
        share(opened.overspeed), metres(opened.gap_m),
    )  # fmt: skip


def words(name: str) -> str:
    """A name as the name of a table has it."""
    return name.replace(", ", "-").replace(" ", "-")
