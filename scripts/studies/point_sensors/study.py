"""What point sensors are worth: by their number, their places, the axles decided on; what their faults cost.

Tables are made for planned layouts, for equal sections and for the rule of zhukovitsky-2012, and run on the same cuts
as the table of the radar. They are made on a finer grid than a tune's. Asked besides: whether ever more sensors become
a radar, what a coarse grid costs, and what it costs and saves to count passages as lost.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from plant_models import PointSensors
from scripts.studies.cases import side_by_side
from scripts.studies.point_sensors.fault_losses import fault_rows
from scripts.studies.point_sensors.findings import PointSensorWorth
from scripts.studies.point_sensors.many_sensors import many_rows
from scripts.studies.point_sensors.rows import FaultRow, GridRow, RadarRow, SensorRow
from scripts.studies.point_sensors.sites import AXLES, TEXTS, Site, sensor_table, sites, tabulated
from scripts.studies.point_sensors.worth import Compared, MadeLayout, missed_row, radar_row, sensor_rows
from scripts.studies.study import Method, Tell, option
from synth.problem.resolution import Resolution
from synth.retarder.sensors.layout import equal_layout, first_sensor_m, with_layout
from synth.simulation.exit_statistics import exit_statistics
from synth.simulation.random_passes import RandomPasses
from synth.simulation.stratified_passes import stratified_passes

FRESH = 20
"""Added to the seed of the configuration: no table was made on these passes."""


@dataclass(frozen=True)
class Options:
    """What is studied."""

    cases: tuple[str, ...] = option(tuple(TEXTS), "sites: position and mass or axles")
    sensors: tuple[int, ...] = option((3, 4, 6, 8, 10, 12), "numbers of sensors, with that behind the exit", (3, 32))
    planned: tuple[int, ...] = option((3, 4, 6, 8), "those of them that a layout is planned for", (3, 32))
    faulty: tuple[int, ...] = option((6,), "numbers of sensors whose faults are tried", (3, 32))
    passes: int = option(20_000, "stratified passes of each table", (200, 10**7))
    fault_passes: int = option(10_000, "the first of them, for each fault", (200, 10**7))
    frictions: int = option(9, "values of friction that speeds are made for", (3, 101))
    path_step_m: float = option(0.25, "path step of the grid, m", (0.05, 2.0))
    speed_step_m_s: float = option(0.015, "speed step of the grid, m/s", (0.002, 0.2))
    friction_nodes: int = option(7, "frictions that a table is made for", (1, 15))
    many: tuple[int, ...] = option((7, 15, 31), "deciding sensors, towards a radar", (2, 31))
    many_std_m_s: tuple[float, ...] = option((0.02, 0.05), "errors of a reading there, m/s", (0.001, 0.5))
    grid_cases: tuple[str, ...] = option(("bunch-22", "bunch-52"), "sites of which the grid is varied")
    grid_sensors: int = option(12, "their sensors", (3, 32))
    missed: tuple[float, ...] = option((0.0, 0.003, 0.01, 0.03), "shares counted as not heard", (0.0, 0.5))
    missed_cases: tuple[str, ...] = option(("bunch-22", "bunch-52"), "sites where this is varied")
    missed_sensors: int = option(8, "their sensors", (3, 32))


def run(options: Options, tell: Tell) -> PointSensorWorth:
    """All parts."""
    chosen = sites(options.cases)
    seed = chosen[0].config.validation.seed + FRESH
    passes = stratified_passes(seed, 0, options.passes)
    resolution = resolution_of(options, chosen[0])
    radars = side_by_side(lambda site: radar_row(site, passes), chosen)
    tell("tables of the radar made")
    given = [Compared(site, passes, resolution, options.frictions, sample) for site, (_, sample) in
             zip(chosen, radars, strict=True)]  # fmt: skip
    orders = [(each, axles) for each in given for axles in AXLES]

    def of_order(order: tuple[Compared, str]) -> tuple[list[SensorRow], list[FaultRow]]:
        compared, axles = order
        made = list(sensor_rows(compared, axles, options.sensors, options.planned))
        tell(f"{compared.site.title}, {axles} axle: {len(made)} layouts")
        few = passes.part(0, min(options.fault_passes, len(passes)))
        return [each.row for each in made], list(faults_of(compared.site, made, options.faulty, few))

    found = side_by_side(of_order, orders)
    tell("more and more sensors")
    many = tuple(many_rows(passes, resolution, options.many, options.many_std_m_s))
    tell("several grids")
    grids = side_by_side(lambda order: grid_row(*order, passes), grid_orders(options, resolution))
    tell("passages that are not heard")
    few = passes.part(0, min(options.fault_passes, len(passes)))
    missed = side_by_side(lambda order: missed_row(*order, resolution, few), missed_orders(options))
    radar_rows: tuple[RadarRow, ...] = tuple(row for row, _ in radars)
    return PointSensorWorth(
        seed, options.passes, min(options.fault_passes, options.passes), options.path_step_m, options.speed_step_m_s,
        options.friction_nodes, radar_rows, tuple(row for rows, _ in found for row in rows),
        tuple(row for _, rows in found for row in rows), many, grids, missed,
    )  # fmt: skip


def resolution_of(options: Options, site: Site) -> Resolution:
    """The grid that the tables are made on."""
    base = site.config.resolution
    return Resolution(
        options.path_step_m, options.speed_step_m_s, base.reference_speed_m_s, base.transient_substeps,
        options.friction_nodes, base.path_levels, base.resistance_nodes,
    )  # fmt: skip


def faults_of(site: Site, made: list[MadeLayout], counts: tuple[int, ...], passes: RandomPasses) -> Iterator[FaultRow]:
    """Faults of the planned layouts with so many sensors."""
    for each in made:
        if each.row.layout == "planned" and each.row.sensors in counts:
            yield from fault_rows(site, each.row.axles, tabulated(site, each.tuned), passes)


def grid_orders(options: Options, resolution: Resolution) -> list[tuple[Site, str, int, Resolution]]:
    """(site, axles, sensors, grid): that of a tune, that of the study."""
    return [
        (site, axles, options.grid_sensors, grid)
        for site in sites(options.grid_cases)
        for axles in AXLES
        for grid in (site.config.resolution, resolution)
    ]


def missed_orders(options: Options) -> list[tuple[Site, str, int, float]]:
    """(site, axles, sensors, share of passages counted as not heard)."""
    return [
        (site, axles, options.missed_sensors, share)
        for site in sites(options.missed_cases)
        for axles in AXLES
        for share in options.missed
    ]


def grid_row(site: Site, axles: str, sensors: int, grid: Resolution, passes: RandomPasses) -> GridRow:
    """Equal sections on one grid."""
    kind = PointSensors((0.0,), axles=AXLES[axles])
    first_m = first_sensor_m(site.plant, kind, site.target_m_s)
    placed = with_layout(kind, equal_layout(first_m, site.plant.exit_m, sensors - 1), site.plant.exit_m)
    made = sensor_table(site, placed, grid)
    found = exit_statistics(made.run(passes), site.target_m_s)
    return GridRow(
        site.title, axles, sensors, grid.path_step_m, grid.speed_step_m_s, made.tuned.rms_m_s, found.rms_m_s,
        found.rms_ci95_m_s,
    )  # fmt: skip


SMALLEST = Options(
    cases=("park-22",), sensors=(3, 4), planned=(4,), faulty=(4,), passes=400, fault_passes=200, frictions=3,
    path_step_m=1.0, speed_step_m_s=0.1, friction_nodes=3, many=(5,), many_std_m_s=(0.05,), grid_cases=("park-22",),
    grid_sensors=3, missed=(0.0, 0.1), missed_cases=("park-22",), missed_sensors=3,
)  # fmt: skip
METHOD = Method(Options, SMALLEST, PointSensorWorth, run)
