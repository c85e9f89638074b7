"""Stage-locked lines as surfaces, and surfaces as the lines at the starts of the path quanta."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from scripts.studies.any_time.switching_surfaces import SwitchingSurfaces
from synth.solver.any_time.drive_modes import DriveModes
from synth.solver.switching_lines import SwitchingLines


def at_rest_only(lines: SwitchingLines, modes: DriveModes) -> SwitchingSurfaces:
    """Stage-locked `lines` as surfaces: no command but at rest, there that of the stage's lines."""
    rests = modes.rests[:, None]
    lower = np.where(rests, lines.lower_m_s[modes.stage], -np.inf)
    upper = np.where(rests, lines.upper_m_s[modes.stage], np.inf)
    return SwitchingSurfaces(modes, np.array(lines.nodes_m), lower, upper)


def at_quanta(surfaces: SwitchingSurfaces) -> NDArray[np.float64]:
    """The lines by side, start of a path quantum and mode, (2, N, M)."""
    return np.stack([surfaces.lower_m_s[:, :-1].T, surfaces.upper_m_s[:, :-1].T])
