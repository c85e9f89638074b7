"""Exit speeds of the last position for every group of routes, chosen as aim tables are, on cuts drawn for it."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np

from plant_models.frozen_arrays import Floats, Ints
from plant_models.hump import Retarder, Route
from plant_models.library.weight_category import WeightCategory
from plant_models.rolling.random_cuts import CutPopulation
from synth.aim.aim_table import AimOrder, chosen, rounded_down, thresholds_at
from synth.aim.configuration.shared_settings import COUPLING_SPEED_M_S
from synth.aim.knowledge import ByCategory, ByReading, Requirement
from synth.aim.position_models import PositionModel
from synth.aim.scene import AimScene, MeasuredStretch, SceneCuts
from synth.hump.planning.aim_control import CategoryAim, HumpAim
from synth.hump.planning.free_stretch import SHORTEST_M, ResistanceOnStretch
from synth.hump.rolling.hump_routes import HumpRoutes
from tuning_tables.aim import AimAxes
from tuning_tables.aim.axes import aim_grid

CARS = (1, 2, 3, 5, 8)
"""Numbers of cars that speeds are chosen for."""

DISTANCES = 16
"""Free distances from 0 to the end of the track, closer to each other where they are short."""

READINGS = 25
"""Readings of the resistance that speeds are chosen for."""


@dataclass(frozen=True)
class MeasuredAhead:
    """The resistance of a cut is read on the free stretch ahead of the last position (`free_stretch`).

    `speed_std_m_s`: of the error of each speed. Cuts come into the stretch with a normal speed of `speed_mean_m_s` and
    `speed_spread_m_s`; the reading hardly depends on it.
    """

    speed_std_m_s: float = 0.1
    speed_mean_m_s: float = 4.5
    speed_spread_m_s: float = 0.5


@dataclass(frozen=True)
class AimDesign:
    """How exit speeds of the last position are chosen: for whom, for which position, and on how many drawn cuts of
    each weight category and number of `cars`, which rise from 1 on; a coupling faster than `coupling_speed_m_s` is
    over-speed. `threads` work on them, 0: one a processor; they change no result."""

    population: CutPopulation
    position: PositionModel
    requirement: Requirement
    knowledge: ByCategory | MeasuredAhead
    cars: tuple[int, ...] = CARS
    design_cuts: int = 2000
    seed: int = 1
    threads: int = 0
    coupling_speed_m_s: float = COUPLING_SPEED_M_S


def hump_aim(routes: HumpRoutes, design: AimDesign, rows: Ints | None = None) -> HumpAim:
    """The exit speeds for `routes`, or those of the `rows` alone, whose groups are told in their order. Routes whose
    tracks are alike share them; they are chosen on the first one."""
    chosen_routes = routes.routes if rows is None else [routes.routes[row] for row in rows]
    groups = [group_key(route, design.knowledge) for route in chosen_routes]
    keys = list(dict.fromkeys(groups))
    tables = tuple(group_aim(chosen_routes[groups.index(key)], design) for key in keys)
    return HumpAim(np.array([keys.index(key) for key in groups]), tables, design.requirement.bounds_m_s[0])


def positions_m(route: Route) -> list[tuple[float, float]]:
    """(entrance, exit) of each position of `route`."""
    held = [(e.at_m, e.vertex) for e in route.elements if isinstance(e.vertex, Retarder)]
    return [(at, at + vertex.exit_m) for at, vertex in held]


def group_key(route: Route, knowledge: ByCategory | MeasuredAhead) -> tuple[object, ...]:
    """What the choice depends on: the track behind the last position; for measured cuts, the falls of the stretch ahead
    of it as well. Bends there do not count, since a reading leaves out what they take by expectation."""
    track, places = route.roll_track, positions_m(route)
    leave = places[-1][1]
    begin = leave
    if isinstance(knowledge, MeasuredAhead):
        begin = places[-2][1] if len(places) > 1 else 0.0
    starts = zip(track.breaks_m[:-1], track.breaks_m[1:], track.profile.grades_permille, strict=True)
    grades = tuple((round(max(at - leave, begin - leave), 3), grade) for at, to, grade in starts if to > begin)
    bends = tuple(
        (round(bend.from_m - leave, 3), round(bend.to_m - leave, 3), bend.switches, round(bend.turn_deg, 3))
        for bend in track.bends
        if bend.to_m > leave
    )
    return grades, bends, round(track.end_m - leave, 3), round(places[-1][0] - leave, 3)


def group_aim(route: Route, design: AimDesign) -> tuple[CategoryAim, ...]:
    """The tables of all weight categories on `route`."""
    members = design.population.categories.members
    workers = min(design.threads or os.cpu_count() or 1, len(members))
    scene = scene_of(route, design, 1 if workers > 1 else design.threads)
    with ThreadPoolExecutor(workers) as pool:
        return tuple(pool.map(lambda member: category_aim(route, scene, member, design), members))


def scene_of(route: Route, design: AimDesign, threads: int) -> AimScene:
    """The last position of `route`. Its last grade goes on behind the end: no standing car is there, but the speeds of
    long cuts at the last distance are worked out as if one were."""
    track, places, knowledge = route.roll_track, positions_m(route), design.knowledge
    longest = max(car.car.length_m for car in design.population.mix.cars) * (max(design.cars) + 1)
    entrance, leave = places[-1]
    begin = places[-2][1] if len(places) > 1 else 0.0
    law = (4.5, 0.0) if isinstance(knowledge, ByCategory) else (knowledge.speed_mean_m_s, knowledge.speed_spread_m_s)
    return AimScene(
        population=replace(design.population, bends=track.bends),
        track=replace(track, end_m=track.end_m + longest),
        entrance_m=entrance,
        exit_m=leave,
        stretch=MeasuredStretch(begin, entrance, *law),
        coupling_speed_m_s=design.coupling_speed_m_s,
        threads=threads,
    )


def category_aim(route: Route, scene: AimScene, member: WeightCategory, design: AimDesign) -> CategoryAim:
    """The tables of one weight category; without a speed where no car of the mix can be in it."""
    distances = distances_m(route)
    axes = AimAxes(np.array(design.cars), distances)
    order = order_of(member, distances, design)
    cuts = scene.draw_each(member, design.cars, design.seed, 0, design.design_cuts)
    thresholds = [thresholds_at(order, each, distances) for each in cuts]
    plain = [
        rounded_down(chosen(order, ByCategory(), each, of_each, None))[:, 0]
        for each, of_each in zip(cuts, thresholds, strict=True)
    ]
    by_category = aim_grid(axes, np.stack(plain))
    if isinstance(design.knowledge, ByCategory):
        return CategoryAim(by_category)
    places = positions_m(route)
    reading = ResistanceOnStretch(places[-2][1] if len(places) > 1 else None, design.knowledge.speed_std_m_s)
    knowledge = ByReading(reading, READINGS)
    nodes = knowledge.readings(cuts[0])  # those of single cars spread most
    speeds = [
        rounded_down(chosen(order, knowledge, each, of_each, nodes))
        if told(reading, each)
        else np.repeat(alone[:, None], READINGS, axis=1)
        for each, of_each, alone in zip(cuts, thresholds, plain, strict=True)
    ]
    measured = aim_grid(AimAxes(axes.cars, axes.free_distance_m, nodes), np.stack(speeds))
    return CategoryAim(by_category, measured, float(reading.of(cuts[0]).value.mean()))


def order_of(member: WeightCategory, distances: Floats, design: AimDesign) -> AimOrder:
    """What is asked of the aim tables' own machinery."""
    return AimOrder(
        category=member,
        cars=design.cars,
        free_distances_m=tuple(float(d) for d in distances),
        requirement=design.requirement,
        position=design.position,
        design_cuts=design.design_cuts,
        report_cuts=design.design_cuts,
        seed=design.seed,
    )


def told(reading: ResistanceOnStretch, cuts: SceneCuts) -> bool:
    """Whether the stretch is long enough for all these cuts."""
    return bool((reading.speeds(cuts).length_m >= SHORTEST_M).all())


def distances_m(route: Route) -> Floats:
    """The free distances of the tables."""
    room = route.length_m - positions_m(route)[-1][1]
    return np.round(room * np.linspace(0.0, 1.0, DISTANCES) ** 2, 3)
