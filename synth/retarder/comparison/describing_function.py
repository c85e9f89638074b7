"""The limit cycle between two stages as python-control's describing functions see it."""

from __future__ import annotations

import math
import warnings
from typing import TYPE_CHECKING

import numpy as np

from synth.retarder.comparison.limit_cycle import LimitCycle

if TYPE_CHECKING:
    from control import DescribingFunctionResponse


def describing_function_analysis(cycle: LimitCycle) -> DescribingFunctionResponse:
    """python-control's own analysis, to plot: relay with hysteresis, exact dead time, integrator.

    It knows one amplitude and one delay: both stages count as (rise + fall)/2 and both changes as delayed by
    the mean. The dead time is exact because the loop is given as frequency response data.
    """
    import control

    height, edge = 0.5 * (cycle.rise_m_s2 + cycle.fall_m_s2), 0.5 * max(0.0, cycle.gap_m_s)
    delay = 0.5 * (cycle.brake_delay_s + cycle.release_delay_s)
    fastest = 0.5 * math.pi / delay
    slowest = 0.5 * math.pi / (delay + edge * math.pi**2 / (8.0 * height))  # as arccos lies above its chord
    omega = np.linspace(0.9 * slowest, 1.1 * fastest, 400)
    loop = control.frd(np.exp(-1j * omega * delay) / (1j * omega), omega, smooth=True)
    largest = 4.0 * height / (math.pi * omega[0])
    amplitudes = np.linspace(max(1.0001 * edge, 0.1 * largest), 1.1 * largest, 80)
    relay = control.relay_hysteresis_nonlinearity(height, edge)
    with warnings.catch_warnings():
        # Where its search for more digits fails, the crossing on this fine a grid stands.
        warnings.filterwarnings("ignore", "not able to refine result", UserWarning)
        return control.describing_function_response(loop, relay, amplitudes, omega=omega)
