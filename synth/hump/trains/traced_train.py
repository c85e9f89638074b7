"""One train of a trial, to look at: which of many are worth it, the one in which most went wrong, a typical one, the
first; its trace, and its event log under the hump control, a second opinion on who was caught up and misrouted.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from math import floor
from typing import Final

import numpy as np

from plant_models.errors import require_between
from synth.hump.control.cut_record import CutRecord, SortingList
from synth.hump.control.cut_routes import RouteTable
from synth.hump.control.events import Event
from synth.hump.control.hump_control import HumpControl, Operation
from synth.hump.control.models import PUBLISHED_MODEL, Misroute, PracticeRules
from synth.hump.planning.train_plan import TrainPlan
from synth.hump.rolling.hump_routes import HumpRoutes
from synth.hump.rolling.outcomes import TrainOutcomes
from synth.hump.rolling.train_cuts import TrainCuts
from synth.hump.rolling.train_memory import TrainMemory
from synth.hump.trains.humped_track import Disagreement, HumpedTrack
from synth.hump.trains.train_passages import train_passages
from synth.hump.trains.train_trace import TrainTrace, train_trace
from synth.hump.trial.trial import HumpTrial

TYPICAL_AMONG: Final = 20
"""A typical train is one of so many, which are humped again together with the first one in no more time than it."""


@dataclass(frozen=True)
class ChosenTrain:
    """The train `number`, from 0, and why it is shown."""

    number: int
    why: str

    @property
    def title(self) -> str:
        """What a menu calls it."""
        return f"train {self.number + 1}: {self.why}"


def chosen_trains(found: TrainOutcomes) -> tuple[ChosenTrain, ...]:
    """The worst train first, then a typical one and the first one; each train once.

    Worst: most catch-ups; of these most contacts in a last position and stops, then most over-speeds, then the first.
    Typical, of the first few: the median of catch-ups and, of such trains, the one of the usual pace.
    """
    gone_wrong = found.caught_in_last + found.stopped
    order = np.lexsort((found.train, -found.overspeed.sum(axis=1), -gone_wrong, -found.caught))
    worst = int(order[0])
    usual = np.abs(found.caught - np.sort(found.caught)[len(found) // 2])
    pace = found.span_s / np.maximum(found.span_cars, 1.0)
    few = slice(0, TYPICAL_AMONG)
    typical = int(np.lexsort((found.train[few], np.abs(pace - np.median(pace))[few], usual[few]))[0])
    caught = int(found.caught[worst])
    why = f"most catch-ups, {caught}" if caught else "none caught up; most other alarms"
    chosen = (
        ChosenTrain(int(found.train[worst]), why),
        ChosenTrain(int(found.train[typical]), "typical"),
        ChosenTrain(int(found.train[0]), "the first"),
    )
    return tuple({each.number: each for each in reversed(chosen)}.values())[::-1]


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


@dataclass(frozen=True)
class OneTrain:
    """The train `lane` of `trains` that `trial` humped by `plan`: what happened to it."""

    trial: HumpTrial
    trains: TrainCuts
    plan: TrainPlan
    memory: TrainMemory
    lane: int = 0

    @property
    def number(self) -> int:
        """From 0, as figures count trains."""
        return int(self.trains.numbers[self.lane])

    def traced(self) -> TrainTrace:
        """Its cuts on their ways."""
        hump = self.trial.hump_for(self.trial.rolls_of(self.trains))
        return train_trace(hump, self.trains, self.memory, self.lane, self.trial.couplings.allowed_m_s)

    def outcomes(self) -> TrainOutcomes:
        """What it and those that were humped with it came to, it in the row `lane`."""
        return self.trial.outcomes(self.trains, self.memory)

    def controlled(self) -> ControlledTrain:
        """What the hump control records of it."""
        return controlled_train(self.trial.routes, self.trains, self.memory, self.lane)

    def standing(self) -> int:
        """How many of its cuts come to no element: they stand between the crest and the first one."""
        return sum(not way for way in train_passages(self.trial.routes, self.trains, self.memory, self.lane).ways)


def one_train(trial: HumpTrial, number: int) -> OneTrain:
    """The train `number`, from 0, of `trial`: the same as in every batch."""
    turn = trial.turn(*trial.train(number))
    return OneTrain(trial, turn.trains, turn.plan, turn.memory)


def some_trains(trial: HumpTrial, numbers: Sequence[int]) -> tuple[OneTrain, ...]:
    """The trains `numbers`, from 0; where each has tracks of its own, those among the first few are humped together,
    which takes no longer than one."""
    most = TYPICAL_AMONG if trial.tracks.shift_trains == 1 else 0
    early = [number for number in numbers if number < most]
    together = trial.humped(0, max(early) + 1) if early else None
    return tuple(
        OneTrain(trial, *together, lane=number) if together and number < most else one_train(trial, number)
        for number in numbers
    )
