"""What is done with cuts that cannot go where the list says ([kozachenko-control], [hump-computer-1970s])."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from synth.hump.control.models import Misroute

ResortingCost = Callable[[int, int], float]
"""From the track where a cut stands and the track where it belongs to what it costs to bring it there."""


def leader_track(misroute: Misroute) -> int:
    """The follower goes to the track of its leader: what the published model does unless told otherwise.

    Without a leader, or where its track cannot be reached, the cut keeps its own track, or goes to the first that can
    be reached.
    """
    for track in (misroute.leader_track, misroute.track):
        if track is not None and track in misroute.reachable:
            return track
    return misroute.reachable[0]


@dataclass(frozen=True)
class RejectionOrCheapest:
    """To a rejection track, the first of `rejection` that can be reached; else to the track from which the cut is
    brought to its own at least cost, of equal ones the one with the smaller number."""

    rejection: tuple[int, ...]
    cost: ResortingCost

    def __call__(self, misroute: Misroute) -> int:
        """A rejection track or the cheapest."""
        for track in self.rejection:
            if track in misroute.reachable:
                return track
        return min(misroute.reachable, key=lambda track: (self.cost(track, misroute.track), track))
