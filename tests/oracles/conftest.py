"""A small plant whose every number a test may choose: one retarder, short cut, few stages."""

from __future__ import annotations

from collections.abc import Callable

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

DRIVE = Pneumatics(
    supply_pressure_kpa=700.0,
    exhaust_pressure_kpa=0.0,
    brake_delay_s=0.07,
    touch_delay_s=0.12,
    release_delay_s=0.09,
    fill_time_constant_s=0.25,
    exhaust_time_constant_s=0.2,
    dead_band_kpa=15.0,
)

PADS = PressingForce(0.05, 50.0, (1.0, 0.9))
GRADE = TrackProfile.uniform(8.0)
EVEN = Friction(0.0, 0.0, 0.0, 2.0)
KNOWN_RUNNER = RollingResistance(1.5, 0.0)
TRUE_SENSOR = DopplerSensor(0.0, 0.0, 0.1, 0.02)
ENTRY = EntrySpeed(3.5, 4.5)


def small_plant(
    *,
    zones_m: tuple[tuple[float, float], ...] = ((0.0, 4.0),),
    stages_kpa: tuple[float, ...] = (0.0, 200.0, 400.0),
    force: PressingForce = PADS,
    pneumatics: Pneumatics = DRIVE,
    mass_t: float = 20.0,
    axles_m: tuple[float, ...] = (0.0, 1.5),
    profile: TrackProfile = GRADE,
    friction: Friction = EVEN,
    resistance: RollingResistance = KNOWN_RUNNER,
    sensor: DopplerSensor = TRUE_SENSOR,
    entry: EntrySpeed = ENTRY,
) -> Plant:
    """Deterministic unless a test says otherwise: no friction noise, no sensor noise, known resistance."""
    position = RetarderPosition("small", zones_m, stages_kpa, force, pneumatics, 7.0)
    cut = Cut("С", mass_t, axles_m, len(stages_kpa) - 1)
    return Plant(position, cut, profile, friction, resistance, sensor, entry)


@pytest.fixture(scope="session")
def plant_with() -> Callable[..., Plant]:
    """`small_plant`."""
    return small_plant


@pytest.fixture(scope="session")
def drive() -> Pneumatics:
    """The small plant's pneumatics."""
    return DRIVE
