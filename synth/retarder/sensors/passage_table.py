"""The one way from an aim to a table for point sensors: solve, polish, round, predict, tabulate."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from plant_models import Plant, PointSensors, every_axle
from plant_models.frozen_arrays import Floats, frozen_arrays
from plant_models.point_sensors import credible_motion, deciding_passages
from synth.problem.problem import Aim
from synth.problem.resolution import Resolution, finer_for_check
from synth.solver.backward_induction import solve
from synth.solver.chain.chain import Chain, check_chain, persistent_chain
from synth.solver.chain.sampling import SensorPassages
from synth.solver.descent import Descent
from synth.solver.exit_density import ExitDensity
from synth.solver.passage_speeds import PassageSpeeds, ordered, polish_passages
from synth.solver.resolved_density import resolved_density
from synth.solver.tabulate import LOWEST_VALID_SPEED_M_S, cut_of, prediction_of, retarder_of
from tuning_tables import Generator
from tuning_tables.decisions import Approach
from tuning_tables.passages.passage_row import PassageRow
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.sensor_layout import DecidesOn, PlausibleMotion, SensorLayout

LEAST_FRICTIONS = 7
"""Of fewer, sensors that measure well tell one from the other: lines polished on five frictions and 64 evaluations cost
0.009 m/s there, and 0.031 on a fine grid (12 equal sections, every axle, 22 t to 2 m/s)."""

RESISTANCES = 1
"""Of the running resistance a design takes the mean: more was not tried with sensors."""


@frozen_arrays
class TunedPassages:
    """Switching speeds as a table holds them, and the exit density predicted of them.

    `polish`: how they were found; they are float32 numbers of the stages that the cut may use.
    """

    plant: Plant
    sensors: PointSensors
    aim: Aim
    polish: Descent[PassageSpeeds]
    predicted: ExitDensity

    @property
    def speeds(self) -> PassageSpeeds:
        """The switching speeds."""
        return self.polish.best

    @property
    def rms_m_s(self) -> float:
        """Predicted rms error at the exit."""
        return self.predicted.rms_m_s(self.aim.target_speed_m_s)


@dataclass(frozen=True)
class PassageChains:
    """The chains of one plant with point sensors: to design switching speeds on, and to predict finished ones."""

    sensors: PointSensors
    design: Chain
    check: Chain


def passage_chains(plant: Plant, sensors: PointSensors, resolution: Resolution) -> PassageChains:
    """Both chains; `plant` begins at the first sensor (`with_point_sensors`).

    The design counts with `missed_share`; the prediction hears every passage.
    """
    frictions = max(resolution.friction_nodes, LEAST_FRICTIONS)
    tuned_on = replace(resolution, friction_nodes=frictions, resistance_nodes=RESISTANCES)
    design = persistent_chain(plant, tuned_on, SensorPassages(sensors))
    every = replace(sensors, missed_share=0.0)
    check = check_chain(plant, finer_for_check(resolution), SensorPassages(every))
    return PassageChains(sensors, design, check)


def tuned_passages(chains: PassageChains, aim: Aim) -> TunedPassages:
    """Switching speeds for one aim: those of the solution, polished, rounded to float32, and predicted."""
    solution = solve(chains.design, aim)
    found = polish_passages(solution)
    speeds = rounded(found.best)
    predicted = resolved_density(chains.check, speeds, aim.target_speed_m_s)
    return TunedPassages(chains.design.plant, chains.sensors, aim, found.ending(speeds, found.cost_after), predicted)


def rounded(speeds: PassageSpeeds) -> PassageSpeeds:
    """The float32 numbers next to the switching speeds, in order; none is negative."""
    apart = ordered(np.where(np.isfinite(speeds.switching_m_s), np.maximum(speeds.switching_m_s, 0.0), np.inf))
    kept: Floats = np.where(np.isfinite(speeds.switching_m_s), apart, speeds.switching_m_s)
    return PassageSpeeds(kept.astype(np.float32).astype(np.float64) + 0.0)


ABOVE_FASTEST_M_S = 2.0
"""Speeds are valid up to so much more than the position takes."""


def passage_table(tuned: TunedPassages, generator: Generator, table_id: str, created: str) -> PassageTable:
    """The table to export, predicted and not yet validated. Raises `tuning_tables.InvalidTable`."""
    plant, sensors = tuned.plant, tuned.sensors
    position = plant.position
    highest = float(np.ceil(position.max_entry_speed_m_s + ABOVE_FASTEST_M_S))
    met = deciding_passages(sensors, plant.cut, plant.exit_m)
    rows = with_forbidden_stages(tuned.speeds.switching_m_s, position.top_stage, highest)
    return PassageTable(
        id=table_id,
        created=created,
        generator=generator,
        retarder=retarder_of(plant),
        cut=cut_of(plant),
        target_speed_m_s=float(tuned.aim.target_speed_m_s),
        pressure_kpa=tuple(float(pressure) for pressure in position.stage_pressures_kpa),
        sensors=layout_of(sensors),
        approach=Approach(float(-plant.start_m), plant.entrance_stage),
        initial_stage=plant.approach.initial_stage,
        passages=tuple(
            PassageRow(each.sensor, each.axle, float(each.path_m), tuple(tuple(map(float, row)) for row in speeds))
            for each, speeds in zip(met, rows, strict=True)
        ),
        plausible=plausible_motion(plant, sensors),
        valid_v_m_s=(LOWEST_VALID_SPEED_M_S, highest),
        predicted=prediction_of(tuned.predicted, tuned.aim.target_speed_m_s),
    )


def with_forbidden_stages(switching_m_s: np.ndarray, top: int, highest_m_s: float) -> np.ndarray:
    """Rows of all stages 0 … `top` of the position, (M, top + 1, top), from those that the cut may use.

    A stage that it may not use is never entered, and is left for the highest allowed one at once.
    """
    passages, stages, used = switching_m_s.shape
    rows = np.full((passages, top + 1, top), np.inf)
    rows[:, :stages, :used] = switching_m_s
    for stage in range(stages, top + 1):
        rows[:, stage, :used] = switching_m_s[:, stages - 1]
        rows[:, stage, used:stage] = np.float32(highest_m_s + 1.0)
    return rows


def layout_of(sensors: PointSensors) -> SensorLayout:
    """The sensors as a table tells them."""
    return SensorLayout(
        path_m=tuple(float(place) for place in sensors.path_m),
        base_m=sensors.base_m,
        base_tolerance=sensors.base_tolerance,
        timer_noise_s=sensors.timer_noise_s,
        timer_resolution_s=sensors.timer_resolution_s,
        computing_delay_s=sensors.computing_delay_s,
        scan_period_s=sensors.scan_period_s,
        decides_on=DecidesOn.EVERY_AXLE if sensors.axles is every_axle else DecidesOn.FIRST_AXLE,
    )


def plausible_motion(plant: Plant, sensors: PointSensors) -> PlausibleMotion:
    """The limits of the tracker, as a table holds them."""
    limits = credible_motion(plant, sensors)
    return PlausibleMotion(
        limits.speed_m_s,
        limits.acceleration_m_s2,
        limits.deceleration_m_s2,
        limits.speed_tolerance,
        limits.path_tolerance_m,
    )
