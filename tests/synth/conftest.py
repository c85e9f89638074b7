"""The plants of most tests: two five-link pressing retarders, one gondola, Doppler sensor."""

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
from synth.simulation.random_passes import RandomPasses, random_passes

GONDOLA_OFFSETS_M = (0.0, 1.85, 8.65, 10.5)

# category, highest mass of it (t), stage allowed, mean and std of w0 (N/kN), as in the library
CATEGORIES = (
    ("Л", 28.0, 2, 1.75, 0.67),
    ("ЛС", 44.0, 3, 1.54, 0.59),
    ("С", 60.0, 4, 1.40, 0.50),
    ("СТ", 72.0, 4, 1.25, 0.38),
    ("Т", 400.0, 4, 1.23, 0.35),
)


def pilot_plant(mass_t: float) -> Plant:
    """The plant with one gondola of `mass_t`."""
    category, _, stage, mean, std = next(row for row in CATEGORIES if mass_t <= row[1])
    position = RetarderPosition(
        name="two КНП-5",
        zones_m=((0.0, 12.475), (14.475, 26.95)),
        stage_pressures_kpa=(0.0, 150.0, 300.0, 450.0, 600.0),
        force=PressingForce(20.0 / 550.0, 50.0),
        pneumatics=Pneumatics(700.0, 0.0, 0.1, 0.2, 0.1, 0.3, 0.3, 15.0),
        max_entry_speed_m_s=7.0,
    )
    return Plant(
        position=position,
        cut=Cut(category, mass_t, GONDOLA_OFFSETS_M, stage),
        profile=TrackProfile.uniform(8.0),
        friction=Friction(common_cv=0.15, axle_cv=0.0, path_std=0.10, correlation_length_m=2.0),
        resistance=RollingResistance(mean, std),
        sensor=DopplerSensor(0.05, 0.04, 0.1, 0.02),
        entry=EntrySpeed(5.0, 6.5),
    )


@pytest.fixture(scope="session")
def plant_of() -> Callable[[float], Plant]:
    """`pilot_plant`, for tests that want another mass."""
    return pilot_plant


@pytest.fixture(scope="session")
def plant_22t() -> Plant:
    """Light gondola, stages 0 … 2."""
    return pilot_plant(22.0)


@pytest.fixture(scope="session")
def plant_52t() -> Plant:
    """Medium gondola, stages 0 … 4."""
    return pilot_plant(52.0)


@pytest.fixture(scope="session")
def passes() -> RandomPasses:
    """A thousand passes as cuts come."""
    return random_passes(seed=1, first_pass=0, count=1000)
