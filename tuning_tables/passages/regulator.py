"""What a regulator does when an axle has rolled over a point sensor: the reading, the tracker and the rule as one step.

A controller calls it at the second pulse of every pair, whatever sensor it is of. The pair counts for the stage only if
the tracker believes it and the change of stage before it had ended by the middle of the reading; for the tracker it
counts in any case. All arithmetic is float32, one rounding an operation.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
import numpy.typing as npt

from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.rule import wanted_stage
from tuning_tables.passages.tracker import LONGEST_WAIT_S, believed_passage

NO_SPEED: Final = -1.0
SHORTEST_READING_S: Final = 2.0**-20
"""About 1 µs; a float32 number, so that it is the same bound in every language."""


class PassageRule(NamedTuple):
    """What the step needs of a table: arrays and numbers alone, so that numba takes it as it stands.

    `switching_m_s` float32 (M, K + 1, K), `entrance_stage` and `before_entrance` as `rule.wanted_stage` wants them;
    `path_m` float32 (T,), `sensor_of` int64 (T,) and `limits` float32 (6,) of all passages heard, as
    `tracker.believed_passage`; `passage_of` int64 (T,): which of the M passages a heard one is, −1 for one at which
    nothing is decided; `base_m` float32, distance of the two coils of a sensor.
    """

    switching_m_s: npt.NDArray[np.float32]
    entrance_stage: int
    before_entrance: int
    path_m: npt.NDArray[np.float32]
    sensor_of: npt.NDArray[np.int64]
    passage_of: npt.NDArray[np.int64]
    limits: npt.NDArray[np.float32]
    base_m: np.float32


def rule_of(table: PassageTable) -> PassageRule:
    """The rule of a table, as a controller holds it."""
    return PassageRule(
        table.switching_m_s,
        table.entrance_stage,
        table.before_entrance,
        table.heard_path_m,
        table.heard_sensor,
        table.heard_passage,
        table.limits,
        np.float32(table.sensors.base_m),
    )


def at_pulse(
    rule: PassageRule,
    state: npt.NDArray[np.float32],
    sensor: int,
    since_s: float,
    over_base_s: float,
    stage: int,
    transient_ended: bool,
) -> int:
    """The stage to command at the second pulse of a pair of `sensor`; `stage` itself: nothing is commanded.

    `state` float32 (6,) of the tracker, which is brought up to date; `since_s`: from the second pulse of the pair
    before, of whatever sensor, or from `begin_cut`, to this one; `over_base_s`: from the first pulse to the second;
    `stage` in force, the one commanded last; `transient_ended`: the change to it had ended by the middle of the two
    pulses. Raises nothing for any number.

    `numba.njit` compiles this text where `believed_passage` and `wanted_stage`, which are globals, are compiled:
    `types.FunctionType(at_pulse.__code__, {**vars(regulator), ...})`.
    """
    v = NO_SPEED
    if SHORTEST_READING_S <= over_base_s <= LONGEST_WAIT_S:
        v = float(rule.base_m / np.float32(over_base_s))
    heard = believed_passage(rule.path_m, rule.sensor_of, rule.limits, state, sensor, since_s, v)
    if heard < 0 or not transient_ended:
        return stage
    passage = rule.passage_of[heard]
    return wanted_stage(rule.switching_m_s, rule.entrance_stage, rule.before_entrance, passage, stage, v)
