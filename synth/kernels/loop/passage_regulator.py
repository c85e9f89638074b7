"""Kernel of the regulator with point sensors: what a controller does at a pulse pair.

The step of the tables, with its tracker and rule, is compiled here unchanged, so that the loop is driven by what a
controller runs.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from synth.kernels.compiled_rules import compiled_rule
from synth.kernels.compiling import borrowing_inline
from synth.kernels.loop.passage_pulses import Pair
from tuning_tables.programs import at_pulse, tracker
from tuning_tables.programs.held import HeldPassages

Tracked = NDArray[np.float32]

NOT_HEARD, DECIDED, UNFINISHED, NOT_BELIEVED, NO_DECISION = 0, 1, 2, 3, 4
"""What came of a passage: never heard of, the rule was asked, a transient was unfinished, taken for no passage, taken
for a passage at which nothing is decided."""

STATE_FIELDS = len(tracker.TRACKER.members)

begin_cut = compiled_rule(tracker.begin_cut)
believed_passage = compiled_rule(tracker.believed_passage)
hear = compiled_rule(at_pulse.hear)
stage_after = compiled_rule(at_pulse.stage_after)
"""The step of a controller is `hear`, then `stage_after`."""


@borrowing_inline
def stage_at_passage(law: HeldPassages, heard: int, stage: int, v_m_s: float) -> int:
    """Digital controller: the stage wanted at the heard passage `heard` while `stage` is in force."""
    return int(stage_after(law, heard, stage, v_m_s, True))


@borrowing_inline
def stage_after_pair(
    law: HeldPassages, tracks: bool, state: Tracked, pair: Pair, since_s: float, stage: int, transient_ended: bool
) -> Any:
    """(stage wanted, heard passage that the pair is taken for or −1); without tracker the passage is told."""
    if tracks:
        heard, v = hear(law, state, pair.sensor, since_s, pair.over_s)
        return int(stage_after(law, heard, stage, v, transient_ended)), int(heard)
    return int(stage_after(law, pair.passage, stage, pair.read_m_s, transient_ended)), pair.passage


@borrowing_inline
def outcome_of(law: HeldPassages, taken_for: int, transient_ended: bool) -> int:
    """What comes of a pair that is taken for the heard passage `taken_for`."""
    if taken_for < 0:
        return NOT_BELIEVED
    if law.deciding[taken_for] < 0:
        return NO_DECISION
    return DECIDED if transient_ended else UNFINISHED
