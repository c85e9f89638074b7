"""What the study `rare-events` has found: probabilities four ways, and why an rms has a heavy tail."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import dataclass

from synth.simulation.replicates import Interval
from synth.studies.markdown_table import MarkdownTable, around, table
from synth.studies.rare_events.tail_probability import TailProbability
from synth.studies.study import Findings

PLAIN, IMPORTANCE, SUBSET, DENSITY = (
    "plain simulation", "importance sampling", "subset simulation", "forward density",
)  # fmt: skip

CONTRADICTION = 1.7
"""`TailProbability.gap` beyond which two methods do not mean the same: about 3.3 standard errors."""


@dataclass(frozen=True)
class MethodTails:
    """One way: (probability, low, high) at every margin of the curve, what it cost, and seconds with two threads."""

    method: str
    passes: int
    seconds: float
    tails: tuple[tuple[float, float, float], ...]


@dataclass(frozen=True)
class HeavyTail:
    """What cuts that are over by more than a little make of the mean square, by importance sampling.

    `mean_friction_factor`: mean ξ_cut of those cuts; `relative_ci95`: half the 95 % interval of an rms from as many
    plain passes as a validation has, over the rms.
    """

    probability: float
    share_of_mean_square: float
    rms_over_m_s: float
    rms_of_the_rest_m_s: float
    kurtosis: float
    relative_ci95: float
    mean_friction_factor: float


@dataclass(frozen=True)
class CaseRow:
    """One table by all methods; `mean_weight`: of the weighted passes, with its standard error, 1 in truth."""

    case: str
    learning_passes: int
    mean_weight: tuple[float, float]
    methods: tuple[MethodTails, ...]
    plain_rms_m_s: float
    plain_rms_ci95_m_s: Interval
    weighted_rms_m_s: float
    weighted_rms_ci95_m_s: Interval
    weighted_gain: float
    heavy_tail: HeavyTail


@dataclass(frozen=True)
class RareEvents(Findings):
    """All cases. `curve_m_s`: margins of the curves, `margins_m_s`: those of the tables, among them."""

    config_sha256: str
    seeds: dict[str, int]
    curve_m_s: tuple[float, ...]
    margins_m_s: tuple[float, ...]
    heavy_m_s: float
    short_passes: int
    cases: tuple[CaseRow, ...]

    def tail(self, method: MethodTails, margin_m_s: float) -> TailProbability:
        """The probability of one method at one margin."""
        p, low, high = method.tails[self.curve_m_s.index(margin_m_s)]
        return TailProbability(margin_m_s, p, low, high, method.method, method.passes)

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`tails`: a row a case and margin; `cost`, `rms`: a row a case."""
        names = tuple(each.method for each in self.cases[0].methods)
        tails = [
            (case.case, f"{margin:g}", *(shown(self.tail(each, margin)) for each in case.methods))
            for case in self.cases for margin in self.margins_m_s
        ]  # fmt: skip
        cost = [
            (c.case, f"{c.learning_passes}", *(f"{m.passes}, {m.seconds:.0f}" for m in c.methods)) for c in self.cases
        ]
        heads = (
            "case", "plain rms", "importance rms", "gain at equal passes", "kurtosis",
            f"± of the rms with {self.short_passes} plain passes", f"P(over {self.heavy_m_s:g} m/s)",
            "their share of the mean square", "rms of all others", "their mean ξ_cut",
        )  # fmt: skip
        return {
            "tails": table("P(exit speed > target + margin), [95 %]; of the density ± bound",
                           ("case", "over by more than, m/s", *names), tails),
            "cost": table("passes (of the density: hidden scenarios), seconds with two threads",
                          ("case", "passes to learn", *names), cost),
            "rms": table("why the rms has a heavy tail, m/s", heads, map(rms_cells, self.cases)),
        }  # fmt: skip

    def sentences(self) -> tuple[str, ...]:
        """The seeds."""
        return ("seeds: " + ", ".join(f"{name} {seed}" for name, seed in self.seeds.items()),)

    def faults(self) -> tuple[str, ...]:
        """Pairs of methods that differ at a margin by more than chance allows."""
        found = []
        for case, margin in itertools.product(self.cases, self.margins_m_s):
            for one, other in itertools.combinations(case.methods, 2):
                gap = self.tail(one, margin).gap(self.tail(other, margin))
                if gap > CONTRADICTION:
                    found.append(
                        f"{case.case}, over {margin:g} m/s: {one.method} and {other.method} differ, gap {gap:.2f}"
                    )
        return tuple(found)


def shown(tail: TailProbability) -> str:
    """Probability with its limits; nothing seen shows the upper limit only."""
    if tail.method == DENSITY:
        return f"{tail.probability:.3e} ± {tail.high - tail.probability:.0e}"
    if tail.probability == 0.0:
        return f"< {tail.high:.1e}"
    return f"{tail.probability:.2e} [{tail.low:.2e}, {tail.high:.2e}]"


def rms_cells(case: CaseRow) -> tuple[str, ...]:
    """The cells of one case."""
    tail = case.heavy_tail
    weighted = around(case.weighted_rms_m_s, case.weighted_rms_ci95_m_s, 5)
    return (
        case.case, around(case.plain_rms_m_s, case.plain_rms_ci95_m_s),
        weighted, f"{case.weighted_gain:.0f}", f"{tail.kurtosis:.0f}",
        f"{100.0 * tail.relative_ci95:.0f} %", f"{tail.probability:.1e}", f"{100.0 * tail.share_of_mean_square:.0f} %",
        f"{tail.rms_of_the_rest_m_s:.4f}", f"{tail.mean_friction_factor:.2f}",
    )  # fmt: skip
