"""Pulse pairs of cuts over the sensors of a table, whole and with faults: what a self-test lets a controller hear.

A cut rolls with constant deceleration from pass to pass; nothing here knows the tracker. Equal tables give equal pairs.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from random import Random
from types import MappingProxyType
from typing import Final, TypeAlias

from tuning_tables.passages.passage_table import PassageTable


@dataclass(frozen=True)
class PulsePair:
    """A pair heard of `sensor`: time of its second pulse, s, time between its pulses, s."""

    sensor: int
    time_s: float
    over_base_s: float


Pairs: TypeAlias = list[PulsePair]
Fault: TypeAlias = Callable[[Random, PassageTable, Pairs], Pairs]

SLOWEST_M_S: Final = 0.05
ODD_TIMES_S: Final = (math.nan, math.inf, -math.inf, -0.1, 0.0, 1e-9, 1e-38, 2.0**-20, 1e6, 1.0000001e6, 3e38)


def true_pairs(table: PassageTable, first_m_s: float, deceleration_m_s2: float) -> Pairs:
    """Every pair of a cut that has `first_m_s` at the first sensor: of all axles, also behind the exit."""
    met = table.sensors.heard(table.cut.axle_offsets_m)
    pairs, time_s, before_m, v = [], 1.0, met[0][2], first_m_s
    for sensor, _, path_m in met:
        squared = v * v - 2.0 * deceleration_m_s2 * (path_m - before_m)
        now = math.sqrt(squared) if squared > SLOWEST_M_S**2 else SLOWEST_M_S
        time_s += 2.0 * (path_m - before_m) / (v + now)
        pairs.append(PulsePair(sensor, time_s, table.sensors.base_m / now))
        before_m, v = path_m, now
    return pairs


def _lost(random: Random, _table: PassageTable, pairs: Pairs) -> Pairs:
    return [pair for pair in pairs if random.random() < 0.6]


def _extra(random: Random, table: PassageTable, pairs: Pairs) -> Pairs:
    """One in two pairs has another one before it, of any sensor or of none."""
    made = list(pairs)
    for pair in pairs:
        if random.random() < 0.5:
            sensor = int(random.random() * (len(table.sensors.path_m) + 1))
            late_s, over_s = random.random() * 1.5, (0.2 + random.random()) * pair.over_base_s
            made.append(PulsePair(sensor, max(pair.time_s - late_s, 0.0), over_s))
    return made


def _false_first(random: Random, table: PassageTable, pairs: Pairs) -> Pairs:
    """A pair of a later sensor before all others: the regulator has to change its mind."""
    return [PulsePair(len(table.sensors.path_m) - 1 - int(2 * random.random()), 0.25, pairs[0].over_base_s), *pairs]


def _swapped(random: Random, table: PassageTable, pairs: Pairs) -> Pairs:
    """Two neighbouring sensors have their cables exchanged."""
    one = int(random.random() * max(len(table.sensors.path_m) - 1, 1))
    other = {one: one + 1, one + 1: one}
    return [replace(pair, sensor=other.get(pair.sensor, pair.sensor)) for pair in pairs]


def _late(random: Random, _table: PassageTable, pairs: Pairs) -> Pairs:
    return [replace(pair, time_s=pair.time_s + (random.random() if random.random() < 0.4 else 0.0)) for pair in pairs]


def _doubled(random: Random, _table: PassageTable, pairs: Pairs) -> Pairs:
    return pairs + [replace(pair, time_s=pair.time_s + 0.05) for pair in pairs if random.random() < 0.5]


def _mismeasured(random: Random, _table: PassageTable, pairs: Pairs) -> Pairs:
    """Noise, and one in three readings is no speed."""
    changed = []
    for pair in pairs:
        noise = 1.0 + 0.1 * (random.random() - 0.5)
        odd = ODD_TIMES_S[int(random.random() * len(ODD_TIMES_S))]
        changed.append(replace(pair, over_base_s=odd if random.random() < 0.3 else noise * pair.over_base_s))
    return changed


def _whole(_random: Random, _table: PassageTable, pairs: Pairs) -> Pairs:
    return pairs


FAULTS: Final[Mapping[str, Fault]] = MappingProxyType(
    {
        "whole": _whole,
        "lost": _lost,
        "extra": _extra,
        "false first": _false_first,
        "swapped": _swapped,
        "late": _late,
        "doubled": _doubled,
        "mismeasured": _mismeasured,
    }
)


def heard_cuts(table: PassageTable, rounds: int, seed: int = 1) -> Iterator[tuple[Random, Pairs]]:
    """For every fault and round a cut, its pairs in the order of time, and the random numbers to go on with.

    Only `Random.random` is used: its numbers are the same in every version of Python.
    """
    greatest = table.plausible.speed_m_s[1]
    for place, fault in enumerate(FAULTS.values()):
        for number in range(rounds):
            random = Random(seed * 1_000_003 + place * 1009 + number)
            first = min((0.7 + 2.0 * random.random()) * table.target_speed_m_s, 1.05 * greatest)
            ahead = max(float(table.heard_path_m[-1] - table.heard_path_m[0]), 1.0)
            steady = random.random() * (first**2 - (0.3 * first) ** 2) / (2.0 * ahead)
            yield random, sorted(fault(random, table, true_pairs(table, first, steady)), key=lambda pair: pair.time_s)
