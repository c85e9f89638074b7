"""The hump of the studies: a made-up large one, every number assumed (docs/aimed-braking.md lists them)."""

from __future__ import annotations

from dataclasses import replace

from plant_models.library import WeightCategory, load_car, load_weight_categories
from plant_models.rolling.car_mix import CarMix, MixedCar
from plant_models.rolling.random_cuts import CutPopulation
from plant_models.rolling.resistance_law import HumpNormLaw
from plant_models.rolling.roll_track import Bend, RollTrack
from plant_models.rolling.weather import Weather
from plant_models.track_profile import TrackProfile
from synth.yard.recorded_cuts import ControlPoints
from synth.yard.scene import AimScene, MeasuredStretch

POINTS = ControlPoints((200.0, 250.0, 305.0))
"""The three control points of S1, between bunch and park position."""

MIX = (
    ("gondola-4", 0.45, 11.6), ("tank-4", 0.20, 9.35), ("box-4", 0.15, 10.9), ("hopper-4", 0.12, 10.8),
    ("flat-4", 0.08, 6.15),
)  # fmt: skip
"""Type, share, C_x·S in m²."""

GRADES = ((0.0, 45.0), (40.0, 22.0), (66.0, 12.0), (98.0, 10.0), (138.0, 8.0), (178.0, 1.5), (338.0, 0.8), (770.0, 0.0))
"""From, m; permille."""

BENDS = (
    Bend(42.0, 53.0, 1, 4.73), Bend(112.0, 123.0, 1, 4.73), Bend(184.0, 195.0, 1, 4.73), Bend(214.0, 225.0, 1, 4.73),
    Bend(246.0, 257.0, 1, 4.73), Bend(270.0, 300.0, 0, 14.0),
)  # fmt: skip


def large_hump() -> AimScene:
    """The park position of a large hump, its track, and the cuts that come over it."""
    mix = CarMix(tuple(MixedCar(load_car(name).car, share, area) for name, share, area in MIX))
    population = CutPopulation(mix, load_weight_categories(), HumpNormLaw(), Weather(), BENDS)
    profile = TrackProfile(tuple(start for start, _ in GRADES), tuple(grade for _, grade in GRADES))
    return AimScene(
        population, RollTrack(profile, 970.0, BENDS), 316.0, 336.0, MeasuredStretch(200.0, 310.0, 4.5, 0.15)
    )


def weight_category(scene: AimScene, name: str) -> WeightCategory:
    """The category of this (Latin) name."""
    return next(c for c in scene.population.categories.members if name in (c.name, c.latin))


def with_weather(scene: AimScene, **values: float) -> AimScene:
    """`scene` in another weather."""
    population = scene.population
    return replace(scene, population=replace(population, weather=replace(population.weather, **values)))


def with_mix(scene: AimScene, mix: CarMix) -> AimScene:
    """`scene` with other cars."""
    return replace(scene, population=replace(scene.population, mix=mix))


def with_bends(scene: AimScene, bends: tuple[Bend, ...]) -> AimScene:
    """`scene` with other switches and curves."""
    population = replace(scene.population, bends=bends)
    return replace(scene, population=population, track=replace(scene.track, bends=bends))


def with_grades(scene: AimScene, grades: tuple[tuple[float, float], ...]) -> AimScene:
    """`scene` on another profile: pairs of where, m, and permille."""
    profile = TrackProfile(tuple(start for start, _ in grades), tuple(grade for _, grade in grades))
    return replace(scene, track=replace(scene.track, profile=profile))
