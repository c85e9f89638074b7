"""Where changes of stage land, in numpy: places on the grid of values and their weights, for all energies at once.

The same interpolation as `kernels.sweep.landing_plan` has, from the same tables of a chain. Arrays have axes (C, I, L,
E): change of stage, scenario, noise level before, energy.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from plant_models.frozen_arrays import Bools, Floats, Ints, frozen_arrays
from synth.kernels.sweep.flow import LINEAR_CELLS
from synth.solver.chain.chain import Chain

Indices = Ints

ALMOST = 1e-9
"""Of a quantum: a landing so little before a node is at it."""


@frozen_arrays
class Stencil:
    """Four neighbouring energies: the first of them, and their weights (…, 4)."""

    first: Indices
    weights: Floats


@frozen_arrays
class Outcome:
    """One noise level after a change, and one side of the law of the friction met: where it ends.

    `level` after it; `node` at or before the landing; values at a sample count at `back` on this node, values before
    the noise level changes at `forth` on the next; `stalled`: weight of a stall.
    """

    level: int
    node: Indices
    back: Stencil
    forth: Stencil
    stalled: Floats

    @property
    def weighty(self) -> tuple[Bools, Bools]:
        """Where the four values of either node have a weight at all."""
        return (self.back.weights != 0.0).any(axis=-1), (self.forth.weights != 0.0).any(axis=-1)

    @property
    def landings(self) -> int:
        """Landings that are possible and no stalls."""
        back, forth = self.weighty
        return int(np.count_nonzero(back | forth))

    @property
    def groups(self) -> int:
        """Groups of four values that they are interpolated from: one or two a landing."""
        back, forth = self.weighty
        return int(np.count_nonzero(back) + np.count_nonzero(forth))


def stencil_at(position: Floats, points: int, share: Floats) -> Stencil:
    """Interpolation at `position` in cells, times `share`.

    Cubic inside, held constant beyond both ends, linear in the last cell and in the first `LINEAR_CELLS`.
    """
    inside = np.clip(position, 0.0, points - 1.0)
    i = np.clip(inside.astype(np.int64), 1, points - 3)
    x = inside - i
    up, down, two = x + 1.0, x - 1.0, x - 2.0
    cubic = (-x * down * two / 6.0, up * down * two / 2.0, -up * x * two / 2.0, up * x * down / 6.0)
    none = np.zeros_like(x)
    cases = [x < 0.0, x > 1.0, inside < LINEAR_CELLS]
    linear = (
        (-x, none, none), (up, none, 1.0 - x), (none, 2.0 - x, x), (none, down, none),
    )  # fmt: skip
    weights = [np.select(cases, others, usual) * share for others, usual in zip(linear, cubic, strict=True)]
    return Stencil(i - 1, np.stack(weights, axis=-1))


@frozen_arrays
class Ends:
    """Path (…, E) and energy at the end of a change; a negative path is a stall."""

    path_m: Floats
    energy_m2_s2: Floats


def ends_at(chain: Chain, n: int, factor: Floats) -> Ends:
    """Ends of all changes from node `n`, friction factors (C, I, L or 1, E): a parabola through three tabulated ones.

    If one of the three stalls, the nearest decides.
    """
    factors, points = chain.landings.factors, chain.landings.points
    z = (factor - factors[0]) / (factors[1] - factors[0])
    centre = np.clip((z + 0.5).astype(np.int64), 1, len(factors) - 2)
    x = np.clip(z - centre, -1.5, 1.5)
    nearest = centre + np.where(x < -0.5, -1, np.where(x > 0.5, 1, 0))
    weights = (0.5 * x * (x - 1.0), 1.0 - x * x, 0.5 * x * (x + 1.0))
    ends, energy = chain.landings.ends[n], np.arange(points)
    c = np.arange(ends.shape[0])[:, None, None, None]
    three = [ends[c, centre + k, :, energy] for k in (-1, 0, 1)]
    parabola = sum(weight[..., None] * each for weight, each in zip(weights, three, strict=True))
    stalls = np.min([each[..., 0] for each in three], axis=0) < 0.0
    found = np.where(stalls[..., None], ends[c, nearest, :, energy], parabola)
    return Ends(found[..., 0], found[..., 1])


def outcomes(chain: Chain, n: int, slope: Floats) -> Iterator[Outcome]:
    """All outcomes of all changes from node `n`; `slope` (I, H, L, N): energy gained in a quantum at a held stage."""
    noise, levels, points = chain.transient_noise, len(chain.path_noise.levels), chain.landings.points
    changes, scenarios = len(chain.landings.end_mode), len(chain.scenarios.factor)
    factor = np.broadcast_to(chain.scenarios.factor[None, :, None, None], (changes, scenarios, 1, points))
    usual = ends_at(chain, n, factor).path_m
    quanta = 1.0 / chain.grid.path_step_m
    over = np.clip((usual * quanta + ALMOST).astype(np.int64), 0, noise.probability.shape[1] - 1)
    c, before = np.arange(changes)[:, None, None, None], np.arange(levels)[None, None, :, None]
    for level in range(levels):
        share, mean, std = (each[c, over, before, level] for each in (noise.probability, noise.mean, noise.std))
        for sign in (-1.0, 1.0):
            ends = ends_at(chain, n, factor * (1.0 + mean + sign * std))
            yield outcome(chain, n, slope[..., level, :], ends, 0.5 * share, usual < 0.0, level)


def outcome(chain: Chain, n: int, slope: Floats, ends: Ends, share: Floats, stalls: Bools, level: int) -> Outcome:
    """Where these `ends` lie among the nodes; `slope` (I, H, N) at the level reached."""
    points, left = chain.landings.points, len(chain.drive_m_s2) - n
    cells, quanta = 1.0 / chain.grid.energy_step_m2_s2, 1.0 / chain.grid.path_step_m
    stalled = stalls | (ends.path_m < 0.0)
    energy = ends.energy_m2_s2 + ends.path_m * chain.scenarios.extra_m_s2[None, :, None, None]
    ahead = ends.path_m * quanta
    crossed = np.clip((ahead + ALMOST).astype(np.int64), 0, left)
    x = np.maximum(ahead - crossed, 0.0)
    i = np.arange(slope.shape[0])[None, :, None, None]
    mode = chain.landings.end_mode[:, None, None, None]
    gained = slope[i, mode, n + np.minimum(crossed, left - 1)]
    leaves, own = crossed >= left, crossed < 1
    back = np.where(leaves, energy, energy - gained * x) * cells
    forth = (energy + gained * (1.0 - x)) * cells
    at_back = np.where(stalled, 0.0, np.where(leaves, share, np.where(own, 0.0, (1.0 - x) * share)))
    at_forth = np.where(stalled | leaves, 0.0, np.where(own, share, x * share))
    return Outcome(
        level, n + crossed, stencil_at(back, points, at_back), stencil_at(forth, points, at_forth),
        np.where(stalled, share, 0.0),
    )  # fmt: skip
