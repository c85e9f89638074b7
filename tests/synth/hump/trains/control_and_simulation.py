"""Catch-ups and misroutes of humped trains, as the simulation has them and as the hump control recorded them.

By hand: `python -m tests.synth.hump.trains.control_and_simulation 300 0.02` compares 300 trains of each hump with
ticks of 0.02 s.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from plant_models.hump import Retarder, Switch
from synth.hump.control.event import Kind, Why
from synth.hump.trains.controlled_train import ControlledTrain, controlled_train
from synth.hump.trains.hump_routes import Mark
from synth.hump.trains.train_cuts import TrainCuts
from synth.hump.trains.train_memory import TrainMemory
from synth.hump.trains.train_trace import user_ahead
from synth.hump.trains.trial import HumpTrial
from tests.synth.hump.trains.made_trials import Day

CUTS = 12
SPEEDS_M_S = {"large": 2.5, "medium": 2.5, "dumper": 2.0}
"""Of the humps of the library: hump speeds at which cuts are caught up and misrouted."""


class Found(NamedTuple):
    """`cut` came on `element` while `leader` was on it, or was misrouted there (`leader` 0): serial numbers."""

    element: int
    cut: int
    leader: int = 0


@dataclass
class Simulated:
    """What the simulation tells of one train. By (element, cut): `margins_s`, how long after the limits the first axle
    came in: after the cut ahead went out, and after the points could have been thrown."""

    met: set[Found] = field(default_factory=set)
    sent: set[Found] = field(default_factory=set)
    margins_s: dict[tuple[int, int], tuple[float, float]] = field(default_factory=dict)


@dataclass
class Tally:
    """What was compared: `met` and `sent` of the simulation. Those that one of both alone has, and cuts for which the
    points of the control lay otherwise than they went: `near`, of cuts within a tick of a limit, `beyond`, all others.
    """

    trains: int = 0
    met: int = 0
    sent: int = 0
    near: int = 0
    beyond: list[tuple[int, Found]] = field(default_factory=list)


def simulated(trial: HumpTrial, trains: TrainCuts, memory: TrainMemory, lane: int) -> Simulated:
    """Catch-ups on switches and retarders, and misroutes where the ways part; of cuts that came there."""
    routes, found = trial.routes, Simulated()
    for cut, column in zip(*np.nonzero(np.isfinite(memory.time_s[lane, :, :, Mark.FIRST_IN])), strict=True):
        row, wanted = memory.route[lane, cut], trains.route[lane * trains.cuts + cut]
        number = routes.numbers[routes.vertex[row, column]]
        first = memory.time_s[lane, cut, column, Mark.FIRST_IN]
        ahead = user_ahead(routes, memory, lane, cut, column)
        if ahead is None or not isinstance(routes.graph.by_number[number], Switch | Retarder):
            continue
        after = first - memory.time_s[lane, ahead, column, Mark.LAST_OUT]
        found.margins_s[number, cut + 1] = after, after - routes.throw_s[row, column]
        if memory.unseparated[lane, cut, column]:
            found.met.add(Found(number, int(cut) + 1, ahead + 1))
        if row != wanted and column == routes.shared(np.array([row]), np.array([wanted]))[0] - 1:
            found.sent.add(Found(number, int(cut) + 1))
    return found


def recorded(control: ControlledTrain) -> tuple[set[Found], set[Found]]:
    """Catch-ups and misroutes in the log; cuts that stand before their tracks are none."""
    met = {Found(e.element, e.cut, int(e.value)) for e in control.events if e.kind is Kind.NOT_SEPARATED}
    sent = {(e.element, e.cut) for e in control.events if e.kind is Kind.MISROUTED and e.value != Why.NOT_SEEN}
    return met, {Found(*each) for each in sent}


def compare(tally: Tally, train: int, truth: Simulated, control: ControlledTrain, tick_s: float) -> None:
    """Add one train."""
    met, sent = recorded(control)
    tally.trains, tally.met, tally.sent = tally.trains + 1, tally.met + len(truth.met), tally.sent + len(truth.sent)

    def is_near(element: int, cut: int) -> bool:
        return any(abs(margin) <= tick_s for margin in truth.margins_s.get((element, cut), ()))

    otherwise = {Found(d.switch, d.cut) for d in control.disagreements}
    for each in (met ^ truth.met) | (sent ^ truth.sent) | otherwise:
        if is_near(each.element, each.cut):
            tally.near += 1
        else:
            tally.beyond.append((train, each))


def compared(hump: str, number: int, tick_s: float) -> Tally:
    """`number` trains of `CUTS` cuts over a hump of the library, with ticks of `tick_s`."""
    trial = Day(cuts=CUTS, constant_m_s=SPEEDS_M_S[hump]).on(hump)
    trains, _, memory = trial.humped(0, number)
    tally = Tally()
    for lane in range(number):
        control = controlled_train(trial.routes, trains, memory, lane, tick_s)
        compare(tally, lane, simulated(trial, trains, memory, lane), control, tick_s)
    return tally


if __name__ == "__main__":
    for name in SPEEDS_M_S:
        print(name, compared(name, int(sys.argv[1]), float(sys.argv[2])))
