"""Plants and laws of the unlocked mode.

Small plants for the unlocked mode: one short retarder, a gondola.
The exported table of surfaces, as the closed loop runs it.
Stage-locked lines as lines of a chain that is asked at every sample.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from plant_models import EntrySpeed, Plant
from synth.simulation.closed_loop import TableController
from synth.solver.any_time.drive_modes import DriveModes
from synth.solver.any_time.polynomial_surfaces import PolynomialSurfaces
from synth.solver.switching_lines import SwitchingLines
from synth.solver.tabulate import UNPREDICTED, tabulate
from tests.synth.conftest import pilot_plant
from tuning_tables import Estimator, Generator

VALVES = pilot_plant(22.0).position.pneumatics


def short_plant(stages: tuple[float, ...] = (0.0, 150.0, 300.0)) -> Plant:
    """22 t on one retarder of 8 m; friction and running resistance have no spread but along the path."""
    whole = pilot_plant(22.0)
    return replace(
        whole,
        position=replace(whole.position, name="one short retarder", zones_m=((0.0, 8.0),), stage_pressures_kpa=stages),
        cut=replace(whole.cut, allowed_stage=len(stages) - 1),
        resistance=replace(whole.resistance, std_n_per_kn=0.0),
        sensor=replace(whole.sensor, resolution_m_s=0.0),
        entry=EntrySpeed(4.0, 4.6),
    )


@pytest.fixture(scope="session")
def plant() -> Plant:
    """`short_plant` with three stages."""
    return short_plant()


ORIGIN = Generator("test", "0", "0" * 64), "surfaces", "2026-01-01T00:00:00Z"


def tabled(
    plant: Plant, surfaces: PolynomialSurfaces, estimator: Estimator | None = None, gauge_factor: float = 1.0
) -> TableController:
    """A regulator with the table of `surfaces`."""
    return TableController(tabulate(plant, surfaces, 3.0, UNPREDICTED, *ORIGIN, estimator), gauge_factor)


def at_rest_only(lines: SwitchingLines, modes: DriveModes) -> NDArray[np.float64]:
    """`lines` by side, start of a path quantum and mode, (2, N, M): no command but at rest, there that of the stage."""
    rests = modes.rests[:, None]
    lower = np.where(rests, lines.lower_m_s[modes.stage], -np.inf)
    upper = np.where(rests, lines.upper_m_s[modes.stage], np.inf)
    return np.stack([lower[:, :-1].T, upper[:, :-1].T])
