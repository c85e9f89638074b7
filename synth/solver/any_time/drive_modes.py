"""The drive at the samples as a finite automaton: what it can be in, and where a period with a command leads.

At a sample the drive is known by the commanded stage, the pressure and the time that the valve it needs still waits
before it opens. The delays run from a command, commands come a computing delay after a sample: so the waits that can
occur at samples are few, and a *mode* is (stage, pressure node, wait). The pressure after a period lies between nodes;
the value there is interpolated. Both are worked out once, before any sweep: they depend on no speed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from plant_models import Plant, RetarderPosition
from plant_models.frozen_arrays import Bools, Floats, Ints, frozen_arrays
from plant_models.stage_regulator import resting_modes
from plant_models.valve_drive import ValveDrive
from synth.kernels.any_time.driven_period import play_period

COMMANDS = (-1, 0, 1)
"""Stages by which the commands of a sample change the stage, in the order of the arrays' second axis."""


STENCIL = 4
"""Nodes that interpolate one pressure, at most."""


@frozen_arrays
class PressureGrid:
    """`nodes_kpa` (B,) increasing; `breaks` (·,) indices of the nodes at which the cost has a kink, both ends included.

    Between two breaks the cost is smooth in the pressure; a break is a pressure at which some stage rests, or P0.
    """

    nodes_kpa: Floats
    breaks: Ints

    def weights(self, pressure_kpa: float) -> tuple[Ints, Floats]:
        """Nodes (≤ 4,) and Lagrange weights at `pressure_kpa`, from nodes of its own segment; one node if it is one."""
        nodes = self.nodes_kpa
        nearest = int(np.abs(nodes - pressure_kpa).argmin())
        if abs(nodes[nearest] - pressure_kpa) < 1e-6:
            return np.array([nearest]), np.ones(1)
        after = int(np.searchsorted(nodes, pressure_kpa))
        if not 0 < after < len(nodes):
            raise ValueError(f"pressure grid: {pressure_kpa} kPa is outside {nodes[0]:g} … {nodes[-1]:g}")
        segment = int(np.searchsorted(self.breaks, after)) - 1
        low, high = int(self.breaks[segment]), int(self.breaks[segment + 1])
        first = min(max(after - 2, low), max(high - STENCIL + 1, low))
        index = np.arange(first, min(first + STENCIL, high + 1))
        x = nodes[index]
        apart = (pressure_kpa - x)[None, :] / (x[:, None] - x[None, :] + np.eye(len(x)))
        np.fill_diagonal(apart, 1.0)
        return index, np.asarray(apart.prod(axis=1), dtype=np.float64)


def pressure_grid(position: RetarderPosition, top_stage: int, step_kpa: float) -> PressureGrid:
    """Nodes at most `step_kpa` apart over all pressures that commands of 0 … `top_stage` can lead to."""
    stages = np.asarray(position.stage_pressures_kpa[: top_stage + 1])
    band, touch = position.pneumatics.dead_band_kpa, position.force.touch_pressure_kpa
    low, high = stages[0] + band, stages[-1] - band
    marks = np.unique(np.round(np.concatenate([stages - band, stages + band, [touch, low, high]]), 9))
    marks = marks[(marks >= low - 1e-9) & (marks <= high + 1e-9)]
    pieces, breaks = [marks[:1]], [0]
    for a, b in pairwise(marks):
        count = math.ceil((b - a) / step_kpa - 1e-9)
        pieces.append(np.linspace(a, b, count + 1)[1:])
        breaks.append(breaks[-1] + count)
    return PressureGrid(np.concatenate(pieces), np.array(breaks))


@frozen_arrays
class DriveModes:
    """M modes that can be reached from the released one, which is mode 0.

    `stage`, `node`, `wait` (M,): commanded stage, index into `grid.nodes_kpa` and into `waits_s`; `rests` (M,): the
    pressure is within the stage's dead band. `allowed` (M, 3) commands; `target`, `weight` (M, 3, 4): modes and weights
    that stand for where the drive is at the next sample; `overpressure_kpa` (M, 3, parts): means over equal parts of
    the period.
    """

    drive: ValveDrive
    grid: PressureGrid
    waits_s: Floats
    stage: Ints
    node: Ints
    wait: Ints
    rests: Bools
    allowed: Bools
    target: Ints
    weight: Floats
    overpressure_kpa: Floats

    @property
    def stages(self) -> int:
        """Number of stages K + 1."""
        return int(self.stage.max()) + 1

    @property
    def pressure_kpa(self) -> Floats:
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
    rows: list[tuple[list[bool], list[list[int]], list[list[float]], list[Floats]]] = []
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
