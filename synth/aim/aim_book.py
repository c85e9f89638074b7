"""The main job of `aim`: the aim tables of all categories and kinds of knowledge of a configuration."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from importlib.metadata import version

import numpy as np

from plant_models.frozen_arrays import frozen_arrays
from plant_models.library.weight_category import WeightCategory
from synth.aim.aim_table import AimedSpeeds, AimOrder, aimed_speeds
from synth.aim.aimed_position import position_of
from synth.aim.knowledge import ByCategory, ByReading, Requirement
from synth.aim.position_models import PositionModel
from synth.aim.readings import ResistanceByTwoSpeeds
from synth.aim.resolved_aim import BOUNDS_M_S, ResolvedAim
from synth.frame.workers.engine import Tell
from tuning_tables import Generator
from tuning_tables.aim import (
    AimAxes,
    AimCategory,
    AimTable,
    MeasuredResistance,
    ParkPosition,
    Reported,
    Required,
)

JUDGED_PART = 2
"""Speeds are judged on a half as many cuts as they are chosen on: these have one error, a choice has two."""


@frozen_arrays
class MadeAim:
    """An aim table as it is written, and the simulated figures behind it; `knowledge`: as a configuration calls it."""

    category: WeightCategory
    knowledge: str
    speeds: AimedSpeeds
    table: AimTable

    @property
    def known(self) -> str:
        """What people call the knowledge."""
        return {"category": "category alone", "measured": "resistance measured"}[self.knowledge]


@dataclass(frozen=True)
class AimBook:
    """Result of an aim: its tables, by category in the order of the configuration, by knowledge within."""

    config: ResolvedAim
    created: str
    tables: tuple[MadeAim, ...]


def aim_book(config: ResolvedAim, created: str, progress: Tell) -> AimBook:
    """All tables of `config`; `progress` is told a sentence for each category.

    Categories are worked out side by side: much of the work is that of numpy and scipy, which use one processor.
    """
    generator = Generator("retarder-synth", version("retarder-synth"), config.sha256)
    position = position_of(config)
    knowledges = tuple(knowledge_of(config, name) for name in config.aim.knowledge)

    workers = min(config.simulation.threads or os.cpu_count() or 1, len(config.members))
    scene = config.scene if workers == 1 else replace(config.scene, threads=1)

    def made_of(member: WeightCategory) -> list[MadeAim]:
        found = aimed_speeds(scene, order_of(config, member, position), knowledges)
        progress(f"category {member.name}: {told(config, found)}")
        return [
            MadeAim(member, name, speeds, table_of(config, speeds, name, generator, created))
            for name, speeds in zip(config.aim.knowledge, found, strict=True)
        ]

    with ThreadPoolExecutor(workers) as pool:
        return AimBook(config, created, tuple(made for each in pool.map(made_of, config.members) for made in each))


def knowledge_of(config: ResolvedAim, name: str) -> ByCategory | ByReading:
    """What a configuration calls `name`."""
    return ByCategory() if name == "category" else ByReading(ResistanceByTwoSpeeds(config.aim.speed_std_m_s))


def order_of(config: ResolvedAim, member: WeightCategory, position: PositionModel) -> AimOrder:
    """What is asked for one category."""
    return AimOrder(
        category=member,
        cars=config.cars,
        free_distances_m=config.aim.free_distances_m,
        requirement=Requirement(config.aim.p_overspeed, BOUNDS_M_S),
        position=position,
        design_cuts=config.simulation.passes,
        report_cuts=config.simulation.passes // JUDGED_PART,
        seed=config.simulation.seed,
    )


def table_of(config: ResolvedAim, speeds: AimedSpeeds, name: str, generator: Generator, created: str) -> AimTable:
    """The speeds as a controller loads them. Gaps are told of a whole cut."""
    order, stretch = speeds.order, config.scene.stretch
    measured = None
    if name == "measured":
        measured = MeasuredResistance(stretch.from_m, stretch.to_m, config.aim.speed_std_m_s)
    cars = np.array(order.cars)
    per_cut = cars.reshape(-1, *(1,) * (speeds.speed_m_s.ndim - 1))
    return AimTable(
        id=f"{config.position_name}-{order.category.latin}-{name}",
        created=created,
        generator=generator,
        position=ParkPosition(config.position_name, config.scene.exit_m),
        category=AimCategory(order.category.number, order.category.name),
        required=Required(order.requirement.p_overspeed, config.scene.coupling_speed_m_s),
        measured=measured,
        axes=AimAxes(cars, np.array(order.free_distances_m), speeds.readings),
        exit_speed_m_s=np.round(speeds.speed_m_s, 3),
        bounds_m_s=order.requirement.bounds_m_s,
        interpolation_error_m_s=speeds.below_m_s,
        reported=Reported(
            passes=order.report_cuts,
            p_overspeed=speeds.overspeed,
            p_overspeed_low95=speeds.overspeed_low95,
            p_overspeed_high95=speeds.overspeed_high95,
            mean_gap_m=speeds.gap_per_car_m * per_cut,
        ),
    )


def told(config: ResolvedAim, found: tuple[AimedSpeeds, ...]) -> str:
    """What was found for a category, in a line: gaps of the shortest cuts at the longest distance."""
    cars, distance = config.cars[0], config.aim.free_distances_m[-1]
    gaps = []
    for name, speeds in zip(config.aim.knowledge, found, strict=True):
        gap = speeds.of_all.gap_m[0, -1]
        gaps.append(f"{gap:.1f} m by {name}")
    return f"mean gap of {cars} car{'s' * (cars > 1)} at {distance:g} m {', '.join(gaps)}"
