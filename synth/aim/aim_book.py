"""The main job of `aim`: the aim tables of all categories and kinds of knowledge of a configuration; and whether they
keep the probability that is asked of them, on cuts that their speeds were not chosen on.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from importlib.metadata import version

import numpy as np
from scipy.special import betainc

from plant_models.frozen_arrays import frozen_arrays
from plant_models.library.weight_category import WeightCategory
from synth.aim.aim_table import AimedSpeeds, AimOrder, aimed_speeds
from synth.aim.knowledge import ByCategory, ByReading, Requirement, ResistanceByTwoSpeeds
from synth.aim.position_models import PositionModel
from synth.aim.resolved_aim import BOUNDS_M_S, ResolvedAim
from synth.aim.table_position import position_of
from synth.frame.interval import Interval
from synth.frame.printed_numbers import counted, percent
from synth.frame.workers.engine import Tell
from synth.simulation.exit_statistics import clopper_pearson
from tuning_tables import Generator
from tuning_tables.aim import AimAxes, AimCategory, AimTable, MeasuredResistance, ParkPosition, Reported, Required

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


CHANCE = 0.025
"""Of calling a table that keeps its limit one that misses it, all its cells together."""


@dataclass(frozen=True)
class AimVerdict:
    """One table: `missed` names the cells whose over-speeds cannot be chance; `told` of `cells` have figures, and
    `without` have no speed at all. `worst`: the share of over-speed of the cell that is most surely above the limit, of
    its cuts, with an interval that holds for all cells of the table at once; None where no cell has figures."""

    table: str
    cells: int
    told: int
    without: int
    missed: tuple[str, ...]
    worst: Interval | None


@dataclass(frozen=True)
class AimBookVerdict:
    """`accepted`: some cell has figures and no table misses the limit; `sentence` says it in words."""

    accepted: bool
    sentence: str
    tables: tuple[AimVerdict, ...]


def judge_aims(made: Sequence[MadeAim], p_excess: float) -> AimBookVerdict:
    """The verdict on all tables: a cell misses where so many over-speeds at the required probability and `p_excess`
    would be rarer than `CHANCE` over the number of the table's cells."""
    judged = tuple(judge_aim(each, p_excess) for each in made)
    told, without = sum(each.told for each in judged), sum(each.without for each in judged)
    bad = [each for each in judged if each.missed]
    required = made[0].speeds.order.requirement.p_overspeed
    limit = f"{100.0 * (required + p_excess):g} %"
    if not told:
        return AimBookVerdict(False, "no exit speed keeps the required probability anywhere", judged)
    if bad:
        first = "; ".join(f"{each.table}: {each.missed[0]}" for each in bad)
        cells = sum(len(each.missed) for each in bad)
        where = f"{counted(cells, 'cell')} of {told} ({first})"
        sentence = f"more than {limit} of the cuts surely couple too fast in {where}"
    else:
        sentence = f"in none of {counted(told, 'cell')} are more than {limit} of the cuts shown to couple too fast"
    if without:
        cells = sum(each.cells for each in judged)
        sentence += (
            f"; in {without} of {counted(cells, 'cell')} no exit speed keeps it, for the track falls more than such "
            "cuts resist: there they are let go at the lowest speed"
        )
    return AimBookVerdict(not bad, sentence, judged)


def judge_aim(made: MadeAim, p_excess: float) -> AimVerdict:
    """The verdict on one table."""
    speeds = made.speeds
    told = speeds.cuts > 0
    hits = np.rint(np.where(told, speeds.overspeed * speeds.cuts, 0.0))
    limit = speeds.order.requirement.p_overspeed + p_excess
    n = np.maximum(speeds.cuts, 1).astype(np.float64)
    # P(at least `hits` of `n`), a binomial tail, is the incomplete beta function; without a hit it is 1.
    chance = np.where(hits > 0.0, betainc(np.maximum(hits, 1.0), n - hits + 1.0, min(limit, 1.0)), 1.0)
    each_chance = CHANCE / max(int(told.sum()), 1)
    over = told & (chance < each_chance)
    cells = [cell_name(made, tuple(int(i) for i in place)) for place in np.argwhere(over)]
    worst = None
    if told.any():
        place = np.unravel_index(np.argmin(np.where(told, chance, np.inf)), told.shape)
        of_it, cuts = int(hits[place]), int(speeds.cuts[place])
        worst = Interval(of_it / cuts, *clopper_pearson(of_it, cuts, 1.0 - 2.0 * each_chance), cuts)
    without = int(np.isnan(speeds.speed_m_s).sum())
    return AimVerdict(made.table.id, told.size, int(told.sum()), without, tuple(cells), worst)


def cell_name(made: MadeAim, place: tuple[int, ...]) -> str:
    """A cell in words."""
    speeds = made.speeds
    cars, distance = speeds.order.cars[place[0]], speeds.order.free_distances_m[place[1]]
    p = speeds.overspeed[place]
    name = f"{counted(cars, 'car')} at {distance:g} m"
    if speeds.readings is not None:
        name += f" and {speeds.readings[place[2]]:.2f} N/kN"
    return f"{name}: {percent(float(p))} % of {speeds.cuts[place]}"
