"""Measured passes run again, under the tables that drove them and under others."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from plant_models.frozen_arrays import Bools, Floats, frozen_arrays
from synth.logs.fitting_passes import FittingPasses
from synth.logs.likelihood import likelihood_of
from synth.logs.replay.known_cuts import known_cuts
from synth.logs.replay.logged_tables import NO_TABLE, LoggedTables, logged_tables
from synth.logs.replay.measured_exits import MeasuredExits, measured_exits
from synth.logs.replay.predicted_exits import (
    Bootstrapped,
    PredictedExits,
    Replayer,
    bootstrapped,
    predicted_exits,
)
from synth.logs.replay.rule_agreement import RuleAgreement, rule_agreement
from synth.logs.unknowns import slope_of, unknowns_of, values_at
from synth.retarder.configuration.resolved_config import ResolvedConfig
from tuning_tables import ControllerTable

STOPPED = "a person took part in it"
NO_EXIT = "the log ends before the exit"


@dataclass(frozen=True)
class Difference:
    """Other table less own table over n passes: rms of exit − target, and share of exits over target + 0.3 m/s.

    `effective`: so many passes would carry the difference of the mean squares if all differed alike, (Σ|d|)² / Σd².
    """

    passes: int
    own_rms_m_s: float
    other_rms_m_s: float
    rms_m_s: Bootstrapped
    own_overspeed: float
    other_overspeed: float
    overspeed: Bootstrapped
    effective: float


@dataclass(frozen=True)
class Uniformity:
    """Kolmogorov–Smirnov test of `n` ranks of measured exits among predicted ones: p value, and the distance."""

    n: int
    distance: float
    p_value: float


@frozen_arrays
class Replay:
    """What another book would have done in `passes`.

    `own`, `other`: exits predicted under the tables that drove the log and under the others, each on the cuts as the
    log knows them; `measured`; `rank` (m,) of each measured exit among those of any cut of its class that enters as
    fast, under its own table: uniform where configuration and log agree; NaN where there is none. `fresh_m_s`
    (m, draws): those exits. `left_out`: (cut_id, why) of passes that are not compared.
    """

    passes: FittingPasses
    agreement: RuleAgreement
    own_agreement: RuleAgreement
    own: PredictedExits
    other: PredictedExits
    measured: MeasuredExits
    fresh_m_s: Floats
    rank: Floats
    compared: Bools
    left_out: tuple[tuple[str, str], ...]
    difference: Difference
    uniformity: Uniformity


@dataclass(frozen=True)
class ReplayOrder:
    """What drove the log, what is tried instead, how many draws of each pass, and the seed of them."""

    own: Sequence[ControllerTable]
    other: Sequence[ControllerTable]
    draws: int = 64
    seed: int = 1


def replay(passes: FittingPasses, config: ResolvedConfig, order: ReplayOrder) -> Replay:
    """Run `passes` again with the numbers of `config`. `InputError` where no pass can be compared."""
    unknowns = unknowns_of(passes, config.parameters)
    values = values_at(unknowns, np.zeros(len(unknowns)))
    like = likelihood_of(passes, slope_of(unknowns))
    found = like.at(values)
    own, other = (logged_tables(passes, tables) for tables in (order.own, order.other))
    replayer = Replayer(passes, known_cuts(like, found, values), order.draws, order.seed)
    measured = measured_exits(like, found, values)
    target = passes.log.target_m_s
    own_exits, other_exits = (
        predicted_exits(replayer.exits(of.tables, of.of_pass, False), target) for of in (own, other)
    )
    by_hand = np.asarray(passes.log.stopped_by_hand)
    compared = (own.of_pass != NO_TABLE) & (other.of_pass != NO_TABLE) & ~by_hand
    fresh = replayer.exits(own.tables, np.where(by_hand, NO_TABLE, own.of_pass), True)
    rank = ranks(fresh, measured, order.seed)
    return Replay(
        passes, rule_agreement(passes, other), rule_agreement(passes, own), own_exits, other_exits, measured,
        fresh, rank, compared,
        left_out(passes, own, other, measured),
        difference(own_exits, other_exits, compared, order.seed), uniformity(rank),
    )  # fmt: skip


def ranks(fresh: Floats, measured: MeasuredExits, seed: int) -> Floats:
    """Rank of each exit among `fresh` (m, draws), from 0 to 1, (m,).

    The exit is drawn from what the filter knows of it: its mean alone would spread less than exits do.
    """
    rng = np.random.default_rng((seed, 1))
    exit_m_s = (measured.speed_m_s + measured.std_m_s * rng.standard_normal(len(fresh)))[:, None]
    below, equal = (fresh < exit_m_s).sum(axis=1), (fresh == exit_m_s).sum(axis=1)
    found = (below + rng.random(len(fresh)) * (equal + 1)) / (fresh.shape[1] + 1)
    return np.where(np.isnan(measured.speed_m_s) | np.isnan(fresh[:, 0]), np.nan, found)


def left_out(
    passes: FittingPasses, own: LoggedTables, other: LoggedTables, measured: MeasuredExits
) -> tuple[tuple[str, str], ...]:
    """(cut_id, why) of every pass that something is wanting of; the first reason that applies."""
    found = []
    for number, cut_id in enumerate(passes.log.cut_id):
        reasons = (
            STOPPED if passes.log.stopped_by_hand[number] else "",
            own.reason[number] and f"own book: {own.reason[number]}",
            other.reason[number] and f"other book: {other.reason[number]}",
            NO_EXIT if np.isnan(measured.speed_m_s[number]) else "",
        )
        why = next((reason for reason in reasons if reason), "")
        if why:
            found.append((cut_id, why))
    return tuple(found)


def difference(own: PredictedExits, other: PredictedExits, compared: Bools, seed: int) -> Difference:
    """Over the passes `compared`; all NaN where there is none."""
    a, b = own.square_m2_s2[compared], other.square_m2_s2[compared]
    over_a, over_b = own.overspeed[compared], other.overspeed[compared]
    n = len(a)
    if n == 0:
        nothing = Bootstrapped(float("nan"), (float("nan"), float("nan")))
        return Difference(0, np.nan, np.nan, nothing, np.nan, np.nan, nothing, 0.0)
    apart = np.abs(b - a)
    return Difference(
        n,
        float(np.sqrt(a.mean())),
        float(np.sqrt(b.mean())),
        bootstrapped(lambda w: np.sqrt(w @ b) - np.sqrt(w @ a), n, seed),
        float(over_a.mean()),
        float(over_b.mean()),
        bootstrapped(lambda w: np.asarray(w @ (over_b - over_a)), n, seed),
        float(apart.sum() ** 2 / max(float(apart @ apart), 1e-300)),
    )


def uniformity(rank: Floats) -> Uniformity:
    """Of the ranks that there are."""
    from scipy.stats import kstest  # start-up: scipy only where it is needed

    known = rank[~np.isnan(rank)]
    if len(known) == 0:
        return Uniformity(0, float("nan"), float("nan"))
    found = kstest(known, "uniform")
    return Uniformity(len(known), float(found.statistic), float(found.pvalue))
