"""One park position behind a straight track with a bend, for light and heavy cuts."""

from __future__ import annotations

from dataclasses import replace

import pytest

from plant_models import TrackProfile
from plant_models.library.catalogue import load_car, load_weight_categories
from plant_models.library.weight_category import WeightCategories
from plant_models.rolling.car_mix import CarMix, MixedCar
from plant_models.rolling.random_cuts import CutPopulation
from plant_models.rolling.resistance_law import HumpNormLaw
from plant_models.rolling.roll_track import Bend, RollTrack, Weather
from synth.aim.scene import AimScene, MeasuredStretch

CATEGORIES = load_weight_categories()
LIGHT, HEAVY = CATEGORIES.members[0], CATEGORIES.members[-1]
TRACK = RollTrack(
    TrackProfile((0.0, 40.0, 170.0, 340.0), (45.0, 10.0, 1.5, 1.0)), 1000.0, (Bend(200.0, 215.0, 1, 4.7),)
)


def scene_on(track: RollTrack, weather: Weather) -> AimScene:
    """Gondolas and tanks on `track`; the position lies from 316 to 338 m, the stretch before it from 178 m."""
    gondola, tank = (load_car(name).car for name in ("gondola-4", "tank-4"))
    mix = CarMix((MixedCar(gondola, 0.7, 11.6), MixedCar(tank, 0.3, 9.0)))
    population = CutPopulation(mix, CATEGORIES, HumpNormLaw(), weather, track.bends)
    return AimScene(population, track, 316.0, 338.0, MeasuredStretch(178.0, 316.0, 4.5, 0.3))


@pytest.fixture(scope="session")
def scene() -> AimScene:
    """Wind N(0, 3) m/s."""
    return scene_on(TRACK, Weather())


@pytest.fixture(scope="session")
def steep(scene: AimScene) -> AimScene:
    """A classification track of 4 permille, on which most heavy cars roll faster and faster."""
    falling = replace(TRACK, profile=TrackProfile((0.0, 40.0, 170.0), (45.0, 10.0, 4.0)))
    return scene_on(falling, scene.population.weather)


@pytest.fixture(scope="session")
def categories() -> WeightCategories:
    """The yard's five."""
    return CATEGORIES
