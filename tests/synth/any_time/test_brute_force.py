"""The unlocked Bellman equation once more, in plain Python loops from the formulas, on a grid that loops can afford.

Taken from the package: the grid, the automaton of the drive (it has its own oracle), the integrals of grade and β over
the path, and the weights of true speeds behind a measured one. Written anew: the motion, where it lands and how the
value there is interpolated, averaging over what is hidden, thresholds, random commands, entry.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from plant_models import Plant, RollingResistance
from synth.problem.criterion import Criterion
from synth.problem.resolution import Resolution
from synth.solver.backward_induction import true_speed_weights
from synth.studies.unlocked.solution import UnlockedPlant, solve_unlocked, unlocked_plant

Row = list[float]


class BruteForce:
    """Values and lines of one problem, node after node from the exit."""

    def __init__(self, p: UnlockedPlant, target_m_s: float, criterion: Criterion) -> None:
        self.p, self.criterion = p, criterion
        self.nodes, self.points = len(p.grid.path_m) - 1, len(p.grid.speed_m_s)
        self.stalled = target_m_s**2 + criterion.stall_cost_m2_s2
        self.exit_row = [(float(v) - target_m_s) ** 2 for v in p.grid.speed_m_s]
        self.value: dict[tuple[int, int, int, int], Row] = {}
        self.lower = np.full((self.nodes, len(p.modes.stage)), -math.inf)
        self.upper = np.full((self.nodes, len(p.modes.stage)), math.inf)
        for n in reversed(range(self.nodes)):
            for m in range(len(p.modes.stage)):
                self.decide(n, m)

    def over_path(self, table: np.ndarray, s: float) -> float:
        """An integral over path at s, constant after the exit."""
        x = s / self.p.plant.exit_m * (len(table) - 1)
        i = min(int(x), len(table) - 2)
        return float(table[i] + min(x - i, 1.0) * (table[i + 1] - table[i]))

    def energy_gain(self, i: int, f: float, kpa: float, a: float, b: float) -> float:
        """Work on the cut from path a to b at a constant overpressure."""
        exit_m = self.p.plant.exit_m
        lift = self.over_path(self.p.lift_m2_s2, b) - self.over_path(self.p.lift_m2_s2, a)
        braked = self.over_path(self.p.work_m2_s2_per_kpa, b) - self.over_path(self.p.work_m2_s2_per_kpa, a)
        inside = min(b, exit_m) - min(a, exit_m)
        return lift - f * kpa * braked + float(self.p.scenarios.extra_m_s2[i]) * inside

    def rolled(self, i: int, f: float, s: float, e: float, overs: Row) -> tuple[float, float]:
        """Path and energy a period on; energy 0: stalled."""
        part = self.p.plant.sensor.sample_period_s / len(overs)
        for kpa in overs:
            v = math.sqrt(2.0 * e)
            a = self.energy_gain(i, f, kpa, s, s + v * part) / (v * part)
            if v + a * part <= 0.0:
                return s, 0.0
            end = s + v * part + 0.5 * a * part**2
            e += self.energy_gain(i, f, kpa, s, end)
            s = end
            if e <= 0.0:
                return s, 0.0
        return s, e

    def in_energy(self, row: Row, e: float) -> float:
        """Cubic Lagrange, linear at both ends; kept within the four values where they differ as beside a stall."""
        x = e / self.p.grid.energy_step_m2_s2
        if x <= 0.0:
            return self.stalled
        i = min(int(x), self.points - 2)
        x = min(x, self.points - 1.0)
        if i < 2 or i == self.points - 2:
            return row[i] + (x - i) * (row[i + 1] - row[i])
        total = 0.0
        for a in range(i - 1, i + 3):
            total += row[a] * math.prod((x - b) / (a - b) for b in range(i - 1, i + 3) if b != a)
        four = row[i - 1 : i + 3]
        return min(max(total, min(four)), max(four)) if max(four) - min(four) > 0.002 * self.stalled else total

    def row_at(self, i: int, node: int, q: int, targets: list[int], shares: Row, level: int) -> Row:
        """Values at a node after the period, interpolated in pressure and averaged over the level there."""
        steps = self.p.level_steps[node - level]
        if node >= self.nodes:
            return self.exit_row
        row = []
        for j in range(self.points):
            found = [sum(float(steps[q, k]) * self.value[i, node, m, k][j] for k in range(len(steps))) for m in targets]
            met = [value for value, share in zip(found, shares, strict=True) if share != 0.0]
            value = sum(share * value for share, value in zip(shares, found, strict=True))
            row.append(min(max(value, min(met)), max(met)))
        return row

    def command(self, i: int, n: int, m: int, q: int, a: int) -> Row:
        """Value of one command at every speed, its price left out."""
        p, modes, step = self.p, self.p.modes, self.p.grid.path_step_m
        f = float(p.scenarios.factor[i] * (1.0 + p.chain.levels[q]))
        overs, end_kpa = [float(x) for x in modes.overpressure_kpa[m, a]], float(modes.end_overpressure_kpa[m, a])
        targets, shares = [int(t) for t in modes.target[m, a]], [float(w) for w in modes.weight[m, a]]
        rows: dict[int, Row] = {}
        out = [self.stalled]
        for j in range(1, self.points):
            s, e = self.rolled(i, f, n * step, float(p.grid.energy_m2_s2[j]), overs)
            if e <= 0.0:
                out.append(self.stalled)
                continue
            ahead = max(s / step - n, 1.0)
            first = max(math.floor(s / step - n + 0.5) - 1, 1)
            found, total = [], 0.0
            for node in range(n + first, n + first + 3):
                if node not in rows:
                    rows[node] = self.row_at(i, node, q, targets, shares, n)
                found.append(self.in_energy(rows[node], e + self.energy_gain(i, f, end_kpa, s, node * step)))
                others = [b for b in range(n + first, n + first + 3) if b != node]
                total += found[-1] * math.prod((n + ahead - b) / (node - b) for b in others)
            out.append(min(max(total, min(found)), max(found)))
        return out

    def decide(self, n: int, m: int) -> None:
        """Lines and values at one node and mode."""
        p, v = self.p, [float(x) for x in self.p.grid.speed_m_s]
        noise = p.plant.sensor.reading_std_m_s
        hidden = [(i, q) for i in range(len(p.scenarios.weight)) for q in range(len(p.chain.levels))]
        value = {(i, q, a): self.command(i, n, m, q, a) for i, q in hidden for a in range(3) if p.modes.allowed[m, a]}
        start, weights = true_speed_weights(p.grid.speed_m_s, p.grid.speed_m_s, noise)
        for a in (0, 2):
            if not p.modes.allowed[m, a]:
                continue
            gain = [0.0] * self.points
            for j in range(1, self.points):
                for i, q in hidden:
                    w = float(p.scenarios.weight[i] * p.chain.stationary[q])
                    gain[j] += w * (value[i, q, 1][j] - value[i, q, a][j] - self.criterion.switching_tolerance_m2_s2)
            seen = [sum(w * gain[start[j] + b] for b, w in enumerate(weights[j])) for j in range(self.points)]
            line = best_threshold(
                [0.0 if abs(g) <= 1e-9 else g - math.copysign(1e-9, g) for g in seen], seen, v, a == 2
            )
            if a == 0:
                self.lower[n, m] = line
            else:
                self.upper[n, m] = max(line, self.lower[n, m])
        for i, q in hidden:
            row = [self.stalled]
            for j in range(1, self.points):
                down = chance_below((self.lower[n, m] - v[j]) / noise)
                up = chance_below((v[j] - self.upper[n, m]) / noise)
                price = self.criterion.switching_tolerance_m2_s2
                row.append((1.0 - down - up) * value[i, q, 1][j])
                for a, chance in ((0, down), (2, up)):
                    if p.modes.allowed[m, a]:
                        row[-1] += chance * (value[i, q, a][j] + price)
            self.value[i, n, m, q] = row

    def cost(self) -> float:
        """Expected cost from the entry on."""
        p, total = self.p, 0.0
        for r, row in enumerate(p.entry):
            for i, weight in enumerate(p.scenarios.weight):
                for q, share in enumerate(p.chain.stationary):
                    for j in np.flatnonzero(row):
                        e = float(p.grid.energy_m2_s2[j]) + self.energy_gain(i, 1.0, 0.0, 0.0, r * p.grid.path_step_m)
                        x = e / p.grid.energy_step_m2_s2
                        values = self.value[i, r, 0, q]
                        at = values[int(x)] + (x - int(x)) * (values[int(x) + 1] - values[int(x)])
                        total += float(weight * share * row[j]) * at
        return total


def chance_below(z: float) -> float:
    """The standard normal law, cut at six standard deviations."""
    return 0.5 * math.erfc(-z / math.sqrt(2.0)) if abs(z) <= 6.0 else float(z > 0.0)


def best_threshold(gain: Row, seen: Row, v: Row, above: bool) -> float:
    """The threshold with the largest total gain beyond it, of all thresholds between two speeds."""
    last = len(v) - 1
    places = range(2, last + 1) if above else range(1, last)
    best, line = 0.0, math.inf if above else -math.inf
    for j in reversed(places) if above else places:
        inside = range(j, last + 1) if above else range(1, j + 1)
        total = sum(gain[b] * (v[b] - v[b - 1] if above else v[b + 1] - v[b]) for b in inside)
        if total > best * (1.0 + 1e-12):
            a, b = (j - 1, j) if above else (j, j + 1)
            x, y = seen[a] - 1e-9, seen[b] - 1e-9
            line = 0.5 * (v[a] + v[b]) if (x < 0.0) == (y < 0.0) else v[a] + (v[b] - v[a]) * x / (x - y)
            best = total
    return line


def test_lines_and_cost_are_those_of_plain_loops(plant: Plant) -> None:
    sensor = replace(plant.sensor, sample_period_s=0.25, computing_delay_s=0.05, resolution_m_s=0.04)
    tiny = replace(plant, resistance=RollingResistance(1.75, 0.6), sensor=sensor)
    coarse = Resolution(path_step_m=0.9, speed_step_m_s=0.13, friction_nodes=2, path_levels=2)
    problem = unlocked_plant(tiny, coarse, pressure_step_kpa=90.0)
    criterion = Criterion()
    solved = solve_unlocked(problem, 2.5, criterion)
    brute = BruteForce(problem, 2.5, criterion)
    assert np.isfinite(brute.upper).sum() > 50
    assert np.isfinite(brute.lower).sum() > 50
    assert pytest.approx(brute.upper, abs=1e-9) == solved.surfaces.upper_m_s[:, :-1].T
    assert pytest.approx(brute.lower, abs=1e-9) == solved.surfaces.lower_m_s[:, :-1].T
    assert solved.cost_m2_s2 == pytest.approx(brute.cost(), abs=1e-9)
