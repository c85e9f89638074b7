"""Small plants for the unlocked mode: one short retarder, a gondola."""

from __future__ import annotations

from dataclasses import replace

import pytest

from plant_models import EntrySpeed, Plant
from tests.synth.conftest import pilot_plant

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
