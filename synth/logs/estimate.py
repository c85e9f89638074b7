"""The numbers of a position that make its measured passes most likely, and how sure they are.

Maximum of the likelihood times what is known before, by `scipy.optimize` (trust region, with the Fisher information in
place of the second derivatives). The intervals are those of the sandwich: the spread of the scores from pass to pass
between two informations, so that they hold where the innovations are not quite normal.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import minimize

from plant_models.frozen_arrays import Floats, frozen_arrays
from synth.logs.fitting_passes import FittingPasses
from synth.logs.likelihood import Innovations, Likelihood, likelihood_of
from synth.logs.unknowns import OF_VALVES, VALVE_TIMES, Unknown, slope_of, values_at

STEP, SIDE = 1e-3, (3e-3, 6e-3)
"""Of the differences that stand for derivatives, in standard deviations of what is known before: to both sides of a
point; and, from there, begin and end of those on one side, which begins behind an edge that lies close to the point."""

CHUNK = 125
"""Passes whose derivatives are in memory at a time."""

FEW = 100
"""Passes that a first estimate is made on."""

STARTS = (0.0, 1.5, -1.5)
"""Where the times of the valves are first sought, in standard deviations of what is known before."""

Z95 = 1.959963984540054

MOST_STEPS = 100

NEAR, ROUGHLY = 0.01, 0.1
"""How near to the summit a search ends, in standard errors: of the estimate, and of the point that it starts from."""

FALL95 = 1.9207294103470202
"""Half the 95 % quantile of χ² with one degree of freedom."""

NEAR_EDGE, MOST_EDGES = 0.2, 4
"""A summit lies on an edge where its gentle sides still rise, to a place so many standard errors away or more. And how
many edges are left one after the other."""


@dataclass(frozen=True)
class Side:
    """Where a difference starts and goes to, from the point itself."""

    start: float
    to: float


CENTRAL = Side(-STEP, STEP)


@frozen_arrays
class Linearised:
    """Log-likelihood, scores (m, p) and information (p, p) at one point, without what was known before."""

    log_likelihood: float
    scores: Floats
    information: Floats


@frozen_arrays
class Estimate:
    """What the passes say of the `unknowns`.

    `u`, `covariance`: in standard deviations of what was known before; `information` of the passes alone.
    """

    unknowns: tuple[Unknown, ...]
    passes: int
    log_likelihood: float
    u: Floats
    covariance: Floats
    information: Floats

    @property
    def values(self) -> dict[str, float]:
        """The numbers by key."""
        return values_at(self.unknowns, self.u)

    @property
    def std(self) -> Floats:
        """Standard errors, as fractions of the standard deviations known before, (p,)."""
        return np.asarray(np.sqrt(np.diag(self.covariance)))

    def interval(self, number: int) -> tuple[float, float]:
        """95 % interval of unknown `number`."""
        reach = Z95 * float(self.std[number])
        one = self.unknowns[number]
        return one.value(float(self.u[number]) - reach), one.value(float(self.u[number]) + reach)

    def correlation(self) -> Floats:
        """Of the errors of all numbers, (p, p)."""
        return np.asarray(self.covariance / np.outer(self.std, self.std))


class Posterior:
    """Minus the logarithm of likelihood times what is known before, for an optimiser; remembers the last point."""

    def __init__(self, parts: Sequence[Likelihood], unknowns: Sequence[Unknown], threads: int) -> None:
        self.parts, self.unknowns, self.threads = parts, unknowns, threads
        self.at_u: Floats | None = None
        self.found: Linearised | None = None

    def value(self, u: Floats) -> float:
        """At `u`."""
        values = values_at(self.unknowns, u)
        with ThreadPoolExecutor(self.threads) as pool:
            sums = pool.map(lambda part: part.at(values).log_likelihood(len(part.passes)).sum(), self.parts)
            return 0.5 * float(u @ u) - float(sum(sums))

    def linearised(self, u: Floats) -> Linearised:
        """At `u`."""
        if self.found is not None and self.at_u is not None and np.array_equal(u, self.at_u):
            return self.found
        self.at_u, self.found = u.copy(), self.linearised_by(u, {})
        return self.found

    def linearised_by(self, u: Floats, sides: Mapping[str, Side]) -> Linearised:
        """At `u`, with differences between the ends of `sides`; of the other numbers between both sides of `u`."""
        with ThreadPoolExecutor(self.threads) as pool:
            found = list(pool.map(lambda part: linearised(part, self.unknowns, u, sides), self.parts))
        return Linearised(
            sum(f.log_likelihood for f in found),
            np.concatenate([f.scores for f in found]),
            np.sum([f.information for f in found], axis=0),
        )

    def gradient(self, u: Floats) -> Floats:
        """At `u`."""
        return np.asarray(u - self.linearised(u).scores.sum(axis=0))

    def hessian(self, u: Floats) -> Floats:
        """At `u`, by the Fisher information."""
        return np.asarray(np.eye(len(u)) + self.linearised(u).information)


def estimate(passes: FittingPasses, unknowns: tuple[Unknown, ...], threads: int = 1) -> Estimate:
    """The most likely numbers. The result does not depend on `threads`."""
    whole = posterior(passes, unknowns, threads)
    u, there = beside_edges(whole, highest(whole, first_estimate(passes, unknowns, threads), NEAR))
    bread = np.linalg.inv(np.eye(len(u)) + there.information)
    apart = there.scores - there.scores.mean(axis=0)
    # As many scores as numbers are used up: without this the intervals of short logs are too short.
    meat = np.eye(len(u)) + apart.T @ apart * (len(passes) / max(1, len(passes) - len(u)))
    return Estimate(unknowns, len(passes), there.log_likelihood, u, bread @ meat @ bread, there.information)


def first_estimate(passes: FittingPasses, unknowns: tuple[Unknown, ...], threads: int) -> Floats:
    """From some of the passes, sought from quick, usual and slow valves: the likelihood has summits of its own."""
    some = np.unique(np.linspace(0, len(passes) - 1, FEW).astype(np.int64))
    target = posterior(passes.taken(some), unknowns, threads, settled=True)
    of_times = np.array([unknown.key in VALVE_TIMES for unknown in unknowns])
    found = [highest(target, np.where(of_times, start, 0.0), ROUGHLY) for start in STARTS]
    return min(found, key=target.value)


def posterior(passes: FittingPasses, unknowns: tuple[Unknown, ...], threads: int, settled: bool = False) -> Posterior:
    """Of the passes in chunks; `settled` as in `likelihood_of`."""
    numbers = np.arange(len(passes))
    chunks = [numbers[i : i + CHUNK] for i in range(0, len(passes), CHUNK)]
    parts = [likelihood_of(passes.taken(chunk), slope_of(unknowns), settled) for chunk in chunks]
    return Posterior(parts, unknowns, threads)


def gentlest(target: Posterior, u: Floats) -> Linearised:
    """At the summit `u`, of each number of the valves on the side where the passes tell less of it.

    Where a flow begins or ends just at a reading of the gauge, the likelihood has an edge: steep on one side, flat on
    the other. The summit often lies on it, and the number may be anywhere on the flat side.
    """
    sides = [Side(*SIDE), Side(-SIDE[1], -SIDE[0])]
    found = [target.linearised_by(u, dict.fromkeys(OF_VALVES, side)) for side in sides]
    above, below = (np.diag(each.information) for each in found)
    chosen = {unknown.key: sides[int(below[j] < above[j])] for j, unknown in enumerate(target.unknowns)}
    return target.linearised_by(u, {key: side for key, side in chosen.items() if key in OF_VALVES})


def beside_edges(target: Posterior, u: Floats) -> tuple[Floats, Linearised]:
    """The summit `u`, or, where that lies on an edge and the flat side is still rising away from it, the summit there.

    A summit on an edge owes its height to the noise of the readings at which a flow just begins. It is a hundred times
    as narrow as the flat side, so the number is hardly there; it is left where it is no more than `FALL95` higher.
    """
    there = gentlest(target, u)
    for _ in range(MOST_EDGES):
        information = np.eye(len(u)) + there.information
        slope = there.scores.sum(axis=0) - u
        step = np.linalg.solve(information, slope)
        if step @ slope < NEAR_EDGE**2 or target.value(u + step) > target.value(u) + FALL95:
            break
        u = highest(target, u + step, NEAR)
        there = gentlest(target, u)
    return u, there


@frozen_arrays
class Turned:
    """`target` in variables z in which the summit is about as wide in all directions as it seems to be at `start`."""

    target: Posterior
    start: Floats
    turn: Floats

    def point(self, z: Floats) -> Floats:
        """Where `z` is."""
        return np.asarray(self.start + self.turn @ z)

    def value(self, z: Floats) -> float:
        """See `Posterior`."""
        return self.target.value(self.point(z))

    def gradient(self, z: Floats) -> Floats:
        """See `Posterior`."""
        return np.asarray(self.turn.T @ self.target.gradient(self.point(z)))

    def hessian(self, z: Floats) -> Floats:
        """See `Posterior`."""
        return np.asarray(self.turn.T @ self.target.hessian(self.point(z)) @ self.turn)


def highest(target: Posterior, start: Floats, near: float) -> Floats:
    """The most likely point, sought from `start` until the slope is `near`, in standard errors."""
    turned = Turned(target, start, np.linalg.inv(np.linalg.cholesky(target.hessian(start))).T)
    options: Any = {"gtol": near, "initial_trust_radius": 10.0, "max_trust_radius": 1e6, "maxiter": MOST_STEPS}
    found: Any = minimize(
        turned.value, np.zeros(len(start)), method="trust-exact", jac=turned.gradient, hess=turned.hessian,
        options=options,
    )  # fmt: skip
    return turned.point(found.x)


def linearised(part: Likelihood, unknowns: Sequence[Unknown], u: Floats, sides: Mapping[str, Side]) -> Linearised:
    """Scores and information of some passes, by differences of the innovations and their variances."""
    values = values_at(unknowns, u)
    pressures = part.pressures(values)
    base = part.at(values, pressures)
    count, r, s = len(unknowns), base.innovation, base.variance
    by_innovation, by_variance = np.empty((count, len(r))), np.empty((count, len(r)))
    for j, unknown in enumerate(unknowns):
        side = sides.get(unknown.key, CENTRAL)
        ends: list[Innovations] = []
        for place in (side.to, side.start):
            moved = values | {unknown.key: unknown.value(float(u[j]) + place)}
            ends.append(part.at(moved, None if unknown.key in OF_VALVES else pressures))
        by_innovation[j] = (ends[0].innovation - ends[1].innovation) / (side.to - side.start)
        by_variance[j] = (ends[0].variance - ends[1].variance) / (side.to - side.start)
    terms = -by_innovation * r / s - 0.5 * by_variance / s * (1.0 - r**2 / s)
    scores = np.array([np.bincount(base.pass_of, term, len(part.passes)) for term in terms]).T
    information = (by_innovation / s) @ by_innovation.T + 0.5 * (by_variance / s**2) @ by_variance.T
    return Linearised(float(base.log_likelihood(len(part.passes)).sum()), scores, information)
