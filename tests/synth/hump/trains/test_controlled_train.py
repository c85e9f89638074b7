"""The hump control over humped trains: a second opinion on who is caught up and misrouted, from the same times."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from plant_models.errors import PlantError
from synth.hump.control.event import Kind
from synth.hump.control.hump_state import replayed
from synth.hump.control.practice_rules import PracticeRules
from synth.hump.control.route_table import RouteTable
from synth.hump.trains.controlled_train import TICK_S, ControlledTrain, controlled_train
from synth.hump.trains.hump_routes import HumpRoutes, Mark
from synth.hump.trains.train_cuts import TrainCuts
from synth.hump.trains.train_memory import TrainMemory
from synth.hump.trains.train_passages import train_passages
from tests.effort import every
from tests.synth.hump.trains.control_and_simulation import SPEEDS_M_S, Tally, compare, compared, recorded, simulated
from tests.synth.hump.trains.humped_trains import humped_trains
from tests.synth.hump.trains.made_trials import Day

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
