"""Stage-locked lines as lines of a chain that is asked at every sample."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from synth.solver.any_time.drive_modes import DriveModes
from synth.solver.switching_lines import SwitchingLines


def at_rest_only(lines: SwitchingLines, modes: DriveModes) -> NDArray[np.float64]:
    """`lines` by side, start of a path quantum and mode, (2, N, M): no command but at rest, there that of the stage."""
    rests = modes.rests[:, None]
    lower = np.where(rests, lines.lower_m_s[modes.stage], -np.inf)
    upper = np.where(rests, lines.upper_m_s[modes.stage], np.inf)
    return np.stack([lower[:, :-1].T, upper[:, :-1].T])
