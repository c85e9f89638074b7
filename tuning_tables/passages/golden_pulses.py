"""Golden pulses of a table: pulse pairs where a wrong tracker or a wrong step shows, with the right answers.

A row stands for itself: state before, pair, state after, answer. Equal rows one by one make equal sequences of any
length. There are two kinds: for the whole step (`at_pulse`), the pairs of cuts, whole and with faults; for the tracker
alone (`believed_passage`), waits at which a pair is just believed and just not, and states and numbers that cannot be.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from itertools import pairwise
from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt

from tuning_tables.golden_vectors import LARGEST, SMALLEST
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.pulse_sequences import heard_cuts
from tuning_tables.passages.regulator import at_pulse, rule_of
from tuning_tables.passages.tracker import LONGEST_WAIT_S, NONE, begin_cut, believed_passage

State: TypeAlias = tuple[float, ...]
Floats: TypeAlias = npt.NDArray[np.float32]

STATE_FIELDS: Final = ("passage", "v_m_s", "time_s", "rival", "rival_m_s", "rival_s")
NEW_FIELDS: Final = tuple(f"new_{name}" for name in STATE_FIELDS)
WHOLE: Final = ("passage", "rival", "new_passage", "new_rival", "sensor", "stage", "ended", "answer")
"""Fields that are whole numbers; the others are float32."""

PULSE_ROW: Final = np.dtype(
    [(name, np.int32 if name in WHOLE else np.float32)
     for name in (*STATE_FIELDS, "sensor", "since_s", "over_base_s", "stage", "ended", *NEW_FIELDS, "answer")]
)  # fmt: skip
PAIR_ROW: Final = np.dtype(
    [(name, np.int32 if name in WHOLE else np.float32)
     for name in (*STATE_FIELDS, "sensor", "since_s", "reading_m_s", *NEW_FIELDS, "answer")]
)  # fmt: skip

BEGUN: Final[State] = (NONE, 0.0, 0.0, NONE, 0.0, 0.0)
ROUNDS, FEW_ROUNDS = 3, 1
MOST_PULSES, FEW_PULSES = 600, 80
MOST_WAYS, FEW_WAYS = 24, 10


def golden_pulses(table: PassageTable) -> npt.NDArray[np.void]:
    """Rows of `PULSE_ROW`, at most `MOST_PULSES`, evenly spread over `ROUNDS` cuts for each fault."""
    return _spread(_pulses(table, ROUNDS), MOST_PULSES)


def few_golden_pulses(table: PassageTable) -> npt.NDArray[np.void]:
    """The same for a small controller: at most `FEW_PULSES` of one cut for each fault."""
    return _spread(_pulses(table, FEW_ROUNDS), FEW_PULSES)


def golden_pairs(table: PassageTable) -> npt.NDArray[np.void]:
    """Rows of `PAIR_ROW` for the tracker alone."""
    return paired(table, [*_edges(table, MOST_WAYS), *_odd_pairs(table)])


def few_golden_pairs(table: PassageTable) -> npt.NDArray[np.void]:
    """The same for a small controller."""
    return paired(table, [*_edges(table, FEW_WAYS), *_odd_pairs(table)])


def paired(table: PassageTable, asked: list[tuple[State, int, float, float]]) -> npt.NDArray[np.void]:
    """(state before, sensor, since, reading) with what the tracker makes of each."""
    rows = np.zeros(len(asked), dtype=PAIR_ROW)
    for row, (before, sensor, since_s, v_m_s) in zip(rows, asked, strict=True):
        row["sensor"], row["since_s"], row["reading_m_s"] = sensor, since_s, v_m_s
        state = _begin_row(row, before)
        given = (float(row["since_s"]), float(row["reading_m_s"]))
        row["answer"] = believed_passage(table.heard_path_m, table.heard_sensor, table.limits, state, sensor, *given)
        _end_row(row, state)
    return rows


def stepped(table: PassageTable, asked: list[tuple[State, int, float, float, int, bool]]) -> npt.NDArray[np.void]:
    """(state before, sensor, since, time over the base, stage, ended) with what the step makes of each."""
    rows = np.zeros(len(asked), dtype=PULSE_ROW)
    rule = rule_of(table)
    for row, (before, sensor, since_s, over_base_s, stage, ended) in zip(rows, asked, strict=True):
        row["sensor"], row["since_s"], row["over_base_s"] = sensor, since_s, over_base_s
        row["stage"], row["ended"] = stage, ended
        state = _begin_row(row, before)
        given = (float(row["since_s"]), float(row["over_base_s"]))
        row["answer"] = at_pulse(rule, state, sensor, *given, stage, ended)
        _end_row(row, state)
    return rows


def _spread(rows: npt.NDArray[np.void], most: int) -> npt.NDArray[np.void]:
    return rows[:: -(-len(rows) // most)]


def _begin_row(row: np.void, before: State) -> Floats:
    for name, value in zip(STATE_FIELDS, before, strict=True):
        row[name] = value
    return np.array([row[name] for name in STATE_FIELDS], dtype=np.float32)


def _end_row(row: np.void, state: Floats) -> None:
    for name, value in zip(NEW_FIELDS, state, strict=True):
        row[name] = value


def _pulses(table: PassageTable, rounds: int) -> npt.NDArray[np.void]:
    """Rounds of cuts with every fault in turn, each from `begin_cut` on; a stage commanded is in force at once."""
    rule, rows = rule_of(table), []
    for random, pairs in heard_cuts(table, rounds):
        state, stage, heard_s = np.zeros(6, dtype=np.float32), table.initial_stage, 0.0
        begin_cut(state)
        for pair in pairs:
            if random.random() < 0.3:
                stage = int(random.random() * len(table.pressure_kpa))
            since_s, heard_s, ended = pair.time_s - heard_s, pair.time_s, random.random() < 0.8
            rows.append((tuple(state.tolist()), pair.sensor, since_s, pair.over_base_s, stage, ended))
            with np.errstate(over="ignore"):
                given = (float(np.float32(since_s)), float(np.float32(pair.over_base_s)))
            stage = at_pulse(rule, state, pair.sensor, *given, stage, ended)
    with np.errstate(over="ignore"):
        return stepped(table, rows)


def _edges(table: PassageTable, most: int) -> Iterator[tuple[State, int, float, float]]:
    """Waits between two passages at which the pair is first and last believed, and their float32 neighbours.

    Cuts that keep their speed, lose or gain some, crawl, and leave a crawl: so every bound of the way is the one that
    counts somewhere. Then, over the shortest ways, the least and the greatest speed that may follow.
    """
    count = len(table.heard_path_m)
    ways = [(here, there) for here in range(count) for there in range(here + 1, min(here + 4, count))]
    least, greatest = map(float, table.limits[:2])
    usual, crawl = min(max(table.target_speed_m_s, least), greatest), min(1.25 * least, greatest)
    lower, higher = max(0.8 * usual, least), min(1.25 * usual, greatest)
    speeds = ((usual, usual), (usual, lower), (usual, higher), (crawl, crawl), (crawl, lower))
    for place, (here, there) in enumerate(ways[:: -(-len(ways) // most) if ways else 1]):
        before_m_s, now_m_s = speeds[place % len(speeds)]
        sensor = int(table.heard_sensor[there])
        other = (NONE, 0.0, 0.0) if place % 2 else (count - 1, least, 1.0)
        last = (here, before_m_s, 0.0)
        waits = [0.0, *np.geomspace(1e-3, 1e3, 61).tolist(), _way(table, here, there) / now_m_s, LONGEST_WAIT_S]
        for since_s in _turning(partial(_is_believed, table, last, there, v_m_s=now_m_s), waits):
            yield (*last, *other) if place % 3 else (NONE, 0.0, 0.0, *last), sensor, since_s, now_m_s
    for here, there in sorted(ways, key=lambda each: _way(table, *each))[:3]:
        last, since_s = (here, usual, 0.0), float(np.float32(_way(table, here, there) / usual))
        readings = np.linspace(least, greatest, 41).tolist()
        for v_m_s in _turning(partial(_is_believed, table, last, there, since_s), readings):
            yield (*last, NONE, 0.0, 0.0), int(table.heard_sensor[there]), since_s, v_m_s


def _way(table: PassageTable, here: int, there: int) -> float:
    return float(table.heard_path_m[there] - table.heard_path_m[here])


def _is_believed(table: PassageTable, last: State, there: int, since_s: float, v_m_s: float) -> bool:
    """Whether a pair of the sensor of `there` is believed where `last` alone was passed."""
    state = np.array((*last, NONE, 0.0, 0.0), dtype=np.float32)
    given = (int(table.heard_sensor[there]), since_s, float(np.float32(v_m_s)))
    return believed_passage(table.heard_path_m, table.heard_sensor, table.limits, state, *given) != NONE


def _turning(is_so: Callable[[float], bool], values: list[float]) -> Iterator[float]:
    """The neighbours on both sides of every float32 number, among those of `values`, at which `is_so` changes."""
    for before, after in pairwise(sorted(float(np.float32(value)) for value in values)):
        if is_so(before) != is_so(after):
            yield from _last_and_next(is_so, before, after)


def _last_and_next(is_so: Callable[[float], bool], before: float, after: float) -> tuple[float, float]:
    """The two neighbouring float32 numbers, >= 0, between which `is_so` changes, by halving."""
    low, high = (int(np.float32(value).view(np.uint32)) for value in (before, after))
    first = is_so(before)
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if is_so(_of_bits(middle)) == first else (low, middle)
    return _of_bits(low), _of_bits(high)


def _of_bits(bits: int) -> float:
    return float(np.uint32(bits).view(np.float32))


def _odd_pairs(table: PassageTable) -> Iterator[tuple[State, int, float, float]]:
    """Speeds at and beside the limits, times that are none, no such sensor, states that cannot be."""
    count, (least, greatest) = len(table.heard_path_m), (float(each) for each in table.limits[:2])
    sensor, known = int(table.heard_sensor[-1]), (0, greatest, 0.5, NONE, 0.0, 0.0)
    speeds = [least, greatest, _beside(least, 0.0), _beside(greatest, np.inf), -0.0, 0.0, -1.0, LARGEST, SMALLEST]
    for v in (*speeds, np.nan, np.inf, -np.inf):
        yield from ((state, sensor, 0.5, v) for state in (BEGUN, known))
    over = _beside(LONGEST_WAIT_S, np.inf)
    for since_s in (0.0, -0.0, SMALLEST, -SMALLEST, LONGEST_WAIT_S, over, LARGEST, np.nan, np.inf, -np.inf):
        yield from ((state, sensor, since_s, greatest) for state in (BEGUN, known))
    for other in (-1, -32768, 32767, len(table.sensors.path_m)):
        yield known, other, 0.5, greatest
    middle = 0.5 * (least + greatest)
    sound: State = (0, middle, 1.0, count - 1, middle, 2.0)
    wrong = {0: (count, -2), 1: (-SMALLEST, _beside(greatest, np.inf), np.nan), 2: (over, -1.0, np.nan, np.inf)}
    for place in range(6):
        for value in wrong[place % 3]:
            yield (*sound[:place], value, *sound[place + 1 :]), sensor, 0.25, middle
    yield sound, sensor, LONGEST_WAIT_S, _beside(greatest, np.inf)


def _beside(value: float, towards: float) -> float:
    return float(np.nextafter(np.float32(value), np.float32(towards)))
