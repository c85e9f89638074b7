"""Measured passes run again, under the tables that drove them and under others, and with which speed they left, by
the filter of the likelihood.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from plant_models.frozen_arrays import Bools, Floats, Ints, frozen_arrays
from plant_models.speed_sensor import measured_speed_std
from synth.kernels.measured.pass_filter import SLOWEST_M_S
from synth.logs import unknowns as asked
from synth.logs.fitting_passes import FittingPasses
from synth.logs.likelihood import Innovations, Likelihood, likelihood_of, on, scales, way_of
from synth.logs.replay.predicted_exits import (
    Bootstrapped,
    PredictedExits,
    Replayer,
    bootstrapped,
    known_cuts,
    predicted_exits,
)
from synth.logs.replay.rule_agreement import NO_TABLE, LoggedTables, RuleAgreement, logged_tables, rule_agreement
from synth.logs.unknowns import slope_of, unknowns_of, values_at
from synth.retarder.configuration.resolved_config import ResolvedConfig
from tuning_tables import ControllerTable

LONGEST_GAP_S = 0.6
"""A pass whose last reading is longer before the exit has no measured exit."""


@frozen_arrays
class MeasuredExits:
    """(m,) of the passes: exit speed and its standard error, NaN if the log ends too early; 0 if the cut stood."""

    speed_m_s: Floats
    std_m_s: Floats


def measured_exits(like: Likelihood, found: Innovations, values: Mapping[str, float]) -> MeasuredExits:
    """The filtered speed at the last reading before the exit, taken on to the exit by the law of motion.

    `found`: the innovations of `like` at `values`.
    """
    passes, log = like.passes, like.passes.log
    speed, std = np.full(len(log), np.nan), np.full(len(log), np.nan)
    reading_var = measured_speed_std(values[asked.NOISE], passes.plant.sensor.resolution_m_s) ** 2
    rows, index = last_readings(passes, values.get(asked.BIAS, 0.0))
    there = np.flatnonzero(rows >= 0)
    innovation, variance = found.innovation[index[there]], found.variance[index[there]]
    bias = values.get(asked.BIAS, 0.0)
    filtered = log.speed_m_s[rows[there]] - bias - innovation * reading_var / variance
    error = np.sqrt(reading_var * np.maximum(variance - reading_var, 0.0) / variance)
    left_m, gained = to_the_exit(like, found, values, rows)
    left_m, gained = left_m[there], gained[there]
    at_exit = np.sqrt(np.maximum(filtered**2 + 2.0 * gained, 0.0))
    leaves = left_m <= LONGEST_GAP_S * filtered
    speed[there] = np.where(leaves, at_exit, np.nan)
    std[there] = np.where(leaves, error * filtered / np.maximum(at_exit, SLOWEST_M_S), np.nan)
    last = log.speed_m_s[log.first_row[1:] - 1]
    stood = np.isnan(speed) & (last - bias < SLOWEST_M_S)
    return MeasuredExits(np.where(stood, 0.0, speed), np.where(stood, 0.0, std))


def last_readings(passes: FittingPasses, bias: float) -> tuple[Ints, Ints]:
    """Row of the last usable reading before the exit of each pass, and its number among the innovations, (m,); −1 for
    none. The first usable reading of a pass has no innovation."""
    log = passes.log
    usable = log.speed_m_s - bias > SLOWEST_M_S  # NaN is not
    of_row = log.pass_of_row
    rank = np.cumsum(usable) - 1
    first = np.searchsorted(np.flatnonzero(usable), log.first_row[:-1])
    seen = usable & (rank > first[of_row])
    number = np.cumsum(seen) - 1
    exit_m = np.array([plant.exit_m for _, plant in passes.plants])[passes.class_of]
    wanted = np.flatnonzero(seen & (log.path_m <= exit_m[of_row]))
    rows = np.full(len(log), -1, dtype=np.int64)
    rows[of_row[wanted]] = wanted  # the last one of a pass stays
    return rows, np.where(rows >= 0, number[rows], -1)


def to_the_exit(like: Likelihood, found: Innovations, values: Mapping[str, float], rows: Ints) -> tuple[Floats, Floats]:
    """Metres from `rows` (m,) to the exit, and energy per mass that is gained on them, by what is known of the cuts."""
    passes, log = like.passes, like.passes.log
    left, gained = np.zeros(len(log)), np.zeros(len(log))
    over = np.maximum(found.pressure_kpa[rows] - values[asked.TOUCH_PRESSURE], 0.0)
    share = values[like.slope_key] / getattr(passes.plant.position.force, like.slope_field)
    cuts = [passes.cut(number) for number in range(len(log))]
    for number, (_, plant) in enumerate(passes.plants):
        mine = np.flatnonzero((passes.class_of == number) & (rows >= 0))
        if len(mine) == 0:
            continue
        at = log.path_m[rows[mine]]
        gravity, force = scales(plant, passes, cuts)
        edges, ground, brake, by_axles = way_of(plant, float(at.min()), like.rows.mean_axles)
        ends = np.stack([at, np.full(len(mine), plant.exit_m)], axis=1)
        left[mine] = plant.exit_m - at
        slope = np.diff(np.interp(ends, edges, brake), axis=1)[:, 0]
        slope += values[asked.SLOPE_BY_AXLES] * np.diff(np.interp(ends, edges, by_axles), axis=1)[:, 0]
        gained[mine] = gravity[mine] * (
            np.diff(on(edges, ground, ends), axis=1)[:, 0]
            - found.cuts.resistance_n_per_kn[mine] * plant.cut.reduced_gravity_m_s2 * 1e-3 * left[mine]
        )
        gained[mine] -= found.cuts.friction[mine] * share * force[mine] * slope * over[mine]
    return left, gained


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
