"""The chain from the park position to the standing cars: which accuracy and which knowledge leave which gaps.

Positions: ideal, with normal errors, and in the closed loop under the tuned energy rule and under our tables. Exit
speeds are chosen for a share of over-speeds on some cuts and judged on others; all variants have the same cuts.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from scripts.studies.aiming.cuts import large_hump
from scripts.studies.aiming.trial import Draws, Outcome, Value, outcomes
from scripts.studies.study import ABSENT, Findings, MarkdownTable, Method, Tell, option, plus_minus, table
from scripts.studies.yard_chain.chain import (
    BUNCH_SPEED_M_S,
    CATEGORY,
    ESTIMATED,
    HEAVY,
    LIGHT,
    MEASURED,
    RADAR,
    BookSize,
    Kind,
    Practice,
    Samples,
    Saved,
    brake_saturated,
    chain_samples,
    knowledge_of,
    positions_of,
    practices,
    saved,
)
from scripts.studies.yard_chain.details import (
    Approach,
    Detail,
    StretchRow,
    approach_row,
    fault_rows,
    record_rows,
    stretch_rows,
)
from synth.aim.knowledge import Knowledge
from synth.aim.position_models import PositionModel


@dataclass(frozen=True)
class Chain:
    """One kind of cuts: `outcomes` by knowledge, position and free distance."""

    cuts: str
    knowledge: tuple[str, ...]
    positions: tuple[str, ...]
    outcomes: tuple[tuple[tuple[Outcome | None, ...], ...], ...]


@dataclass(frozen=True)
class YardChain(Findings):
    """All parts; `brake_saturated`: share of heavy cars too fast for the park position, by the speed out of the bunch
    position in m/s."""

    draws: Draws
    p_overspeed: float
    metres: tuple[float, ...]
    chains: tuple[Chain, ...]
    practices: tuple[Practice, ...]
    saved: tuple[Saved, ...]
    detail_m: float
    records: tuple[Detail, ...]
    stds_m_s: tuple[float, ...]
    stretches: tuple[StretchRow, ...]
    faulty: tuple[Detail, ...]
    approach: Approach
    brake_saturated: dict[str, float]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """See the titles; `chain-CUTS-METRES`: a row a kind of knowledge, a column a position."""
        gap = f"mean gap a car at a share {self.p_overspeed:g} of over-speeds, m ± half its 95 % interval"
        found = {
            f"{chain.cuts.replace(', ', '-').replace(' ', '-')}-{metres:g}": chain_table(
                chain, place, f"{chain.cuts}, {metres:g} m of free roll: {gap}"
            )
            for chain in self.chains
            for place, metres in enumerate(self.metres)
        }
        found["practices"] = table(
            "single cars, light and heavy, all free distances: gap a car, m; couplings in a thousand cars above 1.39, "
            "1.5, 2 m/s; each ± half its 95 % interval",
            ("practice", "gap a car, m", "> 1.39 m/s", "> 1.5 m/s", "> 2 m/s"),
            ((p.name, cell(p.gap_m), *map(cell, p.couplings)) for p in self.practices),
        )
        found["saved"] = table(
            "metres of gap a car less than today's practice, paired, ± half the 95 % interval",
            ("cuts", "free roll, m", "our tables alone", "measuring alone", "both"),
            (
                (s.cuts, f"{s.metres:g}", signed(s.exit_alone_m), signed(s.measuring_alone_m), signed(s.both_m))
                for s in self.saved
            ),
        )
        at = f"light single cars, {self.detail_m:g} m of free roll: {gap}"
        found["records"] = table(at, ("recorded cuts", "gap"), ((d.name, outcome(d.outcome)) for d in self.records))
        found["stretch"] = table(
            at,
            ("stretch", *(f"σ_v {std:g}" for std in self.stds_m_s)),
            ((f"{r.length_m:g} m{', straight' * r.straight}", *map(outcome, r.outcomes)) for r in self.stretches),
        )
        found["faults"] = table(
            at, ("what goes wrong", "gap", "over-speeds, %", "above 2 m/s, %"), map(fault_cells, self.faulty)
        )
        return found

    def sentences(self) -> tuple[str, ...]:
        """How much was simulated, and what needs no table."""
        d, a = self.draws, self.approach
        brake = "; ".join(f"{100 * share:.2f} % from {speed} m/s" for speed, share in self.brake_saturated.items())
        return (
            f"{d.replicates} times {d.design} cuts to choose commands on and {d.report} others to judge them on, seed "
            f"{d.seed}; the same cuts for every position and kind of knowledge",
            f"the free roll before the position tells the resistance within {a.reading_std_n_per_kn:.2f} N/kN; what it "
            f"tells spreads by {a.spread_n_per_kn:.2f}: gap {outcome(a.told)} m instead of {outcome(a.category)} m",
            f"heavy cars that leave the park position 0.3 m/s or more above {LOWEST_TARGET_M_S:g} m/s: {brake}",
        )

    def faults(self) -> tuple[str, ...]:
        """Claims that do not hold: the chain must leave less gap than today, and than either step alone."""
        return tuple(
            f"{s.cuts}, {s.metres:g} m: both steps save {signed(s.both_m)} m, one alone more"
            for s in self.saved
            if s.both_m
            and any(alone and s.both_m.ci95[1] < alone.value for alone in (s.exit_alone_m, s.measuring_alone_m))
        )


LOWEST_TARGET_M_S = 1.0


def chain_table(chain: Chain, place: int, title: str) -> MarkdownTable:
    """A row a kind of knowledge, a column a position."""
    rows = (
        (name, *(outcome(of[place]) for of in row)) for name, row in zip(chain.knowledge, chain.outcomes, strict=True)
    )
    return table(title, ("known", *chain.positions), rows)


def fault_cells(detail: Detail) -> tuple[str, ...]:
    """The cells of one fault."""
    found = detail.outcome
    if found is None:
        return (detail.name, "none", ABSENT, ABSENT)
    return (detail.name, cell(found.gap_m), cell(found.overspeed, 100.0), cell(found.above_2, 100.0))


def outcome(found: Outcome | None) -> str:
    """Its gap, or that no command keeps the share."""
    return "none" if found is None else cell(found.gap_m)


def cell(value: Value | None, scale: float = 1.0) -> str:
    """With digits by its size."""
    if value is None:
        return "none"
    size = scale * value.value
    return plus_minus(value.value, value.ci95, 0 if size >= 99.5 else 1 if size >= 9.95 else 2, scale)


def signed(value: Value | None) -> str:
    """'12.3 ± 0.4'."""
    return ABSENT if value is None else plus_minus(value.value, value.ci95, 1)


@dataclass(frozen=True)
class Options:
    """What is studied."""

    p_overspeed: float = option(0.1, "share of over-speeds that commands keep", (0.01, 0.5))
    careful_share: float = option(0.05, "share of the last practice", (0.001, 0.5))
    metres: tuple[float, ...] = option((100.0, 200.0, 300.0), "free distances behind the position", (20.0, 500.0))
    cars: tuple[int, ...] = option((1, 3), "cars of a cut; 1 must be among them", (1, 20))
    records: int = option(300, "recorded cuts of the three control points", (10, 100_000))
    records_compared: tuple[int, ...] = option((30, 100, 300, 1000, 3000), "recorded cuts compared", (10, 10**5))
    lengths_m: tuple[float, ...] = option((25.0, 50.0, 110.0), "lengths of the stretch compared", (5.0, 130.0))
    stds_m_s: tuple[float, ...] = option((0.01, 0.03, 0.1), "errors of the speeds compared", (1e-3, 1.0))
    classes: int = option(2, "classes of cuts by mass in a book of the position", (1, 2))
    tables: int = option(6, "tables of a class, of as many exit speeds", (2, 6))
    detail_m: float = option(200.0, "free distance of these comparisons", (20.0, 500.0))
    replicates: int = option(5, "independent replicates", (2, 1000))
    design: int = option(3000, "cuts of a replicate that commands are chosen on", (200, 10**6))
    report: int = option(3000, "cuts of a replicate that commands are judged on", (200, 10**6))
    seed: int = option(15, "of all draws", (0, 10**9))
    coarse: bool = option(False, "tables on a coarse grid, to see that it runs")


def run(options: Options, tell: Tell) -> YardChain:
    """All parts."""
    hump = large_hump()
    draws = Draws(options.replicates, options.design, options.report, options.seed)
    books = BookSize(options.classes, options.tables, options.coarse)
    found: dict[Kind, Samples] = {}
    careful: dict[Kind, Samples] = {}
    detailed: PositionModel | None = None
    for category in ("L", "T"):
        for cars in options.cars:
            kind = Kind(category, cars)
            positions = positions_of(kind.cuts(hump), books)
            tell(f"{kind.name}: tables tuned")
            found[kind] = samples_of(kind, positions, knowledge_of(options.records), options, draws)
            if cars == 1:
                straight = Kind(category, 1, True)
                ways = {name: knowledge_of(options.records)[name] for name in (CATEGORY, MEASURED, RADAR)}
                found[straight] = samples_of(straight, positions, ways, options, draws)
                few = {ESTIMATED: positions[ESTIMATED]}
                careful[straight] = samples_of(straight, few, {MEASURED: ways[MEASURED]}, options, draws, True)
            if kind == LIGHT:
                detailed = positions[ESTIMATED]
            tell(f"{kind.name}: aimed")
    assert detailed is not None, "light single cars are always among the cuts"
    light, p, at = LIGHT.cuts(hump), options.p_overspeed, options.detail_m
    many = replace(draws, design=max(draws.design, 2 * max(options.records_compared)))
    records = tuple(record_rows(light, detailed, options.records_compared, at, p, many))
    stretches = tuple(stretch_rows(hump, options.lengths_m, options.stds_m_s, at, p, draws))
    faulty = tuple(fault_rows(light, detailed, options.records, at, p, draws))
    tell("records, stretches, faults")
    return YardChain(
        draws=draws,
        p_overspeed=p,
        metres=options.metres,
        chains=tuple(chain_of(kind, samples) for kind, samples in found.items()),
        practices=practices(found, careful, options.careful_share),
        saved=tuple(row for kind in (LIGHT, HEAVY) for row in saved(kind, found[kind], options.metres)),
        detail_m=at,
        records=records,
        stds_m_s=options.stds_m_s,
        stretches=stretches,
        faulty=faulty,
        approach=approach_row(light, detailed, at, p, draws),
        brake_saturated={
            f"{speed:g}": brake_saturated(hump, speed, books, options.report, options.seed)
            for speed in (BUNCH_SPEED_M_S["L"], BUNCH_SPEED_M_S["T"])
        },
    )


def samples_of(
    kind: Kind,
    positions: Mapping[str, PositionModel],
    knowledge: Mapping[str, Knowledge],
    options: Options,
    draws: Draws,
    careful: bool = False,
) -> Samples:
    """The figures of one kind of cuts."""
    share = options.careful_share if careful else options.p_overspeed
    figures = chain_samples(kind.cuts(large_hump()), options.metres, positions, knowledge, share, draws)
    return Samples(tuple(knowledge), tuple(positions), figures)


def chain_of(kind: Kind, samples: Samples) -> Chain:
    """The outcomes of one kind of cuts."""
    found = tuple(
        tuple(outcomes(np.asarray(samples.figures[:, i, j])) for j in range(len(samples.positions)))
        for i in range(len(samples.knowledge))
    )
    return Chain(kind.name, samples.knowledge, samples.positions, found)


METHOD = Method(
    Options,
    Options(metres=(100.0,), cars=(1,), records=50, records_compared=(30,), lengths_m=(50.0,), stds_m_s=(0.03,),
            classes=1, tables=2, detail_m=100.0, replicates=2, design=400, report=300, coarse=True),
    YardChain,
    run,
)  # fmt: skip
