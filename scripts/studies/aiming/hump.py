"""The hump of the studies: the large one of the library, every number assumed; and changes of it."""

from __future__ import annotations

from dataclasses import replace

from plant_models.library import WeightCategory, load_track, load_weight_categories
from plant_models.library.car_mix_entry import load_car_mix
from plant_models.rolling.car_mix import CarMix
from plant_models.rolling.random_cuts import CutPopulation
from plant_models.rolling.resistance_law import HumpNormLaw
from plant_models.rolling.roll_track import Bend
from plant_models.rolling.weather import Weather
from plant_models.track_profile import TrackProfile
from scripts.studies.aiming.recorded_cuts import ControlPoints
from synth.aim.scene import AimScene, MeasuredStretch

POINTS = ControlPoints((200.0, 250.0, 305.0))
"""The three control points of Kozachenko, between bunch and park position."""


def large_hump() -> AimScene:
    """The park position of the library's large hump, and the usual cars of the library."""
    entry = load_track("large-hump")
    population = CutPopulation(
        load_car_mix("usual").mix, load_weight_categories(), HumpNormLaw(), Weather(), entry.track.bends
    )
    stretch = MeasuredStretch(*entry.stretch_m, entry.bunch_speed_mean_m_s, entry.bunch_speed_std_m_s)
    return AimScene(population, entry.track, entry.entrance_m, entry.exit_m, stretch)


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


def grades_of(scene: AimScene) -> tuple[tuple[float, float], ...]:
    """The profile of the track as pairs of where, m, and permille."""
    profile = scene.track.profile
    return tuple(zip(profile.starts_m, profile.grades_permille, strict=True))
