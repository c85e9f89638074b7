"""What positions make of their commands in humped trains: errors of the exit speed, how long passes last, and why
cuts couple above 2 m/s.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from plant_models.frozen_arrays import Bools, Floats, Ints, frozen_arrays
from scripts.studies.aiming.trial import Value
from scripts.studies.humping.base_trial import FEEDBACK
from scripts.studies.humping.day_figures import PERCENT
from scripts.studies.study import MarkdownTable, plus_minus, table
from synth.hump.rolling.hump_position import Arrivals, HumpPosition, Passed, evenly_braked_s
from synth.hump.rolling.outcomes import USUAL_COUPLINGS
from synth.hump.trains.train_figures import ratio
from synth.hump.trial.trial import HumpTrial

TRAINS = 100
"""Enough: exit speeds are told of every pass."""


@dataclass(frozen=True)
class RecordedPosition:
    """A position that keeps in `kept` what came to it and what it made of that."""

    position: HumpPosition
    kept: list[tuple[Arrivals, Passed]] = field(default_factory=list)

    def passed(self, arrivals: Arrivals) -> Passed:
        """See `HumpPosition`."""
        passed = self.position.passed(arrivals)
        self.kept.append((arrivals, passed))
        return passed


@dataclass(frozen=True)
class Exits:
    """Of one position (1 is the first) under a regulator: `passes`; exit less command, its mean and root mean square,
    all cuts together and those of the lightest and the heaviest category; by how much the time of all passes is more
    than that of even braking between the same speeds, which plan and control foretell; a share of 1."""

    positions: str
    number: int
    passes: int
    mean_m_s: Value
    rms_m_s: Value
    light_rms_m_s: Value
    heavy_rms_m_s: Value
    longer_than_even: Value


def exits_of(trials: Mapping[str, HumpTrial], trains: int) -> tuple[Exits, ...]:
    """Those of every position of the trials, with feedback."""
    found = []
    for name, trial in trials.items():
        positions = tuple(map(RecordedPosition, trial.positions))
        replace(trial, positions=positions, control=FEEDBACK).humped(0, trains)
        for number, position in enumerate(positions, start=1):
            found.append(braked_passes(position.kept, trains).exits(name, number))
    return tuple(found)


@frozen_arrays
class BrakedPasses:
    """Passes, an entry each, of `trains` trains: whose train and category, exit less command, and the times: as it was,
    and of even braking."""

    trains: int
    train: Ints
    category: Ints
    error_m_s: Floats
    time_s: Floats
    even_s: Floats

    def exits(self, name: str, number: int) -> Exits:
        """Their figures."""
        every = np.ones(len(self.train), dtype=bool)
        lightest, heaviest = (self.category == place for place in (0, self.category.max()))
        return Exits(
            positions=name,
            number=number,
            passes=len(self.train),
            mean_m_s=self.over_trains(self.error_m_s, np.ones(len(self.train))),
            rms_m_s=self.rms(every),
            light_rms_m_s=self.rms(lightest),
            heavy_rms_m_s=self.rms(heaviest),
            longer_than_even=self.over_trains(self.time_s - self.even_s, self.even_s),
        )

    def over_trains(self, of_pass: Floats, base: Floats) -> Value:
        """Σ of_pass / Σ base with its interval over trains."""
        sums = [
            np.asarray(np.bincount(self.train, weights=each, minlength=self.trains), dtype=np.float64)
            for each in (of_pass, base)
        ]
        value, low, high = ratio(sums[0], sums[1])
        return Value(value, (low, high))

    def rms(self, which: Bools) -> Value:
        """Root mean square error of the passes `which`."""
        square = self.over_trains(np.where(which, self.error_m_s**2, 0.0), which.astype(float))
        low, high = np.sqrt(np.maximum(square.ci95, 0.0))
        return Value(float(np.sqrt(square.value)), (float(low), float(high)))


def braked_passes(kept: list[tuple[Arrivals, Passed]], trains: int) -> BrakedPasses:
    """Of all passes that were `kept` those of cuts that do not stop and would be faster than commanded without brake:
    about the others the position can do nothing."""
    parts = []
    for arrivals, passed in kept:
        exit_m_s = passed.exit_m_s
        each = (
            arrivals.train, arrivals.category, exit_m_s - arrivals.commanded_m_s, passed.time_s,
            evenly_braked_s(arrivals, exit_m_s),
        )  # fmt: skip
        which = (exit_m_s > 0.0) & (arrivals.unbraked_exit_m_s > arrivals.commanded_m_s)
        parts.append([values[which] for values in each])
    return BrakedPasses(trains, *(np.concatenate(values) for values in zip(*parts, strict=True)))


HEADS = ("positions", "position", "passes", "exit less command, m/s", "rms, m/s", "rms, light cuts, m/s",
         "rms, heavy cuts, m/s", "longer than even braking, %")  # fmt: skip


def exits_table(found: tuple[Exits, ...]) -> MarkdownTable:
    """A row a regulator and position."""
    return table(
        "what positions make of their commands, with feedback; root mean squares of exit less command",
        HEADS,
        (
            (each.positions, str(each.number), str(each.passes), error(each.mean_m_s), error(each.rms_m_s),
             error(each.light_rms_m_s), error(each.heavy_rms_m_s), percent(each.longer_than_even))
            for each in found
        ),
    )  # fmt: skip


def error(value: Value) -> str:
    """'0.071 ± 0.002'."""
    return plus_minus(value.value, value.ci95, 3)


def percent(value: Value) -> str:
    """'8.1 ± 0.2'."""
    return plus_minus(value.value, value.ci95, 1, PERCENT)


FAST_M_S = USUAL_COUPLINGS.harmful_m_s
NOT_HELD_STDS = 3.0
"""A cut that leaves so many standard deviations above its command was not held by the full brake."""


@dataclass(frozen=True)
class Causes:
    """Of `cuts`, `fast` coupled above 2 m/s: `rolling` to a cut that still rolled; of the others `not_held` by the last
    position; of the others `lowest` had the lowest command that there is; the `rest` rolled better than most."""

    cuts: int
    fast: int
    rolling: int
    not_held: int
    lowest: int
    rest: int


def causes(trial: HumpTrial, std_m_s: float, trains: int) -> Causes:
    """Those of the first `trains`; `std_m_s`: of the last position. Cuts in contact are not counted."""
    humped, _, memory = trial.humped(0, trains)
    none = trial.routes.elements
    fast = (memory.end_speed_m_s > FAST_M_S) & (memory.misrouted_at == none) & (memory.contact_at == none)
    rolling = fast & memory.caught_on_track
    command = memory.command_m_s[:, :, -1]
    category = humped.category.reshape(command.shape)
    with np.errstate(invalid="ignore"):  # a cut that never came to the position
        above = memory.exit_m_s[:, :, -1] > command + NOT_HELD_STDS * std_m_s
        at_lowest = command <= trial.aim.lowest_by_table_m_s[trial.aim.group[memory.route], category]
    not_held = fast & ~rolling & above
    lowest = fast & ~rolling & ~above & at_lowest
    of_all, of_rolling, of_not_held, of_lowest = (int(each.sum()) for each in (fast, rolling, not_held, lowest))
    return Causes(fast.size, of_all, of_rolling, of_not_held, of_lowest, of_all - of_rolling - of_not_held - of_lowest)
