"""Commands at any time once more, in plain Python loops from the formulas, on a grid that loops can afford.

Taken from the package: the grid, the automaton of the drive (it has its own oracle), the integrals of grade and β over
the path, the levels of the path noise, and the weights of true speeds behind a measured one. Written anew: the motion,
where it lands and how the value there is interpolated, averaging over what is hidden, commands, entry.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from plant_models import Plant, RollingResistance
from synth.problem.criterion import Criterion
from synth.problem.problem import Aim
from synth.problem.resolution import Resolution
from synth.solver.any_time.polynomial_surfaces import CUBIC_AND_SLOPE, PolynomialSurfaces
from synth.solver.any_time.sampled_chain import SampledChain, sampled_chain
from synth.solver.any_time.surface_evaluation import SurfaceEvaluation

Row = list[float]
AIM = Aim(2.5, Criterion())


class BruteForce:
    """Values of one problem under `lines` (2, N, M), node after node from the exit."""

    def __init__(self, c: SampledChain, lines: np.ndarray) -> None:
        self.c, self.lines = c, lines
        self.nodes, self.points = len(c.grid.path_m) - 1, len(c.grid.speed_m_s)
        exits, self.stalled = AIM.criterion.exit_costs(c.grid.speed_m_s, AIM.target_speed_m_s)
        self.exit_row = [self.stalled, *(float(each) for each in exits[1:])]
        self.value: dict[tuple[int, int, int, int], Row] = {}
        for n in reversed(range(self.nodes)):
            for m in range(len(c.modes.stage)):
                self.decide(n, m)

    def gained(self, i: int, f: float, kpa: float, a: int, b: int) -> float:
        """Energy gained from node a to node b; behind the exit nothing changes it."""
        b = min(b, self.nodes)
        drive, brake = self.c.drive_m2_s2, self.c.brake_m2_s2_per_kpa
        extra = float(self.c.scenarios.extra_m_s2[i]) * (b - a) * self.c.grid.path_step_m
        return float(drive[b] - drive[a]) + extra - f * kpa * float(brake[b] - brake[a])

    def in_energy(self, row: Row, x: float) -> float:
        """Cubic Lagrange at x cells, linear in the first eight cells and in the last, constant beyond both ends."""
        x = min(max(x, 0.0), self.points - 1.0)
        i = min(int(x), self.points - 2)
        if x < 8.0 or i == self.points - 2:
            return row[i] + (x - i) * (row[i + 1] - row[i])
        total = 0.0
        for a in range(i - 1, i + 3):
            total += row[a] * math.prod((x - b) / (a - b) for b in range(i - 1, i + 3) if b != a)
        return total

    def row_at(self, i: int, node: int, q: int, m: int, a: int) -> Row:
        """Values where a period leads to, interpolated in pressure; the level changes over the path of the period."""
        if node >= self.nodes:
            return self.exit_row
        modes = self.c.modes
        pairs = [(int(t), float(w)) for t, w in zip(modes.target[m, a], modes.weight[m, a], strict=True) if w != 0.0]
        row = [self.stalled]
        for j in range(1, self.points):
            mixing = self.c.mixing[q, :, j]
            each = [sum(float(p) * self.value[i, node, t, k][j] for k, p in enumerate(mixing)) for t, _ in pairs]
            row.append(sum(w * value for (_, w), value in zip(pairs, each, strict=True)))
        return row

    def command(self, i: int, n: int, m: int, q: int, a: int) -> Row:
        """Value of one command at every speed, its price left out."""
        c, step = self.c, self.c.grid.path_step_m
        f = float(c.scenarios.factor[i] * (1.0 + c.noise.levels[q]))
        kpa = float(c.modes.overpressure_kpa[m, a].mean())
        period_s = c.plant.sensor.sample_period_s
        rows: dict[int, Row] = {}
        out = [self.stalled]
        for j in range(1, self.points):
            quanta = float(c.grid.speed_m_s[j]) * period_s / step
            middle = max(math.floor(quanta + 0.5), 2)
            mean = self.gained(i, f, kpa, n, n + middle) / (middle * step)
            ahead = max(quanta + 0.5 * mean * period_s**2 / step, 1.0)
            total = 0.0
            for to in range(middle - 1, middle + 2):
                if to not in rows:
                    rows[to] = self.row_at(i, n + to, q, m, a)
                x = j + self.gained(i, f, kpa, n, n + to) / c.grid.energy_step_m2_s2
                others = [b for b in range(middle - 1, middle + 2) if b != to]
                total += self.in_energy(rows[to], x) * math.prod((ahead - b) / (to - b) for b in others)
            out.append(total)
        return out

    def decide(self, n: int, m: int) -> None:
        """Values at one node and mode."""
        c, v = self.c, [float(x) for x in self.c.grid.speed_m_s]
        noise, price = c.measurement.std, AIM.criterion.switching_tolerance_m2_s2
        hidden = [(i, q) for i in range(len(c.scenarios.weight)) for q in range(len(c.noise.levels))]
        asked = [a for a in range(3) if c.modes.allowed[m, a]]
        value = {(i, q, a): self.command(i, n, m, q, a) for i, q in hidden for a in asked}
        for i, q in hidden:
            row = [self.stalled]
            for j in range(1, self.points):
                down = chance_below((self.lines[0, n, m] - v[j]) / noise) if 0 in asked else 0.0
                up = chance_below((v[j] - self.lines[1, n, m]) / noise) if 2 in asked else 0.0
                row.append((1.0 - down - up) * value[i, q, 1][j])
                for a, chance in ((0, down), (2, up)):
                    if a in asked:
                        row[-1] += chance * (value[i, q, a][j] + price)
            self.value[i, n, m, q] = row

    def cost(self) -> float:
        """Expected cost from the entry on."""
        c, total = self.c, 0.0
        for r, row in enumerate(c.entry):
            for i, weight in enumerate(c.scenarios.weight):
                for q, share in enumerate(c.noise.stationary):
                    mixed = [sum(float(p) * self.value[i, r, 0, k][j] for k, p in enumerate(c.mixing[q, :, j]))
                             for j in range(self.points)]  # fmt: skip
                    for j in np.flatnonzero(row):
                        x = float(j) + self.gained(i, 1.0, 0.0, 0, r) / c.grid.energy_step_m2_s2
                        total += float(weight * share * row[j]) * self.in_energy([self.stalled, *mixed[1:]], x)
        return total


def chance_below(z: float) -> float:
    """The standard normal law, cut at six standard deviations."""
    return 0.5 * math.erfc(-z / math.sqrt(2.0)) if abs(z) <= 6.0 else float(z > 0.0)


@pytest.fixture(scope="module")
def tiny(plant: Plant) -> SampledChain:
    sensor = replace(plant.sensor, sample_period_s=0.25, computing_delay_s=0.05, resolution_m_s=0.04)
    small = replace(plant, resistance=RollingResistance(1.75, 0.6), sensor=sensor)
    coarse = Resolution(path_step_m=1.2, speed_step_m_s=0.2, friction_nodes=2, path_levels=2, resistance_nodes=1)
    return sampled_chain(small, coarse, pressure_step_kpa=90.0)


def test_cost_of_given_surfaces_is_that_of_plain_loops(plant: Plant, tiny: SampledChain) -> None:
    coefficients = np.zeros((3, 2, 5))
    coefficients[:, :, 0] = AIM.target_speed_m_s + np.array([0.05, 0.25])
    coefficients[:, :, 1], coefficients[:, :, 2], coefficients[:, :, 4] = -0.25, 0.05, 0.03
    has_line = np.array([[False, True], [True, True], [True, False]])
    stages = np.asarray(plant.position.stage_pressures_kpa)
    surfaces = PolynomialSurfaces(plant.start_m, plant.exit_m, stages, CUBIC_AND_SLOPE, coefficients, has_line)
    lines = surfaces.at(tiny.grid.path_m[:-1], tiny.modes)
    assert np.isfinite(lines).sum(axis=(1, 2)).min() > 50
    evaluation = SurfaceEvaluation(tiny)
    assert evaluation.density(lines).switchings > 2.0
    assert evaluation.gradient(lines, AIM).cost_m2_s2 == pytest.approx(BruteForce(tiny, lines).cost(), abs=1e-9)
