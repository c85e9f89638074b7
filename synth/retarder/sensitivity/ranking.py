"""The answer in a sentence: what to measure first."""

from __future__ import annotations

from collections.abc import Sequence

from synth.retarder.sensitivity.sensitivity import OutputShares
from synth.retarder.sensitivity.shares import Share

UNDECIDABLE = "not decidable with these passes"
MOST_NAMED = 3


def ranked(keys: Sequence[str], found: OutputShares) -> tuple[tuple[str, Share], ...]:
    """(key, share), the largest share first; equal ones in the order of the keys."""
    return tuple(sorted(zip(keys, found.shares, strict=True), key=lambda pair: -pair[1].value))


def measure_first(names: Sequence[str], found: OutputShares) -> str:
    """'measure first, for the rms exit error: … (24 % [20, 28] of its variance), …': at most three decided ones."""
    title = found.output.title
    if not found.varies:
        return f"the {title} is the same at every point, so nothing has to be measured for it"
    best = [(name, share) for name, share in ranked(names, found) if share.decided][:MOST_NAMED]
    if not best:
        return f"measure first, for the {title}: {UNDECIDABLE}; take more points"
    return f"measure first, for the {title}: " + "; ".join(f"{name}, {percent(share)}" for name, share in best)


def percent(share: Share) -> str:
    """'24 % [20, 28]'."""
    low, high = share.ci95
    return f"{100.0 * share.value:.0f} % [{100.0 * low:.0f}, {100.0 * high:.0f}]"
