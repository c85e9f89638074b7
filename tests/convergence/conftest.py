"""A small plant for refinement: one retarder of 12 m, three stages, everything random."""

from __future__ import annotations

import pytest

from plant_models import (
    Cut,
    DopplerSensor,
    EntrySpeed,
    Friction,
    Plant,
    Pneumatics,
    PressingForce,
    RetarderPosition,
    RollingResistance,
    TrackProfile,
)


@pytest.fixture(scope="session")
def plant() -> Plant:
    """Brake power to spare, friction CV 0.1, path noise 0.1 over 2 m, Doppler noise 0.05 m/s."""
    position = RetarderPosition(
        "small",
        ((0.0, 12.0),),
        (0.0, 200.0, 400.0),
        PressingForce(0.06, 50.0, (1.0, 0.9)),
        Pneumatics(700.0, 0.0, 0.07, 0.12, 0.09, 0.25, 0.2, 15.0),
        7.0,
    )
    return Plant(
        position,
        Cut("С", 20.0, (0.0, 1.5), 2),
        TrackProfile.uniform(8.0),
        Friction(0.10, 0.0, 0.10, 2.0),
        RollingResistance(1.5, 0.0),
        DopplerSensor(0.05, 0.04, 0.1, 0.02),
        EntrySpeed(4.0, 5.0),
    )
