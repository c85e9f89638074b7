"""Exit speeds over cars, free distance and resistance that keep the probability of over-speed, and what they give:
in each cell, and over all readings together: what a yard gets, whatever is measured of a single cut.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from plant_models.errors import require, require_between
from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from plant_models.library.weight_category import WeightCategory
from synth.aim.knowledge import ByCategory, ByReading, CommandsByReading, Requirement
from synth.aim.position_models import Couplings, PositionModel, couplings
from synth.aim.scene import AimScene, SceneCuts


@frozen_arrays
class AimFigures:
    """By cars and distance, each (cars, distances), of all judged cuts: share of over-speed with its exact 95 %
    interval; mean gap of a cut with its normal 95 % interval; share of cuts `without` a command.

    A cut without a command, since none keeps what is required for its reading, is let go at the lowest speed.
    """

    overspeed: Floats
    overspeed_low95: Floats
    overspeed_high95: Floats
    gap_m: Floats
    gap_low95_m: Floats
    gap_high95_m: Floats
    without: Floats


def aim_figures(rows: Floats) -> AimFigures:
    """The figures of `rows` (cars, distances, 7), each made by `figures_row`."""
    return AimFigures(*np.moveaxis(rows, -1, 0))


def figures_row(met: Couplings, without: float) -> Floats:
    """The seven figures of one number of cars and one distance."""
    over, gap = met.overspeed, met.gap_per_car_m
    gaps = met.cars * np.array([gap.value, max(gap.low95, 0.0), gap.high95])
    return np.array([over.value, over.low95, over.high95, *gaps, without])


ROUNDED_M_S = 0.001
"""Commands are rounded down to this."""

FEWEST_IN_A_CELL = 100
"""Cuts that a figure of one cell needs; cells with fewer have none."""


@dataclass(frozen=True)
class AimOrder:
    """Aim tables of one weight category: what they are for and how many cuts they are made and judged with.

    `design_cuts` choose the commands, `report_cuts`, which are others, tell what they give; `checked_cuts` of the first
    tell what interpolation does to them.
    """

    category: WeightCategory
    cars: tuple[int, ...]
    free_distances_m: tuple[float, ...]
    requirement: Requirement
    position: PositionModel
    design_cuts: int
    report_cuts: int
    seed: int
    checked_cuts: int = 2000

    def __post_init__(self) -> None:
        require_between("aim: p_overspeed", self.requirement.p_overspeed, 1e-4, 0.9999)
        for name, cuts in (("design_cuts", self.design_cuts), ("report_cuts", self.report_cuts)):
            require(cuts >= FEWEST_IN_A_CELL, f"aim: {name} is {cuts}; it must be {FEWEST_IN_A_CELL} or more")


@frozen_arrays
class AimedSpeeds:
    """Commands of an order and what they give on cuts that they were not chosen on.

    `readings`: the axis of the reading, None by category. All others have the shape (cars, distances), with the
    readings as last axis if there are any: `speed_m_s` NaN where no command meets the requirement; share of over-speed
    with its exact 95 % interval, mean gap a car, and the cuts that these are of, NaN and 0 in cells of less than 100
    cuts: a cut counts in the cell of the nearest reading. `above_m_s`, `below_m_s`: the most that linear interpolation
    was found to be above and below what is right midway between two nodes. `of_all`: figures of all judged cuts.
    """

    order: AimOrder
    knowledge: ByCategory | ByReading
    readings: Floats | None
    speed_m_s: Floats
    overspeed: Floats
    overspeed_low95: Floats
    overspeed_high95: Floats
    gap_per_car_m: Floats
    cuts: Ints
    above_m_s: float
    below_m_s: float
    of_all: AimFigures


@frozen_arrays
class TableCuts:
    """Cuts of one number of cars for all kinds of knowledge: to choose on, to check interpolation on, to report on."""

    design: SceneCuts
    thresholds_m_s: Floats
    checked: SceneCuts
    checked_thresholds_m_s: Floats
    report: SceneCuts


def aimed_speeds(
    scene: AimScene, order: AimOrder, knowledges: tuple[ByCategory | ByReading, ...]
) -> tuple[AimedSpeeds, ...]:
    """Choose the commands of `order` for each kind of knowledge, and tell what they give; all on the same cuts.

    Raises `PlantError` where a cut that stands that far away would be beyond the end of the track.
    """
    by_cars = table_cuts(scene, order)
    spread = by_cars[order.cars.index(min(order.cars))].design  # the readings of short cuts spread most
    return tuple(known_speeds(order, knowledge, by_cars, spread) for knowledge in knowledges)


def known_speeds(
    order: AimOrder, knowledge: ByCategory | ByReading, by_cars: list[TableCuts], spread: SceneCuts
) -> AimedSpeeds:
    """The table of one kind of knowledge."""
    nodes = knowledge.readings(spread) if isinstance(knowledge, ByReading) else None
    between = None if nodes is None else with_midways(nodes)
    exact = [chosen(order, knowledge, cuts.design, cuts.thresholds_m_s, between) for cuts in by_cars]
    made = [rounded_down(fine[:, :: 1 if nodes is None else 2]) for fine in exact]
    errors = [errors_between(order, knowledge, cuts, nodes, fine) for cuts, fine in zip(by_cars, exact, strict=True)]
    figures = [
        figures_of(order, knowledge, cuts.report, commands, nodes) for cuts, commands in zip(by_cars, made, strict=True)
    ]
    speed, told = np.stack(made), np.stack([cells for cells, _ in figures])
    if nodes is None:
        speed, told = speed[..., 0], told[..., 0, :]
    return AimedSpeeds(
        order=order,
        knowledge=knowledge,
        readings=nodes,
        speed_m_s=speed,
        overspeed=told[..., 0],
        overspeed_low95=told[..., 1],
        overspeed_high95=told[..., 2],
        gap_per_car_m=told[..., 3],
        cuts=told[..., 4].astype(np.int64),
        above_m_s=max(above for above, _ in errors),
        below_m_s=max(below for _, below in errors),
        of_all=aim_figures(np.stack([rows for _, rows in figures])),
    )


def table_cuts(scene: AimScene, order: AimOrder) -> list[TableCuts]:
    """Cuts of each number of cars for every use, with the thresholds that belong to them."""
    distances = np.asarray(order.free_distances_m)
    checked_cuts = min(order.checked_cuts, order.design_cuts)
    uses = ((0, order.design_cuts), (0, checked_cuts), (order.design_cuts, order.report_cuts))
    drawn = (scene.draw_each(order.category, order.cars, order.seed, first, count) for first, count in uses)
    found = []
    for design, checked, report in zip(*drawn, strict=True):
        require_on_track(design, float(distances[-1]))
        on_design = thresholds_at(order, design, distances)
        on_checked = thresholds_at(order, checked, with_midways(distances))
        found.append(TableCuts(design, on_design, checked, on_checked, report))
    return found


def thresholds_at(order: AimOrder, cuts: SceneCuts, free_distances_m: Floats) -> Floats:
    """The commands above which the cuts couple too fast, (n, distances)."""
    exits, release = order.position.exits(cuts), cuts.release_m
    columns = [exits.threshold(cuts.critical_speeds_m_s(release + d)) for d in free_distances_m]
    return np.stack(columns, axis=1)


def chosen(
    order: AimOrder, knowledge: ByCategory | ByReading, cuts: SceneCuts, thresholds_m_s: Floats, nodes: Floats | None
) -> Floats:
    """Commands (distances, readings); one column by category."""
    if nodes is None or isinstance(knowledge, ByCategory):
        return ByCategory().commands(cuts, thresholds_m_s, order.requirement).speeds_m_s[:, None]
    return knowledge.commands_at(nodes, cuts, thresholds_m_s, order.requirement).speeds_m_s.T


def rounded_down(speeds_m_s: Floats) -> Floats:
    """Speeds in whole millimetres a second, none of them faster."""
    return np.asarray(np.floor(speeds_m_s / ROUNDED_M_S + 1e-9) * ROUNDED_M_S)


def errors_between(
    order: AimOrder, knowledge: ByCategory | ByReading, cuts: TableCuts, nodes: Floats | None, exact: Floats
) -> tuple[float, float]:
    """How far linear interpolation is above and below what is chosen midway between two distances, and between two
    readings that are both the nearest of enough cuts; `exact` (distances, readings and midways)."""
    fine = chosen(order, ByCategory(), cuts.checked, cuts.checked_thresholds_m_s, None)
    errors = [0.5 * (fine[:-2:2] + fine[2::2]) - fine[1::2]]
    if nodes is not None and isinstance(knowledge, ByReading):
        counted = np.bincount(nearest_node(knowledge, cuts.design, nodes), minlength=len(nodes)) >= FEWEST_IN_A_CELL
        among = 0.5 * (exact[:, :-2:2] + exact[:, 2::2]) - exact[:, 1::2]
        errors.append(among[:, counted[:-1] & counted[1:]])
    found = np.concatenate([e[np.isfinite(e)] for e in errors] + [np.zeros(1)])
    return float(found.max()), float(-found.min()) + 0.0  # no zero with a sign


def nearest_node(knowledge: ByReading, cuts: SceneCuts, nodes: Floats) -> Ints:
    """The node nearest to the reading of each cut, (n,)."""
    reading = knowledge.reading.of(cuts).with_error(cuts)
    return np.asarray(np.abs(reading[:, None] - nodes).argmin(axis=1))


def with_midways(places: Floats) -> Floats:
    """`places` and what is midway between them, in order."""
    return np.sort(np.concatenate([places, 0.5 * (places[1:] + places[:-1])]))


def figures_of(
    order: AimOrder, knowledge: ByCategory | ByReading, report: SceneCuts, commands_m_s: Floats, nodes: Floats | None
) -> tuple[Floats, Floats]:
    """Over-speed with both ends of its interval, gap a car, cuts: (distances, readings, 5); figures of all cuts
    together: (distances, 7)."""
    exits, release = order.position.exits(report), report.release_m
    figures, rows = np.zeros((*commands_m_s.shape, 5)), []
    nearest = np.zeros(len(report), dtype=np.int64)
    commanded = np.broadcast_to(commands_m_s[:, 0], (len(report), len(commands_m_s)))
    if nodes is not None and isinstance(knowledge, ByReading):
        nearest = nearest_node(knowledge, report, nodes)
        commanded = CommandsByReading(knowledge.reading, nodes, commands_m_s.T).of(report)
    for place, distance in enumerate(order.free_distances_m):
        told = np.isfinite(commanded[:, place])
        lowest = order.requirement.bounds_m_s[0]
        met = couplings(report, exits, np.where(told, commanded[:, place], lowest), release + distance)
        rows.append(figures_row(met, 1.0 - float(told.mean())))
        for node in range(commands_m_s.shape[1]):
            figures[place, node] = figures_of_cell(met.of(told & (nearest == node)))
    return figures, np.array(rows)


def figures_of_cell(met: Couplings) -> Floats:
    """Over-speed with its interval, gap a car and cuts; NaN where they are too few."""
    if len(met.speed_m_s) < FEWEST_IN_A_CELL:
        return np.array([np.nan, np.nan, np.nan, np.nan, 0.0])
    over, gap = met.overspeed, met.gap_per_car_m
    return np.array([over.value, over.low95, over.high95, gap.value, len(met.speed_m_s)])


def require_on_track(cuts: SceneCuts, free_distance_m: float) -> None:
    """Raise unless standing cars `free_distance_m` away are on the track."""
    room = cuts.scene.track.end_m - float(cuts.release_m.max())
    require(
        free_distance_m <= room,
        f"aim: free_distances_m holds {free_distance_m:g}; a cut of {cuts.rolling.cuts.cars} cars has {room:.0f} m at "
        "most from where it leaves the position to the end of the track",
    )
