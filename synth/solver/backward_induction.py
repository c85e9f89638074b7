"""Solve a problem: backward induction over path quanta to switching lines, and to a map of the best command."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plant_models.frozen_arrays import Bools, Floats, Ints, frozen_arrays
from synth.kernels.sweep.bellman import Entrance, sweep
from synth.kernels.sweep.drawn_lines import Readings
from synth.kernels.sweep.pass_time import Costs, Prices
from synth.kernels.vector.packs import EIGHT
from synth.problem.problem import Aim
from synth.solver.chain.chain import Chain, chain_arrays, pass_times, scenario_arrays
from synth.solver.switching_lines import SwitchingLines

TIE_M2_S2 = 1e-9
"""Averaged gains smaller than this are none: hold wins."""

ROUNDINGS = 16
"""Gains are none, too, that so many roundings of the cost itself could make. Without it float32 puts lines where a cut
is beyond help, at 26 nodes of the default book where switchings have no price."""


@frozen_arrays
class Solution:
    """The best policy on a grid.

    Attributes
    ----------
    chain
        The grid, and the motion on it.
    aim
        What the policy is for.
    lines_m_s
        The policy by command, decision and stage, m/s, (C, R, K + 1).
    gain
        Mean-square cost that is saved by a command at a measured speed, m²/s², (C, R, K + 1, E): what the lines bound,
        and what the indifferent region is read from.
    values
        Estimated cost to go by scenario, m²/s², (I, N + 1, H, L, E), or of fewer nodes.

    Examples
    --------
    With `solution` from the example of `tabulate`:

    >>> solution.lines.lower_m_s.shape == solution.lines.upper_m_s.shape
    True
    """

    chain: Chain
    aim: Aim
    lines_m_s: Floats
    gain: Floats
    values: NDArray[np.floating[Any]]

    def __repr__(self) -> str:
        shape = f"{len(self.chain.grid.path_m)} nodes of the path, {self.lines_m_s.shape[2]} stages"
        return f"Solution(to {self.aim.target_speed_m_s:g} m/s, {shape})"

    @cached_property
    def lines(self) -> SwitchingLines:
        """The policy as lines over the path, of decisions at every node, found for commands that go one stage far."""
        lower, upper = (with_exit_node(each) for each in self.lines_m_s)
        return SwitchingLines(self.chain.grid.path_m, lower, upper)

    @property
    def gain_down(self) -> Floats:
        """Of going one stage down, (R, K + 1, E)."""
        gain: Floats = self.gain[0]
        return gain

    @property
    def gain_up(self) -> Floats:
        """Of going one stage up, (R, K + 1, E)."""
        gain: Floats = self.gain[1]
        return gain


def solve(chain: Chain, aim: Aim, value_type: type[np.floating[Any]] = np.float32) -> Solution:
    """Backward induction for one aim; `value_type` as of `solve_all`."""
    return solve_all(chain, [aim], value_type=value_type)[0]


def solve_all(
    chain: Chain,
    aims: Sequence[Aim],
    nodes_kept: int | None = None,
    value_type: type[np.floating[Any]] = np.float32,
    heard: Floats | None = None,
) -> tuple[Solution, ...]:
    """Backward induction for several aims in one sweep: they share all motion.

    Up to eight cost little more than one, and none depends on which others there are. `nodes_kept`: at how many path
    nodes, from the entrance on, the solutions hold values, by default at all; they are most of the memory of a
    solution. `value_type`: of the numbers that values are computed and kept in. float32 takes less time than float64
    and half the memory; what it costs: `docs/explanation/method-solver.md`. `heard` (R, T): the probability that a
    decision is taken, by aim; by default that of the chain's epochs for all.
    """
    c = chain
    priced = [each.criterion.exit_costs(c.grid.speed_m_s, each.target_speed_m_s) for each in aims]
    exit_costs, stall_costs = zip(*priced, strict=True)
    change_costs = [each.criterion.switching_tolerance_m2_s2 for each in aims]
    time_prices = [each.criterion.time_price_m2_s3 for each in aims]
    stages, points, width = c.actuator.stages, len(c.grid.speed_m_s), len(aims)
    kept = len(c.drive_m_s2) + 1 if nodes_kept is None else nodes_kept
    states = (len(c.actuator.mode_stage), len(c.path_noise.levels), points)
    values = np.empty((len(c.scenarios.factor), kept, *states, width), value_type)
    shape = (2 * c.decisions.swept, len(c.decisions), stages, width)
    lines, gain = np.empty(shape), np.empty((*shape, points))
    heard = np.full((len(c.decisions), width), c.epochs.heard) if heard is None else heard
    readings, noise = c.measurement.readings(c.grid.speed_m_s), c.measurement.std
    smear_start, smear = true_speed_weights(c.grid.speed_m_s, readings, noise)
    costs = (np.stack(exit_costs, axis=1), stall_costs, change_costs, time_prices)
    terminal, stalled, of_change, of_second = (in_packs_of_targets(each, value_type).ravel() for each in costs)
    sweep(
        chain_arrays(c, 2 * c.decisions.swept),
        scenario_arrays(c),
        hidden_prior(c).astype(value_type),
        Costs(terminal, stalled, Prices(of_change, of_second, pass_times(c))),
        TIE_M2_S2,
        ROUNDINGS * float(np.finfo(value_type).eps),
        Readings(readings, noise, heard, smear_start, smear.astype(value_type)),
        Entrance(c.approach_nodes, c.plant.entrance_stage),
        values,
        lines,
        gain,
    )
    return tuple(
        Solution(
            chain=c,
            aim=aim,
            lines_m_s=c.measurement.speeds(lines[..., i]),
            gain=gain[:, :, :, i],
            values=values[..., i],
        )
        for i, aim in enumerate(aims)
    )


def in_packs_of_targets(by_target: ArrayLike, value_type: type[np.floating[Any]]) -> NDArray[np.floating[Any]]:
    """Zeros added for targets that nobody asked for, until the last axis fills whole packs of the kernel."""
    numbers = np.asarray(by_target, dtype=value_type)
    missing = -numbers.shape[-1] % EIGHT
    return np.pad(numbers, [(0, 0)] * (numbers.ndim - 1) + [(0, missing)])


def hidden_prior(c: Chain) -> Floats:
    """Prior weights (I, H, L) of scenario, resting mode within its stage, and noise level."""
    stage = c.actuator.mode_stage
    per_mode = 1.0 / np.bincount(stage)[stage]
    prior: Floats = np.einsum("i,h,l->ihl", c.scenarios.weight, per_mode, c.path_noise.stationary)
    return prior


def true_speed_weights(speed_m_s: Floats, readings: Floats, noise: float) -> tuple[Ints, Floats]:
    """Bands of P(true speed | measured speed) on the grid: first index (E,) and weights (E, W).

    Flat prior in speed: weight φ((y' − y)/σ)·dv', cut at four standard deviations, y = `readings` of the speeds.
    """
    v = readings
    width = np.gradient(speed_m_s)
    first = np.searchsorted(v, v - 4 * noise)
    last = np.searchsorted(v, v + 4 * noise, side="right")
    span = int((last - first).max())
    start = np.minimum(first, len(v) - span)
    index = start[:, None] + np.arange(span)
    weights = np.exp(-0.5 * ((v[index] - v[:, None]) / noise) ** 2) * width[index]
    return start, weights / weights.sum(axis=1, keepdims=True)


def with_exit_node(lines: Floats) -> Floats:
    """(N, K + 1) per quantum start → (K + 1, N + 1) with the last row repeated at S_exit."""
    return np.concatenate([lines, lines[-1:]]).T.copy()


@frozen_arrays
class PolicyMap:
    """Best command and indifferent region on the solver's grid, by stage.

    `path_m` (N,), `speed_m_s` (E,); `command` (K + 1, N, E) int8: −1 down, 0 hold, +1 up; `indifferent`
    (K + 1, N, E): several commands cost the same within the tolerance.
    """

    path_m: Floats
    speed_m_s: Floats
    command: NDArray[np.int8]
    indifferent: Bools


def policy_map(solution: Solution, tolerance_m2_s2: float) -> PolicyMap:
    """The solver's map by measured speed.

    The cost of holding is taken as 0, of a change as minus its gain; the best command is the cheapest, hold in
    a tie; a state is indifferent if a second command costs at most `tolerance_m2_s2` more than the best.
    """
    grid, (down, up) = solution.chain.grid, gains(solution)
    best = np.maximum(0.0, np.maximum(down, up))
    command = np.zeros(down.shape, dtype=np.int8)
    command[(down > 0.0) & (down >= up)] = -1
    command[(up > 0.0) & (up > down)] = 1
    near = np.stack([best - gain <= tolerance_m2_s2 for gain in (np.zeros_like(best), down, up)])
    return PolicyMap(grid.path_m[:-1], grid.speed_m_s, command, near.sum(axis=0) >= 2)


def share_of_ties(solution: Solution) -> float:
    """Share of the states with a change at hand where hold wins because the best change gains nothing."""
    changes = np.maximum(*gains(solution))
    tied = np.abs(changes[np.isfinite(changes)]) <= TIE_M2_S2
    return float(tied.mean())


def gains(solution: Solution) -> tuple[Floats, Floats]:
    """What a change down and one up gain, (K + 1, N, E) each; −inf where there is none."""
    down, up = (np.moveaxis(gain, 1, 0) for gain in (solution.gain_down, solution.gain_up))
    down, up = np.where(available(down), down, -np.inf), np.where(available(up), up, -np.inf)
    up[solution.chain.plant.entrance_stage :, : solution.chain.approach_nodes] = -np.inf
    return down, up


def available(gain: Floats) -> Bools:
    """Which commands a stage has at all: the sweep leaves the gain of a missing one exactly zero everywhere."""
    exists: Bools = np.any(gain != 0.0, axis=(1, 2), keepdims=True)
    return np.broadcast_to(exists, gain.shape)
