"""Cars an hour at a share of catch-ups, with tables for which a second has a price and with those without."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

from scripts.studies.humping.base_trial import Day, with_interval_std
from scripts.studies.humping.books import HIGHEST_M_S, Book
from scripts.studies.humping.closed_loops import TABLES, TABLES_STD_M_S
from scripts.studies.humping.exits import TRAINS, Exits, exits_of
from scripts.studies.humping.frontier import (
    WITH_FEEDBACK,
    Curve,
    Family,
    Frontier,
    Gain,
    frontier_groups,
    lines_of,
    sigma,
)
from scripts.studies.humping.runs import measured
from scripts.studies.humping.table_positions import table_positions
from scripts.studies.study import Tell

PRICED = "our tables, a second priced"

EXACT_STD_M_S = 0.03
EXACT = sigma(EXACT_STD_M_S)
"""Normal positions beside them, commanded as they are."""

PAIRS = ((PRICED, TABLES), (TABLES, EXACT), (PRICED, EXACT))
"""What is compared with what."""


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


def humped(
    seed: int, trains: int, cuts: int, price_m2_s3: float, least_s: tuple[float, ...], limits: tuple[float, ...],
    workers: int, tell: Tell,
) -> Humped:  # fmt: skip
    """Books are tuned here, which takes minutes."""
    wider = f"highest_m_s = {HIGHEST_M_S}"
    base = Day(seed, cuts, TABLES_STD_M_S, positions=(wider, wider, "")).trial()
    made = {}
    for name, price in ((TABLES, 0.0), (PRICED, price_m2_s3)):
        made[name] = table_positions(base, partial(Book.priced_tables, time_price_m2_s3=price)).on(base)
        tell(f"books tuned: {name}")
    exits = exits_of(made, min(trains, TRAINS))
    made[EXACT] = with_interval_std(base, EXACT_STD_M_S)
    families = {name: Family(trial, (WITH_FEEDBACK,)) for name, trial in made.items()}
    outcomes = measured(frontier_groups(families, least_s), trains, workers, tell)
    found = Frontier(outcomes, lines_of(families), least_s, limits, (), seed)
    gains = tuple(
        found.gain((one, WITH_FEEDBACK), (other, WITH_FEEDBACK), limit) for limit in limits for one, other in PAIRS
    )
    return Humped(trains, cuts, price_m2_s3, found.curves(), gains, exits)
