"""What is done with cuts that cannot go where the list says ([kozachenko-control], [hump-computer-1970s])."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from plant_models.errors import require
from synth.yard.hump.models import Misroute
from synth.yard.hump.route_table import RouteTable

ResortingCost = Callable[[int, int], float]
"""From the track where a cut stands and the track where it belongs to what it costs to bring it there."""


@dataclass(frozen=True)
class LeaderTrack:
    """The follower goes to the track of its leader: what the published model does unless told otherwise.

    Without a leader, or where its track cannot be reached, the cut keeps its own track, or goes to the first that can
    be reached.
    """

    def track_for(self, misroute: Misroute) -> int:
        """The track of the leader."""
        for track in (misroute.leader_track, misroute.track):
            if track is not None and track in misroute.reachable:
                return track
        return misroute.reachable[0]


@dataclass(frozen=True)
class OwnTrack:
    """The cut keeps its own track as long as it can reach it; otherwise `otherwise` decides."""

    otherwise: RejectionOrCheapest | LeaderTrack

    def track_for(self, misroute: Misroute) -> int:
        """Its own track, or another's word."""
        if misroute.track in misroute.reachable:
            return misroute.track
        return self.otherwise.track_for(misroute)


@dataclass(frozen=True)
class RejectionOrCheapest:
    """To a rejection track, the first of `rejection` that can be reached; else to the track from which the cut is
    brought to its own at least cost, of equal ones the one with the smaller number."""

    rejection: tuple[int, ...]
    cost: ResortingCost

    def track_for(self, misroute: Misroute) -> int:
        """A rejection track or the cheapest."""
        for track in self.rejection:
            if track in misroute.reachable:
                return track
        return min(misroute.reachable, key=lambda track: (self.cost(track, misroute.track), track))


@dataclass(frozen=True)
class ShuntedMetres:
    """Cost of re-sorting: metres that a shunting engine drives with the cut from one track to another and back empty.

    With the cut it draws back from the begin of the track to the last switch that both routes share, and pushes to the
    begin of the other track; empty it goes the same way back. Cars that came behind the cut are not counted: nobody
    knows them when the cut is sent.
    """

    table: RouteTable

    def __call__(self, track: int, belongs: int) -> float:
        """Metres; 0 for the same track, `PlantError` where no lead reaches both."""
        if track == belongs:
            return 0.0
        for lead in self.table.graph.leads:
            routes = self.table.graph.routes(lead)
            if track in routes and belongs in routes:
                here, there = routes[track], routes[belongs]
                shared = [e for e, f in zip(here.elements, there.elements, strict=False) if e.number == f.number]
                begins = here.elements[-1].at_m + there.elements[-1].at_m
                return 2.0 * (begins - 2.0 * shared[-1].at_m)
        require(False, f"no lead reaches both track {track} and track {belongs}")
        return 0.0
