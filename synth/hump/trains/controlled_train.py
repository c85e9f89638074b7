"""One humped train under the hump control: a second opinion on who was caught up and misrouted, and its event log."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from math import floor

import numpy as np

from plant_models.errors import require_between
from synth.hump.control.cut_record import CutRecord
from synth.hump.control.event import Event
from synth.hump.control.hump_control import HumpControl, Operation
from synth.hump.control.models import Misroute
from synth.hump.control.practice_rules import PUBLISHED_MODEL, PracticeRules
from synth.hump.control.route_table import RouteTable
from synth.hump.control.sorting_list import SortingList
from synth.hump.trains.hump_routes import HumpRoutes
from synth.hump.trains.humped_track import Disagreement, HumpedTrack
from synth.hump.trains.train_cuts import TrainCuts
from synth.hump.trains.train_memory import TrainMemory
from synth.hump.trains.train_passages import train_passages

TICK_S = 0.02
"""Of the control, where nothing else is said."""

LEAD_IN_S = 5.0
"""The control begins so long before the first axle comes to the first joint: points need time for their first cut."""


@dataclass(frozen=True)
class ControlledTrain:
    """What the control recorded, and where cuts went otherwise than its points lay; times as in the simulation."""

    events: tuple[Event, ...]
    disagreements: tuple[Disagreement, ...]


def own_then_ahead(track: HumpedTrack, misroute: Misroute) -> int:
    """What the simulation has of cuts that the control cannot send where the list says: a cut keeps its own track as
    long as it can reach it; else it goes the way of its leader, or, without one, of the cut that came there before."""
    for number in (misroute.track, misroute.leader_track, track.track_ahead(misroute.element, misroute.cut)):
        if number is not None and number in misroute.reachable:
            return number
    return misroute.reachable[0]


def controlled_train(
    routes: HumpRoutes,
    trains: TrainCuts,
    memory: TrainMemory,
    lane: int,
    tick_s: float = TICK_S,
    rules: PracticeRules = PUBLISHED_MODEL,
) -> ControlledTrain:
    """The control over the train `lane` of `memory`, a tick each `tick_s`, until all its cuts are on their tracks.

    Cuts go where the simulation had them. What the points of the control would have done otherwise stands in the
    disagreements. `PlantError` for ticks of less than a millisecond or more than a second.
    """
    require_between("hump control: tick_s", tick_s, 0.001, 1.0)
    table = RouteTable(routes.graph)
    passages = train_passages(routes, trains, memory, lane)
    track = HumpedTrack(table, passages)
    operation = Operation(partial(own_then_ahead, track), rules)
    control = HumpControl(table, sorting_list_of(routes, trains, memory, lane), track, operation)
    first, last = floor((passages.begins_s - LEAD_IN_S) / tick_s), floor(passages.ends_s / tick_s) + 1
    for tick in range(first, last + 1):
        control.tick(round(tick * tick_s, 6))
    control.finish()
    return ControlledTrain(control.events, tuple(track.disagreements))


def sorting_list_of(routes: HumpRoutes, trains: TrainCuts, memory: TrainMemory, lane: int) -> SortingList:
    """The sorting list of the train `lane`, with the speeds at which it was pushed; serial numbers from 1 on."""
    lead, begins = routes.graph.leads.index(routes.lead), lane * trains.cuts
    members = trains.population.categories.members
    return SortingList(
        tuple(
            CutRecord(
                serial=cut + 1,
                cars=int(trains.cars[row]),
                axles=int(trains.axles[row]),
                mass_t=float(trains.mass_t[row]),
                category=members[trains.category[row]].number,
                track=int(trains.track[row]),
                length_m=float(trains.length_m[row]),
                lead=lead,
                hump_speed_m_s=float(np.round(memory.hump_speed_m_s[lane, cut], 3)),
            )
            for cut, row in enumerate(range(begins, begins + trains.cuts))
        )
    )
