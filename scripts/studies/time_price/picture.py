"""Picture: rms over the mean time in the position, a panel for each case."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from synth.retarder.pictures.pareto_fronts import pareto_fronts

if TYPE_CHECKING:
    from scripts.studies.time_price.study import TimePrice


def figures(found: TimePrice) -> Mapping[str, Figure]:
    """`fronts`, as a tune draws them."""
    return {"fronts": pareto_fronts(found.fronts)}
