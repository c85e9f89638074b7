"""On-line correction of the commanded speed from the last exits: its numbers, checked, and its golden exits.

The rules are `programs.correct`: `usable_exit` judges a pass, `learn_exit` takes its exit, `corrected_speed` is asked.
A golden exit is what one pass must make of a state of the correction, where a wrong implementation shows. A row stands
for itself: state before, exit, state after, and a speed with what becomes of it. Equal rows one by one make equal
sequences of any length.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from math import sqrt
from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt

from tuning_tables.errors import require_between
from tuning_tables.programs.correct import (
    CORRECTION,
    FEWEST_SAMPLES,
    LARGEST_ERROR_M_S,
    LARGEST_EXCESS_M_S,
    LARGEST_SPEED_M_S,
    MOST_LEARNT,
    MOST_MISSING,
    CorrectionSetting,
    corrected_speed,
    learn_exit,
    usable_exit,
)

CERTAINTY: Final = 2.0
"""Standard deviations of b that are not believed: t = 2 spread √K."""

CLIP: Final = 3.0
"""Spreads at which an innovation is clipped: 0.3 % of normal exits are."""

LEAST_LIMIT_M_S, LARGEST_LIMIT_M_S = 0.01, 0.5


@dataclass(frozen=True)
class Correction:
    """How far and how fast the correction may go.

    limit_m_s       c never leaves ±limit, 0.01 to 0.5 m/s
    spread_m_s      standard deviation of a usable exit around its mean, with that of its measurement, 0.005 to 0.5 m/s
    memory_passes   1/K: how many passes the mean is taken over, 10 to 10 000
    step_m_s        most that one pass may change c by, 0.0001 to 0.1 m/s

    Derived, for the rules: `setting`. Raises `InvalidTable`.
    """

    limit_m_s: float = 0.15
    spread_m_s: float = 0.06
    memory_passes: float = 100.0
    step_m_s: float = 0.005
    setting: CorrectionSetting = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        require_between(self.limit_m_s, "correction.limit_m_s", LEAST_LIMIT_M_S, LARGEST_LIMIT_M_S)
        require_between(self.spread_m_s, "correction.spread_m_s", 0.005, 0.5)
        require_between(self.memory_passes, "correction.memory_passes", 10.0, 1e4)
        require_between(self.step_m_s, "correction.step_m_s", 1e-4, 0.1)
        limit, t = self.limit_m_s, self.threshold_m_s
        reach = 0.5 * (limit + sqrt(limit * limit + 4.0 * t * t))
        numbers = (self.gain, t * t, limit, reach, CLIP * self.spread_m_s, self.step_m_s)
        object.__setattr__(self, "setting", CorrectionSetting(*map(np.float32, numbers)))

    @property
    def gain(self) -> float:
        """K of the filter."""
        return 1.0 / self.memory_passes

    @property
    def threshold_m_s(self) -> float:
        """t: a mean error up to it changes nothing."""
        return CERTAINTY * self.spread_m_s * sqrt(self.gain)


def begun_correction() -> npt.NDArray[np.float32]:
    """The state of a position before its first pass, float32 (3,): no correction."""
    return np.zeros(len(CORRECTION.members), dtype=np.float32)


Exit: TypeAlias = tuple[float, bool, float]
"""Error, whether it is credible, and a speed to correct."""

BEFORE_FIELDS: Final = ("before_mean_m_s", "before_correction_m_s", "before_learnt")
NUMBERS: Final = (*BEFORE_FIELDS, "error_m_s", "v_m_s", "mean_m_s", "correction_m_s", "learnt", "corrected")
STEP: Final = np.dtype([("credible", np.bool_), *((name, np.float32) for name in NUMBERS)])
PASS: Final = np.dtype([*((name, np.int16) for name in ("samples", "missing", "at_top")),
                        *((name, np.bool_) for name in ("ends_at_top", "by_hand", "stalled")),
                        ("error_m_s", np.float32), ("usable", np.bool_)])  # fmt: skip
SPEED: Final = np.dtype([(name, np.float32) for name in (*BEFORE_FIELDS, "v_m_s", "corrected")])
"""Questions to `learn_exit` and `corrected_speed`, to `usable_exit`, and to `corrected_speed` alone, by the names of
what they take and answer."""

SEQUENCE: Final = 60
SMALLEST: Final = float(np.finfo(np.float32).smallest_subnormal)
LARGEST: Final = float(np.finfo(np.float32).max)


def answered(correction: Correction, rows: npt.NDArray[np.void]) -> npt.NDArray[np.void]:
    """`rows` of type `STEP` with the state after each exit and the corrected speed filled in, as a copy."""
    filled = rows.copy()
    for row in filled:
        state = np.array([row[name] for name in BEFORE_FIELDS], dtype=np.float32)
        learn_exit(correction.setting, state, row["error_m_s"], row["credible"])
        row["mean_m_s"], row["correction_m_s"], row["learnt"] = state
        row["corrected"] = corrected_speed(correction.setting, state, row["v_m_s"])
    return filled


def golden_exits(correction: Correction) -> npt.NDArray[np.void]:
    """All rows, of type `STEP`: sequences of passes, then states and readings at, beside and beyond every bound."""
    rows = [row for exits in _sequences(correction) for row in _run(correction, exits)]
    rows += [_row(state, reading) for state in _states(correction) for reading in _readings(correction)]
    return answered(correction, np.array(rows, dtype=STEP))


def golden_speeds(correction: Correction) -> npt.NDArray[np.void]:
    """A speed in every state that `golden_exits` begins with, of type `SPEED`: before an exit has mended it."""
    rows = np.array([(*state, 3.0, 0.0) for state in _states(correction)], dtype=SPEED)
    for row in rows:
        state = np.array([row[name] for name in BEFORE_FIELDS], dtype=np.float32)
        row["corrected"] = corrected_speed(correction.setting, state, row["v_m_s"])
    return rows


def _row(state: Iterable[float], reading: Exit) -> tuple[float | bool, ...]:
    error, credible, speed = reading
    return (credible, *state, error, speed, 0.0, 0.0, 0.0, 0.0)


def _run(correction: Correction, exits: Iterable[Exit]) -> Iterator[tuple[float | bool, ...]]:
    state = begun_correction()
    for error, credible, speed in exits:
        yield _row(map(float, state), (error, credible, speed))
        learn_exit(correction.setting, state, np.float32(error), credible)


def _sequences(correction: Correction) -> Iterator[list[Exit]]:
    """Means of several sizes and both signs; one exit in ten cannot be used."""
    for place, mean in enumerate((0.6, -1.6, 4.0, -30.0)):
        exits = []
        for number in range(SEQUENCE):
            noise = (number * 7919 + place * 104729) % 997 / 498.0 - 1.0  # no rule in it, and the same everywhere
            error = min(max(correction.spread_m_s * (mean + 1.7 * noise), -0.99), 0.99)
            exits.append((error, number % 10 != 7, 0.07 * number))
        yield exits


def _states(correction: Correction) -> Iterator[tuple[float, float, float]]:
    """Begun, at the bounds, about to stop counting, and such as cannot be."""
    limit, reach, t = float(correction.setting.limit_m_s), float(correction.setting.reach_m_s), correction.threshold_m_s
    most = float(MOST_LEARNT)
    yield from ((0.0, limit, 7.0), (0.0, -limit, 7.0))
    yield from ((0.0, 0.0, 0.0), (reach, limit, 9.0), (-reach, -limit, most), (1.5 * t, 0.0, most - 1.0))
    yield from ((_above(reach), 0.0, 5.0), (0.0, _above(limit), 5.0), (0.0, -_above(limit), 5.0), (0.0, 0.0, -1.0))
    yield from ((-_above(reach), 0.0, 5.0), (0.01, 0.001, 2.0 * most))
    yield from ((np.nan, 0.01, 5.0), (0.01, np.inf, 5.0), (0.01, 0.001, np.nan), (-np.inf, np.nan, 5.0))
    yield (SMALLEST, -SMALLEST, 3.0)


def _readings(correction: Correction) -> list[Exit]:
    """At, beside and beyond what is believed and what is clipped."""
    clip, fastest, largest = map(float, (correction.setting.clip_m_s, LARGEST_SPEED_M_S, LARGEST_ERROR_M_S))
    return [
        (0.02, True, 3.0), (0.02, False, 0.001), (largest, True, 0.0), (-largest, True, fastest),
        (_above(largest), True, _above(fastest)), (-_above(largest), True, -1.0),
        (0.9 * clip, True, 0.3), (-0.9 * clip, True, 12.5), (1.1 * clip, True, 1e-3), (-1.1 * clip, True, 0.15),
        (np.nan, True, 2.0), (np.inf, True, np.nan), (0.0, True, np.inf), (-LARGEST, True, -np.inf),
        (SMALLEST, True, SMALLEST), (0.01, True, LARGEST),
    ]  # fmt: skip


def _above(value: float) -> float:
    return float(np.nextafter(np.float32(value), np.float32(np.inf)))


def golden_passes() -> npt.NDArray[np.void]:
    """Passes, of type `PASS`, at and beyond each condition of `usable_exit`, with its answer."""
    few, most = FEWEST_SAMPLES, MOST_MISSING
    counts = [
        (few, 0, 0), (few - 1, 0, 0), (60, most, 0), (60, most + 1, 0), (60, 0, 30), (60, 0, 31), (61, 0, 30),
        (61, 0, 31), (60, -1, 0), (60, 0, -1), (60, 0, 61), (32767, 0, 16383), (32767, 0, 16384), (-32768, 0, 0),
        (0, 0, 0), (32767, 32767, 32767),
    ]  # fmt: skip
    passes = [(*each, *flags, 0.05, False) for each in counts for flags in ((False,) * 3, (True, False, False))]
    passes += [(60, 0, 5, False, hand, stalled, 0.0, False) for hand in (True, False) for stalled in (True, False)]
    one, excess = float(LARGEST_ERROR_M_S), float(LARGEST_EXCESS_M_S)
    errors = [one, -one, _above(one), -_above(one), excess, _above(excess), -excess, 0.5]
    errors += [np.nan, np.inf, -np.inf]
    passes += [(60, 0, 5, ends, False, False, error, False) for error in errors for ends in (True, False)]
    return judged(np.array(passes, dtype=PASS))


def judged(passes: npt.NDArray[np.void]) -> npt.NDArray[np.void]:
    """`passes` of type `PASS` with the answer of `usable_exit` filled in, as a copy."""
    filled = passes.copy()
    for each in filled:
        samples, missing, at_top, ends, hand, stalled, error_m_s, _ = each.tolist()
        each["usable"] = usable_exit(samples, missing, at_top, ends, hand, stalled, error_m_s)
    return filled
