"""Small plants for the unlocked mode: one short retarder, a gondola."""

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

VALVES = Pneumatics(700.0, 0.0, 0.1, 0.2, 0.1, 0.3, 0.3, 15.0)


def short_plant(stages: tuple[float, ...] = (0.0, 150.0, 300.0)) -> Plant:
    """22 t on one retarder of 8 m; friction and running resistance have no spread but along the path."""
    position = RetarderPosition(
        name="one short retarder",
        zones_m=((0.0, 8.0),),
        stage_pressures_kpa=stages,
        force=PressingForce(20.0 / 550.0, 50.0),
        pneumatics=VALVES,
        max_entry_speed_m_s=7.0,
    )
    return Plant(
        position=position,
        cut=Cut("Л", 22.0, (0.0, 1.85, 8.65, 10.5), len(stages) - 1),
        profile=TrackProfile.uniform(8.0),
        friction=Friction(common_cv=0.15, axle_cv=0.0, path_std=0.10, correlation_length_m=2.0),
        resistance=RollingResistance(1.75, 0.0),
        sensor=DopplerSensor(0.05, 0.0, 0.1, 0.02),
        entry=EntrySpeed(4.0, 4.6),
    )


@pytest.fixture(scope="session")
def plant() -> Plant:
    """`short_plant` with three stages."""
    return short_plant()
