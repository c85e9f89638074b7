"""The day of a hump: how fast trains can be humped, and what it costs in catch-ups, over-speeds and gaps, with
commanded exits and where positions work in their closed loop.

Every variant humps the same trains with the same draws. Nothing is tuned to a published figure.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from scripts.studies.aiming.trial import Value
from scripts.studies.humping.base_trial import FEEDBACK, Day
from scripts.studies.humping.closed_loops import (
    ClosedLoops,
    RegulatedCouplings,
    closed_loops,
    normal_gains,
    table_gains,
)
from scripts.studies.humping.day_figures import PairFigures, metres, points, share
from scripts.studies.humping.exits import TRAINS, Causes, Exits, causes, exits_of, exits_table
from scripts.studies.humping.frontier import Curve, Frontier, Gain, frontier_groups, lines_of, normal_families
from scripts.studies.humping.pairs import (
    FREE,
    AimedFigures,
    coupling_pairs,
    disturbance_pairs,
    program_pairs,
    sensitivity_pairs,
)
from scripts.studies.humping.runs import measured
from scripts.studies.humping.tables import (
    PUBLISHED_SPEEDS_M_S,
    answer_table,
    catch_up_rows,
    coupling_rows,
    curve_table,
    gains_table,
    limit_cell,
    pair_table,
    speed_rows,
)
from scripts.studies.study import ABSENT, Findings, MarkdownTable, Method, Tell, option, table


@dataclass(frozen=True)
class RegulatedDay:
    """Gains of our tables beside other positions; variants at one least interval; couplings by regulator; what
    positions make of their commands."""

    gains: tuple[Gain, ...]
    beside: tuple[PairFigures, ...]
    couplings: tuple[RegulatedCouplings, ...]
    exits: tuple[Exits, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """See the titles."""
        return {
            "table-gains": gains_table("our tables: mean hump speed and cars an hour more, same trains", self.gains),
            "tables": pair_table("our tables", "positions", self.beside),
            "exits": exits_table(self.exits),
        }


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


TODAY_STD_M_S, ASKED_STD_M_S = 0.35, 0.15
"""Errors of the exit speed: of regulators as the computer of the 1970s had them, and as it asks for."""


@dataclass(frozen=True)
class Options:
    """What is studied."""

    trains: int = option(250, "trains of every variant", (2, 10**6))
    cuts: int = option(40, "cuts of a train", (2, 999))
    stds_m_s: tuple[float, ...] = option((0.03, 0.15, 0.35), "errors of the interval positions", (0.0, 1.0))
    least_s: tuple[float, ...] = option(
        (3.0, 2.0, 1.4, 1.0, 0.6, 0.3, 0.0, -0.4, -1.0, -2.0), "least intervals of the programs, falling", (-10.0, 10.0)
    )
    limits: tuple[float, ...] = option((0.001, 0.005), "shares of catch-ups that may not be passed", (1e-5, 0.5))
    design_cuts: int = option(2000, "cuts that exit speeds of the last position are chosen on", (200, 200_000))
    no_tables: bool = option(False, "tune no tables, run none")
    workers: int = option(2, "processes; they change no result", (1, 1000))
    seed: int = option(17, "of all draws", (0, 10**9))


def run(options: Options, tell: Tell) -> HumpDay:
    """All parts."""
    asked = Day(options.seed, options.cuts, ASKED_STD_M_S, design_cuts=options.design_cuts)
    today = replace(asked, std_m_s=TODAY_STD_M_S)
    base, worse = asked.trial(), today.trial()
    aimed = coupling_pairs(today, options.stds_m_s, tell)
    pairs = {
        "programs": program_pairs(worse),
        "disturbances": disturbance_pairs(asked, base, tell),
        "sensitivity": sensitivity_pairs(base),
        "couplings": list(aimed.values()),
    }
    loops = None if options.no_tables else closed_loops(asked, options.stds_m_s, tell)
    families = [normal_families(base, options.stds_m_s)]
    groups = [pair.group for of_part in pairs.values() for pair in of_part]
    if loops is not None:
        families.append(loops.families())
        groups += [pair.group for pair in (*loops.pairs(), *loops.couplings().values())]
    groups = [group for each in families for group in frontier_groups(each, options.least_s)] + groups
    outcomes = measured(groups, options.trains, options.workers, tell)
    found = {part: tuple(pair.found(outcomes) for pair in of_part) for part, of_part in pairs.items()}
    frontier = Frontier(
        outcomes, lines_of(*families), options.least_s, options.limits, PUBLISHED_SPEEDS_M_S, options.seed
    )
    return HumpDay(
        inputs=Inputs(options.trains, options.cuts, options.seed, base.planner.least_s, options.stds_m_s),
        curves=frontier.curves(),
        gains=normal_gains(frontier, options.stds_m_s),
        programs=found["programs"],
        couplings=tuple(map(AimedFigures, aimed, found["couplings"])),
        causes=causes(replace(worse, control=FEEDBACK), TODAY_STD_M_S, options.trains),
        disturbances=found["disturbances"],
        sensitivity=found["sensitivity"],
        regulated=None if loops is None else regulated_day(loops, frontier),
    )


def regulated_day(loops: ClosedLoops, frontier: Frontier) -> RegulatedDay:
    """What is found where positions work in their closed loop."""
    return RegulatedDay(
        gains=table_gains(frontier, loops),
        beside=tuple(pair.found(frontier.outcomes) for pair in loops.pairs()),
        couplings=loops.found_couplings(frontier.outcomes),
        exits=exits_of({name: made.on(loops.base) for name, made in loops.made.items()}, TRAINS),
    )


METHOD = Method(
    Options,
    Options(trains=2, no_tables=True, cuts=6, stds_m_s=(0.35,), least_s=(0.5, -0.5), design_cuts=200),
    HumpDay,
    run,
)
