"""What faults of point sensors cost, with the limits of the table's tracker and with limits that believe anything."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from scripts.studies.point_sensors.rows import FaultRow
from scripts.studies.point_sensors.sensor_fault_figures import FaultCase, FaultFigures, fault_figures, single_faults
from scripts.studies.point_sensors.sensor_faults import together
from scripts.studies.point_sensors.sensor_table import SensorTable
from scripts.studies.point_sensors.sites import Site
from synth.simulation.exit_statistics import rms_ratio
from synth.simulation.passage_controller import of_table
from synth.simulation.random_passes import RandomPasses

WIDE: dict[str, Any] = {
    "least_m_s": np.float32(0.01),
    "greatest_m_s": np.float32(40.0),
    "acceleration_m_s2": np.float32(10.0),
    "deceleration_m_s2": np.float32(10.0),
    "speed_tolerance": np.float32(0.9),
    "path_tolerance_m": np.float32(10.0),
}
"""The widest that a table may have: hardly a pair of pulses is not believed."""


def fault_rows(site: Site, axles: str, made: SensorTable, passes: RandomPasses) -> Iterator[FaultRow]:
    """A row for every fault, after the one without; all on the same passes."""
    target, draws, loop = site.target_m_s, made.loop.draws(passes), made.loop
    controller = of_table(made.table, tracking=True)
    wide = replace(controller, rule=controller.rule._replace(**WIDE))
    whole = loop.run(controller, draws, together(loop.sensors, ()))
    cases = single_faults(loop.sensors, target, made.plant.entry.high_m_s)
    figures = fault_figures(loop, controller, draws, target, cases)
    for case, each in zip((FaultCase("no fault", ()), *cases), figures, strict=True):
        sample = loop.run(wide, draws, together(loop.sensors, case.faults))
        yield row_of(site, axles, each, rms_ratio(sample, whole, target))


def row_of(site: Site, axles: str, figures: FaultFigures, wide: tuple[float, tuple[float, float]]) -> FaultRow:
    """One fault."""
    found = figures.statistics
    return FaultRow(
        case=site.title,
        axles=axles,
        fault=figures.name,
        rms_m_s=found.rms_m_s,
        rms_ci95_m_s=found.rms_ci95_m_s,
        ratio=figures.rms_ratio,
        ratio_ci95=figures.rms_ratio_ci95,
        wide_ratio=wide[0],
        wide_ratio_ci95=wide[1],
        overspeed=found.overspeed,
        overspeed_ci95=found.overspeed_ci95,
        stalled=found.stalled,
        stalled_ci95=found.stalled_ci95,
    )
