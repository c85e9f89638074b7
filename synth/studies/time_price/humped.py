"""Cars an hour at a share of catch-ups, with tables for which a second has a price and with those without."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

from synth.studies.humping.base_trial import Day, with_interval_std
from synth.studies.humping.books import HIGHEST_M_S, Book
from synth.studies.humping.closed_loops import TABLES, TABLES_STD_M_S
from synth.studies.humping.exits import TRAINS, Exits, exits_of
from synth.studies.humping.frontier import (
    WITH_FEEDBACK,
    Curve,
    Family,
    Frontier,
    Gain,
    frontier_groups,
    lines_of,
    sigma,
)
from synth.studies.humping.runs import measured
from synth.studies.humping.table_positions import table_positions
from synth.studies.study import Tell
from synth.yard.humping.hump_position import Arrivals, HumpPosition, Passed
from synth.yard.humping.trial import HumpTrial

PRICED = "our tables, a second priced"
EVENLY = "foretold as even braking"
"""What the plan and the control take passes for; by default of tables that they brake early and hold the speed then."""

EXACT_STD_M_S = 0.03
"""Of the normal positions beside them, which brake evenly."""


def evenly(name: str) -> str:
    """The same positions, otherwise foretold."""
    return f"{name}, {EVENLY}"


PAIRS = (
    (PRICED, TABLES),
    (evenly(PRICED), evenly(TABLES)),
    (evenly(TABLES), TABLES),
    (evenly(PRICED), TABLES),
    (TABLES, sigma(EXACT_STD_M_S)),
    (evenly(PRICED), sigma(EXACT_STD_M_S)),
)
"""What is compared with what."""


@dataclass(frozen=True)
class EvenlyForetold:
    """`position`, of which plan and control think that it brakes evenly."""

    position: HumpPosition

    brakes_early = False

    def passed(self, arrivals: Arrivals) -> Passed:
        """See `HumpPosition`."""
        return self.position.passed(arrivals)


@dataclass(frozen=True)
class Humped:
    """`trains` of `cuts` cuts, with feedback; `gains`: of the priced tables over those without, and over exact
    positions; `exits`: what the positions make of their commands."""

    trains: int
    cuts: int
    price_m2_s3: float
    curves: tuple[Curve, ...]
    gains: tuple[Gain, ...]
    exits: tuple[Exits, ...]


def evenly_foretold(trial: HumpTrial) -> HumpTrial:
    """The trial whose plan and control think so of all positions."""
    return replace(trial, positions=tuple(map(EvenlyForetold, trial.positions)))


def humped(
    seed: int, trains: int, cuts: int, price_m2_s3: float, least_s: tuple[float, ...], limits: tuple[float, ...],
    workers: int, tell: Tell,
) -> Humped:  # fmt: skip
    """Books are tuned here, which takes minutes."""
    more = f"[exit_speeds]\nhighest_m_s = [{HIGHEST_M_S}, {HIGHEST_M_S}]\n"
    base = Day(seed, cuts, TABLES_STD_M_S, more=more).trial()
    made = {}
    for name, price in ((TABLES, 0.0), (PRICED, price_m2_s3)):
        made[name] = table_positions(base, partial(Book.priced_tables, time_price_m2_s3=price)).on(base)
        tell(f"books tuned: {name}")
    early = {name: Family(trial, (WITH_FEEDBACK,)) for name, trial in made.items()}
    even = {evenly(name): Family(evenly_foretold(trial), (WITH_FEEDBACK,)) for name, trial in made.items()}
    even[sigma(EXACT_STD_M_S)] = Family(with_interval_std(base, EXACT_STD_M_S), (WITH_FEEDBACK,))
    groups = [group for part in (early, even) for group in frontier_groups(part, least_s)]
    found = Frontier(measured(groups, trains, workers, tell), lines_of(early, even), least_s, limits, (), seed)
    gains = tuple(
        found.gain((one, WITH_FEEDBACK), (other, WITH_FEEDBACK), limit) for limit in limits for one, other in PAIRS
    )
    exits = exits_of(made, min(trains, TRAINS))
    return Humped(trains, cuts, price_m2_s3, found.curves(), gains, exits)
