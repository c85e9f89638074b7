"""Populations of cuts whose every part a test may choose."""

from __future__ import annotations

from plant_models import Car
from plant_models.library import WeightCategories, load_car, load_weight_categories
from plant_models.rolling.car_mix import CarMix, MixedCar
from plant_models.rolling.random_cuts import CutPopulation
from plant_models.rolling.resistance_law import HumpNormLaw, ResistanceLaw
from plant_models.rolling.roll_track import Bend, Weather

CATEGORIES: WeightCategories = load_weight_categories()
NORM = HumpNormLaw()
WINDY = Weather(temperature_c=10.0, head_wind_mean_m_s=0.5, head_wind_std_m_s=3.0)


def library_car(name: str) -> Car:
    """The car `name` of the library."""
    return load_car(name).car


GONDOLA, TANK, FLAT, LONG_TANK = (library_car(name) for name in ("gondola-4", "tank-4", "flat-4", "tank-8"))
MIX = CarMix((MixedCar(GONDOLA, 0.5, 11.6), MixedCar(TANK, 0.3, 10.5), MixedCar(FLAT, 0.2, 6.2)))


def population(
    mix: CarMix = MIX, law: ResistanceLaw = NORM, weather: Weather = WINDY, bends: tuple[Bend, ...] = ()
) -> CutPopulation:
    """Library cars on a windy day, by the hump norm."""
    return CutPopulation(mix, CATEGORIES, law, weather, bends)
