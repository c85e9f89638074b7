"""The study of the hump's day: its arithmetic against closed forms, its changes against what they are to change."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from plant_models.hump import Switch
from plant_models.library.catalogue import load_weight_categories
from scripts.studies.aiming.trial import Value
from scripts.studies.documents import result_of
from scripts.studies.humping.base_trial import (
    FEEDBACK,
    OPEN,
    Day,
    UnknownWind,
    braked_by,
    with_known_resistance,
    with_planner,
    with_stds,
)
from scripts.studies.humping.pairs import on_graph, on_section, thrown_in, with_king_switch, with_switches
from scripts.studies.humping.runs import Group, measured
from scripts.studies.humping.study import HumpDay
from scripts.studies.humping.table_positions import FRICTION, SUPPLY, TablePositions
from synth.hump.rolling.hump_routes import Mark
from synth.hump.rolling.outcomes import TrainOutcomes
from synth.hump.rolling.table_hump_position import ClassChoice, TableHumpPosition
from synth.hump.trial.trial import HumpTrial
from tests.synth.hump.trains.coarse_book import coarse_classes, coming

ROOT = Path(__file__).parents[2]
TRAINS = 4


@pytest.fixture(scope="module")
def trial() -> HumpTrial:
    return Day(seed=3, cuts=8, design_cuts=200).trial()


@pytest.mark.long
def test_trials_of_a_group_come_to_what_each_comes_to_alone(trial: HumpTrial) -> None:
    worse = with_stds(trial, (0.35, 0.35, 0.35))
    group = Group({"open": replace(trial, control=OPEN), "feedback": replace(worse, control=FEEDBACK)})
    found = measured([group], TRAINS, 2, lambda _: None)
    for name, each in group.trials.items():
        same(found[name], each.batch(0, TRAINS))
    with pytest.raises(AssertionError, match="share their program"):
        Group({"one": trial, "other": with_planner(trial, least_s=2.0)})


def same(one: TrainOutcomes, other: TrainOutcomes) -> None:
    for name, values in vars(one).items():
        np.testing.assert_array_equal(values, getattr(other, name), name)


def test_a_program_that_knows_all_foretells_every_time_of_ideal_positions(trial: HumpTrial) -> None:
    """Left out are cuts that meet others."""
    ideal = replace(with_stds(trial, (0.0, 0.0, 0.0)), control=OPEN)

    def missed(each: HumpTrial) -> float:
        _, plan, memory = each.humped(0, TRAINS)
        routes = each.routes
        told = (memory.misrouted_at == routes.elements) & (memory.contact_at == routes.elements)
        assert told.mean() > 0.9
        ahead = np.arange(routes.elements) <= routes.retarder[memory.route][:, :, -1:]
        apart = np.abs(memory.time_s[:, :, :, Mark.FIRST_IN] - plan.first_in_s)
        return float(apart[ahead & told[:, :, None]].max())

    assert missed(with_known_resistance(ideal)) < 0.002
    assert missed(ideal) > 0.5


def test_a_worst_pair_is_no_other_than_the_mean_where_all_is_known(trial: HumpTrial) -> None:
    known = with_known_resistance(trial)
    plans = [each.humped(0, TRAINS)[1] for each in (known, with_planner(known, worst_pair=True))]
    np.testing.assert_allclose(plans[0].hump_speed_m_s, plans[1].hump_speed_m_s)


def test_a_brake_that_is_gone_lets_cuts_leave_as_if_it_were_not_there(trial: HumpTrial) -> None:
    _, _, memory = braked_by(trial, 0.0, 1).humped(0, TRAINS)
    rolling = np.isfinite(memory.exit_m_s[:, :, 1])
    faster = memory.exit_m_s[:, :, 1][rolling] > memory.command_m_s[:, :, 1][rolling] + 0.5
    assert faster.mean() > 0.5
    assert (memory.exit_m_s[:, :, 1][rolling] > 0.95 * memory.entry_m_s[:, :, 1][rolling]).all()
    usual = trial.humped(0, TRAINS)[2]
    np.testing.assert_array_equal(memory.entry_m_s[:, :, 0], usual.entry_m_s[:, :, 0])


def test_a_wind_that_nobody_knows_blows_and_is_not_planned_for(trial: HumpTrial) -> None:
    windy = replace(trial, source=UnknownWind(**vars(trial.source), more_m_s=6.0))
    trains, plan, memory = windy.humped(0, TRAINS)
    calm, calm_plan, calm_memory = trial.humped(0, TRAINS)
    np.testing.assert_allclose(trains.drawn.head_wind_m_s - calm.drawn.head_wind_m_s, 6.0)
    np.testing.assert_array_equal(plan.hump_speed_m_s, calm_plan.hump_speed_m_s)
    assert np.nanmean(memory.entry_m_s[:, :, 0]) < np.nanmean(calm_memory.entry_m_s[:, :, 0]) - 0.01


def test_switches_are_changed_alone_and_the_king_switch_keeps_its_fall(trial: HumpTrial) -> None:
    graph, lead = trial.routes.graph, trial.routes.lead
    for change, read, expected in (
        (thrown_in(1.0), "throw_s", 1.0),
        (on_section(15.0), "exit_joint_m", 15.0 - graph.switches[0].entry_joint_m),
    ):
        changed = with_switches(graph, change)
        assert {getattr(s, read) for s in changed.switches} == {expected}
        assert [v for v in changed.vertices if not isinstance(v, Switch)] == [
            v for v in graph.vertices if not isinstance(v, Switch)
        ]

    def king(routes_of: HumpTrial) -> tuple[float, float]:
        route = routes_of.routes.routes[0]
        at = next(e.at_m for e in route.elements if isinstance(e.vertex, Switch))
        edge = route.elements[0].vertex.edges[0]
        ends = [*[begin for begin, _ in edge.grades[1:]], edge.length_m]
        fall = sum((end - begin) * grade for end, (begin, grade) in zip(ends, edge.grades, strict=True))
        return at, fall

    moved = on_graph(trial, with_king_switch(graph, lead, 50.0))
    assert king(trial)[0] == 42.0
    assert king(moved) == pytest.approx((50.0, king(trial)[1]))
    behind = moved.routes.length_m - trial.routes.length_m
    np.testing.assert_allclose(behind, 8.0)


@pytest.mark.long
def test_tables_on_a_weaker_plant_brake_less_and_stay_the_same_tables() -> None:
    """A brake of less friction takes the same share less work, at all stages; the energy it takes tells."""
    classes = coarse_classes()
    made = TablePositions((classes,), load_weight_categories())
    entry = np.full(200, 4.0)
    cuts = coming(classes[0], entry, np.full(200, 1.5), np.full(200, 1.5))

    def left(positions: TablePositions) -> float:
        position = TableHumpPosition(ClassChoice(positions.classes[0], positions.categories))
        return float(position.passed(cuts).exit_m_s.mean())

    weaker = made.changed({FRICTION: 0.15})
    assert [c.controllers for c in weaker.classes[0]] == [c.controllers for c in classes]
    full = left(made)
    assert full == pytest.approx(1.5, abs=0.15)
    free = float(cuts.unbraked_exit_m_s.mean())
    for values in ({FRICTION: 0.15}, {SUPPLY: 0.3}):
        assert full + 0.5 < left(made.changed(values)) < free
    assert left(made.changed({FRICTION: 1.0})) == full


def test_the_kept_result_holds_its_claims_and_tells_where_one_fails() -> None:
    kept = result_of(ROOT, "hump-day").findings
    assert isinstance(kept, HumpDay)
    assert kept.faults() == ()
    first = kept.programs[0]
    worse = replace(kept, programs=(replace(first, fewer=Value(-0.01, (-0.012, -0.008))), *kept.programs[1:]))
    assert worse.faults() == (
        f"{first.name}: feedback has 1.00 ± 0.20 percentage points more catch-ups than open loop",
    )
    (cells,) = worse.tables()["feedback"].rows
    assert cells[3:] == ("1", first.name)
    assert sum(map(int, cells[1:4])) == int(cells[0])
