"""The decision at a passage: which stage the regulator wants when an axle has rolled over a sensor.

A passage has a row of K switching speeds t[0] ≤ … ≤ t[K − 1] for every stage in force; t[j] parts wanting stage j from
wanting stage j + 1. From the stage in force the regulator goes up while v > t[j], or down while v < t[j]; so a tie, v
equal to a switching speed, holds. A command may pass over several stages: a cut meets few sensors. −∞ below the stage
in force: never lower so far; +∞ from it on: never raise so far.

All comparisons are float32. Safe answer: where the speed is NaN, infinite or negative, or where there is no such
passage or stage, the stage in force is held; see `tuning_tables.rule` for why.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

LARGEST_READING: Final = 3.4028234663852886e38  # the largest float32 number


def wanted_stage(
    switching_m_s: npt.NDArray[np.float32],
    entrance_stage: int,
    before_entrance: int,
    passage: int,
    stage: int,
    v_m_s: float,
) -> int:
    """The stage wanted at `passage` while `stage` is in force and `v_m_s` was read; `stage` itself: hold.

    switching_m_s float32 (M, K + 1, K), rows not falling. At the first `before_entrance` passages no stage above
    `entrance_stage` is entered. Pure; raises nothing for any number. `numba.njit` compiles this text as it stands.
    """
    if not 0.0 <= v_m_s <= LARGEST_READING:  # written so that NaN fails it
        return stage
    if passage < 0 or passage >= switching_m_s.shape[0] or stage < 0 or stage >= switching_m_s.shape[1]:
        return stage
    v = np.float32(v_m_s)
    highest = switching_m_s.shape[2]
    if passage < before_entrance:
        highest = max(stage, min(highest, entrance_stage))
    wanted = stage
    while wanted < highest and v > switching_m_s[passage, stage, wanted]:
        wanted += 1
    if wanted > stage:
        return wanted
    while wanted > 0 and v < switching_m_s[passage, stage, wanted - 1]:
        wanted -= 1
    return wanted
