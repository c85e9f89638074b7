"""How far a pass has gone wrong, as a function of its random numbers alone."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from synth.simulation.closed_loop import ClosedLoop, Controller
from synth.simulation.random_passes import RandomPasses

PassScore = Callable[[RandomPasses], NDArray[np.float64]]
"""Random passes → score (n,); the rare event is a score above a limit. Must be safe to call from threads."""


def exit_error(loop: ClosedLoop, controller: Controller, target_speed_m_s: float) -> PassScore:
    """Exit speed − target in m/s; a stalled pass has exit speed 0."""

    def score(passes: RandomPasses) -> NDArray[np.float64]:
        return loop.run(controller, loop.draws(passes)).exit_speed_m_s - target_speed_m_s

    return score
