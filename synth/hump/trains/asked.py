"""What a control of a humped train is asked, and what it answers."""

from __future__ import annotations

from typing import Protocol

from plant_models.frozen_arrays import Bools, Floats, Ints, frozen_arrays
from synth.hump.trains.motion import Moving
from synth.hump.trains.train_memory import TrainMemory


@frozen_arrays
class Asked:
    """A control is asked for the exit speeds of cut number `cut` of the trains `lanes` (n,) in `position`.

    `routes` (n,): the rows on which they roll. `start`: the cuts when their first axles are at the entrance. `free_m`
    (n,): where the standing cars begin, or will begin if the cut that still rolls there couples. `memory`: what
    happened so far. It tells later times, too; a control may only look at what is over when it is asked.
    """

    cut: int
    position: int
    lanes: Ints
    routes: Ints
    start: Moving
    free_m: Floats
    memory: TrainMemory

    def chosen(self, which: Bools) -> Asked:
        """Some of the cuts."""
        lanes, routes, start = self.lanes[which], self.routes[which], self.start.chosen(which)
        return Asked(self.cut, self.position, lanes, routes, start, self.free_m[which], self.memory)


class ExitSpeeds(Protocol):
    """Commands the exit speeds of the positions."""

    def command(self, asked: Asked) -> Floats:
        """Exit speeds (n,), m/s."""


class HumpSpeeds(Protocol):
    """Chooses the speeds at which the trains are pushed over the crest."""

    def speed(self, cut: int, memory: TrainMemory) -> Floats:
        """Speed of the trains (trains,) when the middle of cut number `cut` is at the crest, m/s."""
