"""The decision at a passage by the checker's own count, and how far a cut can have rolled between two passages."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from itertools import takewhile
from typing import Final

from synth.checker.float32 import rounded
from synth.checker.passages.reading import PassageTable

LARGEST: Final = float.fromhex("0x1.fffffep+127")


def wanted(table: PassageTable, passage: int, stage: int, v_m_s: float) -> int:
    """The stage wanted at `passage` with `stage` in force, by counting the switching speeds on either side of v."""
    highest = len(table.pressures_kpa) - 1
    if not 0 <= passage < len(table.passages) or not 0 <= stage <= highest:
        return stage
    if not (math.isfinite(v_m_s) and 0.0 <= v_m_s <= LARGEST):
        return stage
    here = table.passages[passage]
    if here.path_m < 0.0:
        highest = max(stage, min(highest, table.entrance_stage))
    v, row = rounded(v_m_s), here.rows[stage]
    raised = leading(speed < v for speed in row[stage:highest])
    if raised:
        return stage + raised
    return stage - leading(speed > v for speed in reversed(row[:stage]))


def leading(answers: Iterable[bool]) -> int:
    """How many of the answers are true before the first that is not."""
    return sum(1 for _ in takewhile(bool, answers))


def passages_heard(sensors_m: Sequence[float], axles_m: Sequence[float]) -> list[tuple[float, int, int]]:
    """(path, sensor, axle) of every axle over every sensor, in the order of the path, then of the sensors."""
    return sorted(
        (place + offset, sensor, axle) for sensor, place in enumerate(sensors_m) for axle, offset in enumerate(axles_m)
    )
