"""Passes of a cut under a table for point sensors, in plain Python and coarse steps of time.

Plant, friction and drive are those of `synth.checker.coarse_simulation`. A step ends where a deciding axle is over a
coil, so that times over a base are those of the motion; the pressure regulator is played as a relay, and a change of
stage is over at the first scan after it has come to rest. All this differs from the simulator that made the claims.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from random import Random
from typing import Final

from synth.checker.brake_drive import BrakeDrive
from synth.checker.coarse_simulation import (
    LONGEST_PASS_S,
    LONGEST_STEP_S,
    Ground,
    Passes,
    friction_row,
    ground_of,
    resting_kpa,
    start_speed_m_s,
)
from synth.checker.drawn_cuts import friction_numbers
from synth.checker.passages.table import PassageTable, wanted
from synth.checker.plant import Plant

ROUNDING_S: Final = 1e-9
"""A change that ends by so much behind a scan has ended at it."""


@dataclass(frozen=True)
class Coil:
    """The first axle stands at `path_m` when the axle of `passage` is over the coil; `second`: of the two."""

    path_m: float
    passage: int
    second: bool


def simulate(plant: Plant, table: PassageTable, count: int, seed: int) -> Passes:
    """`count` passes of `plant`, whose approach is the table's; equal arguments give equal passes."""
    ground, random, rest_kpa = ground_of(plant), Random(f"{seed} {table.id}"), resting_kpa(plant)
    friction = friction_numbers(count, random)
    found = [PassOverSensors(plant, ground, table, rest_kpa, each.normal, random).run() for each in friction]
    speeds, stalled, switchings = zip(*found, strict=True)
    weights = tuple(each.weight for each in friction)
    return Passes(speeds, stalled, switchings, weights, tuple(each.as_it_comes for each in friction))


class PassOverSensors:
    """One pass as it moves on in time; `normal`: of the cut's friction."""

    def __init__(
        self, plant: Plant, ground: Ground, table: PassageTable, rest_kpa: float, normal: float, random: Random
    ) -> None:
        self.plant, self.ground, self.table, self.random = plant, ground, table, random
        self.friction = friction_row(plant, ground, normal, random)
        mean, std = plant.resistance_n_kn
        w = random.gammavariate((mean / std) ** 2, std * std / mean) if std > 0.0 else mean
        self.drag = w * ground.drag_m_s2_per_n_kn
        self.drive = BrakeDrive(plant.drive, rest_kpa)
        self.time_s, self.s_m, self.stage, self.switchings = 0.0, ground.start_m, plant.initial_stage, 0
        self.v_m_s = start_speed_m_s(ground, self.drag, plant.entry.draw(random))
        self.commanded_s, self.ended_s = -math.inf, -math.inf
        self.first_pulse_s: dict[int, float] = {}

    def run(self) -> tuple[float, bool, int]:
        """(exit speed, stalled, changes of stage)."""
        coils = coils_of(self.table, self.random)
        while self.time_s < LONGEST_PASS_S:
            limit_m = coils[0].path_m if coils else self.plant.exit_m
            reached = self.move_on(min(limit_m, self.plant.exit_m))
            if self.v_m_s <= 0.0:
                return 0.0, True, self.switchings
            if reached and (not coils or coils[0].path_m >= self.plant.exit_m):
                return self.v_m_s, False, self.switchings
            if reached:
                self.pulse(coils.pop(0))
        return 0.0, True, self.switchings

    def move_on(self, limit_m: float) -> bool:
        """Roll on for a step, or to `limit_m` if that is reached in it, which is told."""
        v, held = self.v_m_s, self.drive.overpressure_kpa
        middle = self.s_m + 0.5 * v * LONGEST_STEP_S
        ground = self.ground
        cell = min(int((middle - ground.start_m) / ground.cell_m), len(ground.gravity_m_s2) - 1)
        xi = self.friction[min(int(max(0.0, middle) / ground.noise_cell_m), ground.noise_cells - 1)]
        brake, free = xi * ground.brake_m_s2_per_kpa[cell], ground.gravity_m_s2[cell] - self.drag
        step = min(LONGEST_STEP_S, time_to(limit_m - self.s_m, v, free - brake * held))
        was_resting = self.drive.resting
        pressed = held if was_resting else self.drive.overpressure(step)
        a = free - brake * pressed
        self.time_s += step
        if not was_resting and self.drive.resting:
            scan = self.table.scan_period_s
            scans = math.ceil((self.time_s - self.commanded_s - ROUNDING_S) / scan)
            self.ended_s = self.commanded_s + max(1, scans) * scan
        self.s_m += (v + 0.5 * a * step) * step
        self.v_m_s = v + a * step
        return step < LONGEST_STEP_S or self.s_m >= limit_m

    def pulse(self, coil: Coil) -> None:
        """An axle is over a coil; over the second one the regulator decides."""
        if not coil.second:
            self.first_pulse_s[coil.passage] = self.time_s
            return
        table, first_s = self.table, self.first_pulse_s[coil.passage]
        told_s = self.time_s - first_s + table.timer_noise_s * self.random.gauss(0.0, 1.0)
        if table.timer_resolution_s > 0.0:
            told_s = round(told_s / table.timer_resolution_s) * table.timer_resolution_s
        at_rest = self.drive.resting and 0.5 * (first_s + self.time_s) >= self.ended_s
        if told_s <= 0.0 or not at_rest:
            return
        stage = wanted(table, coil.passage, self.stage, table.base_m / told_s)
        if stage != self.stage:
            self.stage, self.commanded_s = stage, self.time_s
            self.switchings += 1
            self.drive.command(self.plant.stages_kpa[stage], table.computing_delay_s)


def coils_of(table: PassageTable, random: Random) -> list[Coil]:
    """The coils of one pass in the order of the path; the base of each sensor is off by its tolerance."""
    factor = [1.0 + table.base_tolerance * random.gauss(0.0, 1.0) for _ in table.sensors_m]
    found = []
    for number, passage in enumerate(table.passages):
        half_m = 0.5 * table.base_m * max(factor[passage.sensor], 0.1)
        found += [Coil(passage.path_m - half_m, number, False), Coil(passage.path_m + half_m, number, True)]
    return sorted(found, key=lambda coil: coil.path_m)


def time_to(way_m: float, v_m_s: float, a_m_s2: float) -> float:
    """Time for `way_m` from the speed v on with constant acceleration; infinite if it is never done."""
    square = v_m_s * v_m_s + 2.0 * a_m_s2 * way_m
    if way_m <= 0.0:
        return 0.0
    return 2.0 * way_m / (v_m_s + math.sqrt(square)) if square > 0.0 else math.inf
