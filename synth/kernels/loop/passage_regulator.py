"""Kernel of the regulator with point sensors: what a controller does at a pulse pair.

The step of the tables, with its tracker and rule, is compiled here unchanged, so that the loop is driven by what a
controller runs.
"""

from __future__ import annotations

from types import FunctionType
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from synth.kernels.vector.borrowing import borrowing_inline
from tuning_tables.passages import regulator, rule, tracker
from tuning_tables.passages.regulator import PassageRule

Tracked = NDArray[np.float32]

NOT_HEARD, DECIDED, UNFINISHED, NOT_BELIEVED, NO_DECISION = 0, 1, 2, 3, 4
"""What came of a passage: never heard of, the rule was asked, a transient was unfinished, taken for no passage, taken
for a passage at which nothing is decided."""

TAKEN_FOR, STATE_FIELDS = 6, 7
"""Behind the six numbers of the tracker's state stands the heard passage that it took the last pair for, or −1."""

wanted_stage = njit(cache=True, nogil=True)(rule.wanted_stage)
begin_cut = njit(cache=True, nogil=True)(tracker.begin_cut)
believed_passage = njit(cache=True, nogil=True)(tracker.believed_passage)


@njit(cache=True, nogil=True)
def noted_passage(
    path_m: Tracked,
    sensor_of: NDArray[np.int64],
    limits: Tracked,
    state: Tracked,
    sensor: int,
    since_s: float,
    v_m_s: float,
) -> int:
    """`believed_passage`, which notes its answer too: the step tells only the stage."""
    found = believed_passage(path_m, sensor_of, limits, state, sensor, since_s, v_m_s)
    state[TAKEN_FOR] = found
    return int(found)


at_pulse = njit(cache=True, nogil=True)(
    FunctionType(
        regulator.at_pulse.__code__,
        {**vars(regulator), "believed_passage": noted_passage, "wanted_stage": wanted_stage},
    )
)


@borrowing_inline
def stage_at_passage(law: PassageRule, heard: int, stage: int, v_m_s: float) -> int:
    """Digital controller: the stage wanted at the heard passage `heard` while `stage` is in force, as in `at_pulse`."""
    passage = law.passage_of[heard]
    return int(wanted_stage(law.switching_m_s, law.entrance_stage, law.before_entrance, passage, stage, v_m_s))


@borrowing_inline
def stage_after_pair(
    law: PassageRule, tracks: bool, state: Tracked, sensor: int, since_s: float, over_base_s: float, reading_m_s: float,
    true_passage: int, stage: int, transient_ended: bool,
) -> Any:  # fmt: skip
    """(stage wanted, heard passage that the pair is taken for or −1); without tracker the passage is told."""
    if tracks:
        wanted = int(at_pulse(law, state, sensor, since_s, over_base_s, stage, transient_ended))
        return wanted, int(state[TAKEN_FOR])
    wanted = stage
    if transient_ended:
        wanted = stage_at_passage(law, true_passage, stage, reading_m_s)
    return wanted, true_passage


@borrowing_inline
def outcome_of(law: PassageRule, taken_for: int, transient_ended: bool) -> int:
    """What comes of a pair that is taken for the heard passage `taken_for`."""
    if taken_for < 0:
        return NOT_BELIEVED
    if law.passage_of[taken_for] < 0:
        return NO_DECISION
    return DECIDED if transient_ended else UNFINISHED
