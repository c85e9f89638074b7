"""A small plant for refinement: one retarder of 12 m, three stages, everything random."""

from __future__ import annotations

import pytest

from plant_models import DopplerSensor, EntrySpeed, Friction, Plant, PressingForce
from tests.oracles.conftest import small_plant


@pytest.fixture(scope="session")
def plant() -> Plant:
    """Brake power to spare, friction CV 0.1, path noise 0.1 over 2 m, Doppler noise 0.05 m/s."""
    return small_plant(
        zones_m=((0.0, 12.0),),
        force=PressingForce(0.06, 50.0, (1.0, 0.9)),
        friction=Friction(0.10, 0.0, 0.10, 2.0),
        sensor=DopplerSensor(0.05, 0.04, 0.1, 0.02),
        entry=EntrySpeed(4.0, 5.0),
    )
