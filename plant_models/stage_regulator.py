"""The stage-locked actuator, with its resting modes, commands and the pressure histories between them; and the brake
power of a position, the energy head that its full brake takes from a cut.

A command is taken at a sample; no other is taken until its transient has ended (zhukovitsky-2002: choice only at the
discrete pressures P_k). So a change of stage lasts a whole number of sampling periods, and what the brake does
meanwhile is known when the command is given. Because the regulator stops at the edge of its dead band, a stage rests at
P_k − ε when it is reached from below and at P_k + ε from above: the resting *mode* is (stage, pressure).

The work of the brake is the force on each wheel pair times the braked length, summed over the wheel pairs. It depends
on mass and axles of the cut; where the cars couple matters only to force laws whose slope depends on how many wheel
pairs are braked at once.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from plant_models.cut import GRAVITY_M_S2, Car, Cut, couple
from plant_models.errors import require
from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from plant_models.motion import path_breaks_m, path_coefficients
from plant_models.pneumatics import PressureHistory
from plant_models.pressure_regulator import overpressure_kpa
from plant_models.retarder import RetarderPosition
from plant_models.track_profile import TrackProfile


@frozen_arrays
class Actuator:
    """Modes and commands of a position for a cut that may use stages 0 … K.

    H modes: `mode_stage` (H,), `mode_overpressure_kpa` (H,) = max(0, P − P0); mode 0 is the released one.
    `command` (H, K + 1): index of the chain that leads from a mode to a stage, −1 to the stage itself.
    C chains: `chain_mode` (C,) resting mode at the end, `chain_samples` (C,) duration in sampling periods,
    `chain_overpressure_kpa` (C, longest·substeps): means over `substeps` equal parts of each period,
    counted from the sample at which the command was decided (computing delay and valve delay included).
    """

    mode_stage: Ints
    mode_pressure_kpa: Floats
    mode_overpressure_kpa: Floats
    command: Ints
    chain_mode: Ints
    chain_samples: Ints
    chain_overpressure_kpa: Floats
    substeps: int

    @property
    def stages(self) -> int:
        """Number of stages K + 1."""
        return int(self.command.shape[1])

    def mode_of(self, stage: int) -> int:
        """The mode in which `stage` rests when it was reached from below."""
        return int(np.argmax(self.mode_stage == stage))

    def change(self, mode: int, stage: int) -> tuple[int, int]:
        """(mode at the end, duration in sampling periods) of the command of `stage` from `mode`; (mode, 0) if there."""
        chain = int(self.command[mode, stage])
        return (mode, 0) if chain < 0 else (int(self.chain_mode[chain]), int(self.chain_samples[chain]))


class RegulatorClock(Protocol):
    """How a regulator counts time: radar and point sensors are both one."""

    @property
    def sample_period_s(self) -> float:
        """Durations of changes of stage are whole numbers of these."""
        ...

    @property
    def computing_delay_s(self) -> float:
        """From the decision to the command on the valves' wires."""
        ...


def reaches_valves_s(decided_s: float, computing_delay_s: float) -> float:
    """Computing delay: the time at which a command decided at `decided_s` is on the valves' wires."""
    return decided_s + computing_delay_s


def stage_locked_actuator(position: RetarderPosition, clock: RegulatorClock, top_stage: int, substeps: int) -> Actuator:
    """Modes and chains of `position` with its stages 0 … `top_stage` under the regulator's `clock`."""
    touch = position.force.touch_pressure_kpa
    modes = resting_modes(position, top_stage)
    command = np.full((len(modes), top_stage + 1), -1)
    delay_s = reaches_valves_s(0.0, clock.computing_delay_s)
    ends: list[int] = []
    samples: list[int] = []
    histories: list[tuple[float, PressureHistory]] = []
    for mode, (stage, pressure) in enumerate(modes):
        for wanted in range(top_stage + 1):
            if wanted == stage:
                continue
            history = position.pneumatics.respond(pressure, position.stage_pressures_kpa[wanted], touch)
            command[mode, wanted] = len(ends)
            distance = [abs(p - history.end_kpa) if k == wanted else math.inf for k, p in modes]
            ends.append(int(np.argmin(distance)))
            busy_s = delay_s + history.duration_s
            samples.append(max(1, math.ceil(busy_s / clock.sample_period_s - 1e-9)))
            histories.append((pressure, history))
    count = max(samples) * substeps
    edges = np.arange(count + 1) * (clock.sample_period_s / substeps) - delay_s
    overpressure = np.empty((len(ends), count))
    for chain, (pressure, history) in enumerate(histories):
        before = max(0.0, pressure - touch) * np.minimum(edges, 0.0)
        after = history.overpressure_integral(np.maximum(edges, 0.0), touch)
        overpressure[chain] = np.diff(before + after) / np.diff(edges)
    pressures = np.array([p for _, p in modes])
    return Actuator(
        mode_stage=np.array([k for k, _ in modes]),
        mode_pressure_kpa=pressures,
        mode_overpressure_kpa=overpressure_kpa(pressures, touch),
        command=command,
        chain_mode=np.array(ends),
        chain_samples=np.array(samples),
        chain_overpressure_kpa=overpressure,
        substeps=substeps,
    )


def resting_modes(position: RetarderPosition, top_stage: int) -> list[tuple[int, float]]:
    """(stage, pressure) pairs at which the regulator can rest: P_k − ε from below, P_k + ε from above.

    Closing delays shift them; the pressures are those that commands between neighbouring stages end at.
    """
    pressures = position.stage_pressures_kpa
    touch = position.force.touch_pressure_kpa
    below, above = [0.0] * (top_stage + 1), [0.0] * (top_stage + 1)
    for k in range(1, top_stage + 1):
        below[k] = position.pneumatics.respond(pressures[k - 1], pressures[k], touch).end_kpa
    for k in range(top_stage):
        above[k] = position.pneumatics.respond(pressures[k + 1], pressures[k], touch).end_kpa
    modes = [(0, above[0])]
    for k in range(1, top_stage):
        modes += [(k, below[k]), (k, above[k])]
    return [*modes, (top_stage, below[top_stage])]


MASSES_T = (20.0, 100.0)
"""Masses of a car between which, and beyond, the work is linear: force laws are constant or linear in mass."""


@dataclass(frozen=True)
class FullBrake:
    """What the full brake of `position` takes; axles stand as in cuts of whole cars of the type `car`.

    The brake is full from the first axle to the last: at rest in a stage, reached from below, at the mean friction.
    A brake that still closes at the entrance takes less: 1 to 4 % with a regulator that acts from 4 m ahead.
    """

    position: RetarderPosition
    car: Car

    def head_m(self, mass_t: Floats, axles: Ints, top_stage: Ints) -> Floats:
        """Energy head h in metres of cuts (n,) of `mass_t` on `axles`; the work over the whole position is m·g·h.

        In the highest stage that both the position and `top_stage` (n,) allow. `PlantError` for a cut without axles
        or mass.
        """
        require(bool(np.all(mass_t > 0.0) and np.all(axles > 0)), "full brake: each cut must have a mass and axles")
        stages, which = np.unique(np.minimum(top_stage, self.position.top_stage), return_inverse=True)
        rest = np.array([resting_overpressure_kpa(self.position, int(stage)) for stage in stages])
        counts, of_count = np.unique(axles, return_inverse=True)
        at_masses = np.array([self.work_kj_per_kpa(int(count)) for count in counts])[of_count]
        cars = axles / len(self.car.axle_offsets_m)
        light, heavy = MASSES_T
        work = at_masses[:, 0] + (at_masses[:, 1] - at_masses[:, 0]) * (mass_t / cars - light) / (heavy - light)
        return np.asarray(rest[which] * work / (mass_t * GRAVITY_M_S2))

    def work_kj_per_kpa(self, axles: int) -> tuple[float, ...]:
        """Work over the whole position by 1 kPa of overpressure on `axles`, for cars of each of `MASSES_T`.

        Of the nearest number of whole cars, in proportion to the axles.
        """
        if axles not in self._works:
            cars = max(1, round(axles / len(self.car.axle_offsets_m)))
            cuts = (couple((self.car,) * cars, mass_t * cars, "", 1) for mass_t in MASSES_T)
            self._works[axles] = tuple(self._work_kj_per_kpa(cut) * axles / cut.axles for cut in cuts)
        return self._works[axles]

    @cached_property
    def _works(self) -> dict[int, tuple[float, ...]]:
        """Those already worked out, by axles: trains ask for few numbers of axles, but for each thousands of times."""
        return {}

    def _work_kj_per_kpa(self, cut: Cut) -> float:
        """That of a cut of whole cars."""
        edges = path_breaks_m(self.position, cut, TrackProfile.uniform(0.0))
        brake = path_coefficients(self.position, cut, TrackProfile.uniform(0.0), edges).brake_m_s2_per_kpa
        return float(brake @ np.diff(edges)) * cut.inertia_t


def resting_overpressure_kpa(position: RetarderPosition, stage: int) -> float:
    """Pressure above that of touching at which the regulator rests in `stage`, 0 or more, reached from below."""
    if stage == 0:
        return 0.0
    return max(0.0, resting_modes(position, stage)[-1][1] - position.force.touch_pressure_kpa)
