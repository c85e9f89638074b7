"""What is asked of the exits of a case: one number of all passes on one plant."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from synth.problem.aim import OVERSPEED_M_S
from synth.simulation.passes import ExitSample

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Output:
    """`figure` makes the number from the exit errors (n,) and weights (n,) of the passes."""

    name: str
    title: str
    unit: str
    figure: Callable[[Floats, Floats], float]

    def of(self, sample: ExitSample, target_m_s: float) -> float:
        """The number of a sample; a stalled pass counts with exit speed 0, as in `exit_statistics`."""
        return self.figure(sample.exit_speed_m_s - target_m_s, sample.weight)


OUTPUTS: Final = (
    Output("rms_m_s", "rms exit error", "m/s", lambda e, w: math.sqrt(float(w @ e**2 / w.sum()))),
    Output("bias_m_s", "mean exit error", "m/s", lambda e, w: float(w @ e / w.sum())),
    Output(
        "overspeed", f"share over +{OVERSPEED_M_S:g} m/s", "1", lambda e, w: float(w @ (e > OVERSPEED_M_S) / w.sum())
    ),
)
"""The first is what the ranking is told by."""
