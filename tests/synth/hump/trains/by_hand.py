"""Trains that are worked out by hand: cars without resistance on flat track, one switch.

The first axle of such a car is 5.5 m behind the crest when it is let go, the last one 5.5 m ahead of it.
"""

from __future__ import annotations

from dataclasses import replace

from tests.synth.hump.trains.made_slow_trains import LEAD, LEFT_TRACK, RIGHT_TRACK, one_switch
from tests.synth.hump.trains.slow_humping import humped_slowly
from tests.synth.hump.trains.slow_train import Kind, SlowCut, SlowRun, SlowTrain

FREE = {LEFT_TRACK: 300.0, RIGHT_TRACK: 300.0}
REDUCED_GRAVITY = 9.81 / (1.0 + 0.42 * 2 / 80.0)
FIRST_BEHIND_M, BASE_M, HALF_M, LENGTH_M = 5.5, 11.0, 7.0, 14.0
FROM_M, TO_M, FOULING_PLACE_M, TRACK_FROM_M = 40.0, 51.0, 72.0, 86.0


def run(*cuts: SlowCut, free_to_m: dict[int, float] | None = None) -> SlowRun:
    return humped_slowly(one_switch(), SlowTrain(cuts, LEAD, free_to_m or FREE))


def alarms(found: SlowRun) -> set[tuple[str, int, int]]:
    """What happened but couplings and gaps."""
    return {each for each in found.outcome() if each[0] not in (Kind.COUPLED.value, Kind.GAP.value)}


def stopping(cut: SlowCut, path_m: float) -> SlowCut:
    """The cut with the resistance that stops it `path_m` behind the place where it is let go."""
    w0 = 1e3 * 0.5 * cut.hump_speed_m_s**2 / (REDUCED_GRAVITY * path_m)
    return replace(cut, body=replace(cut.body, w0_n_per_kn=w0))
