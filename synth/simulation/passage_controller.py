"""A regulator that decides at passages over point sensors, as the closed loop runs it: the pulse pairs that it hears
of n passes (faults turn one such value into another), the rule that it holds, and what the passes leave behind.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from plant_models import Plant, PointSensors, every_axle
from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from plant_models.point_sensors import deciding_passages, passages
from synth.kernels.loop.passage_pulses import BASE_COLUMN, MOST_BASES, Heard, Pulses
from synth.kernels.loop.passage_regulator import DECIDED, NO_DECISION, NOT_BELIEVED, NOT_HEARD, UNFINISHED
from synth.simulation.controllers import fixed
from synth.simulation.passes import ExitSample, PassTrace
from synth.simulation.replicates import Interval, share_of
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.rule import LIMITS, held_by, held_passages
from tuning_tables.programs.held import HeldPassages

BY_THE_CLOCK = -1


@frozen_arrays
class HeardPairs:
    """R rows, each a pulse pair that may be heard in each of n passes.

    `source` (R,): the axle over a sensor that the pair comes from, not falling, then `BY_THE_CLOCK`; `sensor` (R,): the
    number under which it is heard. `after_s` (n, R): from the second pulse of the source on, or the time in the pass;
    NaN: not heard. `told_m_s` (n, R): the speed told; NaN: that which is measured.
    """

    source: Ints
    sensor: Ints
    after_s: Floats
    told_m_s: Floats

    def __len__(self) -> int:
        return len(self.after_s)

    def first_row(self, sources: int) -> Ints:
        """First row of each source, and of those by the clock, (`sources` + 1,)."""
        return np.searchsorted(self.source[self.source != BY_THE_CLOCK], np.arange(sources + 1)).astype(np.int64)

    def for_kernel(self) -> Heard:
        """What differs from pass to pass."""
        return Heard(fixed(self.after_s, np.float64), fixed(self.told_m_s, np.float64))


def as_given(sensor: Ints, passes: int) -> HeardPairs:
    """Every axle over a sensor is heard once, at once, as it was measured; `sensor` (E,) of each."""
    shape = (passes, len(sensor))
    return HeardPairs(np.arange(len(sensor)), np.array(sensor), np.zeros(shape), np.full(shape, np.nan))


TIMER_COLUMNS = BASE_COLUMN + 1 - MOST_BASES
"""Numbers of a pass that are the noise of the timer, one pulse pair each; beyond so many pairs they come again."""


def every_pulse(plant: Plant, sensors: PointSensors) -> Pulses:
    """The pulses of every axle over every sensor until the first axle is at the exit.

    Passages at which is decided take the first numbers of a pass for the noise of their timer, all others those behind:
    so a cut measures the same there, whether the others are heard or not.
    """
    deciding = {
        (each.sensor, each.axle): i for i, each in enumerate(deciding_passages(sensors, plant.cut, plant.exit_m))
    }
    met = deciding_passages(replace(sensors, axles=every_axle), plant.cut, plant.exit_m)
    decides = np.array([deciding.get((each.sensor, each.axle), -1) for each in met], dtype=np.int64)
    column = decides.copy()
    column[decides < 0] = len(deciding) + np.arange(np.count_nonzero(decides < 0))
    path = np.maximum(np.array([each.path_m for each in met]), plant.start_m)
    nothing = np.empty(0, dtype=np.int64)
    sensor, number = np.array([each.sensor for each in met]), np.arange(len(met))
    return in_order(
        Pulses(
            path, sensor, number, decides, column % TIMER_COLUMNS, nothing, nothing, nothing,
            sensors.base_m, sensors.base_tolerance, sensors.timer_noise_s, sensors.timer_resolution_s,
        )
    )  # fmt: skip


def deciding_pulses(pulses: Pulses) -> Pulses:
    """Those of `pulses` at whose passages is decided."""
    here = np.flatnonzero(pulses.decides >= 0)
    return in_order(
        pulses._replace(
            path_m=pulses.path_m[here],
            sensor=pulses.sensor[here],
            number=pulses.number[here],
            decides=pulses.decides[here],
            column=pulses.column[here],
        )
    )


def in_order(pulses: Pulses) -> Pulses:
    """`pulses` with the order of their coils and a row for each source."""
    half_m, sources = 0.5 * pulses.base_m, len(pulses.path_m)
    coils = np.argsort(np.concatenate([pulses.path_m - half_m, pulses.path_m + half_m]), kind="stable")
    sensor = fixed(pulses.sensor, np.int64)
    return pulses._replace(
        path_m=fixed(pulses.path_m, np.float64),
        sensor=sensor,
        number=fixed(pulses.number, np.int64),
        decides=fixed(pulses.decides, np.int64),
        column=fixed(pulses.column, np.int64),
        coils=fixed(coils, np.int64),
        first_row=fixed(np.arange(sources + 1), np.int64),
        told_sensor=sensor,
    )


@dataclass(frozen=True, eq=False)
class PassageController:
    """The rule that a controller holds, and whether it `tracks`.

    With the tracker the regulator hears every axle and finds out itself which passage a pulse pair is; each pair goes
    through `tuning_tables.programs.at_pulse`. Without it hears only the passages at which is decided, and is
    told which each pair is, as if no sensor ever failed. `ValueError` for arrays that do not fit.
    """

    rule: HeldPassages
    tracks: bool

    def __post_init__(self) -> None:
        rule = self.rule
        shape = rule.switching_m_s.shape
        if len(shape) != 3 or shape[1] != shape[2] + 1 or shape[2] < 1:
            raise ValueError(f"passage controller: switching_m_s has shape {shape}; it must be (M, K + 1, K), K >= 1")
        if np.isnan(rule.switching_m_s).any() or (rule.switching_m_s[..., 1:] < rule.switching_m_s[..., :-1]).any():
            raise ValueError("passage controller: switching_m_s must not fall along a row and have no NaN")
        heard = rule.deciding.shape
        if rule.path_m.shape != heard or rule.sensor.shape != heard or (np.diff(rule.path_m) < 0.0).any():
            raise ValueError("passage controller: path_m (rising), sensor and deciding must be of one length")
        if not np.array_equal(rule.deciding[rule.deciding != -1], np.arange(shape[0])):
            raise ValueError(f"passage controller: deciding must name each of {shape[0]} passages once, in order")
        limits = np.array([getattr(rule, name) for name in LIMITS])
        if not np.all(np.isfinite(limits) & (limits >= 0.0)):
            raise ValueError("passage controller: limits must be six numbers that are not negative")

    @property
    def stages(self) -> int:
        """Number of stages K + 1."""
        return int(self.rule.switching_m_s.shape[1])


def of_speeds(
    plant: Plant, sensors: PointSensors, switching_m_s: NDArray[np.floating], limits: tuple[float, ...] = ()
) -> PassageController:
    """The regulator with `switching_m_s` (M, K + 1, K) at the passages at which the cut of `plant` decides.

    With the six `limits` of a tracker (`PlausibleMotion.numbers`) it tracks, else it is told each passage.
    """
    if len(limits) not in (0, len(LIMITS)):
        raise ValueError(f"passage controller: there are {len(limits)} limits, but a tracker has six numbers")
    met = deciding_passages(sensors, plant.cut, plant.exit_m)
    heard = passages(replace(sensors, axles=every_axle), plant.cut)
    rule = held_passages(
        switching_m_s,
        np.array([each.path_m for each in heard]),
        np.array([each.sensor for each in heard]),
        np.array([met.index(each) if each in met else -1 for each in heard]),
        limits or [0.0] * len(LIMITS),
        base_m=sensors.base_m,
        entrance_stage=plant.entrance_stage,
        before_entrance=sum(each.path_m < 0.0 for each in met),
    )
    return PassageController(rule, tracks=bool(limits))


def of_table(table: PassageTable, tracking: bool) -> PassageController:
    """The regulator that runs `table`; `tracking`: with the tracker, as in a controller, else told each passage."""
    return PassageController(held_by(table), tracking)


__all__ = [
    "DECIDED",
    "HEARD",
    "MISTAKEN",
    "NOT_BELIEVED",
    "NOT_HEARD",
    "NO_DECISION",
    "TAKEN",
    "UNFINISHED",
    "PassReadings",
    "PassageSample",
    "PassageTrace",
    "shares_of_outcomes",
]

TAKEN: Final = (DECIDED, UNFINISHED)
"""Outcomes of pulses that were taken for a passage at which is decided."""

MISTAKEN: Final = (NOT_BELIEVED, NO_DECISION)
"""Of those that were taken for none."""

HEARD: Final = (*TAKEN, *MISTAKEN)


@frozen_arrays
class PassageSample(ExitSample):
    """Exits of n passes, and `outcome` uint8 (n, M): what came of the first pulse pair of each deciding passage.

    `NOT_HEARD`: the cut did not come there, or no pair was heard; `DECIDED`: the rule was asked; `UNFINISHED`: a
    transient had not ended by the middle of the reading; `NOT_BELIEVED`: the tracker took the pair for no passage;
    `NO_DECISION`: it took the pair for a passage at which nothing is decided.
    """

    outcome: NDArray[np.uint8]


@frozen_arrays
class PassReadings:
    """The pulse pairs that the regulator heard in one pass, in their order, arrays (pairs,).

    `time_s` of the second pulse as heard and `middle_s` of the reading; `told_sensor`; `passage`, the true one, −1 if
    the pair was none; `believed`, the passage that the regulator took it for, −1: none; both are numbers among all
    passages heard, as in `PassageTable.heard_path_m`. `reading_m_s` as told; `outcome` as in `PassageSample`; `stage`
    commanded from then on.
    """

    time_s: Floats
    middle_s: Floats
    told_sensor: Ints
    passage: Ints
    believed: Ints
    reading_m_s: Floats
    outcome: NDArray[np.uint8]
    stage: Ints


@frozen_arrays
class PassageTrace(PassTrace):
    """One pass event by event, and what the regulator heard; `measured_m_s` is that of a pulse pair, else NaN."""

    readings: PassReadings


def shares_of_outcomes(
    sample: PassageSample, of: Sequence[int], among: Sequence[int]
) -> tuple[tuple[float, Interval], ...]:
    """For every passage the share of cuts that met one of the outcomes `of`, and its 95 % interval.

    Of those that met one of the outcomes `among` there; NaN where none did.
    """
    nothing = (float("nan"), (float("nan"), float("nan")))
    found = []
    for outcome in sample.outcome.T:
        weight = np.where(np.isin(outcome, among), sample.weight, 0.0)
        found.append(share_of(np.isin(outcome, of), weight) if weight.any() else nothing)
    return tuple(found)
