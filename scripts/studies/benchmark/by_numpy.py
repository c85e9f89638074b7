"""The recursion of the solver once more in numpy, all energies and targets at once: what a careful user would write.

The same formulas, the same chain and the same grid as `kernels.sweep.bellman`, in float64; written without a look at
packs or caches. Values have axes (I, H, L, E, T): scenario, resting mode, noise level, energy, target.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from plant_models.frozen_arrays import Floats, frozen_arrays
from scripts.studies.benchmark.numpy_landings import Outcome, Stencil, outcomes, stencil_at
from synth.problem.problem import Aim
from synth.solver.backward_induction import ROUNDINGS, TIE_M2_S2, hidden_prior, true_speed_weights
from synth.solver.chain.chain import Chain

SIX_SIGMA = 6.0
"""Chances beyond are 0 or 1."""


@frozen_arrays
class Swept:
    """Values at entry (I, H, L, E, T), lines (N, K + 1, T).

    `landings` of changes that were possible and no stalls; `groups` of four values that they were interpolated from.
    """

    values: Floats
    lower_m_s: Floats
    upper_m_s: Floats
    landings: int
    groups: int


@frozen_arrays
class Costs:
    """At the exit (E, T), of a stall (T,), of a command (T,)."""

    exit_m2_s2: Floats
    stall_m2_s2: Floats
    change_m2_s2: Floats


def sweep_by_numpy(chain: Chain, aims: Sequence[Aim]) -> Swept:
    """Backward induction for several aims."""
    nodes, stages = len(chain.drive_m_s2), chain.actuator.stages
    costs, slope = costs_of(chain, aims), slopes(chain)
    shape = (*slope.shape[:3], *costs.exit_m2_s2.shape)
    values = np.zeros((nodes + 1, *shape))
    mixed = np.zeros_like(values)
    values[nodes] = mixed[nodes] = costs.exit_m2_s2
    ahead = [values[nodes].copy() for _ in range(len(chain.entry))]
    lower, upper = np.empty((nodes, stages, len(aims))), np.empty((nodes, stages, len(aims)))
    landings = groups = 0
    for n in reversed(range(nodes)):
        shift = slope[..., n] / chain.grid.energy_step_m2_s2
        ahead = [ahead[0], *(pulled(chain, each, shift, costs) for each in (values[n + 1], *ahead[1:-1]))]
        quanta = quanta_to_sample(chain, slope[..., n])
        holding = held(ahead, quanta)
        found = list(outcomes(chain, n, slope))
        landings += sum(each.landings for each in found)
        groups += sum(each.groups for each in found)
        changing = changed(chain, found, values, mixed, costs)
        lower[n], upper[n] = lines(chain, holding, changing, costs)
        values[n] = sampled(chain, (lower[n], upper[n]), changing, ahead[1], holding, quanta)
        values[n, ..., 0, :] = costs.stall_m2_s2
        mixed[n] = levels_mixed(chain, values[n], costs)
    return Swept(values[0].copy(), lower, upper, landings, groups)


def costs_of(chain: Chain, aims: Sequence[Aim]) -> Costs:
    """Those of all aims."""
    priced = [aim.criterion.exit_costs(chain.grid.speed_m_s, aim.target_speed_m_s) for aim in aims]
    at_exit, stall = zip(*priced, strict=True)
    change = [aim.criterion.switching_tolerance_m2_s2 for aim in aims]
    return Costs(np.stack(at_exit, axis=1), np.array(stall, dtype=float), np.array(change, dtype=float))


def slopes(chain: Chain) -> Floats:
    """Energy gained in a path quantum at a held stage, (I, H, L, N)."""
    held_kpa = chain.actuator.mode_overpressure_kpa[None, :, None, None]
    factor = chain.scenarios.factor[:, None, None, None] * (1.0 + chain.path_noise.levels[None, None, :, None])
    free = chain.drive_m_s2 + chain.scenarios.extra_m_s2[:, None, None, None]
    return np.asarray((free - chain.brake_m_s2_per_kpa * factor * held_kpa) * chain.grid.path_step_m)


def levels_mixed(chain: Chain, values: Floats, costs: Costs) -> Floats:
    """Expectation over the noise level of the quantum that begins."""
    mixed: Floats = np.einsum("um,ihmet->ihuet", chain.path_noise.transition, values)
    mixed[..., 0, :] = costs.stall_m2_s2
    return mixed


def pulled(chain: Chain, values: Floats, shift: Floats, costs: Costs) -> Floats:
    """Values one quantum earlier at a held stage; `shift` (I, H, L) in cells."""
    points = values.shape[-2]
    position = np.arange(points) + shift[..., None]
    found = interpolated(levels_mixed(chain, values, costs), stencil_at(position, points, np.ones_like(position)))
    found[..., 0, :] = costs.stall_m2_s2
    return found


def interpolated(rows: Floats, stencil: Stencil) -> Floats:
    """`rows` (…, E, T) at the places of `stencil` (…, E)."""
    total = np.zeros_like(rows)
    for k in range(4):
        there = np.take_along_axis(rows, (stencil.first + k)[..., None], axis=-2)
        total += there * stencil.weights[..., k, None]
    return total


def quanta_to_sample(chain: Chain, slope: Floats) -> Floats:
    """How far a cut rolls at a held stage until the next sample, in quanta, (I, H, L, E)."""
    v, period = chain.grid.speed_m_s, chain.plant.sensor.sample_period_s
    a = slope[..., None] / chain.grid.path_step_m
    stopping = np.divide(-0.5 * v**2, a, out=np.zeros(np.broadcast_shapes(v.shape, a.shape)), where=a < 0.0)
    way = np.where(v + a * period >= 0.0, v * period + 0.5 * a * period**2, stopping)
    return np.maximum(way / chain.grid.path_step_m, 0.01)


def held(ahead: Sequence[Floats], quanta: Floats) -> Floats:
    """Value of holding until the next sample; within this quantum that means until the next node."""
    last = len(ahead) - 2
    step = np.minimum(quanta.astype(np.int64), last)
    x = np.minimum(quanta - step, 1.0)[..., None]
    every = np.stack(ahead)
    near = np.take_along_axis(every, np.maximum(step, 1)[None, ..., None], axis=0)[0]
    far = np.take_along_axis(every, (step + 1)[None, ..., None], axis=0)[0]
    return np.asarray(np.where(step[..., None] == 0, near, (1.0 - x) * near + x * far))


def changed(chain: Chain, found: Sequence[Outcome], values: Floats, mixed: Floats, costs: Costs) -> Floats:
    """Expected value of every change of stage, (C, I, L, E, T)."""
    mode, last = chain.landings.end_mode[:, None, None, None], len(values) - 1
    i = np.arange(values.shape[1])[None, :, None, None]
    total = costs.change_m2_s2
    for each in found:
        total = total + each.stalled[..., None] * costs.stall_m2_s2
        for rows, node, stencil in ((values, each.node, each.back), (mixed, each.node + 1, each.forth)):
            for k in range(4):
                there = rows[np.minimum(node, last), i, mode, each.level, stencil.first + k]
                total = total + there * stencil.weights[..., k, None]
    return np.asarray(total)


def lines(chain: Chain, holding: Floats, changing: Floats, costs: Costs) -> tuple[Floats, Floats]:
    """(lower, upper) of one node, (K + 1, T): the thresholds with the largest total gain beyond them."""
    stages, speed = chain.actuator.stages, chain.grid.speed_m_s
    prior = hidden_prior(chain)[..., None, None]
    start, smear = true_speed_weights(speed, speed, chain.measurement.std)
    seen = start[:, None] + np.arange(smear.shape[1])
    shape = (stages, costs.exit_m2_s2.shape[1])
    found = np.full(shape, -np.inf), np.full(shape, np.inf)
    for side, chains in enumerate(chain.landings.change_chain[:2]):
        for k in range(stages):
            gain = np.zeros_like(costs.exit_m2_s2)
            for h in np.flatnonzero((chain.actuator.mode_stage == k) & (chains >= 0)):
                saved = holding[:, h] - changing[chains[h]]
                counts = np.abs(saved) > holding[:, h] * ROUNDINGS * np.finfo(float).eps
                gain += np.where(counts, saved * prior[:, h], 0.0).sum(axis=(0, 1))
            gain[0] = 0.0
            averaged = np.einsum("ew,ewt->te", smear, gain[seen])
            threshold = (lowest, highest)[side]
            found[side][k] = [threshold(row, speed) for row in averaged]
    return found[0], np.maximum(found[1], found[0])


def beyond(gain: Floats) -> Floats:
    """The part of gains or losses that exceeds the tolerance."""
    return np.sign(gain) * np.maximum(np.abs(gain) - TIE_M2_S2, 0.0)


def lowest(gain: Floats, speed: Floats) -> float:
    """Speed below which a change pays most in total; −inf if nowhere."""
    totals = np.cumsum(beyond(gain[1:-1]) * np.diff(speed)[1:])
    j = 1 + int(np.argmax(totals))
    return crossing(gain, speed, j) if totals[j - 1] > 0.0 else -np.inf


def highest(gain: Floats, speed: Floats) -> float:
    """Speed above which a change pays most in total; +inf if nowhere."""
    totals = np.cumsum((beyond(gain[2:]) * np.diff(speed)[1:])[::-1])
    best = int(np.argmax(totals))
    return crossing(gain, speed, len(gain) - 2 - best) if totals[best] > 0.0 else np.inf


def crossing(gain: Floats, speed: Floats, j: int) -> float:
    """Where the gain passes the tolerance between speeds j and j + 1."""
    a, b = gain[j] - TIE_M2_S2, gain[j + 1] - TIE_M2_S2
    share = 0.5 if (a < 0.0) == (b < 0.0) else a / (a - b)
    return float(speed[j] + (speed[j + 1] - speed[j]) * share)


def chances(z: Floats) -> Floats:
    """Normal distribution function, 0 or 1 beyond six standard deviations."""
    from scipy.special import ndtr  # start-up: scipy only where it is needed

    return np.asarray(np.where(np.abs(z) > SIX_SIGMA, (z > 0.0).astype(float), ndtr(z)))


def sampled(
    chain: Chain, found: tuple[Floats, Floats], changing: Floats, following: Floats, holding: Floats, quanta: Floats
) -> Floats:
    """Values at a sample under the lines `found`; within one quantum the next sample may be at this node again."""
    (lower, upper), speed, noise = found, chain.grid.speed_m_s[:, None], chain.measurement.std
    out = np.empty_like(holding)
    for h, k in enumerate(chain.actuator.mode_stage):
        down, up = chances((lower[k] - speed) / noise), chances((speed - upper[k]) / noise)
        gone: Floats = np.zeros_like(holding[:, h])
        for chance, c in ((down, chain.landings.change_chain[0, h]), (up, chain.landings.change_chain[1, h])):
            if c >= 0:
                gone = gone + chance * changing[c]
        stay, f = 1.0 - (down + up), quanta[:, h, :, :, None]
        again = (stay * f * following[:, h] + gone) / (1.0 - stay * (1.0 - f))
        out[:, h] = np.where(down + up > 0.0, np.where(f < 1.0, again, stay * holding[:, h] + gone), holding[:, h])
    return out
