"""Pulse pairs of many cuts and arbitrary ones, and what the Python text makes of each, compiled."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
from numba import njit

from synth.kernels.compiled_rules import compiled_rule
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.pulse_sequences import heard_cuts
from tuning_tables.passages.rule import held_by
from tuning_tables.programs.at_pulse import at_pulse, wanted_stage
from tuning_tables.programs.held import HeldPassages
from tuning_tables.programs.tracker import LONGEST_WAIT_S, begin_cut, believed_passage

ON, BEGIN, GIVEN, PAIR = range(4)
"""The tracker goes on, begins, or is given; PAIR: it is given, and asked alone with the reading `v_m_s`."""

QUESTION = np.dtype(
    [("table", "i4"), ("mode", "i4"), ("tracker", "f4", 6), ("sensor", "i4"), ("since_s", "f4"), ("over_base_s", "f4"),
     ("stage", "i4"), ("ended", "i4"), ("passage", "i4"), ("v_m_s", "f4")]
)  # fmt: skip
"""`passage`, `stage` and `v_m_s` are put to the rule alone, too."""

ANSWER = np.dtype([("stage", "i4"), ("tracker", "f4", 6), ("wanted", "i4")])
"""`stage`: of the step, or for PAIR the passage."""

Rows = npt.NDArray[np.void]


def asked(tables: tuple[PassageTable, ...], count: int, seed: int) -> Rows:
    """At least `count` questions: of each table as many pairs of cuts as arbitrary ones, in the order of the tables."""
    each = -(-count // (2 * len(tables)))
    parts = []
    for number, table in enumerate(tables):
        parts += [_cuts(table, each, seed + number), _arbitrary(table, each, seed + number)]
        for part in parts[-2:]:
            part["table"] = number
    return np.concatenate(parts)


def _cuts(table: PassageTable, count: int, seed: int) -> Rows:
    """The pairs of cuts with every fault in turn."""
    rng, rounds = np.random.default_rng(seed), 0
    rows: list[tuple[int, int, float, float]] = []
    while len(rows) < count:
        rounds += 1
        for _, pairs in heard_cuts(table, 1, 1000 * seed + rounds):
            heard_s = 0.0
            for place, pair in enumerate(pairs):
                rows.append((BEGIN if place == 0 else ON, pair.sensor, pair.time_s - heard_s, pair.over_base_s))
                heard_s = pair.time_s
    found = np.zeros(len(rows), QUESTION)
    with np.errstate(over="ignore"):
        for name, column in zip(("mode", "sensor", "since_s", "over_base_s"), zip(*rows, strict=True), strict=True):
            found[name] = column
    _decisions(table, found, rng)
    return found


def _arbitrary(table: PassageTable, count: int, seed: int) -> Rows:
    """States that can be, one in ten with something that cannot; likely pairs, one number in ten of any bits."""
    rng = np.random.default_rng(seed + 7919)
    found, heard = np.zeros(count, QUESTION), len(table.heard_path_m)
    least, greatest = map(float, table.limits[:2])

    def numbers(low: float, high: float, special: tuple[float, ...]) -> npt.NDArray[np.uint32]:
        with np.errstate(over="ignore"):
            near = np.array(special, np.float32)[rng.integers(0, len(special), count)]
            edges = np.nextafter(near, rng.choice([-9, 0, 9], count).astype(np.float32))
            chosen = np.where(rng.random(count) < 0.06, edges, rng.uniform(low, high, count).astype(np.float32))
        return np.where(rng.random(count) < 0.02, rng.integers(0, 2**32, count, np.uint32), chosen.view(np.uint32))

    found["mode"] = rng.choice([GIVEN, PAIR], count)
    for first in (0, 3):
        found["tracker"][:, first] = rng.integers(-1, heard, count)
        found["tracker"][:, first + 1] = numbers(least, greatest, (0.0, greatest)).view(np.float32)
        found["tracker"][:, first + 2] = numbers(0.0, 4.0, (0.0, float(LONGEST_WAIT_S))).view(np.float32)
        wrong = rng.random(count) < 0.02
        impossible = (-2.0, -0.5, 0.5, heard - 0.5, heard, 32767.0, 1e30, np.nan, np.inf)
        found["tracker"][wrong, first] = rng.choice(impossible, wrong.sum())
    found["sensor"] = rng.integers(-1, len(table.sensors.path_m) + 1, count)
    found["since_s"] = numbers(0.0, 4.0, (0.0, float(LONGEST_WAIT_S), np.inf)).view(np.float32)
    speeds = numbers(0.7 * least, 1.1 * greatest, (least, greatest)).view(np.float32)
    with np.errstate(all="ignore"):
        bases = np.float32(table.sensors.base_m) / speeds
    shortest = numbers(0.0, 2.0, (0.0, 2.0**-20, float(LONGEST_WAIT_S), np.inf)).view(np.float32)
    found["over_base_s"] = np.where(rng.random(count) < 0.2, shortest, bases)
    _decisions(table, found, rng)
    return found


def _decisions(table: PassageTable, found: Rows, rng: np.random.Generator) -> None:
    """Stages, and readings of the rule alone: half of them on a switching speed or one float32 step beside it."""
    count, stages = len(found), len(table.pressure_kpa)
    found["ended"] = rng.random(count) < 0.8
    found["stage"] = rng.integers(0, stages, count)
    found["passage"] = rng.integers(0, len(table.passages), count)
    threshold = rng.integers(0, stages - 1, count)
    speed = table.switching_m_s[found["passage"], found["stage"], threshold]
    with np.errstate(over="ignore"):
        beside = np.nextafter(speed, rng.choice([-np.inf, np.inf], count).astype(np.float32))
    beside = np.where(rng.random(count) < 0.3, speed, beside)
    least, greatest = map(float, table.limits[:2])
    likely = rng.uniform(least, greatest, count).astype(np.float32)
    any_bits = rng.integers(0, 2**32, count, np.uint32).view(np.float32)
    kind = rng.random(count)
    found["v_m_s"] = np.select([kind < 0.5, kind < 0.9], [beside, likely], any_bits)
    for name, outside in (("stage", (-1, stages, -32768, 32767)), ("passage", (-1, len(table.passages), 32767))):
        wrong = rng.random(count) < 0.02
        found[name][wrong] = rng.choice(outside, wrong.sum())


def right(tables: tuple[PassageTable, ...], questions: Rows) -> Rows:
    """The answers of the Python text to `questions`."""
    believed, wanted, step, begin = map(compiled_rule, (believed_passage, wanted_stage, at_pulse, begin_cut))

    @njit
    def all_answers(table: HeldPassages, whole: Any, numbers: Any, states: Any, stages: Any, trackers: Any) -> None:
        state = np.zeros(6, np.float32)
        for i in range(len(whole)):
            mode, sensor, stage, ended, passage = whole[i]
            since_s, over_base_s, v_m_s = numbers[i]
            if mode == BEGIN:
                begin(state)
            elif mode != ON:
                state[:] = states[i]
            if mode == PAIR:
                stages[i, 0] = believed(table, state, sensor, since_s, v_m_s)
            else:
                stages[i, 0] = step(table, state, sensor, since_s, over_base_s, stage, ended != 0)
            stages[i, 1] = wanted(table, passage, stage, v_m_s)
            trackers[i] = state

    answers = np.zeros(len(questions), ANSWER)
    for number, table in enumerate(tables):
        chosen = questions["table"] == number
        part = questions[chosen]
        whole = np.stack([part[name].astype(np.int64) for name in ("mode", "sensor", "stage", "ended", "passage")], 1)
        with np.errstate(invalid="ignore"):  # a signalling NaN is widened
            numbers = np.stack([part[name].astype(np.float64) for name in ("since_s", "over_base_s", "v_m_s")], 1)
        stages, trackers = np.zeros((len(part), 2), np.int64), np.zeros((len(part), 6), np.float32)
        all_answers(held_by(table), whole, numbers, part["tracker"].copy(), stages, trackers)
        here = np.zeros(len(part), ANSWER)
        here["stage"], here["tracker"], here["wanted"] = stages[:, 0], trackers, stages[:, 1]
        answers[chosen] = here
    return answers
