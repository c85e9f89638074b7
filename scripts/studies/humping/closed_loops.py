"""What is run where positions work in their closed loop, and which curves are compared: what control, exactness
and regulators bring.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from scripts.studies.humping.base_trial import Day, with_free, with_interval_std, with_stds
from scripts.studies.humping.day_figures import Pair, PairFigures
from scripts.studies.humping.frontier import (
    CONTROLS,
    OPEN_LOOP,
    WITH_FEEDBACK,
    WITH_MEASURED,
    WITH_SLOWING,
    Families,
    Family,
    Frontier,
    Gain,
    Line,
    sigma,
)
from scripts.studies.humping.pairs import FREE, OILED, WEAKER
from scripts.studies.humping.table_positions import (
    FRICTION,
    HIGHEST_M_S,
    SUPPLY,
    Book,
    Regulator,
    TablePositions,
    table_positions,
)
from scripts.studies.study import Tell
from synth.hump.rolling.outcomes import TrainOutcomes
from synth.hump.trial.trial import HumpTrial

ENERGY_RULE, TABLES, TABLES_ESTIMATED = "energy rule", "our tables", "our tables, estimator"

REGULATORS: dict[str, Regulator] = {
    ENERGY_RULE: Book.energy_rule,
    TABLES: Book.tables,
    TABLES_ESTIMATED: Book.estimating_tables,
}

REGULATED = (OPEN_LOOP, WITH_FEEDBACK, WITH_SLOWING)
"""Their controls."""

TABLES_STD_M_S = 0.05
"""Error that the exit speeds of the last position are chosen with where positions work in their closed loop."""


@dataclass(frozen=True)
class RegulatedCouplings:
    """Couplings and gaps of regulated positions, with tracks free between both shares of `free`."""

    positions: str
    free: tuple[float, float]
    found: PairFigures


@dataclass(frozen=True)
class ClosedLoops:
    """`base`: their trial, still with normal positions; the positions of every regulator by its name; errors of the
    normal positions beside them."""

    base: HumpTrial
    made: dict[str, TablePositions]
    stds_m_s: tuple[float, ...]

    @property
    def best(self) -> str:
        """The most exact normal positions."""
        return sigma(min(self.stds_m_s))

    @property
    def commanded(self) -> str:
        """These, commanded as tables are: at most `HIGHEST_M_S`, and the last position for `TABLES_STD_M_S`."""
        return f"{self.best}, commanded as tables are"

    def families(self) -> Families:
        """The curves of the regulators, and of the most exact normal positions commanded as these are."""
        found = {name: Family(made.on(self.base), REGULATED) for name, made in self.made.items()}
        found[self.commanded] = Family(with_interval_std(self.base, min(self.stds_m_s)), (WITH_FEEDBACK,))
        return found

    def pairs(self) -> list[Pair]:
        """A pair for each regulator beside normal positions, and for tables on plants they were not tuned for."""
        base, tables = self.base, self.made[TABLES]
        told = f"commands for {sigma(TABLES_STD_M_S)}"
        rows = [Pair(f"normal, {sigma(std)}, {told}", with_stds(base, (std,) * 3)) for std in self.stds_m_s]
        rows += [Pair(name, made.on(base)) for name, made in self.made.items()]
        oiled, weak = tables.changed({FRICTION: OILED}), tables.changed({SUPPLY: WEAKER})
        rows.append(Pair(f"{TABLES}, friction −30 %", oiled.on(base)))
        return [*rows, Pair(f"{TABLES}, stages at {WEAKER:g} of their pressure", weak.on(base))]

    def couplings(self) -> dict[tuple[str, tuple[float, float]], Pair]:
        """A pair for each regulator and length of the free tracks, but the one that `pairs` have."""
        return {
            (name, free): Pair(f"{name}, free {free[0]:g}–{free[1]:g}", with_free(made.on(self.base), free))
            for name, made in self.made.items()
            for free in FREE[:-1]
        }

    def found_couplings(self, outcomes: dict[str, TrainOutcomes]) -> tuple[RegulatedCouplings, ...]:
        """What they came to, those of `pairs` with them."""
        usual = {(pair.name, FREE[-1]): pair for pair in self.pairs() if pair.name in self.made}
        return tuple(
            RegulatedCouplings(name, free, pair.found(outcomes))
            for (name, free), pair in (*self.couplings().items(), *usual.items())
        )


def closed_loops(day: Day, stds_m_s: tuple[float, ...], tell: Tell) -> ClosedLoops:
    """All of them; books are tuned here, which takes minutes."""
    limits = f"highest_m_s = {HIGHEST_M_S}"
    base, made = replace(day, std_m_s=TABLES_STD_M_S, positions=(limits, limits, "")).trial(), {}
    for name, regulator in REGULATORS.items():
        made[name] = table_positions(base, regulator)
        tell(f"books tuned: {name}")
    return ClosedLoops(base, made, stds_m_s)


Compared = tuple[Line, Line]
"""A curve and the one that it is compared with."""


def normal_gains(frontier: Frontier, stds_m_s: tuple[float, ...]) -> tuple[Gain, ...]:
    """What feedback, measured resistance and exactness bring, at every limit."""
    best, worst = min(stds_m_s), max(stds_m_s)
    named = [sigma(std) for std in stds_m_s]
    pairs = [((name, WITH_FEEDBACK), (name, OPEN_LOOP)) for name in named]
    pairs += [((name, WITH_MEASURED), (name, WITH_FEEDBACK)) for name in named]
    pairs += [((name, WITH_SLOWING), (name, WITH_FEEDBACK)) for name in named]
    pairs += [((sigma(best), control), (sigma(worst), control)) for control in CONTROLS if best < worst]
    return gains(frontier, pairs)


def table_gains(frontier: Frontier, loops: ClosedLoops) -> tuple[Gain, ...]:
    """What our tables bring beside normal positions and other regulators, and what feedback brings with them; what
    their commands cost exact positions."""
    others = [*map(sigma, sorted(loops.stds_m_s, reverse=True)), *(name for name in REGULATORS if name != TABLES)]
    pairs = [((TABLES, control), (other, control)) for control in REGULATED for other in others]
    pairs += [((TABLES, WITH_FEEDBACK), (loops.commanded, WITH_FEEDBACK))]
    pairs += [((loops.commanded, WITH_FEEDBACK), (loops.best, WITH_FEEDBACK))]
    pairs += [((TABLES, WITH_FEEDBACK), (TABLES, OPEN_LOOP)), ((TABLES, WITH_SLOWING), (TABLES, WITH_FEEDBACK))]
    return gains(frontier, pairs)


def gains(frontier: Frontier, pairs: list[Compared]) -> tuple[Gain, ...]:
    """Of all pairs at every limit."""
    return tuple(frontier.gain(more, than, limit) for limit in frontier.limits for more, than in pairs)
