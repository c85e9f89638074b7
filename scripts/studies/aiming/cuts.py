"""Cuts on their way to standing cars (places, what would be right for each, what a command makes of it), and the
hump of the studies: the large one of the library, every number assumed, and changes of it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from plant_models.frozen_arrays import Floats, frozen_arrays
from plant_models.library import WeightCategory, load_track, load_weight_categories
from plant_models.library.car_entry import load_car_mix
from plant_models.rolling.car_mix import CarMix
from plant_models.rolling.random_cuts import CutPopulation
from plant_models.rolling.resistance_law import HumpNormLaw
from plant_models.rolling.roll_track import Bend, Weather
from plant_models.track_profile import TrackProfile
from scripts.studies.aiming.refinements import ControlPoints
from synth.aim.position_models import Couplings, ExitSpeeds, PositionModel, couplings
from synth.aim.scene import AimScene, MeasuredStretch, SceneCuts


class Places(Protocol):
    """Some places at which cuts meet standing cars."""

    @property
    def metres(self) -> tuple[float, ...]:
        """What names the places."""

    def arrivals_m(self, cuts: SceneCuts) -> Floats:
        """Where the head of each cut meets the standing cars, (n, places)."""


@dataclass(frozen=True)
class FromCrest:
    """Standing cars `metres` from the crest, as Kozachenko counts. A cut too long for that couples as it is let go."""

    metres: tuple[float, ...]

    def arrivals_m(self, cuts: SceneCuts) -> Floats:
        """At least where the head is when the last axle leaves the position."""
        return np.asarray(np.maximum(np.asarray(self.metres)[None, :], cuts.release_m[:, None]))


@dataclass(frozen=True)
class FreeDistance:
    """Standing cars `metres` ahead of the head when the last axle leaves the position."""

    metres: tuple[float, ...]

    def arrivals_m(self, cuts: SceneCuts) -> Floats:
        """So far on from there."""
        return np.asarray(cuts.release_m[:, None] + np.asarray(self.metres)[None, :])


@frozen_arrays
class RolledCuts:
    """Cuts with the places where they meet standing cars, `arrivals_m` (n, k), and the highest exit speeds that do not
    couple too fast there, `critical_m_s` (n, k). No position counts yet. Build it with `rolled_cuts`."""

    cuts: SceneCuts
    arrivals_m: Floats
    critical_m_s: Floats

    def at(self, position: PositionModel) -> AimedCuts:
        """The same cuts at `position`."""
        exits = position.exits(self.cuts)
        thresholds = [exits.threshold(column) for column in self.critical_m_s.T]
        return AimedCuts(self, exits, np.stack(thresholds, axis=1))


@frozen_arrays
class AimedCuts:
    """Cuts at a position: `thresholds_m_s` (n, k) are the commands above which they couple too fast."""

    rolled: RolledCuts
    exits: ExitSpeeds
    thresholds_m_s: Floats

    @property
    def cuts(self) -> SceneCuts:
        """The cuts themselves."""
        return self.rolled.cuts

    def couplings(self, commanded_m_s: Floats, place: int) -> Couplings:
        """How they couple at one place that are commanded `commanded_m_s` (n,)."""
        return couplings(self.cuts, self.exits, commanded_m_s, self.rolled.arrivals_m[:, place])


def rolled_cuts(cuts: SceneCuts, places: Places) -> RolledCuts:
    """`cuts` that are rolled back from `places`."""
    arrivals = places.arrivals_m(cuts)
    critical = [cuts.critical_speeds_m_s(column) for column in arrivals.T]
    return RolledCuts(cuts, arrivals, np.stack(critical, axis=1))


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
