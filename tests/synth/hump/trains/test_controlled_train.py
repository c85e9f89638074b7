"""Catch-ups and misroutes of humped trains, as the simulation has them and as the hump control recorded them: a second
opinion from the same times.

By hand: `python -m tests.synth.hump.trains.test_controlled_train 300 0.02` compares 300 trains of each hump with
ticks of 0.02 s.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass, field, replace
from functools import cache
from typing import NamedTuple

import numpy as np
import pytest

from plant_models.errors import PlantError
from plant_models.hump import Retarder, Switch
from synth.hump.control.cut_routes import RouteTable
from synth.hump.control.events import Kind, Why, replayed
from synth.hump.control.models import PracticeRules
from synth.hump.rolling.hump_routes import HumpRoutes, Mark
from synth.hump.rolling.train_cuts import TrainCuts
from synth.hump.rolling.train_memory import TrainMemory
from synth.hump.trains.traced_train import TICK_S, ControlledTrain, controlled_train
from synth.hump.trains.train_passages import train_passages
from synth.hump.trains.train_trace import user_ahead
from synth.hump.trial.trial import HumpTrial
from tests.effort import every
from tests.synth.hump.trains.humped_trains import humped_trains
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


TRAINS = 30


@pytest.mark.parametrize("hump", every(3, SPEEDS_M_S))
def test_control_and_simulation_agree_on_each_catch_up_and_each_misroute(hump: str) -> None:
    found = compared(hump, TRAINS, TICK_S)
    assert found.beyond == []
    assert found.met > 0
    assert found.sent > 0
    assert found.near <= 0.1 * (found.met + found.sent)


@cache
def fast_train() -> tuple[HumpRoutes, TrainCuts, TrainMemory]:
    """Trains whose cuts are pushed so fast that some are misrouted."""
    found = humped_trains(2.8)
    return found.hump.routes, found.trains, found.memory


@cache
def controlled(lane: int) -> ControlledTrain:
    return controlled_train(*fast_train(), lane)


def test_the_log_leads_to_the_tracks_where_the_simulation_has_the_cuts() -> None:
    routes, trains, memory = fast_train()
    for lane in range(4):
        control = controlled(lane)
        state, passages = replayed(control.events), train_passages(routes, trains, memory, lane)
        came = {
            cut: [track]
            for cut, (track, way) in enumerate(zip(passages.tracks, passages.ways, strict=True), start=1)
            if way[-1].element in RouteTable(routes.graph).home
        }
        assert state.arrived == came
        assert len(state.misrouted) > 0


def test_the_counters_see_all_axles_and_each_catch_up() -> None:
    """Axle counters tell catch-ups by exact times, on plain sections too: the second way to the same cuts.

    Where a cut stops on a joint, a counter takes the axles of the next one for its own; such sections are left out.
    """
    routes, _, memory = fast_train()
    counted = {v.number for v in routes.graph.vertices if getattr(v, "axle_counters", False)}
    for lane in range(4):
        number = np.array(routes.numbers)[routes.vertex[memory.route[lane]]]
        came = np.isfinite(memory.time_s[lane])
        stopped = set(number[came[:, :, Mark.FIRST_IN] & ~came[:, :, Mark.LAST_IN]].tolist())
        told = {(e.element, e.cut) for e in controlled(lane).events if e.kind is Kind.CATCH_UP}
        met = {
            (int(number[cut, at]), int(cut) + 1) for cut, at in zip(*np.nonzero(memory.unseparated[lane]), strict=True)
        }
        assert {each for each in told if each[0] not in stopped} == {
            each for each in met if each[0] in counted - stopped
        }
        assert len(stopped) <= 2
        assert not [e for e in controlled(lane).events if e.kind is Kind.COUNTER_FAULT]


def test_a_simulation_that_takes_points_for_quicker_is_found_out() -> None:
    """Where points are thrown a second later than the simulation has it, the control misroutes others."""
    trial = Day(cuts=12, constant_m_s=SPEEDS_M_S["dumper"]).on("dumper")
    quick = replace(trial, routes=replace(trial.routes, throw_s=np.maximum(trial.routes.throw_s - 1.0, 0.0)))
    trains, _, memory = quick.humped(0, 10)
    tally = Tally()
    for lane in range(10):
        control = controlled_train(trial.routes, trains, memory, lane)
        compare(tally, lane, simulated(trial, trains, memory, lane), control, TICK_S)
    assert tally.beyond


def test_finer_ticks_tell_the_same_but_for_cases_near_a_limit() -> None:
    routes, trains, memory = fast_train()
    coarse, fine = (recorded(controlled_train(routes, trains, memory, 0, tick)) for tick in (0.05, 0.01))
    assert fine[1] <= coarse[1]
    assert fine[0] <= coarse[0]


def test_rules_of_practice_may_be_tried_on_the_same_train() -> None:
    routes, trains, memory = fast_train()
    rules = PracticeRules(usual_base_m=30.0)
    strict = controlled_train(routes, trains, memory, 0, rules=rules)
    assert recorded(controlled(0))[0] <= recorded(strict)[0]


def test_a_tick_that_is_none_is_refused() -> None:
    with pytest.raises(PlantError, match="tick_s"):
        controlled_train(*fast_train(), 0, tick_s=0.0)


if __name__ == "__main__":
    for name in SPEEDS_M_S:
        print(name, compared(name, int(sys.argv[1]), float(sys.argv[2])))
