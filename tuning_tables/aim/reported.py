"""What cuts did that were sent off with the exit speeds of an aim table, at each of its nodes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Final

import numpy as np

from tuning_tables.aim.nodes import NodeNumbers, Nodes, nodes_of, require_all
from tuning_tables.declared.numbers import Count
from tuning_tables.requirement import require_count

FIGURES: Final = ("p_overspeed", "p_overspeed_low95", "p_overspeed_high95", "mean_gap_m")
"""What is told of every node."""


@dataclass(frozen=True, eq=False)
class Reported:
    """Figures of simulated cuts at the nodes, of other draws than those that the exit speeds were chosen on.

    The share lies within its interval. All figures have the shape of the axes, and NaN at the same nodes: where there
    is no exit speed, and where too few of the passes came to a node to tell. Read-only copies. Raises `InvalidTable`.

    Examples
    --------
    >>> from tuning_tables.aim import Reported
    >>> figures = Reported(
    ...     2000,
    ...     p_overspeed=[[0.08]],
    ...     p_overspeed_low95=[[0.07]],
    ...     p_overspeed_high95=[[0.09]],
    ...     mean_gap_m=[[12.5]],
    ... )
    >>> figures.p_overspeed.shape
    (1, 1)
    """

    passes: Annotated[int, Count("simulated cuts at each node", 1)]
    p_overspeed: Annotated[Nodes, NodeNumbers("share that coupled faster than required", 0.0, 1.0)]
    p_overspeed_low95: Annotated[Nodes, NodeNumbers("lower end of its 95 % interval", 0.0, 1.0)]
    p_overspeed_high95: Annotated[Nodes, NodeNumbers("upper end of its 95 % interval", 0.0, 1.0)]
    mean_gap_m: Annotated[
        Nodes, NodeNumbers("mean of what stayed free before the standing cars; 0 for a cut that coupled", 0.0)
    ]

    def __post_init__(self) -> None:
        require_count(self.passes, "reported.passes", 1)
        shape = np.shape(self.p_overspeed)
        for name in FIGURES:
            nodes = nodes_of(getattr(self, name), f"reported.{name}", shape)
            nodes.setflags(write=False)
            object.__setattr__(self, name, nodes)
        low, p, high = self.p_overspeed_low95, self.p_overspeed, self.p_overspeed_high95
        key, null = "reported.p_overspeed", np.isnan(p)
        for nodes, name in ((low, "p_overspeed_low95"), (high, "p_overspeed_high95"), (self.mean_gap_m, "mean_gap_m")):
            require_all(np.isnan(nodes) == null, nodes, f"reported.{name}", f"null exactly where {key} is")
        require_all(null | ((low >= 0.0) & (high <= 1.0)), p, key, "a share, its interval within [0, 1]")
        require_all(null | ((low <= p) & (p <= high)), p, key, "within its interval")
        require_all(null | (self.mean_gap_m >= 0.0), self.mean_gap_m, "reported.mean_gap_m", "0 m or more")

    def require_nodes(self, speeds: Nodes) -> None:
        """They have the shape of `speeds`, and no figure where that has no number."""
        key = "reported.p_overspeed"
        nodes = nodes_of(self.p_overspeed, key, speeds.shape)
        require_all(np.isnan(nodes) | ~np.isnan(speeds), nodes, key, "null where there is no exit speed")
