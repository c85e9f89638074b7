"""Golden vectors of a table: readings where a wrong implementation of the rule shows, with the right answers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from tuning_tables.rule import NO_GAUGE, decide_many, rises_at
from tuning_tables.table import ControllerTable

Floats = npt.NDArray[np.float32]
Reading = tuple[int, np.float32, np.float32, np.float32]
"""Stage, path, speed, pressure."""

LARGEST: Final = float(np.finfo(np.float32).max)
LEAST_NORMAL: Final = float(np.finfo(np.float32).smallest_normal)
SMALLEST: Final = float(np.finfo(np.float32).smallest_subnormal)
STAGE_LIMITS: Final = (-32768, 32767)
"""Of a 16-bit INT, which every controller has."""

BETWEEN: Final = np.float32(0.8125)
"""Where on the path range every stage is asked about the lines of all."""

PLACES: Final = 65
"""Of the path where it is looked for speeds at which a step would be taken back."""

FEW: Final = 20
"""Readings a line, at most, of a self-test for a small controller."""

ASIDE_M_S: Final = np.float32(0.01)
"""Distance from a line that no rounding bridges."""

OUTSIDE_KPA: Final = np.float32(50.0)
"""How far outside their range pressures are asked, too."""


@dataclass(frozen=True, eq=False)
class GoldenVectors:
    """n readings and the stages to command: stage int32, s_m, v_m_s and pressure_kpa float32, answer int32, all (n,).

    The pressure is NaN, of no meaning, in those of a table without slopes.
    """

    stage: npt.NDArray[np.int32]
    s_m: Floats
    v_m_s: Floats
    pressure_kpa: Floats
    answer: npt.NDArray[np.int32]

    def __post_init__(self) -> None:
        for array in vars(self).values():
            array.setflags(write=False)

    def __len__(self) -> int:
        return len(self.answer)


def golden_vectors(table: ControllerTable) -> GoldenVectors:
    """Readings on, next to (one float32 step) and beyond every line and both ends of the path, and incredible ones.

    With an approach also on and next to every line on it, just before, at and just behind the entrance; with slopes all
    of that at the pressure of the stage and at others, within their range and outside. Where one command may go several
    stages, every stage is asked also on and next to the lines of the others, and where a step would be taken back. The
    same table gives the same vectors, in the same order, each once.
    """
    readings = [*_line_readings(table, _paths(table), STEPS_AND_ASIDE), *_incredible_readings(table)]
    if table.approach is not None:
        readings += _line_readings(table, _entrance_paths(table), STEPS)
    if table.has_gauge:
        readings += _line_readings(table, _paths(table), STEPS_AND_ASIDE, _pressures)
        readings += _line_readings(table, _paths(table)[:3], STEPS_AND_ASIDE, _silent_pressures)
    if table.farthest > 1:
        readings += [*_far_readings(table), *turning_readings(table)]
    return _answered(table, readings)


def few_golden_vectors(table: ControllerTable) -> GoldenVectors:
    """At most `FEW` readings a line, but 2 without any: on it and next to it, at four places of the path.

    The places are the farthest numbers before and behind the range, and two within it; with an approach one of these is
    just before the entrance, and with slopes each place is asked at another pressure. At every stage with a line also a
    negative speed, none, the largest, and what is not finite, within the range or at the entrance; and stages that do
    not exist. Where one command may go several stages, also where a step would be taken back.
    """
    low, high = table.valid_range[0], table.valid_range[1]
    near, far = (low + (high - low) * np.float32(part) for part in (0.25, 0.8125))
    before = near
    if table.approach is not None:
        before, near = np.float32(-LEAST_NORMAL), np.float32(0.0)
    paths = np.array([-LARGEST, before, far, LARGEST], dtype=np.float32)
    fast, speeds = np.float32(LARGEST), [np.float32(v) for v in (-1.0, 0.0, LARGEST, np.inf, np.nan)]
    lined = np.flatnonzero(table.has_line.any(axis=1)).tolist()
    pressures = _pressures if table.has_gauge else _own_pressures
    readings = [reading for reading in _line_readings(table, paths, STEPS, pressures) if reading[0] in lined]
    readings += [(k, near, v, _own(table, k)) for k in lined for v in speeds]
    readings += [(k, np.float32(-np.inf), fast, _own(table, k)) for k in lined]
    readings += [(k, near, fast, _own(table, k)) for k in (-1, len(table.stages))]
    readings += turning_readings(table) if table.farthest > 1 else []
    return _answered(table, readings)


def _answered(table: ControllerTable, readings: Sequence[Reading]) -> GoldenVectors:
    """The readings, each once, in their order, with their answers."""
    stage = np.array([reading[0] for reading in readings], dtype=np.int32)
    s_m, v_m_s, kpa = (np.array([reading[i] for reading in readings], dtype=np.float32) for i in (1, 2, 3))
    # By bit pattern, so that NaN equals NaN and -0.0 is not 0.0.
    bits = np.stack([each.view(np.uint32) for each in (stage, s_m, v_m_s, kpa)], axis=1)
    first = np.sort(np.unique(bits, axis=0, return_index=True)[1])
    asked = stage[first], s_m[first], v_m_s[first], kpa[first]
    return GoldenVectors(*asked, decide_many(table, *asked).astype(np.int32))


def line_speeds(coefficients: Floats, s_m: Floats) -> Floats:
    """One line, float32 (degree+1,), at paths s_m (n,), as the rule computes it: (n,) in m/s."""
    speed = np.full(s_m.shape, coefficients[-1], dtype=np.float32)
    for coefficient in coefficients[-2::-1]:
        speed = speed * s_m + coefficient
    return speed


def _own(table: ControllerTable, stage: int) -> np.float32:
    """The pressure of `stage`, or of the nearest stage that there is; NaN where none is asked for."""
    if not table.has_gauge:
        return np.float32(NO_GAUGE)
    return np.float32(table.pressures[min(max(stage, 0), len(table.stages) - 1)])


def _own_pressures(table: ControllerTable, stage: int, count: int) -> Floats:
    """That of the stage, `count` times."""
    return np.full(count, _own(table, stage))


def _pressures(table: ControllerTable, stage: int, count: int) -> Floats:
    """`count` pressures in turn: both ends of their range, its middle, and outside."""
    low, high = table.pressures[0], table.pressures[table.highest_raised]
    middle = low + (high - low) / np.float32(2.0)
    turn = (high, low, low - OUTSIDE_KPA, middle, high + OUTSIDE_KPA, np.float32(LARGEST), np.float32(-LARGEST))
    return np.resize(np.roll(np.array(turn, dtype=np.float32), stage), count)


def _silent_pressures(table: ControllerTable, stage: int, count: int) -> Floats:
    """What is no pressure."""
    return np.resize(np.array([np.nan, np.inf, -np.inf], dtype=np.float32), count)


def _line_readings(
    table: ControllerTable,
    paths: Floats,
    places: Sequence[Callable[[Floats], Floats]],
    pressures: Callable[[ControllerTable, int, int], Floats] = _own_pressures,
) -> list[Reading]:
    """Readings at `paths` and `places` around every line, or around the target speed at a stage that has none."""
    clamped = np.clip(paths, table.valid_range[0], table.valid_range[1])
    target = np.full(paths.shape, table.target_speed_m_s, dtype=np.float32)
    readings = []
    for k in range(len(table.stages)):
        kpa = pressures(table, k, len(paths))
        rise = rises_at(table, k, kpa)
        lines = [line_speeds(table.coefficients[k, i], clamped) + rise[:, i] for i in (0, 1) if table.has_line[k, i]]
        for line in lines or [target]:
            for place in places:
                readings += [(k, s, v, p) for s, v, p in zip(paths, place(line), kpa, strict=True)]
    return readings


def _far_readings(table: ControllerTable) -> list[Reading]:
    """On and next to every line at a place within the path range, asked of every stage."""
    low, high = table.valid_range[:2]
    beside = _line_readings(table, np.array([low + (high - low) * BETWEEN]), STEPS)
    return [(k, s, v, _own(table, k)) for k in range(len(table.stages)) for _, s, v, _ in beside]


def turning_readings(table: ControllerTable) -> list[Reading]:
    """Speeds at which stage k is raised and stage k+1 lowered, asked of both and of the two stages beside them.

    For each k that has such speeds, where on the path they are most: the middle of them. A rule that goes on after the
    opposite answer does not end where it should.
    """
    low, high = table.valid_range[:2]
    paths = low + (high - low) * np.linspace(0.0, 1.0, PLACES, dtype=np.float32)
    readings: list[Reading] = []
    for k in range(len(table.stages) - 1):
        if not (table.has_line[k, 1] and table.has_line[k + 1, 0]):
            continue
        raised_above, lowered_below = (line_speeds(table.coefficients[k + i, 1 - i], paths) for i in (0, 1))
        at = int(np.argmax(lowered_below - raised_above))
        speed = raised_above[at] + (lowered_below[at] - raised_above[at]) / np.float32(2.0)
        if raised_above[at] < speed < lowered_below[at]:
            beside = [stage for stage in range(k - 1, k + 3) if 0 <= stage < len(table.stages)]
            readings += [(stage, paths[at], speed, _own(table, stage)) for stage in beside]
    return readings


def _paths(table: ControllerTable) -> Floats:
    """Both ends, one step inside and outside them, far outside, and three places between."""
    low, high = table.valid_range[0], table.valid_range[1]
    ends = [low, high, _next(low, -np.inf), _next(high, np.inf), _next(low, np.inf), _next(high, -np.inf)]
    inner = [low + (high - low) * np.float32(part) for part in (0.25, 0.5, 0.8125)]
    return np.array([*ends, *inner, low - np.float32(1000.0), high + np.float32(1000.0)], dtype=np.float32)


def _entrance_paths(table: ControllerTable) -> Floats:
    """Within the approach; then the entrance: its neighbours, those that every controller has, and both zeros."""
    middle = table.valid_range[0] * np.float32(0.5)
    paths = (middle, -LEAST_NORMAL, -SMALLEST, -0.0, 0.0, SMALLEST, LEAST_NORMAL)
    return np.array(paths, dtype=np.float32)


def _incredible_readings(table: ControllerTable) -> list[Reading]:
    """Readings that cannot be true, or only just can, at every stage; and stages that do not exist."""
    target = np.float32(table.target_speed_m_s)
    middle = (table.valid_range[0] + table.valid_range[1]) / np.float32(2.0)
    speeds = (np.nan, np.inf, -np.inf, -1.0, -SMALLEST, -0.0, 0.0, SMALLEST, LARGEST, -LARGEST)
    paths = (np.nan, np.inf, -np.inf, LARGEST, -LARGEST, SMALLEST, -SMALLEST, -0.0)
    readings: list[tuple[int, np.float32, np.float32]] = []
    for k in range(len(table.stages)):
        readings += [(k, middle, np.float32(v)) for v in speeds]
        for v in (np.float32(0.0), np.float32(100.0)):
            readings += [(k, np.float32(s), v) for s in paths]
    for k in (-1, len(table.stages), *STAGE_LIMITS):
        readings += [(k, middle, target), (k, middle, np.float32(100.0)), (k, middle, np.float32(0.0))]
    return [(*reading, _own(table, reading[0])) for reading in readings]


def _next(value: npt.NDArray[np.float32] | np.float32, towards: float) -> npt.NDArray[np.float32]:
    """The neighbouring float32 number."""
    return np.asarray(np.nextafter(value, np.float32(towards)), dtype=np.float32)


STEPS: Final = (lambda line: line, lambda line: _next(line, -np.inf), lambda line: _next(line, np.inf))
"""Speeds on a line, and one float32 step beside it."""

STEPS_AND_ASIDE: Final = (*STEPS, lambda line: line - ASIDE_M_S, lambda line: line + ASIDE_M_S)
