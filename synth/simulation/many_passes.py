"""Stratified passes of any closed loop, many of them in bounded memory."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import fields
from typing import TypeVar

import numpy as np

from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses
from synth.simulation.stratified_passes import stratified_passes

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
