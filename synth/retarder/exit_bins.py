"""How simulated exit speeds are set beside the predicted density, in pictures and in what is said under them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from synth.retarder.tuned_case import TunedCase

NARROW_M_S: Final = 0.01
"""Width of the bins of simulated passes near the target, within `OVERSPEED_M_S` of it."""

WIDE_M_S: Final = 0.1
"""The same beyond."""

EXACT: Final = "predicted by the forward equation"


def prediction_origin(cases: Sequence[TunedCase]) -> str:
    """What the predicted densities come from, in a legend or a caption."""
    estimated = [case.table.predicted.passes is not None for case in cases]
    if all(estimated):
        return "predicted from other simulated passes"
    return f"{EXACT}; with an estimator from other simulated passes" if any(estimated) else EXACT
