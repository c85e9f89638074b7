"""The drive at the samples as a finite automaton: what it can be in, and where a period with a command leads.

At a sample the drive is known by the commanded stage, the pressure and the time that the valve it needs still waits
before it opens. The delays run from a command, commands come a computing delay after a sample: so the waits that can
occur at samples are few, and a *mode* is (stage, pressure node, wait). The pressure after a period lies between nodes;
the value there is interpolated. Both are worked out once, before any sweep: they depend on no speed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models import Plant
from plant_models.frozen_arrays import frozen_arrays
from plant_models.stage_regulator import resting_modes
from plant_models.valve_drive import ValveDrive
from synth.kernels.any_time.driven_period import play_period
from synth.solver.any_time.pressure_grid import STENCIL, PressureGrid, pressure_grid

COMMANDS = (-1, 0, 1)
"""Stages by which the commands of a sample change the stage, in the order of the arrays' second axis."""


@frozen_arrays
@dataclass(frozen=True, eq=False)
class DriveModes:
    """M modes that can be reached from the released one, which is mode 0.

    `stage`, `node`, `wait` (M,): commanded stage, index into `grid.nodes_kpa` and into `waits_s`; `rests` (M,): the
    pressure is within the stage's dead band. `allowed` (M, 3) commands; `target`, `weight` (M, 3, 4): modes and weights
    that stand for where the drive is at the next sample; `overpressure_kpa` (M, 3, parts): means over equal parts of
    the period.
    """

    drive: ValveDrive
    grid: PressureGrid
    waits_s: NDArray[np.float64]
    stage: NDArray[np.int64]
    node: NDArray[np.int64]
    wait: NDArray[np.int64]
    rests: NDArray[np.bool_]
    allowed: NDArray[np.bool_]
    target: NDArray[np.int64]
    weight: NDArray[np.float64]
    overpressure_kpa: NDArray[np.float64]

    @property
    def stages(self) -> int:
        """Number of stages K + 1."""
        return int(self.stage.max()) + 1

    @property
    def pressure_kpa(self) -> NDArray[np.float64]:
        """Pressure of every mode, (M,)."""
        return self.grid.nodes_kpa[self.node]


@dataclass
class Found:
    """Modes and waits found so far by `drive_modes`, in the order in which they were found."""

    modes: dict[tuple[int, int, int], int]
    waits_s: list[float]

    def wait_index(self, wait_s: float) -> int:
        """Index of a wait; equal ones differ by rounding alone."""
        for i, known in enumerate(self.waits_s):
            if abs(known - wait_s) < 1e-9:
                return i
        self.waits_s.append(wait_s)
        return len(self.waits_s) - 1

    def mode_index(self, stage: int, node: int, wait: int) -> int:
        """Index of a mode, a new one if it was not met before."""
        return self.modes.setdefault((stage, node, wait), len(self.modes))


def drive_modes(plant: Plant, step_kpa: float, parts: int) -> DriveModes:
    """All modes of `plant`'s drive on a pressure grid of `step_kpa`, a period cut into `parts`.

    Raises `PlantError` as `Plant.drive_at_any_time`.
    """
    position, sensor, top = plant.position, plant.sensor, plant.top_stage
    drive = plant.drive_at_any_time()
    grid = pressure_grid(position, top, step_kpa)
    stages = position.stage_pressures_kpa
    start = resting_modes(position, top)[0][1]
    found = Found({(0, int(np.abs(grid.nodes_kpa - start).argmin()), 0): 0}, [0.0])
    rows: list[tuple[list[bool], list[list[int]], list[list[float]], list[NDArray[np.float64]]]] = []
    while len(rows) < len(found.modes):
        stage, node, wait = list(found.modes)[len(rows)]
        allowed, targets, weights, overs = [], [], [], []
        for command in COMMANDS:
            allowed.append(0 <= stage + command <= top)
            wanted = stage + command if allowed[-1] else stage
            over = np.empty(parts)
            pressure, left = play_period(
                grid.nodes_kpa[node], found.waits_s[wait], stages[stage], stages[wanted],
                sensor.computing_delay_s, sensor.sample_period_s, drive, over,
            )  # fmt: skip
            index, share = grid.weights(pressure)
            in_band = np.abs(grid.nodes_kpa[index] - stages[wanted]) <= drive.band_kpa * (1 + 1e-9)
            waits = np.where(in_band, 0, found.wait_index(left))  # a stage at rest waits for nothing
            modes = [found.mode_index(wanted, int(b), int(q)) for b, q in zip(index, waits, strict=True)]
            targets.append(modes + [modes[0]] * (STENCIL - len(modes)))
            weights.append([*share, *[0.0] * (STENCIL - len(modes))])
            overs.append(over)
        rows.append((allowed, targets, weights, overs))
    allowed_rows, targets_rows, weight_rows, over_rows = zip(*rows, strict=True)
    stage_of, node_of, wait_of = np.array(list(found.modes)).T
    away = np.abs(np.asarray(stages)[stage_of] - grid.nodes_kpa[node_of])
    return DriveModes(
        drive=drive,
        grid=grid,
        waits_s=np.array(found.waits_s),
        stage=stage_of.copy(),
        node=node_of.copy(),
        wait=wait_of.copy(),
        rests=away <= drive.band_kpa * (1 + 1e-9),
        allowed=np.array(allowed_rows),
        target=np.array(targets_rows),
        weight=np.array(weight_rows),
        overpressure_kpa=np.array(over_rows),
    )
