"""Kernel of the regulator with point sensors: which passage a pulse pair is taken for, and which stage it then wants.

The tables' own rule and tracker are compiled here unchanged, so that the loop is driven by what a controller runs.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from synth.kernels.vector.borrowing import borrowing_inline
from tuning_tables.passages import rule, tracker

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

NOT_HEARD, DECIDED, UNFINISHED, NOT_BELIEVED = 0, 1, 2, 3
"""What came of a passage: never heard of, the rule was asked, a transient was unfinished, taken for no passage."""


class PassageLaw(NamedTuple):
    """A rule of switching speeds (`tuning_tables.passages.rule`) and, where `limits` is not empty, the tracker.

    `switching_m_s` float32 (M, K + 1, K); `path_m` float32 and `sensor_of` (M,) as the controller knows them; `limits`
    float32 (6,) or (0,). Without limits the regulator is told which passage each pulse pair is.
    """

    switching_m_s: NDArray[np.float32]
    entrance_stage: int
    before_entrance: int
    path_m: NDArray[np.float32]
    sensor_of: Ints
    limits: NDArray[np.float32]


wanted_stage = njit(cache=True, nogil=True)(rule.wanted_stage)
begin_cut = njit(cache=True, nogil=True)(tracker.begin_cut)
believed_passage = njit(cache=True, nogil=True)(tracker.believed_passage)


@borrowing_inline
def passage_of_pair(
    law: PassageLaw, state: NDArray[np.float32], sensor: int, since_s: float, v_m_s: float, true_passage: int
) -> int:
    """The passage that a pair heard from `sensor` is taken for, or −1; `state` is the tracker's."""
    if law.limits.shape[0] == 0:
        return true_passage
    return int(believed_passage(law.path_m, law.sensor_of, law.limits, state, sensor, since_s, v_m_s))


@borrowing_inline
def stage_at_passage(law: PassageLaw, passage: int, stage: int, v_m_s: float) -> int:
    """The stage that the rule wants at `passage`, where `v_m_s` was read while `stage` is in force."""
    return int(wanted_stage(law.switching_m_s, law.entrance_stage, law.before_entrance, passage, stage, v_m_s))
