"""Where curves of catch-ups over the hump speed cross a share or a speed, with intervals from bootstrap samples."""

from __future__ import annotations

import numpy as np

from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from synth.frame.interval import Interval
from synth.hump.trains.outcomes import TrainOutcomes
from synth.hump.trains.shift_sums import shift_sums

REPLICATES = 2000

FEWEST_EVENTS = 10.0
"""Catch-ups that the trains must have at a limit; with fewer the bootstrap has nothing to draw from."""


@frozen_arrays
class Sums:
    """Of each bootstrap replicate (rows; the first is the sample itself) and each program, safest first: share of
    catch-ups, mean hump speed, cars an hour."""

    catch_ups: Floats
    hump_speed_m_s: Floats
    cars_per_hour: Floats

    def crossing(self, limit: float) -> tuple[Floats, Floats]:
        """Speed and cars an hour (rows,) where the share passes `limit`, linear in between; −∞ and ∞ where it does so
        ahead of the first program or behind the last."""
        beyond = self.catch_ups > limit
        behind = beyond.argmax(axis=1)
        rows = np.arange(len(beyond))
        ahead = np.maximum(behind - 1, 0)
        low, high = self.catch_ups[rows, ahead], self.catch_ups[rows, behind]
        part = np.where(high > low, (limit - low) / np.where(high > low, high - low, 1.0), 0.0)
        found = []
        for values in (self.hump_speed_m_s, self.cars_per_hour):
            between = values[rows, ahead] + part * (values[rows, behind] - values[rows, ahead])
            between = np.where(behind == 0, -np.inf, between)
            found.append(np.where(beyond.any(axis=1), between, np.inf))
        return found[0], found[1]

    def at_speed(self, hump_speed_m_s: float) -> Floats:
        """Share of catch-ups (rows,) where the mean hump speed is passed first, linear in between; NaN if it is not."""
        faster = self.hump_speed_m_s >= hump_speed_m_s
        behind, rows = faster.argmax(axis=1), np.arange(len(faster))
        ahead = np.maximum(behind - 1, 0)
        low, high = self.hump_speed_m_s[rows, ahead], self.hump_speed_m_s[rows, behind]
        part = np.where(high > low, (hump_speed_m_s - low) / np.where(high > low, high - low, 1.0), 0.0)
        share = self.catch_ups[rows, ahead] + part * (self.catch_ups[rows, behind] - self.catch_ups[rows, ahead])
        return np.where(faster.any(axis=1) & (behind > 0), share, np.nan)


def sums_of(outcomes: list[TrainOutcomes], weights: Floats, shift: Ints | None = None) -> Sums:
    """Those of the programs of a curve; `weights` (rows, shifts): how often each shift is drawn; `shift` (trains,):
    other shifts that the trains are counted in."""

    def total(name: str) -> Floats:
        return np.stack([weights @ shift_sums(each, getattr(each, name), shift) for each in outcomes], axis=1)

    seconds = total("span_s")
    return Sums(total("caught") / total("cuts"), total("span_m") / seconds, 3600.0 * total("span_cars") / seconds)


def drawn_weights(shifts: int, seed: int) -> Floats:
    """Bootstrap weights (1 + REPLICATES, shifts); the first row is one each."""
    rng = np.random.default_rng(np.random.SeedSequence(seed))
    drawn = rng.multinomial(shifts, np.full(shifts, 1.0 / shifts), REPLICATES)
    return np.concatenate((np.ones((1, shifts)), drawn.astype(float)))


def enough_for(limit: float, cuts: int) -> bool:
    """Whether so many cuts carry a share as small as this."""
    return limit * cuts >= FEWEST_EVENTS


def decided(values: Floats, trains: int) -> Interval | None:
    """The value of the sample of `trains` (the first) with the percentile interval of its replicates (the others), if
    all three are finite."""
    if not np.isfinite(values[0]):
        return None
    ordered = np.sort(values[1:])
    low, high = (float(ordered[int(q * (len(ordered) - 1))]) for q in (0.025, 0.975))
    value = float(values[0])
    if not np.isfinite((low, high)).all():
        return None
    return Interval(value, min(low, value), max(high, value), trains)
