"""The interval of a median from the order of a sample, whatever its law."""

from __future__ import annotations

from collections.abc import Sequence
from math import comb

from synth.simulation.replicates import UPPER_TAIL, Interval


def median_interval(values: Sequence[float]) -> Interval | None:
    """95 % interval of the median of the law that `values` are drawn from; None for fewer than 6, which tell none.

    From the k-th least to the k-th greatest, k the greatest number for which at most 2.5 % of all samples have fewer
    than k values below the median: these follow the binomial law with probability 1/2 (David and Nagaraja, *Order
    Statistics*, chapter 7).
    """
    count, below = len(values), 0
    k = 0
    while below + comb(count, k) <= UPPER_TAIL * 2**count:
        below += comb(count, k)
        k += 1
    ordered = sorted(values)
    return (ordered[k - 1], ordered[-k]) if k else None
