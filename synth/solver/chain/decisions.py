"""The nodes of the path at which a regulator decides, and how far a command may go."""

from __future__ import annotations

import numpy as np

from plant_models.frozen_arrays import Floats, Ints, frozen_arrays


@frozen_arrays
class Decisions:
    """R decisions on a path of N quanta, in the order of the path.

    `node` (R,): path node of each, rising; `place_m` (R,): its path from where the regulator acts; `lead_m` (R,): path
    from there to where the command leaves. `farthest`: by how many stages a command may go; `swept`: by how many those
    go whose gains a sweep compares. Commands are numbered: 2·d − 2 goes down, 2·d − 1 up by d stages.
    """

    node: Ints
    place_m: Floats
    lead_m: Floats
    farthest: int
    swept: int

    @property
    def commands(self) -> int:
        """How many commands there are, C."""
        return 2 * self.farthest

    def __len__(self) -> int:
        return len(self.node)

    def at_nodes(self, nodes: int) -> Ints:
        """Number of the decision at each of the first `nodes` path nodes, R where there is none."""
        numbers = np.full(nodes, len(self.node))
        numbers[self.node] = np.arange(len(self.node))
        return numbers

    def behind(self, node: int) -> Decisions:
        """Those at path node `node` and behind it, whose nodes are counted from there."""
        kept = self.node >= node
        return Decisions(self.node[kept] - node, self.place_m[kept], self.lead_m[kept], self.farthest, self.swept)


def steps_of(command: int) -> int:
    """By how many stages a command changes the stage: down negative."""
    return (command // 2 + 1) * (2 * (command % 2) - 1)
