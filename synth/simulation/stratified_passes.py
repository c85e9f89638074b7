"""Passes in strata of the friction, with weights: what every printed figure of simulated passes rests on.

Squared exit errors have a rare, heavy tail: cuts whose friction is so low that they saturate the brake. A thousand
plain passes meet one of them or none, so plain samples are too low most of the time and far too high seldom. Here half
of the passes have the friction of cuts as it comes; the other half have low friction, and count by how much rarer they
are in truth (deterministic mixture: Veach and Guibas 1995; Owen, *Monte Carlo theory*, §9.11). No weight exceeds 2.

Passes come in replicates of `REPLICATE_PASSES`. Within one, the friction is drawn from strata of equal probability,
and entry speed, phase and resistance from a Latin hypercube (McKay, Beckman and Conover 1979). Replicates are
independent of each other and alike, so their spread gives the error of any figure (`replicates`). At 20 000 passes the
rms of the default book is as certain as by 15 to 100 times as many plain passes where its tail is heavy.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import fields, replace
from typing import TypeVar

import numpy as np

from plant_models.frozen_arrays import Floats, Ints
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import BLOCK_PASSES, PATH_CELLS, RandomPasses, block_of_passes, row_of_passes
from synth.simulation.replicates import REPLICATE_PASSES

AS_THEY_COME = 50
"""Passes of a replicate whose friction is drawn as it comes; the others have low friction."""

LOW_MEAN, LOW_STD = -2.0, 1.5
"""Of the standard normal number of the friction, in the passes of low friction.

So chosen that the variance of the mean square is small for cases of the default book with and without a heavy tail.
"""

PERMUTATIONS = 2
"""Number of the child stream of a block that orders the strata; 0 and 1 are those of path and sensor."""


def stratified_passes(seed: int, first_pass: int, count: int, path_cells: int = PATH_CELLS) -> RandomPasses:
    """Passes `first_pass` … `first_pass + count − 1` of the endless stratified row that `seed` stands for.

    As with `random_passes`, pass i has the same numbers whatever `first_pass`, `count` and `path_cells`. A replicate
    that is cut short is a random part of a whole one.
    """
    return row_of_passes(stratified_block, seed, first_pass, count, path_cells)


def stratified_block(seed: int, block: int, path_cells: int) -> RandomPasses:
    """All passes of one block: its plain numbers, moved into strata."""
    from scipy.special import ndtr, ndtri  # start-up: scipy only where it is needed

    plain = block_of_passes(seed, block, path_cells)
    rng = np.random.Generator(np.random.SFC64(np.random.SeedSequence(seed, spawn_key=(block, PERMUTATIONS))))
    order = np.stack([permutations(rng) for _ in range(4)])
    friction, entry, phase, resistance = order
    u = ndtr(plain.cut_z)
    common = friction < AS_THEY_COME
    low = REPLICATE_PASSES - AS_THEY_COME
    stratum_u = np.where(common, (friction + u) / AS_THEY_COME, (friction - AS_THEY_COME + u) / low)
    normal = ndtri(np.clip(stratum_u, 1e-300, 1.0 - 2.0**-53))
    z = np.where(common, normal, LOW_MEAN + LOW_STD * normal)
    return replace(
        plain,
        cut_z=z,
        entry_u=(entry + plain.entry_u) / REPLICATE_PASSES,
        phase_u=(phase + plain.phase_u) / REPLICATE_PASSES,
        resistance_u=(resistance + plain.resistance_u) / REPLICATE_PASSES,
        weight=weight_of(z),
    )


def weight_of(z: Floats) -> Floats:
    """Density of `z` as cuts come / density of `z` in a replicate."""
    excess = np.exp(0.5 * (z**2 - ((z - LOW_MEAN) / LOW_STD) ** 2)) / LOW_STD
    share = AS_THEY_COME / REPLICATE_PASSES
    return 1.0 / (share + (1.0 - share) * excess)


def permutations(rng: np.random.Generator) -> Ints:
    """The numbers of the strata of a replicate in random order, for each replicate of a block, (1000,)."""
    rows = rng.permuted(np.tile(np.arange(REPLICATE_PASSES), (BLOCK_PASSES // REPLICATE_PASSES, 1)), axis=1)
    return rows.ravel()


Sample = TypeVar("Sample", bound=ExitSample)

CHUNK_PASSES = 2000
"""Passes whose random numbers are in memory at a time, for each thread (4 MB)."""


def many_passes(
    run: Callable[[RandomPasses], Sample], cells: int, seed: int, count: int, first_pass: int = 0, threads: int = 1
) -> Sample:
    """What `run` makes of passes `first_pass` … `first_pass + count − 1` of the stratified row of `seed`.

    `cells`: of the path, behind the entrance. The result does not depend on `threads` nor on how the passes are split.
    """

    def chunk(start: int, stop: int) -> Sample:
        return run(stratified_passes(seed, start, stop - start, cells))

    with ThreadPoolExecutor(max_workers=threads) as pool:
        samples = list(pool.map(chunk, *chunk_bounds(first_pass, count)))
    kind = type(samples[0])
    names = [field.name for field in fields(kind)]
    return kind(**{name: np.concatenate([getattr(sample, name) for sample in samples]) for name in names})


def chunk_bounds(first_pass: int, count: int) -> tuple[list[int], list[int]]:
    """Where the chunks of so many passes begin and end: at multiples of their size, so that no block is drawn twice."""
    end = first_pass + count
    inner = range((first_pass // CHUNK_PASSES + 1) * CHUNK_PASSES, end, CHUNK_PASSES)
    return [first_pass, *inner], [*inner, end]
