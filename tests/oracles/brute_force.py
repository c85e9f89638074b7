"""The Bellman equation once more, in plain Python loops from the formulas, on a grid that loops can afford.

Taken from the package: the grid, the cell means, the landing tables (they have their own oracle) and the weights of
true speeds behind a measured one. Written anew: noise over a transient by listing every path of levels, the wait for
the next sample as a recursion, interpolation, averaging over what is hidden, thresholds, random commands.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable

from synth.problem.criterion import Criterion
from synth.solver.backward_induction import true_speed_weights
from synth.solver.chain.chain import Chain

Row = list[float]

ROUNDING = 1e-9
"""Gains below this are rounding (`solve`: hold wins)."""


def interpolate(row: Row, position: float) -> float:
    """Cubic Lagrange polynomial through four points; linear in the last cell and in the eight next to a stall; constant
    beyond both ends."""
    last = len(row) - 1
    position = min(max(position, 0.0), float(last))
    i = min(int(position), last - 1)
    if i < 8 or i == last - 1:
        return row[i] + (position - i) * (row[i + 1] - row[i])
    total = 0.0
    for a in range(i - 1, i + 3):
        weight = 1.0
        for b in range(i - 1, i + 3):
            if b != a:
                weight *= (position - b) / (a - b)
        total += weight * row[a]
    return total


def brake_shares(profile: Row, quanta: int) -> Row:
    """Share of the work of a force profile (equal steps of time) done in each of `quanta` equal parts of its time."""
    if sum(profile) <= 0.0:
        profile = [1.0] * len(profile)
    shares = [0.0] * quanta
    for q, (step, force) in itertools.product(range(quanta), enumerate(profile)):
        low, high = q * len(profile) / quanta, (q + 1) * len(profile) / quanta
        shares[q] += force * max(0.0, min(high, step + 1) - max(low, step))
    return [share / sum(profile) for share in shares]


class BruteForce:
    """Values and switching lines of one problem, by recursion with memory."""

    def __init__(self, t: Chain, target_m_s: float, criterion: Criterion) -> None:
        self.t, self.target, self.criterion = t, target_m_s, criterion
        self.nodes, self.points = len(t.drive_m_s2), len(t.grid.speed_m_s)
        self.scenarios = range(len(t.scenarios.factor))
        self.modes, self.levels = range(len(t.actuator.mode_stage)), range(len(t.path_noise.levels))
        self.stalled = target_m_s**2 + criterion.stall_cost_m2_s2
        self.furthest = len(t.entry) - 2
        exit_row = [(float(v) - target_m_s) ** 2 for v in t.grid.speed_m_s]
        self.value = dict.fromkeys(itertools.product(self.scenarios, [self.nodes], self.modes, self.levels), exit_row)
        self.waiting: dict[tuple[int, ...], Row] = {}
        self.noise: dict[tuple[int, int, int, int], tuple[float, float, float]] = {}
        stages = t.actuator.stages
        self.lower = [[-math.inf] * stages for _ in range(self.nodes)]
        self.upper = [[math.inf] * stages for _ in range(self.nodes)]
        for n in reversed(range(self.nodes)):
            self.decide(n)

    def slope(self, i: int, n: int, h: int, u: int) -> float:
        """dv²/2 per metre of path in quantum n."""
        t = self.t
        factor = t.scenarios.factor[i] * (1.0 + t.path_noise.levels[u])
        braking = factor * t.brake_m_s2_per_kpa[n] * t.actuator.mode_overpressure_kpa[h]
        return float(t.drive_m_s2[n] + t.scenarios.extra_m_s2[i] - braking)

    def after_mixing(self, i: int, n: int, h: int, u: int, rows: Callable[[int], Row]) -> Row:
        """Expectation over the level of the quantum that begins, given the level u of the one that ends."""
        if n == self.nodes:
            mixed = list(rows(u))
        else:
            chances = self.t.path_noise.transition[u]
            mixed = [sum(float(chances[m]) * rows(m)[j] for m in self.levels) for j in range(self.points)]
        return mixed

    def wait(self, i: int, n: int, r: int, h: int, u: int) -> Row:
        """Value at node n, holding, with the next sample r nodes further on."""
        if n == self.nodes or r == 0:
            return self.value[i, n, h, u]
        key = i, n, r, h, u
        if key not in self.waiting:
            row = self.after_mixing(i, n + 1, h, u, lambda m: self.wait(i, n + 1, r - 1, h, m))
            row[0] = self.stalled
            shift = self.slope(i, n, h, u) * self.t.grid.path_step_m / self.t.grid.energy_step_m2_s2
            self.waiting[key] = [self.stalled] + [
                interpolate(row, j + shift) + self.price(self.quantum_time(n, j, j + shift, 1.0))
                for j in range(1, self.points)
            ]
        return self.waiting[key]

    def price(self, time_s: float) -> float:
        """What so much time costs."""
        return self.criterion.time_price_m2_s3 * time_s

    def speed(self, position: float) -> float:
        """Speed of an energy, in cells."""
        return math.sqrt(max(2.0 * position * self.t.grid.energy_step_m2_s2, 0.0))

    def quantum_time(self, n: int, before: float, after: float, part: float) -> float:
        """Time over a part of quantum n between two energies, in cells: path over mean speed.

        The mean is that of a cut that stops from the first speed of the grid at least.
        """
        path = self.t.grid.path_m
        mean = 0.5 * max(self.speed(before) + self.speed(after), self.speed(1))
        return part * float(path[n + 1] - path[n]) / mean

    def quanta_to_sample(self, i: int, n: int, h: int, u: int, j: int) -> float:
        """v·T + a·T²/2, or the way to rest, in quanta, at least 0.01."""
        v, a = float(self.t.grid.speed_m_s[j]), self.slope(i, n, h, u)
        period = self.t.plant.sensor.sample_period_s
        way = v * period + 0.5 * a * period**2 if v + a * period >= 0 else -0.5 * v * v / a
        return max(way / self.t.grid.path_step_m, 0.01)

    def holding(self, i: int, n: int, h: int, u: int, j: int) -> float:
        """Value of holding until the next sample; within this quantum that means: until the next node."""
        f = self.quanta_to_sample(i, n, h, u, j)
        if f < 1.0:
            return self.wait(i, n, 1, h, u)[j]
        r = min(int(f), self.furthest)
        x = min(f - r, 1.0)
        return (1.0 - x) * self.wait(i, n, r, h, u)[j] + x * self.wait(i, n, r + 1, h, u)[j]

    def noise_between(self, c: int, r: int, u: int, m: int) -> tuple[float, float, float]:
        """P(level m after r boundaries | u), mean and std of the force-weighted η: every path of levels listed."""
        if (c, r, u, m) not in self.noise:
            land, chain = self.t.landings, self.t.path_noise
            used = int(land.samples[c]) * self.t.actuator.substeps
            shares = brake_shares([float(p) for p in land.overpressure_kpa[c][:used]], r + 1)
            moments = [0.0, 0.0, 0.0]
            for path in itertools.product(self.levels, repeat=r + 1):
                if path[0] != u or path[-1] != m:
                    continue
                chance = math.prod(float(chain.transition[a, b]) for a, b in itertools.pairwise(path))
                mean = sum(g * float(chain.levels[level]) for g, level in zip(shares, path, strict=True))
                moments = [total + chance * mean**q for q, total in enumerate(moments)]
            p, first, second = moments
            mean = first / p if p > 0 else 0.0
            self.noise[c, r, u, m] = p, mean, math.sqrt(max(second / p - mean**2, 0.0)) if p > 0 else 0.0
        return self.noise[c, r, u, m]

    def landing(self, n: int, c: int, j: int, f: float) -> tuple[float, float]:
        """Travel and energy for friction factor f: parabola through the three nearest tabulated ones."""
        factors = [float(x) for x in self.t.landings.factors]
        nearest = min(range(len(factors)), key=lambda q: abs(factors[q] - f))
        middle = min(max(nearest, 1), len(factors) - 2)
        three = range(middle - 1, middle + 2)
        travel, energy = self.t.landings.travel_m[n, c], self.t.landings.energy_m2_s2[n, c]
        if any(travel[q, j] < 0.0 for q in three):
            return float(travel[nearest, j]), float(energy[nearest, j])
        weights = [math.prod((f - factors[b]) / (factors[a] - factors[b]) for b in three if b != a) for a in three]
        way = sum(w * float(travel[q, j]) for w, q in zip(weights, three, strict=True))
        return way, sum(w * float(energy[q, j]) for w, q in zip(weights, three, strict=True))

    def changing(self, i: int, n: int, c: int, u: int, j: int) -> float:
        """Expected value after transient c, its cost as a command included."""
        t, step, cell_e = self.t, self.t.grid.path_step_m, self.t.grid.energy_step_m2_s2
        factor, h = float(t.scenarios.factor[i]), int(t.landings.end_mode[c])
        nominal, _ = self.landing(n, c, j, factor)
        if nominal < 0.0:
            return self.criterion.switching_tolerance_m2_s2 + self.stalled
        total = self.criterion.switching_tolerance_m2_s2
        for m, sign in itertools.product(self.levels, (-1.0, 1.0)):
            p, mean, std = self.noise_between(c, int(nominal / step + 1e-9), u, m)
            if p == 0.0:
                continue
            way, energy = self.landing(n, c, j, factor * (1.0 + mean + sign * std))
            if way < 0.0:
                total += 0.5 * p * self.stalled
                continue
            energy += float(t.scenarios.extra_m_s2[i]) * way
            into = int(way / step + 1e-9)
            at, x = n + into, max(way / step - into, 0.0)
            left_m = float(t.grid.path_m[-1] - t.grid.path_m[n])
            if at >= self.nodes:
                total += 0.5 * p * self.price(left_m / (0.5 * (self.speed(j) + self.speed(energy / cell_e))))
                total += 0.5 * p * interpolate(self.value[i, self.nodes, h, m], energy / cell_e)
                continue
            slope = self.slope(i, at, h, m)

            def behind(q: int, n: int = at + 1) -> Row:
                return self.value[i, n, h, q]

            ahead = self.after_mixing(i, at + 1, h, m, behind)
            there = (energy + slope * (1.0 - x) * step) / cell_e
            forth = interpolate(ahead, there)
            total += 0.5 * p * self.price(float(t.landings.samples[c]) * t.plant.sensor.sample_period_s)
            if at == n:
                total += 0.5 * p * self.price(self.quantum_time(n, energy / cell_e, there, 1.0 - x))
                total += 0.5 * p * forth
            else:
                back = interpolate(self.value[i, at, h, m], (energy - slope * x * step) / cell_e)
                total += 0.5 * p * ((1.0 - x) * back + x * forth)
        return total

    def decide(self, n: int) -> None:
        """Lines and values of node n."""
        t, stage_of = self.t, self.t.actuator.mode_stage
        sides = t.landings.change_chain[:2]
        hidden = list(itertools.product(self.scenarios, self.modes, self.levels))
        hold = {(i, h, u): [self.holding(i, n, h, u, j) for j in range(self.points)] for i, h, u in hidden}
        change: dict[tuple[int, int, int, int], Row] = {}
        for side, (i, h, u) in itertools.product((0, 1), hidden):
            c = int(sides[side][h])
            row = hold[i, h, u]
            if c >= 0:
                row = [row[0], *(self.changing(i, n, c, u, j) for j in range(1, self.points))]
            change[side, i, h, u] = row
        sensor = t.plant.sensor
        sigma = sensor.reading_std_m_s
        start, smear = true_speed_weights(t.grid.speed_m_s, t.grid.speed_m_s, sigma)
        for k in range(t.actuator.stages):
            gains = []
            for side in (0, 1):
                mean = [0.0] * self.points
                for j in range(1, self.points):
                    weights = {
                        (i, h, u): float(t.scenarios.weight[i] * t.path_noise.stationary[u])
                        for i, h, u in hidden
                        if stage_of[h] == k
                    }
                    saved = sum(w * (hold[x][j] - change[side, *x][j]) for x, w in weights.items())
                    mean[j] = saved / sum(weights.values())
                seen = range(smear.shape[1])
                gains.append([sum(float(smear[j, q]) * mean[start[j] + q] for q in seen) for j in range(self.points)])
            self.lower[n][k] = self.lowest_line(gains[0])
            self.upper[n][k] = max(self.highest_line(gains[1]), self.lower[n][k])
        for i, h, u in hidden:
            row = [self.stalled]
            for j in range(1, self.points):
                v, k = float(t.grid.speed_m_s[j]), stage_of[h]
                down, up = probability((self.lower[n][k] - v) / sigma), probability((v - self.upper[n][k]) / sigma)
                stay = 1.0 - down - up
                changed = down * change[0, i, h, u][j] + up * change[1, i, h, u][j]
                f = self.quanta_to_sample(i, n, h, u, j)
                if f < 1.0:  # the next sample is at this node again with chance 1 − f: V = stay·((1 − f)V + f A) + …
                    row.append((changed + stay * f * self.wait(i, n, 1, h, u)[j]) / (1.0 - stay * (1.0 - f)))
                else:
                    row.append(changed + stay * hold[i, h, u][j])
            self.value[i, n, h, u] = row

    def highest_line(self, gain: Row) -> float:
        """The line above which the gains, beyond rounding, sum to most; +inf if to nothing."""
        v = self.t.grid.speed_m_s
        totals = {
            j: sum(excess(gain[q]) * float(v[q] - v[q - 1]) for q in range(j, self.points))
            for j in range(2, self.points)
        }
        best = max(totals, key=lambda j: (totals[j], j))
        if totals[best] <= 0.0:
            return math.inf
        return zero_between(float(v[best - 1]), float(v[best]), gain[best - 1], gain[best])

    def lowest_line(self, gain: Row) -> float:
        """The line below which the gains, beyond rounding, sum to most; −inf if to nothing."""
        v = self.t.grid.speed_m_s
        totals = {
            j: sum(excess(gain[q]) * float(v[q + 1] - v[q]) for q in range(1, j + 1)) for j in range(1, self.points - 1)
        }
        best = max(totals, key=lambda j: (totals[j], -j))
        if totals[best] <= 0.0:
            return -math.inf
        return zero_between(float(v[best]), float(v[best + 1]), gain[best], gain[best + 1])


def probability(z: float) -> float:
    """Φ(z), 0 or 1 beyond six standard deviations."""
    return (1.0 if z > 0 else 0.0) if abs(z) > 6.0 else 0.5 * math.erfc(-z / math.sqrt(2.0))


def excess(gain: float) -> float:
    """Gain or loss beyond rounding."""
    return math.copysign(max(abs(gain) - ROUNDING, 0.0), gain)


def zero_between(low: float, high: float, at_low: float, at_high: float) -> float:
    """Where the gain passes through the rounding limit, linearly."""
    a, b = at_low - ROUNDING, at_high - ROUNDING
    if (a < 0) == (b < 0):
        return 0.5 * (low + high)
    return low + (high - low) * a / (a - b)
