"""Golden pulses of a table: pulse pairs where a wrong tracker or a wrong step shows, with the right answers.

A row stands for itself: state before, pair, answer, state after. Equal rows one by one make equal sequences of any
length. There are two kinds: for the whole step (`at_pulse`), the pairs of cuts, whole and with faults; for the tracker
alone (`believed_passage`), waits at which a pair is just believed and just not, and states and numbers that cannot be.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from itertools import pairwise, product
from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt

from tuning_tables.golden_vectors import LARGEST, SMALLEST
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.pulse_sequences import heard_cuts
from tuning_tables.passages.rule import held_by
from tuning_tables.programs.at_pulse import at_pulse
from tuning_tables.programs.held import NONE, HeldPassages
from tuning_tables.programs.tracker import LONGEST_WAIT_S, TRACKER, begin_cut, believed_passage

State: TypeAlias = tuple[float, ...]
Pulse: TypeAlias = tuple[State, bool, int, float, float, int, bool]
"""State before, whether it begins then, sensor, since, over base, stage, whether the change to it had ended."""
Floats: TypeAlias = npt.NDArray[np.float32]

MEMBERS: Final = tuple(TRACKER.members)
STATES: Final = [(f"before_{name}", "f4") for name in MEMBERS], [(name, "f4") for name in MEMBERS]

PULSE_ROW: Final = np.dtype(
    [*STATES[0], ("begins", "i4"), ("sensor", "i4"), ("since_s", "f4"), ("over_base_s", "f4"), ("stage", "i4"),
     ("transient_ended", "i4"), *STATES[1], ("wanted", "i4")]
)  # fmt: skip
"""State before, whether it begins then, what `at_pulse` is asked, by its parameters, state afterwards, its answer."""
PAIR_ROW: Final = np.dtype(
    [*STATES[0], ("sensor", "i4"), ("since_s", "f4"), ("reading_m_s", "f4"), *STATES[1], ("found", "i4")]
)
"""Likewise of `believed_passage`."""

BEGUN: Final[State] = (NONE, 0.0, 0.0, NONE, 0.0, 0.0)
USED: Final[State] = (1.0, 1.0, 1.0, 1.0, 1.0, 1.0)
LONGEST_S: Final = float(LONGEST_WAIT_S)
ROUNDS, FEW_ROUNDS = 3, 1
MOST_PULSES, FEW_PULSES = 600, 80
MOST_WAYS, FEW_WAYS = 24, 10


def golden_pulses(table: PassageTable) -> npt.NDArray[np.void]:
    """Rows of `PULSE_ROW`, about `MOST_PULSES`, evenly spread over `ROUNDS` cuts for each fault."""
    return np.append(_spread(_pulses(table, ROUNDS), MOST_PULSES), _silent_begin(table))


def few_golden_pulses(table: PassageTable) -> npt.NDArray[np.void]:
    """The same for a small controller: about `FEW_PULSES` of one cut for each fault."""
    return np.append(_spread(_pulses(table, FEW_ROUNDS), FEW_PULSES), _silent_begin(table))


def golden_pairs(table: PassageTable) -> npt.NDArray[np.void]:
    """Rows of `PAIR_ROW` for the tracker alone."""
    return paired(table, [*_edges(table, MOST_WAYS), *_odd_pairs(table)])


def few_golden_pairs(table: PassageTable) -> npt.NDArray[np.void]:
    """The same for a small controller."""
    return paired(table, [*_edges(table, FEW_WAYS), *_odd_pairs(table)])


def paired(table: PassageTable, asked: list[tuple[State, int, float, float]]) -> npt.NDArray[np.void]:
    """(state before, sensor, since, reading) with what the tracker makes of each."""
    held, rows = held_by(table), np.zeros(len(asked), dtype=PAIR_ROW)
    for row, (before, sensor, since_s, v_m_s) in zip(rows, asked, strict=True):
        row["sensor"], row["since_s"], row["reading_m_s"] = sensor, since_s, v_m_s
        state = _begin_row(row, before)
        row["found"] = believed_passage(held, state, sensor, row["since_s"], row["reading_m_s"])
        _end_row(row, state)
    return rows


def stepped(table: PassageTable, asked: list[Pulse]) -> npt.NDArray[np.void]:
    """The pulses with what the step makes of each."""
    held, rows = held_by(table), np.zeros(len(asked), dtype=PULSE_ROW)
    for row, (before, begins, sensor, since_s, over_base_s, stage, ended) in zip(rows, asked, strict=True):
        row["begins"], row["sensor"], row["since_s"], row["over_base_s"] = begins, sensor, since_s, over_base_s
        row["stage"], row["transient_ended"] = stage, ended
        state = _begin_row(row, before)
        if begins:
            begin_cut(state)
        row["wanted"] = at_pulse(held, state, sensor, row["since_s"], row["over_base_s"], stage, ended)
        _end_row(row, state)
    return rows


def _spread(rows: npt.NDArray[np.void], most: int) -> npt.NDArray[np.void]:
    return rows[:: -(-len(rows) // most)]


def _begin_row(row: np.void, before: State) -> Floats:
    for name, value in zip(MEMBERS, before, strict=True):
        row[f"before_{name}"] = value
    return np.array([row[f"before_{name}"] for name in MEMBERS], dtype=np.float32)


def _end_row(row: np.void, state: Floats) -> None:
    for name, value in zip(MEMBERS, state, strict=True):
        row[name] = value


def _pulses(table: PassageTable, rounds: int) -> npt.NDArray[np.void]:
    """Rounds of cuts with every fault in turn, each after the one before; a stage commanded is in force at once."""
    held, rows, state = held_by(table), [], np.array(USED, dtype=np.float32)
    for random, pairs in heard_cuts(table, rounds):
        stage, heard_s = table.initial_stage, 0.0
        for place, pair in enumerate(pairs):
            if random.random() < 0.3:
                stage = int(random.random() * len(table.pressure_kpa))
            since_s, heard_s, ended = pair.time_s - heard_s, pair.time_s, random.random() < 0.8
            rows.append((tuple(state.tolist()), place == 0, pair.sensor, since_s, pair.over_base_s, stage, ended))
            if place == 0:
                begin_cut(state)
            with np.errstate(over="ignore"):
                given = np.float32(since_s), np.float32(pair.over_base_s)
            stage = at_pulse(held, state, pair.sensor, *given, stage, ended)
    with np.errstate(over="ignore"):
        return stepped(table, rows)


def _silent_begin(table: PassageTable) -> npt.NDArray[np.void]:
    """A cut that begins with a pair of which one pulse is missing: the state shows that all of it was forgotten."""
    return stepped(table, [(USED, True, 0, 0.25, 0.0, table.initial_stage, True)])


def _edges(table: PassageTable, most: int) -> Iterator[tuple[State, int, float, float]]:
    """Waits between two passages at which the pair is first and last believed, and their float32 neighbours.

    Cuts that keep their speed, lose or gain some, crawl, and leave a crawl: so every bound of the way is the one that
    counts somewhere. Then, over the shortest ways, the least and the greatest speed that may follow.
    """
    count, held = len(table.heard_path_m), held_by(table)
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
        waits = [0.0, *np.geomspace(1e-3, 1e3, 61).tolist(), _way(table, here, there) / now_m_s, LONGEST_S]
        for since_s in _turning(partial(_is_believed, held, last, there, v_m_s=now_m_s), waits):
            yield (*last, *other) if place % 3 else (NONE, 0.0, 0.0, *last), sensor, since_s, now_m_s
    for here, there in sorted(ways, key=lambda each: _way(table, *each))[:3]:
        last, since_s = (here, usual, 0.0), float(np.float32(_way(table, here, there) / usual))
        readings = np.linspace(least, greatest, 41).tolist()
        for v_m_s in _turning(partial(_is_believed, held, last, there, since_s), readings):
            yield (*last, NONE, 0.0, 0.0), int(table.heard_sensor[there]), since_s, v_m_s


def _way(table: PassageTable, here: int, there: int) -> float:
    return float(table.heard_path_m[there] - table.heard_path_m[here])


def _is_believed(held: HeldPassages, last: State, there: int, since_s: float, v_m_s: float) -> bool:
    """Whether a pair of the sensor of `there` is believed where `last` alone was passed."""
    state = np.array((*last, NONE, 0.0, 0.0), dtype=np.float32)
    given = (int(held.sensor[there]), np.float32(since_s), np.float32(v_m_s))
    return bool(believed_passage(held, state, *given) != NONE)


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
    over = _beside(LONGEST_S, np.inf)
    for since_s in (0.0, -0.0, SMALLEST, -SMALLEST, LONGEST_S, over, LARGEST, np.nan, np.inf, -np.inf):
        yield from ((state, sensor, since_s, greatest) for state in (BEGUN, known))
    for other in (-1, -32768, 32767, len(table.sensors.path_m)):
        yield known, other, 0.5, greatest
    middle = 0.5 * (least + greatest)
    sound: State = (0, middle, 1.0, count - 1, middle, 2.0)
    wrong = {0: (count, -2), 1: (-SMALLEST, _beside(greatest, np.inf), np.nan), 2: (over, -1.0, np.nan, np.inf)}
    for place in range(6):
        for value in wrong[place % 3]:
            yield (*sound[:place], value, *sound[place + 1 :]), sensor, 0.25, middle
    yield sound, sensor, LONGEST_S, _beside(greatest, np.inf)
    for place, value in product((0, 3), (0.5, -0.5)):
        yield (*sound[:place], value, *sound[place + 1 :]), sensor, 0.25, middle


def _beside(value: float, towards: float) -> float:
    return float(np.nextafter(np.float32(value), np.float32(towards)))
