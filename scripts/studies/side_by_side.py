"""Work on several cases at a time, in threads: kernels hold no lock."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

_T = TypeVar("_T")
_R = TypeVar("_R")

THREADS = 2
"""Times of the documentation are of two cores. No figure depends on it."""


def side_by_side(work: Callable[[_T], _R], orders: Iterable[_T], threads: int = THREADS) -> tuple[_R, ...]:
    """`work` of each of `orders`, in their order."""
    with ThreadPoolExecutor(max_workers=threads) as pool:
        return tuple(pool.map(work, orders))
