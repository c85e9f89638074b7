"""What a policy of switching surfaces costs, exactly, with its slopes; where it takes the cuts. Nothing is sampled."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import TypeVar

import numpy as np

from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from synth.kernels.any_time.occupancy import occupy
from synth.kernels.any_time.period import ROOM
from synth.kernels.any_time.sampled_arrays import Costs, Lines, Met, SampledArrays
from synth.kernels.any_time.value import value
from synth.problem.problem import Aim
from synth.solver.any_time.sampled_chain import SampledChain, sampled_arrays
from synth.solver.exit_density import ExitDensity

Result = TypeVar("Result")

Valued = tuple[float, Floats, Floats]
"""Cost, slopes and bends of one scenario."""

UP = 1
"""Second of the two sides of a pair of lines."""


@frozen_arrays
class SurfaceCost:
    """Expected cost of a policy, and its derivatives by every line value, (2, N, M): by side, node and mode.

    `slopes`: first derivatives; `bends`: second derivatives by each value alone.
    """

    cost_m2_s2: float
    slopes: Floats
    bends: Floats


@frozen_arrays
class Followed:
    """The forward pass of one scenario: its exits (E,), totals (4,), and where the states are that it met."""

    exits: Floats
    totals: Floats
    band: Ints
    where: Ints
    way_band: Ints


@dataclass(frozen=True)
class SurfaceEvaluation:
    """Exact figures of policies on one chain; `lines_m_s` (2, N, M) by side, path node and mode; ±inf: no command.

    Scenarios are followed side by side in `threads`; no figure depends on how many. Energies of a state beyond which no
    probability is larger than `negligible_mass` are left out. `free`: memory that no thread works in at the moment;
    evaluations on the same grid can share it.
    """

    chain: SampledChain
    threads: int = 1
    negligible_mass: float = 1e-12
    free: list[WorkingMemory] = field(default_factory=list, repr=False)

    def density(self, lines_m_s: Floats) -> ExitDensity:
        """Exit-speed density, all scenarios weighted."""
        c, policy = self.chain, self._policy(lines_m_s)
        found = self._each(lambda i, memory: self._followed(self._in_scenario(policy, i), i, memory, False))
        exits = sum(w * each.exits for w, each in zip(c.scenarios.weight, found, strict=True))
        totals = sum(w * each.totals for w, each in zip(c.scenarios.weight, found, strict=True))
        stalled, escaped, down, up = (float(each) for each in np.asarray(totals))
        return ExitDensity(c.grid.speed_m_s, np.asarray(exits), max(stalled, 0.0), escaped, down + up)

    def gradient(self, lines_m_s: Floats, aim: Aim) -> SurfaceCost:
        """Expected cost and its derivatives, all scenarios weighted."""
        c, policy = self.chain, self._policy(lines_m_s)
        cost, slopes, bends = 0.0, np.zeros(policy.lines.shape), np.zeros(policy.lines.shape)
        found = self._each(lambda i, memory: self._valued(self._in_scenario(policy, i), i, aim, memory))
        for weight, (one, slope, bend) in zip(c.scenarios.weight, found, strict=True):
            cost += weight * one
            slopes += weight * slope
            bends += weight * bend
        rate = c.measurement.slopes(lines_m_s)
        return SurfaceCost(cost, slopes * rate, bends * rate**2)

    def _each(self, work: Callable[[int, WorkingMemory], Result]) -> list[Result]:
        """What `work` gives for every scenario, in their order."""

        def one(i: int) -> Result:
            try:
                memory = self.free.pop()
            except IndexError:
                memory = WorkingMemory(self.chain)
            found = work(i, memory)
            self.free.append(memory)
            return found

        with ThreadPoolExecutor(max_workers=self.threads) as pool:
            return list(pool.map(one, range(len(self.chain.scenarios.weight))))

    def _policy(self, lines_m_s: Floats) -> Lines:
        """Lines in readings, what is read of true speeds, and the error at every node (N,)."""
        c = self.chain
        if c.estimate is None:
            lines, std = c.measurement.thresholds(lines_m_s)
            noise = np.full(lines.shape[1], max(std, 1e-6))
            read = c.measurement.readings(c.grid.speed_m_s)
        else:
            lines, noise, read = lines_m_s, c.estimate.noise_m_s(c.grid.path_m[:-1]), c.grid.speed_m_s
        lines = np.array(lines, order="C")  # of any measurement alike: kernels are compiled once for all
        held = c.modes.stage >= c.plant.entrance_stage
        lines[UP, : c.approach_nodes, held] = np.inf  # before the entrance, no further
        return Lines(lines, np.pad(read, (0, ROOM), mode="edge"), noise)

    def _in_scenario(self, policy: Lines, i: int) -> Lines:
        """The policy as true speeds meet it in scenario `i`: what is estimated is shifted there."""
        c = self.chain
        if c.estimate is None:
            return policy
        shift = c.estimate.shift_m_s(c.grid.path_m[:-1], c.scenarios, i)
        return policy._replace(lines=policy.lines - shift[None, :, None])

    def _followed(self, policy: Lines, i: int, memory: WorkingMemory, keep: bool) -> Followed:
        c = self.chain
        nodes, modes, points = len(c.drive_m2_s2) - 1, len(c.modes.stage), len(c.grid.speed_m_s)
        band, where = np.empty((nodes, modes, 2), dtype=np.int64), np.empty((nodes, modes), dtype=np.int64)
        way_band = np.empty((nodes, len(c.periods.target), 2), dtype=np.int64)
        exits, totals = np.empty(points), np.empty(4)
        met = Met(memory.records, band, where, way_band)
        memory.records = occupy(
            policy, *self._shared(i), memory.heading, memory.here, self.negligible_mass, keep, met, exits, totals
        )
        return Followed(exits, totals, band, where, way_band)

    def _valued(self, policy: Lines, i: int, aim: Aim, memory: WorkingMemory) -> Valued:
        f = self._followed(policy, i, memory, keep=True)
        slopes, bends = np.empty(policy.lines.shape), np.empty(policy.lines.shape)
        period_s, criterion = self.chain.plant.sensor.sample_period_s, aim.criterion
        costs = Costs(
            *criterion.exit_costs(self.chain.grid.speed_m_s, aim.target_speed_m_s),
            criterion.switching_tolerance_m2_s2, criterion.time_price_m2_s3 * period_s,
        )  # fmt: skip
        met = Met(memory.records, f.band, f.where, f.way_band)
        return value(policy, *self._shared(i), costs, memory.heading, memory.here, met, slopes, bends), slopes, bends

    def _shared(self, i: int) -> tuple[SampledArrays, Floats, float]:
        """What both passes take of the chain, and of scenario `i`."""
        c = self.chain
        return sampled_arrays(c), c.scenarios.factor[i] * (1.0 + c.noise.levels), float(c.scenarios.extra_m_s2[i])


class WorkingMemory:
    """Memory of one pass at a time.

    `heading` (W, L, ring, E') of ways and `here` (M, L, E') of modes: zeros between passes. `records`: what a forward
    pass keeps for the backward one; a longer array takes its place where it does not suffice.
    """

    def __init__(self, chain: SampledChain) -> None:
        levels, row = len(chain.noise.levels), len(chain.grid.speed_m_s) + ROOM
        ring = 1 + max(len(chain.first_energy), len(chain.entry))
        self.heading = np.zeros((len(chain.periods.target), levels, ring, row))
        self.here = np.zeros((len(chain.modes.stage), levels, row))
        self.records = np.empty(0)
