"""How fast may trains be humped at a share of catch-ups: over the least interval of the program, on common trains."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from plant_models.frozen_arrays import frozen_arrays
from synth.studies.aiming.trial import Value
from synth.studies.humping.base_trial import FEEDBACK, MEASURED, OPEN, SLOWING, with_interval_std, with_planner
from synth.studies.humping.day_figures import DayFigures, day_figures, fewer_catch_ups
from synth.studies.humping.runs import Group
from synth.yard.humping.outcomes import TrainOutcomes
from synth.yard.humping.trial import Floats, HumpTrial

CONTROLS = {
    "open loop": OPEN,
    "feedback": FEEDBACK,
    "feedback, resistance measured": MEASURED,
    "feedback, train slowed down": SLOWING,
}
OPEN_LOOP, WITH_FEEDBACK, WITH_MEASURED, WITH_SLOWING = CONTROLS

FEWEST_EVENTS = 10.0
"""Catch-ups that the trains must have at a limit; with fewer the bootstrap has nothing to draw from."""

REPLICATES = 2000


@dataclass(frozen=True)
class Point:
    """One program of a curve; `fewer`: by how much the share of catch-ups is less than in open loop, None there."""

    least_s: float
    figures: DayFigures
    fewer: Value | None


@dataclass(frozen=True)
class AtLimit:
    """Where a curve has the share `limit` of catch-ups: mean hump speed and cars an hour, with bootstrap intervals.

    None where the trains do not decide it. `least_m_s`, `most_m_s`: ends of the curve.
    """

    limit: float
    hump_speed_m_s: Value | None
    cars_per_hour: Value | None
    least_m_s: float
    most_m_s: float


@dataclass(frozen=True)
class AtSpeed:
    """Share of catch-ups where a curve has a mean hump speed; None where it is beyond the ends of the curve."""

    hump_speed_m_s: float
    catch_ups: Value | None


@dataclass(frozen=True)
class Curve:
    """All programs with one exactness of the interval positions and one control."""

    std_m_s: float
    control: str
    points: tuple[Point, ...]
    at_limits: tuple[AtLimit, ...]
    at_speeds: tuple[AtSpeed, ...]


@dataclass(frozen=True)
class Gain:
    """Mean hump speed at a limit that one curve has more than another, on the same trains; None: not decided."""

    limit: float
    more: str
    than: str
    hump_speed_m_s: Value | None
    cars_per_hour: Value | None


def name_of(std_m_s: float, control: str, least_s: float | None = None) -> str:
    """The trial of a point, or a curve."""
    curve = f"σ {std_m_s:g}, {control}"
    return curve if least_s is None else f"{curve}, {least_s:g} s"


def frontier_groups(base: HumpTrial, stds_m_s: tuple[float, ...], least_s: tuple[float, ...]) -> list[Group]:
    """A group a program: all curves at it."""
    groups = []
    for least in least_s:
        planned = with_planner(base, least_s=least)
        of_std = {std: with_interval_std(planned, std) for std in stds_m_s}
        trials = {
            name_of(std, control, least): replace(trial, control=made)
            for std, trial in of_std.items()
            for control, made in CONTROLS.items()
        }
        groups.append(Group(trials))
    return groups


@frozen_arrays
@dataclass(frozen=True, eq=False)
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


def sums_of(outcomes: list[TrainOutcomes], weights: Floats) -> Sums:
    """Those of the programs of a curve; `weights` (rows, trains): how often each train is drawn."""

    def total(name: str) -> Floats:
        return np.stack([weights @ getattr(each, name).astype(float) for each in outcomes], axis=1)

    seconds = total("span_s")
    return Sums(total("caught") / total("cuts"), total("span_m") / seconds, 3600.0 * total("span_cars") / seconds)


def drawn_weights(trains: int, seed: int) -> Floats:
    """Bootstrap weights (1 + REPLICATES, trains); the first row is one each."""
    rng = np.random.default_rng(np.random.SeedSequence(seed))
    drawn = rng.multinomial(trains, np.full(trains, 1.0 / trains), REPLICATES)
    return np.concatenate((np.ones((1, trains)), drawn.astype(float)))


def decided(values: Floats) -> Value | None:
    """The sample's own value (the first) with the percentile interval of the others, if all three are finite."""
    if not np.isfinite(values[0]):
        return None
    ordered = np.sort(values[1:])
    low, high = (float(ordered[int(q * (len(ordered) - 1))]) for q in (0.025, 0.975))
    return Value(float(values[0]), (low, high)) if np.isfinite((low, high)).all() else None


@dataclass(frozen=True)
class Frontier:
    """All curves on the same trains, from the outcomes of their trials by name."""

    outcomes: dict[str, TrainOutcomes]
    stds_m_s: tuple[float, ...]
    least_s: tuple[float, ...]
    limits: tuple[float, ...]
    speeds_m_s: tuple[float, ...]
    seed: int

    def curves(self) -> tuple[Curve, ...]:
        """A curve an exactness and control."""
        return tuple(self.curve(std, control) for std in self.stds_m_s for control in CONTROLS)

    def of(self, std_m_s: float, control: str) -> list[TrainOutcomes]:
        """The outcomes of a curve, safest program first."""
        return [self.outcomes[name_of(std_m_s, control, least)] for least in self.least_s]

    def sums(self, std_m_s: float, control: str) -> Sums:
        """The sums of a curve over common bootstrap draws."""
        outcomes = self.of(std_m_s, control)
        return sums_of(outcomes, drawn_weights(len(outcomes[0]), self.seed))

    def curve(self, std_m_s: float, control: str) -> Curve:
        """One of them."""
        outcomes, sums = self.of(std_m_s, control), self.sums(std_m_s, control)
        opened = self.of(std_m_s, OPEN_LOOP)
        points = tuple(
            Point(least, day_figures(each), None if control == OPEN_LOOP else fewer_catch_ups(beside, each))
            for least, each, beside in zip(self.least_s, outcomes, opened, strict=True)
        )
        limits = tuple(self.at_limit(sums, limit, outcomes[0]) for limit in self.limits)
        speeds = tuple(AtSpeed(each, decided(sums.at_speed(each))) for each in self.speeds_m_s)
        return Curve(std_m_s, control, points, limits, speeds)

    def at_limit(self, sums: Sums, limit: float, trains: TrainOutcomes) -> AtLimit:
        """Where a curve has this share."""
        speed, cars = sums.crossing(limit) if self.enough(limit, trains) else (np.full(2, np.nan),) * 2
        ends = float(sums.hump_speed_m_s[0].min()), float(sums.hump_speed_m_s[0].max())
        return AtLimit(limit, decided(speed), decided(cars), *ends)

    def enough(self, limit: float, trains: TrainOutcomes) -> bool:
        """Whether the trains carry a share as small as this."""
        return limit * float(trains.cuts.sum()) >= FEWEST_EVENTS

    def gains(self) -> tuple[Gain, ...]:
        """What feedback, measured resistance and exactness bring, at every limit."""
        best, worst = min(self.stds_m_s), max(self.stds_m_s)
        pairs = [((std, WITH_FEEDBACK), (std, OPEN_LOOP)) for std in self.stds_m_s]
        pairs += [((std, WITH_MEASURED), (std, WITH_FEEDBACK)) for std in self.stds_m_s]
        pairs += [((std, WITH_SLOWING), (std, WITH_FEEDBACK)) for std in self.stds_m_s]
        pairs += [((best, control), (worst, control)) for control in CONTROLS if best < worst]
        return tuple(self.gain(more, than, limit) for limit in self.limits for more, than in pairs)

    def gain(self, more: tuple[float, str], than: tuple[float, str], limit: float) -> Gain:
        """Of one curve over another."""
        found: list[Value | None] = [None, None]
        if self.enough(limit, self.of(*more)[0]):
            with np.errstate(invalid="ignore"):  # ∞ − ∞ decides nothing
                between = [
                    one - other
                    for one, other in zip(
                        self.sums(*more).crossing(limit), self.sums(*than).crossing(limit), strict=True
                    )
                ]
            found = [decided(each) for each in between]
        return Gain(limit, name_of(*more), name_of(*than), *found)
