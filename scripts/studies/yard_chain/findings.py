"""What the study `yard-chain` has found, and its tables."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from scripts.studies.aiming.trial import Draws, Outcome, Value
from scripts.studies.markdown_table import ABSENT, MarkdownTable, plus_minus, table
from scripts.studies.study import Findings
from scripts.studies.yard_chain.details import Approach, Detail, StretchRow
from scripts.studies.yard_chain.practices import Practice, Saved


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
