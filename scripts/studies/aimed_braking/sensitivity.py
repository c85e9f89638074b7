"""Which assumed input moves the distance to which aiming by category meets the norm, and by how much."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from plant_models.frozen_arrays import Floats
from plant_models.rolling.car_mix import CarMix
from plant_models.rolling.resistance_law import HumpNormLaw, Tb10062Law
from scripts.studies.aiming.cuts import grades_of, weight_category, with_bends, with_grades, with_mix, with_weather
from scripts.studies.aiming.refinements import ByRegression
from scripts.studies.aiming.trial import Cuts, Draws, Value, norm_distance, value_of
from scripts.studies.cases import side_by_side
from synth.aim.knowledge import ByCategory, Knowledge, ResistanceByTwoSpeeds
from synth.aim.position_models import NormalPosition
from synth.aim.scene import AimScene

EXIT_STD_M_S = 0.1
MEASURED_STD_M_S = 0.03

LIGHT_KNOWLEDGE: Knowledge = ByRegression(ResistanceByTwoSpeeds(MEASURED_STD_M_S))


@dataclass(frozen=True)
class Input:
    """An assumed input at another value: `scene_of` changes the scene, `exit_std_m_s` is that of the position."""

    name: str
    assumed: str
    value: str
    scene_of: Callable[[AimScene], AimScene]
    exit_std_m_s: float = EXIT_STD_M_S


@dataclass(frozen=True)
class Moved:
    """How far the distance is, m, and how much farther than with the assumed inputs on the same draws; None: beyond the
    last distance tried, or no command keeps the share."""

    metres: Value | None
    farther_m: Value | None


@dataclass(frozen=True)
class Sensitivity:
    """One input at one value: light and heavy single cars by category, light ones with measured resistance."""

    name: str
    assumed: str
    value: str
    light: Moved
    heavy: Moved
    measured: Moved


def sensitivities(scene: AimScene, inputs: int, last_m: float, p: float, draws: Draws) -> Iterator[Sensitivity]:
    """The assumed inputs first, then the first `inputs` of the changed ones."""
    asked = (Input("as assumed", "", "", unchanged), *INPUTS[:inputs])
    base, *others = side_by_side(lambda changed: distances(changed, scene, last_m, p, draws), asked)
    for changed, found in zip(asked, (base, *others), strict=True):
        moved = (moved_by(new, old) for new, old in zip(found, base, strict=True))
        yield Sensitivity(changed.name, changed.assumed, changed.value, *moved)


def distances(changed: Input, scene: AimScene, last_m: float, p: float, draws: Draws) -> list[Floats]:
    """Distances to which the norm is met, by replicate: light, heavy, light with measured resistance."""
    changed_scene = changed.scene_of(scene)
    position = NormalPosition(changed.exit_std_m_s, only_brakes=False)
    light, heavy = (Cuts(changed_scene, weight_category(changed_scene, name)) for name in ("L", "T"))
    asked = ((light, ByCategory()), (heavy, ByCategory()), (light, LIGHT_KNOWLEDGE))
    return [norm_distance(cuts, position, knowledge, p, draws, last_m) for cuts, knowledge in asked]


def moved_by(new: Floats, old: Floats) -> Moved:
    """Mean and mean difference with their intervals."""
    if np.isinf(new).any():
        return Moved(None, None)
    return Moved(value_of(new), None if np.isinf(old).any() else value_of(new - old))


def weather(**values: float) -> Callable[[AimScene], AimScene]:
    """Another weather."""
    return lambda scene: with_weather(scene, **values)


def areas(factor: float) -> Callable[[AimScene], AimScene]:
    """All C_x·S times `factor`."""

    def changed(scene: AimScene) -> AimScene:
        mix = scene.population.mix
        cars = tuple(replace(car, drag_area_m2=factor * car.drag_area_m2) for car in mix.cars)
        return with_mix(scene, replace(mix, cars=cars))

    return changed


def gondolas(scene: AimScene) -> AimScene:
    """Gondolas alone."""
    return with_mix(scene, CarMix(scene.population.mix.cars[:1]))


def underload(mean_t: float) -> Callable[[AimScene], AimScene]:
    """Another mean under-load."""
    return lambda scene: with_mix(scene, replace(scene.population.mix, underload_mean_t=mean_t))


def law(of: HumpNormLaw | Tb10062Law, temperature_c: float = 10.0) -> Callable[[AimScene], AimScene]:
    """Another law of resistance, at a temperature."""

    def changed(scene: AimScene) -> AimScene:
        warm = with_weather(scene, temperature_c=temperature_c)
        return replace(warm, population=replace(warm.population, law=of))

    return changed


def grade_behind(permille: float) -> Callable[[AimScene], AimScene]:
    """Another grade of the classification track, which begins where the first grade behind the position does."""

    def changed(scene: AimScene) -> AimScene:
        first = first_behind(scene)
        return with_grades(scene, tuple((at, permille if at == first else i) for at, i in grades_of(scene)))

    return changed


def first_behind(scene: AimScene) -> float:
    """Where the first grade behind the position begins, m."""
    return min(at for at, _ in grades_of(scene) if at >= scene.exit_m)


def farther(metres: float) -> Callable[[AimScene], AimScene]:
    """Park position, measured stretch, bends on the way to them and the grade behind them, all so much farther."""

    def changed(scene: AimScene) -> AimScene:
        before, first = last_before(scene), first_behind(scene)
        bends = tuple(
            replace(b, from_m=b.from_m + metres, to_m=b.to_m + metres) if b.from_m > before else b
            for b in scene.track.bends
        )
        grades = tuple((at + (metres if at == first else 0.0), i) for at, i in grades_of(scene))
        moved = with_grades(with_bends(scene, bends), grades)
        stretch = replace(moved.stretch, from_m=moved.stretch.from_m + metres, to_m=moved.stretch.to_m + metres)
        entrance, exit_m = moved.entrance_m + metres, moved.exit_m + metres
        return replace(moved, entrance_m=entrance, exit_m=exit_m, stretch=stretch)

    return changed


def last_before(scene: AimScene) -> float:
    """Where the grade on which the position lies begins, m."""
    return max(at for at, _ in grades_of(scene) if at <= scene.entrance_m)


def bunch(mean_m_s: float, std_m_s: float) -> Callable[[AimScene], AimScene]:
    """Another speed out of the bunch position."""
    return lambda scene: replace(scene, stretch=replace(scene.stretch, speed_mean_m_s=mean_m_s, speed_std_m_s=std_m_s))


def unchanged(scene: AimScene) -> AimScene:
    """The scene as it is."""
    return scene


INPUTS = (
    Input("head wind, std, m/s", "3", "2", weather(head_wind_std_m_s=2.0)),
    Input("head wind, std, m/s", "3", "5", weather(head_wind_std_m_s=5.0)),
    Input("head wind, mean, m/s", "0", "3", weather(head_wind_mean_m_s=3.0)),
    Input("air, °C", "10", "−20", weather(temperature_c=-20.0)),
    Input("air, °C", "10", "30", weather(temperature_c=30.0)),
    Input("C_x·S, all cars", "1", "× 0.8", areas(0.8)),
    Input("C_x·S, all cars", "1", "× 1.2", areas(1.2)),
    Input("cars", "mix", "gondolas alone", gondolas),
    Input("Erlang order of bends", "3", "1", law(HumpNormLaw(erlang_order=1))),
    Input("Erlang order of bends", "3", "6", law(HumpNormLaw(erlang_order=6))),
    Input("grade behind the position, ‰", "0.8", "0.6", grade_behind(0.6)),
    Input("grade behind the position, ‰", "0.8", "1.0", grade_behind(1.0)),
    Input("exit of the position, m from the crest", "336", "316", farther(-20.0)),
    Input("exit of the position, m from the crest", "336", "356", farther(20.0)),
    Input("mean under-load of heavy cars, t", "4", "1", underload(1.0)),
    Input("mean under-load of heavy cars, t", "4", "15", underload(15.0)),
    Input("law of w0", "norm", "TB 10062, +10 °C", law(Tb10062Law())),
    Input("law of w0", "norm", "TB 10062, −20 °C", law(Tb10062Law(), -20.0)),
    Input("snow, N/kN", "0", "0.5", weather(snow_n_per_kn=0.5)),
    Input("speed out of the bunch position, m/s", "4.5", "5.5", bunch(5.5, 0.15)),
    Input("its std, m/s", "0.15", "0.5", bunch(4.5, 0.5)),
    Input("std of the exit speed, m/s", "0.1", "0", unchanged, 0.0),
    Input("std of the exit speed, m/s", "0.1", "0.2", unchanged, 0.2),
    Input("std of the exit speed, m/s", "0.1", "0.4", unchanged, 0.4),
)
"""Each of these is assumed; those that the sources state (gamma law of w0, limit of 1.39 m/s) are not varied."""
