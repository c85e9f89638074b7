"""What faults of point sensors cost: exits with a fault beside those of the same passes without, with the limits
of the table's tracker and with limits that believe anything.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from plant_models import PointSensors
from scripts.studies.point_sensors.rows import FaultRow
from scripts.studies.point_sensors.sensor_faults import (
    DeadSensor,
    LateSensor,
    LoneAxle,
    MissedPulses,
    RepeatedPulses,
    ReversedSensor,
    SensorFault,
    SpuriousPulses,
    StuckReading,
    SwappedSensors,
    together,
)
from scripts.studies.point_sensors.sites import SensorTable, Site
from synth.kernels.loop.passes import Draws
from synth.simulation.exit_statistics import ExitStatistics, exit_statistics, rms_ratio
from synth.simulation.passage_controller import PassageController, of_table
from synth.simulation.passage_loop import PassageLoop
from synth.simulation.random_passes import RandomPasses
from synth.simulation.replicates import Interval


@dataclass(frozen=True)
class FaultCase:
    """Faults that are there together in every pass, and what they are called."""

    name: str
    faults: tuple[SensorFault, ...]


@dataclass(frozen=True)
class FaultFigures:
    """Exits of passes with the faults of a case; `rms_ratio`: their rms over that of the same passes without fault; the
    interval is the paired one, 95 %."""

    name: str
    statistics: ExitStatistics
    rms_ratio: float
    rms_ratio_ci95: Interval


def fault_figures(
    loop: PassageLoop, controller: PassageController, draws: Draws, target_m_s: float, cases: Sequence[FaultCase]
) -> tuple[FaultFigures, ...]:
    """Figures of every case, in order, after those without fault, whose ratio is 1; all on the passes of `draws`.

    `controller` needs limits for its tracker. `ValueError` for fewer than two replicates of passes.
    """
    whole = loop.run(controller, draws, together(loop.sensors, ()))
    found = [FaultFigures("no fault", exit_statistics(whole, target_m_s), 1.0, (1.0, 1.0))]
    for case in cases:
        sample = loop.run(controller, draws, together(loop.sensors, case.faults))
        statistics = exit_statistics(sample, target_m_s)
        found.append(FaultFigures(case.name, statistics, *rms_ratio(sample, whole, target_m_s)))
    return tuple(found)


def single_faults(sensors: PointSensors, target_m_s: float, entry_m_s: float) -> tuple[FaultCase, ...]:
    """One fault at a time: every sensor dead, stuck, reversed, late and swapped, then those that strike any sensor.

    A stuck sensor tells `entry_m_s` or `target_m_s`, what it measures at most and at least; a late one is 0.5 s late. A
    lone axle rolls 20 s or 2 s ahead of the cut with `entry_m_s`, or 2 s behind its first axle with `target_m_s`.
    """
    cases: list[FaultCase] = []
    for sensor in range(len(sensors.path_m)):
        cases += [
            FaultCase(f"sensor {sensor} dead", (DeadSensor(sensor),)),
            FaultCase(f"sensor {sensor} stuck at the entry speed", (StuckReading(sensor, entry_m_s),)),
            FaultCase(f"sensor {sensor} stuck at the target", (StuckReading(sensor, target_m_s),)),
            FaultCase(f"sensor {sensor} reversed", (ReversedSensor(sensor),)),
            FaultCase(f"sensor {sensor} late by 0.5 s", (LateSensor(sensor, 0.5),)),
            FaultCase(f"sensor {sensor} chatters", (RepeatedPulses(sensor, 10, 0.1),)),
        ]
        if sensor + 1 < len(sensors.path_m):
            cases.append(FaultCase(f"sensors {sensor} and {sensor + 1} swapped", (SwappedSensors(sensor),)))
    return (
        *cases,
        FaultCase("one pair in twenty missed", (MissedPulses(0.05),)),
        FaultCase("every pair double", (RepeatedPulses(None, 1, 0.05),)),
        FaultCase("one spurious pair", (SpuriousPulses(1),)),
        FaultCase("five spurious pairs", (SpuriousPulses(5),)),
        FaultCase("lone axle 20 s ahead", (LoneAxle(20.0, entry_m_s),)),
        FaultCase("lone axle 2 s ahead", (LoneAxle(2.0, entry_m_s),)),
        FaultCase("lone axle 2 s behind", (LoneAxle(-2.0, target_m_s),)),
    )


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
