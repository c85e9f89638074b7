"""A compact controller for unlocked commands: cubics in path plus a little pressure, found by direct search.

Begun from the surfaces (least squares) and from the polished stage-locked cubics, whichever simulates better, then
evolved on the simulated cost of tuning passes, the same for every candidate. What it is worth must be measured on
other passes.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays
from synth.kernels.loop.closed_loop import Draws
from synth.problem.criterion import Criterion
from synth.simulation.closed_loop import ClosedLoop, LineController
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses
from synth.solver.polynomial_lines import PolynomialLines, basis
from synth.studies.unlocked.evolution import Vector, evolve
from synth.studies.unlocked.laws import PRESSURE_POWERS, CompactController, SurfaceController
from synth.studies.unlocked.loop import UnlockedLoop
from synth.studies.unlocked.surfaces import SwitchingSurfaces

SLOPES_M_S = (0.0, -0.05, -0.1, -0.2)
"""Changes of a line for 100 kPa above its stage, tried when the stage-locked cubics are the beginning."""

SPREAD = 0.03
"""Std of the first generation in every coefficient, m/s."""

NEAR_M_S = 0.3
"""A sample counts for a line if its speed is nearer than this."""

LINE_NODES = 301


@dataclass(frozen=True)
class Form:
    """Degree in path for the powers 0, 1 … of the pressure; e.g. (3, 0): a cubic and a constant slope in pressure."""

    degrees: tuple[int, ...] = (3, 0)

    @property
    def terms(self) -> int:
        """Coefficients of one line."""
        return sum(degree + 1 for degree in self.degrees)


@frozen_arrays
@dataclass(frozen=True, eq=False)
class Compact:
    """Lines as a vector: Legendre coefficients in path for each power of the pressure, line after line."""

    exit_m: float
    form: Form
    has_line: NDArray[np.bool_]

    @property
    def size(self) -> int:
        """Number of coefficients of all lines."""
        return int(self.has_line.sum()) * self.form.terms

    def controller(self, vector: Vector) -> CompactController:
        """The controller whose coefficients are `vector`."""
        degree = max(self.form.degrees)
        coefficients = np.zeros((*self.has_line.shape, PRESSURE_POWERS, degree + 1))
        for row, (k, side) in zip(vector.reshape(-1, self.form.terms), np.argwhere(self.has_line), strict=True):
            at = 0
            for power, terms in enumerate(self.form.degrees):
                series = np.polynomial.legendre.leg2poly(row[at : at + terms + 1])
                coefficients[k, side, power, : len(series)] = series
                at += terms + 1
        return CompactController(self.exit_m, coefficients, self.has_line.copy())

    def of_lines(self, lines: PolynomialLines, slope_m_s: float) -> Vector:
        """Stage-locked cubics with one slope in pressure, m/s for 100 kPa."""
        vector = np.zeros((int(self.has_line.sum()), self.form.terms))
        shared = min(lines.degree, self.form.degrees[0]) + 1
        for row, (k, side) in zip(vector, np.argwhere(self.has_line), strict=True):
            row[:shared] = lines.coefficients[k, side, :shared]
            if len(self.form.degrees) > 1:
                row[self.form.degrees[0] + 1] = slope_m_s
        return vector.ravel()


def cost_of(sample: ExitSample, target_m_s: float, criterion: Criterion) -> float:
    """Mean simulated cost: squared error, stalls, and the tolerance for every command, m²/s²."""
    square = float(((sample.exit_speed_m_s - target_m_s) ** 2).mean())
    commands = criterion.switching_tolerance_m2_s2 * float(sample.switchings.mean())
    return square + commands + criterion.stall_cost_m2_s2 * float(sample.stalled.mean())


def fit_surfaces(compact: Compact, surfaces: SwitchingSurfaces, loop: UnlockedLoop, passes: RandomPasses) -> Vector:
    """Least squares on the surfaces; a place weighs what samples of its stage pass near the line there.

    Places where nothing passes weigh a thousandth, so that lines stay near their surfaces; lines that are nowhere
    finite are put where they are never crossed.
    """
    m, path = surfaces.modes, surfaces.nodes_m
    speeds = visited_speeds(surfaces, loop, passes)
    x = 0.01 * (m.pressure_kpa - np.asarray(loop.drive.stage_kpa)[m.stage])
    rows = []
    for k, side in np.argwhere(compact.has_line):
        at = np.flatnonzero((m.stage == k) & (m.wait == 0))
        lines = (surfaces.lower_m_s, surfaces.upper_m_s)[side][at]
        near = np.array(
            [
                [
                    np.mean(np.abs(v - line) < NEAR_M_S) if len(v) else 0.0
                    for v, line in zip(speeds[k], row, strict=True)
                ]
                for row in np.nan_to_num(lines, posinf=99.0, neginf=-99.0)
            ]
        )
        mode, node = np.nonzero(np.isfinite(lines))
        if not len(mode):
            rows.append(np.append((0.0, 15.0)[side], np.zeros(compact.form.terms - 1)))
            continue
        columns = [basis(path, 0.0, compact.exit_m, degree)[node] * (x[at][mode] ** power)[:, None]
                   for power, degree in enumerate(compact.form.degrees)]  # fmt: skip
        root = np.sqrt(near[mode, node] + 1e-3)
        rows.append(np.linalg.lstsq(np.hstack(columns) * root[:, None], lines[mode, node] * root, rcond=None)[0])
    return np.concatenate(rows)


def visited_speeds(
    surfaces: SwitchingSurfaces, loop: UnlockedLoop, passes: RandomPasses
) -> list[list[NDArray[np.float64]]]:
    """Speeds at the samples of all `passes` under the surfaces, by commanded stage and nearest path node."""
    controller, step = SurfaceController(surfaces), float(surfaces.nodes_m[1])
    stage, node, speed = [], [], []
    for i in range(len(passes)):
        trace = loop.follow(controller, loop.draws(passes.part(i, i + 1)))
        sampled = ~np.isnan(trace.measured_m_s)
        stage.append(trace.stage[sampled])
        node.append(np.rint(trace.path_m[sampled] / step).astype(int))
        speed.append(trace.speed_m_s[sampled])
    k, n, v = np.concatenate(stage), np.concatenate(node), np.concatenate(speed)
    order = np.lexsort((n, k))
    k, n, v = k[order], n[order], v[order]
    nodes = len(surfaces.nodes_m)
    cuts = np.searchsorted(k * nodes + n, np.arange(controller.stages * nodes + 1))
    return [[v[cuts[s * nodes + i] : cuts[s * nodes + i + 1]] for i in range(nodes)] for s in range(controller.stages)]


def search(
    compact: Compact,
    starts: list[Vector],
    loop: UnlockedLoop,
    draws: Draws,
    target_m_s: float,
    criterion: Criterion,
    evaluations: int,
) -> tuple[Vector, float]:
    """(coefficients, simulated cost): the best of `starts` on `draws`, evolved on them."""

    def cost(vector: Vector) -> float:
        return cost_of(loop.run(compact.controller(vector), draws), target_m_s, criterion)

    return evolve(cost, min(starts, key=cost), SPREAD, evaluations, seed=1)


def search_locked(
    lines: PolynomialLines, loop: ClosedLoop, draws: Draws, target_m_s: float, criterion: Criterion, evaluations: int
) -> LineController:
    """Stage-locked cubics taken through the same search: the control that tells unlocking and searching apart."""
    nodes = lines.nodes_m(LINE_NODES)
    where = lines.has_line[:, :, None] & np.ones(lines.coefficients.shape, dtype=bool)

    def controller(vector: Vector) -> LineController:
        coefficients = np.zeros(lines.coefficients.shape)
        coefficients[where] = vector
        return LineController(replace(lines, coefficients=coefficients).at(nodes))

    def cost(vector: Vector) -> float:
        return cost_of(loop.run(controller(vector), draws), target_m_s, criterion)

    return controller(evolve(cost, lines.coefficients[where], SPREAD, evaluations, seed=1)[0])
