"""The programme of point sensors once more, in plain loops.

Taken from the package: grid, cell means, landing tables, weights of true speeds behind a reading. Written anew: the
recursion over places instead of samples, commands by several stages, ordered thresholds by trying all of them.
"""

from __future__ import annotations

import itertools
import math

import numpy as np

from synth.problem.criterion import Criterion
from synth.solver.backward_induction import true_speed_weights
from synth.solver.chain.chain import Chain
from synth.solver.chain.decisions import steps_of

HEARD = 0.85
TARGET_M_S = 2.4
CRITERION = Criterion(stall_cost_m2_s2=0.5, switching_tolerance_m2_s2=1e-4, time_price_m2_s3=0.01)
ROUNDING = 1e-9


class PlainLoops:
    """Values and lines by recursion from the exit, node by node."""

    def __init__(self, t: Chain) -> None:
        self.t, self.nodes, self.points = t, len(t.drive_m_s2), len(t.grid.speed_m_s)
        self.stalled = TARGET_M_S**2 + CRITERION.stall_cost_m2_s2
        self.hidden = list(
            itertools.product(
                range(len(t.scenarios.factor)), range(len(t.actuator.mode_stage)), range(len(t.path_noise.levels))
            )
        )
        exit_row = [(float(v) - TARGET_M_S) ** 2 for v in t.grid.speed_m_s]
        self.value = {(self.nodes, *x): exit_row for x in self.hidden}
        self.lines: dict[tuple[int, int], list[float]] = {}
        decided = {int(node): number for number, node in enumerate(t.decisions.node)}
        for n in reversed(range(self.nodes)):
            held = {x: self.held(n, *x) for x in self.hidden}
            if n in decided:
                self.decide(n, decided[n], held)
            else:
                self.value.update({(n, *x): row for x, row in held.items()})

    def slope(self, i: int, n: int, h: int, u: int) -> float:
        t = self.t
        braking = t.scenarios.factor[i] * (1.0 + t.path_noise.levels[u]) * t.actuator.mode_overpressure_kpa[h]
        return float(t.drive_m_s2[n] + t.scenarios.extra_m_s2[i] - t.brake_m_s2_per_kpa[n] * braking)

    def mixed(self, n: int, i: int, h: int, u: int) -> list[float]:
        """Value at node n before the level of the next quantum is known."""
        if n == self.nodes:
            return self.value[n, i, h, u]
        chances, levels = self.t.path_noise.transition[u], range(len(self.t.path_noise.levels))
        rows = [self.value[n, i, h, m] for m in levels]
        return [sum(float(chances[m]) * rows[m][j] for m in levels) for j in range(self.points)]

    def held(self, n: int, i: int, h: int, u: int) -> list[float]:
        """Value of rolling on to the next node."""
        row = self.mixed(n + 1, i, h, u)
        row = [self.stalled, *row[1:]]
        shift = self.slope(i, n, h, u) * self.t.grid.path_step_m / self.t.grid.energy_step_m2_s2
        return [
            self.stalled,
            *(interpolated(row, j + shift) + self.time_price(n, j, j + shift, 1.0) for j in range(1, self.points)),
        ]

    def speed(self, position: float) -> float:
        """Speed of an energy, in cells."""
        return math.sqrt(max(2.0 * position * self.t.grid.energy_step_m2_s2, 0.0))

    def time_price(self, n: int, before: float, after: float, part: float) -> float:
        """Price of the time over a part of quantum n between two energies, in cells."""
        path, speeds = self.t.grid.path_m, self.speed(before) + self.speed(after)
        way = part * float(path[n + 1] - path[n])
        return CRITERION.time_price_m2_s3 * way / (0.5 * max(speeds, self.speed(1)))

    def landing(self, decision: int, c: int, j: int, f: float) -> tuple[float, float]:
        """Path and energy at the end of a transient: the parabola through the three nearest factors."""
        factors = [float(x) for x in self.t.landings.factors]
        nearest = min(range(len(factors)), key=lambda q: abs(factors[q] - f))
        three = range(min(max(nearest, 1), len(factors) - 2) - 1, min(max(nearest, 1), len(factors) - 2) + 2)
        travel, energy = self.t.landings.travel_m[decision, c], self.t.landings.energy_m2_s2[decision, c]
        if any(travel[q, j] < 0.0 for q in three):
            return float(travel[nearest, j]), float(energy[nearest, j])
        weights = [math.prod((f - factors[b]) / (factors[a] - factors[b]) for b in three if b != a) for a in three]
        way = sum(w * float(travel[q, j]) for w, q in zip(weights, three, strict=True))
        return way, sum(w * float(energy[q, j]) for w, q in zip(weights, three, strict=True))

    def changed(self, n: int, decision: int, c: int, i: int, u: int, j: int) -> float:
        """Expected value after transient c: decided on at the first node behind its end."""
        t, step = self.t, self.t.grid.path_step_m
        factor, h, noise = float(t.scenarios.factor[i]), int(t.landings.end_mode[c]), t.transient_noise
        nominal, _ = self.landing(decision, c, j, factor)
        total = CRITERION.switching_tolerance_m2_s2
        if nominal < 0.0:
            return total + self.stalled
        r = int(nominal / step + 1e-9)
        for m, sign in itertools.product(range(len(t.path_noise.levels)), (-1.0, 1.0)):
            p = 0.5 * float(noise.probability[c, r, u, m])
            met = factor * (1.0 + float(noise.mean[c, r, u, m]) + sign * float(noise.std[c, r, u, m]))
            way, energy = self.landing(decision, c, j, met)
            if way < 0.0:
                total += p * self.stalled
                continue
            energy += float(t.scenarios.extra_m_s2[i]) * way
            cell_e = t.grid.energy_step_m2_s2
            into = int(way / step + 1e-9)
            at, left = n + into, 1.0 - max(way / step - into, 0.0)
            if at >= self.nodes:
                way_m, mean = float(t.grid.path_m[-1] - t.grid.path_m[n]), self.speed(j) + self.speed(energy / cell_e)
                total += p * CRITERION.time_price_m2_s3 * way_m / (0.5 * mean)
                total += p * interpolated(self.value[self.nodes, i, h, m], energy / cell_e)
                continue
            until = float(t.decisions.lead_m[decision]) / self.speed(j)
            until += float(t.landings.samples[c]) * t.epochs.clock.sample_period_s
            total += p * CRITERION.time_price_m2_s3 * until
            landed = energy / cell_e
            energy += self.slope(i, at, h, m) * left * step
            total += p * self.time_price(at, landed, energy / cell_e, left)
            total += p * interpolated(self.mixed(at + 1, i, h, m), energy / t.grid.energy_step_m2_s2)
        return total

    def decide(self, n: int, decision: int, held: dict[tuple[int, int, int], list[float]]) -> None:
        t, stage_of, tops = self.t, self.t.actuator.mode_stage, self.t.actuator.stages - 1
        before, limit = n < t.approach_nodes, t.plant.entrance_stage
        change: dict[tuple[int, int, int, int], list[float]] = {}
        for command, x in itertools.product(range(t.decisions.commands), self.hidden):
            c, to = int(t.landings.change_chain[command, x[1]]), int(stage_of[x[1]]) + steps_of(command)
            if c >= 0 and not (before and steps_of(command) > 0 and to > limit):
                row = [self.changed(n, decision, c, x[0], x[2], j) for j in range(1, self.points)]
                change[command, *x] = [held[x][0], *row]
        readings = t.measurement.readings(t.grid.speed_m_s)
        start, smear = true_speed_weights(t.grid.speed_m_s, readings, t.measurement.std)
        lines = {}
        for k in range(tops + 1):
            gains = {}
            for command in range(t.decisions.commands):
                mine = [x for x in self.hidden if stage_of[x[1]] == k and (command, *x) in change]
                if not mine:
                    continue
                share = {x: float(t.scenarios.weight[x[0]] * t.path_noise.stationary[x[2]]) for x in mine}
                modes = len({x[1] for x in mine})
                mean = [sum(w * (held[x][j] - change[command, *x][j]) for x, w in share.items()) / modes
                        for j in range(self.points)]  # fmt: skip
                seen = range(smear.shape[1])
                gains[command] = [
                    sum(float(smear[j, q]) * mean[start[j] + q] for q in seen) for j in range(self.points)
                ]
            for up in (0, 1):
                mine_up = [gains[command] for command in sorted(gains) if command % 2 == up]
                lines.update({(k, 2 * d + up): line for d, line in enumerate(best_lines(mine_up, readings, bool(up)))})
            if (k, 1) in lines and (k, 0) in lines:
                for command in (c for kk, c in lines if kk == k and c % 2):
                    lines[k, command] = max(lines[k, command], lines[k, 0])
        for (k, command), line in lines.items():
            self.lines.setdefault((decision, command), [math.nan] * (tops + 1))[k] = line
        for x in self.hidden:
            k, row = int(stage_of[x[1]]), [self.stalled]
            for j in range(1, self.points):
                chance = {
                    c: probability(line, float(readings[j]), c % 2 == 1) for (kk, c), line in lines.items() if kk == k
                }
                exact = {c: HEARD * (p - chance.get(c + 2, 0.0)) for c, p in chance.items()}
                value = sum(p * change[c, *x][j] for c, p in exact.items() if p != 0.0)
                row.append(value + (1.0 - sum(exact.values())) * held[x][j])
            self.value[n, *x] = row


def interpolated(row: list[float], position: float) -> float:
    """Cubic inside; linear in the last cell and the eight next to a stall; constant beyond both ends."""
    last = len(row) - 1
    position = min(max(position, 0.0), float(last))
    i = min(int(position), last - 1)
    if i < 8 or i == last - 1:
        return row[i] + (position - i) * (row[i + 1] - row[i])
    nodes = range(i - 1, i + 3)
    return sum(row[a] * math.prod((position - b) / (a - b) for b in nodes if b != a) for a in nodes)


def probability(line: float, reading: float, up: bool) -> float:
    """That a reading with error of std 1 lies beyond the line."""
    z = reading - line if up else line - reading
    return (1.0 if z > 0 else 0.0) if abs(z) > 6.0 else 0.5 * math.erfc(-z / math.sqrt(2.0))


def best_lines(gains: list[list[float]], readings: np.ndarray, up: bool) -> list[float]:
    """Ordered thresholds of the largest total gain, all of them tried."""
    if not gains:
        return []
    y, points = readings, len(readings)
    over = [[g - (gains[d - 1][j] if d else 0.0) for j, g in enumerate(row)] for d, row in enumerate(gains)]
    beyond = [[math.copysign(max(abs(g) - ROUNDING, 0.0), g) for g in row] for row in over]
    places = range(2, points + 1) if up else range(points - 2, -1, -1)  # points, and 0: never

    def total(d: int, place: int) -> float:
        if up:
            return sum(beyond[d][j] * float(y[j] - y[j - 1]) for j in range(place, points))
        return sum(beyond[d][j] * float(y[j + 1] - y[j]) for j in range(1, place + 1))

    totals = {(d, place): total(d, place) for d in range(len(gains)) for place in places}
    order = sorted(places, key=lambda place: place if up else -place)
    best = -math.inf
    chosen: tuple[int, ...] = ()
    for tried in itertools.combinations_with_replacement(order, len(gains)):
        worth = sum(totals[d, place] for d, place in enumerate(tried))
        if worth > best + 1e-13:
            best, chosen = worth, tried
    found = []
    for place in chosen:
        if place == (points if up else 0):
            found.append(math.inf if up else -math.inf)
            continue
        same = [e for e, other in enumerate(chosen) if other == place]
        step = -1 if up else 1
        pooled = [gains[same[-1]][j] - (gains[same[0] - 1][j] if same[0] else 0.0) for j in range(points)]
        a, b = pooled[place + step] - ROUNDING, pooled[place] - ROUNDING
        low, high = float(y[place + step]), float(y[place])
        found.append(0.5 * (low + high) if (a < 0) == (b < 0) else low + (high - low) * a / (a - b))
    return found
