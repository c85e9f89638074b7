"""The formulation as published (zhukovitsky-2002: independent noise in every quantum) once more, in plain numpy arrays.

With independent noise everything between the first and last quantum of a transient is summed in closed form, so no
Markov chain is needed here. Taken from the package: grid, cell means, landing tables, true-speed weights.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.stats import norm

from plant_models import DopplerSensor, Friction, Plant
from synth.problem.aim import Aim
from synth.problem.criterion import Criterion
from synth.problem.resolution import Resolution
from synth.solver.backward_induction import solve, true_speed_weights
from synth.solver.chain.chain import Chain, persistent_chain
from tests.oracles.as_published import as_published

Array = NDArray[np.float64]

LEVELS, WEIGHTS = np.polynomial.hermite_e.hermegauss(5)
WEIGHTS = WEIGHTS / WEIGHTS.sum()

ROUNDING = 1e-9


def sampled(rows: Array, position: Array) -> Array:
    """`rows` (…, E) at `position` (…, P) in cells: cubic; linear in the top cell and in the eight above a stall."""
    last = rows.shape[-1] - 1
    position = np.clip(position, 0.0, last)
    i = np.clip(position.astype(int), 0, last - 1)
    x = position - i

    def take(offset: int) -> Array:
        return np.take_along_axis(np.broadcast_to(rows, (*i.shape[:-1], last + 1)), np.clip(i + offset, 0, last), -1)

    linear = take(0) + x * (take(1) - take(0))
    cubic = -x * (x - 1) * (x - 2) / 6 * take(-1) + (x + 1) * (x - 1) * (x - 2) / 2 * take(0)
    cubic += -(x + 1) * x * (x - 2) / 2 * take(1) + (x + 1) * x * (x - 1) / 6 * take(2)
    found: Array = np.where((i < 8) | (i == last - 1), linear, cubic)
    return found


class Published:
    """Values V (N + 1, H, 5, E) and lines (N, K + 1) of the published formulation."""

    def __init__(self, t: Chain, target_m_s: float, criterion: Criterion) -> None:
        self.t = t
        plant, sensor = t.plant, t.plant.sensor
        self.step, self.cell = t.grid.path_step_m, t.grid.energy_step_m2_s2
        self.std = math.hypot(plant.friction_cv, plant.friction.path_std)
        self.eta = self.std * LEVELS
        self.nodes, self.speed, self.stage = len(t.drive_m_s2), t.grid.speed_m_s, t.actuator.mode_stage
        self.stalled = target_m_s**2 + criterion.stall_cost_m2_s2
        self.price = criterion.switching_tolerance_m2_s2
        self.V = np.zeros((self.nodes + 1, len(self.stage), 5, len(self.speed)))
        self.V[-1] = (self.speed - target_m_s) ** 2
        self.mean = self.V.copy()  # the same before the level of the quantum that begins is known
        braking = t.brake_m_s2_per_kpa[:, None] * t.actuator.mode_overpressure_kpa
        self.slope = t.drive_m_s2[:, None, None] - (1.0 + self.eta) * braking[:, :, None]  # d(v²/2)/ds, (N, H, 5)
        self.lower = np.full((self.nodes, t.actuator.stages), -math.inf)
        self.upper = np.full((self.nodes, t.actuator.stages), math.inf)
        self.sigma = sensor.reading_std_m_s
        furthest = len(t.entry) - 1
        waiting = [self.V[-1]] * (furthest + 1)  # waiting[r]: the next sample is r nodes further on
        for n in reversed(range(self.nodes)):
            grid = np.arange(len(self.speed)) + (self.slope[n] * self.step / self.cell)[..., None]
            ahead = [self.V[n]]
            for r in range(1, furthest + 1):
                mean = np.einsum("m,hmj->hj", WEIGHTS, waiting[r - 1])
                mean[:, 0] = self.stalled
                moved = sampled(mean[:, None, :], grid)
                moved[..., 0] = self.stalled
                ahead.append(moved)
            self.decide(n, ahead)
            self.mean[n] = np.einsum("m,hmj->hj", WEIGHTS, self.V[n])[:, None]
            waiting = [self.V[n], *ahead[1:]]

    def decide(self, n: int, ahead: list[Array]) -> None:
        """Lines and values of node n."""
        v, period = self.speed, self.t.plant.sensor.sample_period_s
        a = self.slope[n, ..., None]
        way = np.where(v + a * period < 0, -0.5 * v**2 / np.where(a == 0, -1, a), v * period + 0.5 * a * period**2)
        f = np.maximum(way / self.step, 0.01)
        stacked = np.stack(ahead)
        r = np.minimum(f.astype(int), len(ahead) - 2)
        x = np.minimum(f - r, 1.0)
        near, far = (np.take_along_axis(stacked, q[None], 0)[0] for q in (r, r + 1))
        hold = np.where(f < 1.0, ahead[1], (1 - x) * near + x * far)
        changes = []
        for chains in self.t.landings.change_chain[:2]:
            value = hold.copy()
            for h, c in enumerate(chains):
                if c >= 0:
                    value[h, :, 1:] = self.change(n, int(c))[:, 1:] + self.price
            changes.append(value)
        start, smear = true_speed_weights(v, v, self.sigma)
        for k in range(self.t.actuator.stages):
            for side, lines in enumerate((self.lower, self.upper)):
                gain = np.einsum("m,hmj->j", WEIGHTS, (hold - changes[side])[self.stage == k])
                gain = gain / (self.stage == k).sum()
                gain[0] = 0.0
                gain = (smear * gain[start[:, None] + np.arange(smear.shape[1])]).sum(axis=1)
                lines[n, k] = threshold(gain, v, upwards=side == 1)
            self.upper[n, k] = max(self.upper[n, k], self.lower[n, k])
        down = chance((self.lower[n, self.stage, None] - v) / self.sigma)[:, None]
        up = chance((v - self.upper[n, self.stage, None]) / self.sigma)[:, None]
        stay, changed = 1.0 - down - up, down * changes[0] + up * changes[1]
        again = (changed + stay * x * ahead[1]) / np.where(f < 1, 1.0 - stay * (1.0 - x), 1.0)
        self.V[n] = np.where(f < 1.0, again, changed + stay * hold)
        self.V[n, ..., 0] = self.stalled

    def change(self, n: int, c: int) -> Array:
        """Expected value after transient c by first level and energy, (5, E)."""
        land, points = self.t.landings, len(self.speed)
        nominal, _ = self.land(n, c, 1.0)
        total = np.zeros((5, points))
        crossed = np.where(nominal >= 0, (nominal / self.step + 1e-9).astype(int), -1)
        for r in np.unique(crossed[crossed >= 0]):
            here = crossed == r
            used = int(land.samples[c]) * self.t.actuator.substeps
            shares = work_shares(land.overpressure_kpa[c, :used], r + 1)
            for u in range(5):
                for m in [u] if r == 0 else range(5):
                    mean = self.eta[u] if r == 0 else shares[0] * self.eta[u] + shares[-1] * self.eta[m]
                    spread = self.std * math.sqrt((shares[1:-1] ** 2).sum())
                    for sign in (-1.0, 1.0):
                        weight = 0.5 * (1.0 if r == 0 else WEIGHTS[m])
                        value = self.arrive(n, c, m, 1.0 + mean + sign * spread)
                        total[u, here] += weight * value[here]
        total[:, crossed < 0] = self.stalled
        return total

    def arrive(self, n: int, c: int, m: int, factor: float) -> Array:
        """Value at the landing for every start energy, (E,)."""
        way, energy = self.land(n, c, factor)
        mode = int(self.t.landings.end_mode[c])
        into = (np.maximum(way, 0.0) / self.step + 1e-9).astype(int)
        leaves = n + into >= self.nodes
        x = np.where(leaves, 0.0, np.maximum(way / self.step - into, 0.0))
        at = np.minimum(n + into, self.nodes - 1)
        slope = self.slope[at, mode, m]
        known = np.where(leaves, self.nodes, at)
        back = sampled(self.V[known, mode, m], self.cells(energy - slope * x * self.step))[:, 0]
        forth = sampled(self.mean[at + 1, mode, m], self.cells(energy + slope * (1 - x) * self.step))[:, 0]
        x = np.where((into == 0) & ~leaves, 1.0, x)
        return np.where(way < 0.0, self.stalled, np.where(x == 1.0, forth, (1 - x) * back + x * forth))

    def cells(self, energy: Array) -> Array:
        """Position in the energy grid, (E, 1)."""
        position: Array = energy[:, None] / self.cell
        return position

    def land(self, n: int, c: int, factor: float) -> tuple[Array, Array]:
        """Travel and energy by start energy: parabola through the three nearest tabulated factors."""
        table = self.t.landings
        middle = int(np.clip(np.argmin(np.abs(table.factors - factor)), 1, len(table.factors) - 2))
        three = slice(middle - 1, middle + 2)
        powers = np.vander((table.factors[three] - factor), 3)
        weights = np.linalg.solve(powers.T, [0.0, 0.0, 1.0])  # the parabola's value at the factor
        travel, energy = table.travel_m[n, c, three], table.energy_m2_s2[n, c, three]
        nearest = int(np.argmin(np.abs(table.factors - factor)))
        stops = (travel < 0).any(axis=0)
        return (
            np.where(stops, table.travel_m[n, c, nearest], weights @ travel),
            np.where(stops, table.energy_m2_s2[n, c, nearest], weights @ energy),
        )


def work_shares(profile: Array, quanta: int) -> Array:
    """Share of the brake work in each of `quanta` equal parts of the time of `profile`."""
    work = np.concatenate([[0.0], np.cumsum(profile if profile.sum() > 0 else np.ones_like(profile))])
    at_ends = np.interp(np.linspace(0, len(profile), quanta + 1), np.arange(len(profile) + 1), work)
    shares: Array = np.diff(at_ends) / work[-1]
    return shares


def chance(z: Array) -> Array:
    """Φ(z), 0 or 1 beyond six standard deviations."""
    shares: Array = np.where(np.abs(z) > 6.0, (z > 0).astype(float), norm.cdf(z))
    return shares


def threshold(gain: Array, v: Array, upwards: bool) -> float:
    """The speed beyond which (upwards: above) the gains sum to most; infinite if to nothing."""
    if not upwards:
        return -threshold(gain[::-1], -v[::-1], True)
    excess = np.sign(gain) * np.maximum(np.abs(gain) - ROUNDING, 0.0)
    cells = excess[1:] * np.diff(v)  # cell j − 1 … j counts for the change made at v_j
    first = 2 if v[0] == 0.0 else 1  # no command at rest: the stall has no gain
    last = len(v) if v[0] == 0.0 else len(v) - 1
    totals = np.cumsum(cells[first - 1 : last - 1][::-1])[::-1]
    best = len(totals) - 1 - int(np.argmax(totals[::-1]))
    if totals[best] <= 0.0:
        return math.inf
    j = best + first
    low, high = gain[j - 1] - ROUNDING, gain[j] - ROUNDING
    if (low < 0) == (high < 0):
        return 0.5 * float(v[j - 1] + v[j])
    return float(v[j - 1] + (v[j] - v[j - 1]) * low / (low - high))


SMALL = Resolution(
    path_step_m=0.5, speed_step_m_s=0.1, transient_substeps=3, friction_nodes=1, path_levels=1, resistance_nodes=1
)


def noisy(plant_with: Callable[..., Plant]) -> Plant:
    """Friction that varies, and a sensor that errs."""
    return plant_with(friction=Friction(0.12, 0.05, 0.10, 1.5), sensor=DopplerSensor(0.05, 0.04, 0.15, 0.02))


@pytest.mark.long
@pytest.mark.parametrize(("target_m_s", "tolerance"), [(2.4, 1e-5), pytest.param(3.2, 0.0, marks=pytest.mark.long)])
def test_solve_agrees_with_numpy(plant_with: Callable[..., Plant], target_m_s: float, tolerance: float) -> None:
    """The same lines and values to 1e-9: only the order of additions differs."""
    t = as_published(persistent_chain(noisy(plant_with), SMALL))
    criterion = Criterion(switching_tolerance_m2_s2=tolerance)
    found, expected = solve(t, Aim(target_m_s, criterion), np.float64), Published(t, target_m_s, criterion)
    np.testing.assert_allclose(found.lines.lower_m_s[:, :-1].T, expected.lower, rtol=0, atol=1e-8)
    np.testing.assert_allclose(found.lines.upper_m_s[:, :-1].T, expected.upper, rtol=0, atol=1e-8)
    np.testing.assert_allclose(found.values[0], expected.V, rtol=0, atol=1e-9)
