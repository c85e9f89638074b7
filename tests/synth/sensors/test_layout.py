"""Layouts of point sensors: the rule, exhaustive search, and that a plan is never worse than equal sections."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable

import numpy as np
import pytest

from plant_models import Plant, PointSensors
from synth.frame.exhibits import File, Table
from synth.problem.aim import Aim
from synth.problem.criterion import Criterion
from synth.problem.resolution import Resolution
from synth.retarder.sensors.anywhere import policy_anywhere
from synth.retarder.sensors.candidate_places import CandidatePlaces, LayoutCase, candidate_places
from synth.retarder.sensors.layout import equal_layout, fastest_m_s, first_sensor_m, longest_change_s, rule_layout
from synth.retarder.sensors.layout_plan import LayoutProblem, fewest_for, plan_layouts, steps_of_plan
from synth.retarder.sensors.layout_results import layout_results
from synth.retarder.sensors.layout_search import LayoutSearch
from synth.retarder.sensors.plan_command import COMMAND
from synth.retarder.sensors.plan_map import plan_map
from synth.retarder.sensors.tuned_passages import passage_chains
from synth.solver.backward_induction import solve
from synth.solver.chain.sensor_passages import with_point_sensors
from synth.solver.evaluation import Evaluation
from synth.solver.passage_speeds import passage_speeds

SENSORS = PointSensors((0.0,))
TARGET_M_S = 2.5
AIMS = (Aim(TARGET_M_S, Criterion()),)
COARSE = Resolution(path_step_m=1.0, speed_step_m_s=0.1, friction_nodes=3, path_levels=1, resistance_nodes=1)
AHEAD_M = 10.0


@pytest.fixture(scope="module")
def places(plant_22t: Plant) -> CandidatePlaces:
    """The light gondola, which has stages 0 … 2."""
    return candidate_places(LayoutCase(plant_22t, AIMS), SENSORS, AHEAD_M, COARSE)


def test_by_the_rule_every_section_outlasts_the_longest_change(plant_52t: Plant) -> None:
    """The fastest cut that slows down evenly needs longer for a section than the longest change of stage."""
    places = rule_layout(plant_52t, SENSORS, TARGET_M_S)
    time_s = longest_change_s(plant_52t, SENSORS)
    assert places[0] == first_sensor_m(plant_52t, SENSORS, TARGET_M_S) < 0.0
    for here, there in itertools.pairwise(places):
        speed = fastest_m_s(plant_52t, TARGET_M_S, here, 0.99)
        assert there - here - 0.5 * SENSORS.base_m >= speed * time_s - 2e-3 or there == 0.0
    assert all(a > b for a, b in itertools.pairwise(np.diff(places)[1:]))  # they shrink towards the exit


def test_the_cost_of_a_layout_is_that_of_its_own_chain(plant_22t: Plant) -> None:
    """Sensors at nodes of the path: the same as the chain of these sensors, solved and evaluated by itself."""
    resolution = Resolution(path_step_m=0.5, speed_step_m_s=0.06, friction_nodes=7, path_levels=2, resistance_nodes=1)
    probe = candidate_places(LayoutCase(plant_22t, AIMS), SENSORS, AHEAD_M, resolution)
    path = probe.chain.grid.path_m
    layout = tuple(float(path[node]) for node in (0, 30, 50, 70))
    sensors = PointSensors(layout)
    chains = passage_chains(with_point_sensors(plant_22t, sensors), sensors, resolution)
    solution = solve(chains.design, AIMS[0], np.float64)
    cost = Evaluation(chains.design, AIMS[0]).cost(passage_speeds(solution.lines_m_s))
    assert probe.mean_costs([layout]) == [pytest.approx(cost, rel=2e-3)]


def test_layouts_solved_together_cost_what_each_costs_alone(places: CandidatePlaces) -> None:
    """To the bit, whatever other layouts decide where: so no search depends on what it asks for at once."""
    layouts = [(-8.0, 5.0, 20.0), (-8.0, 7.0, 20.0), (-6.0,), (-8.0, 0.0, 10.0, 20.0, 30.0)]
    alone = [places.mean_costs([each])[0] for each in layouts]
    assert places.mean_costs(layouts) == alone
    assert places.mean_costs(layouts[::-1]) == alone[::-1]
    assert len(set(alone)) == len(alone)


def test_the_search_finds_what_exhaustive_search_finds(places: CandidatePlaces) -> None:
    """Three sensors on sixteen places, all 560 layouts."""
    grid = np.array([-9.0, -6.0, -3.0, -0.5, *np.arange(3.0, 36.5, 3.0)])
    search = LayoutSearch((places,), tuple(grid.tolist()), -8.0, 37.0)
    every = [layout for layout in itertools.combinations(range(len(grid)), 3) if grid[layout[0]] <= 0.0]
    costs = search.costs(every)
    fresh = LayoutSearch((places,), tuple(grid.tolist()), -8.0, 37.0)
    found = fresh.best_layouts((3,))[3]
    assert len(fresh.known) < 0.4 * len(every)
    assert fresh.known[found] <= min(costs) * (1.0 + 1e-3)


def test_a_plan_is_never_worse_than_equal_sections(plant_22t: Plant) -> None:
    """By the predictions of the tables that both give; and of plans for an rms the fewest sensors are chosen."""
    problem = LayoutProblem((LayoutCase(plant_22t, AIMS),), SENSORS, COARSE)
    plans = plan_layouts(problem, (2, 4))
    for plan, count in zip(plans, (2, 4), strict=True):
        assert plan.deciding == count
        assert plan.best.rms_m_s <= plan.equal.rms_m_s
        assert plan.equal.deciding_m == equal_layout(problem.first_m, problem.exit_m, count)
    assert plans[1].best.rms_m_s < plans[0].best.rms_m_s
    assert fewest_for(plans, plans[1].best.rms_m_s) is plans[1]
    assert fewest_for(plans, 0.0) is None


@pytest.mark.parametrize("threads", [1, 2])
def test_a_plan_does_not_depend_on_threads(places: CandidatePlaces, threads: int) -> None:
    """The same layout."""
    grid = np.arange(-8.0, 36.0, 4.0)
    search = LayoutSearch((places,), tuple(grid.tolist()), -8.0, 37.0, threads)
    assert (
        search.best_layouts((4,))[4] == LayoutSearch((places,), tuple(grid.tolist()), -8.0, 37.0).best_layouts((4,))[4]
    )


def test_prediction_and_simulation_of_a_table_agree(plant_of: Callable[[float], Plant]) -> None:
    """The exported table in the closed loop, 20 000 passes: predicted rms within 5 %, bias within 0.01 m/s."""
    from synth.retarder.sensors.passage_table import passage_table
    from synth.retarder.sensors.tuned_passages import tuned_passages
    from synth.simulation.exit_statistics import exit_statistics
    from synth.simulation.passage_controller import of_table
    from synth.simulation.passage_loop import simulate_passages
    from tuning_tables import Generator

    sensors = PointSensors((-8.0, 10.0, 18.0, 24.0, 29.0, 33.0, 39.0))
    plant = with_point_sensors(plant_of(52.0), sensors)
    tuned = tuned_passages(passage_chains(plant, sensors, Resolution()), Aim(3.0, Criterion()))
    table = passage_table(tuned, Generator("retarder-synth", "0", "0" * 64), "t", "2026-11-22T00:00:00Z")
    sample = simulate_passages(plant, sensors, of_table(table, tracking=False), 1, 20_000)
    found = exit_statistics(sample, 3.0)
    assert table.predicted.rms_m_s == pytest.approx(found.rms_m_s, rel=0.05)
    assert table.predicted.bias_m_s == pytest.approx(found.bias_m_s, abs=0.01)
    assert table.predicted.rms_m_s < 0.06


def test_the_map_under_a_plan_brakes_what_is_fast_and_releases_what_is_slow(plant_22t: Plant) -> None:
    case = LayoutCase(plant_22t, AIMS)
    policy = policy_anywhere(case, SENSORS, 5.0)
    near_exit = int(np.argmin(np.abs(policy.path_m - 30.0)))
    fast, slow = (int(np.argmin(np.abs(policy.speed_m_s - v))) for v in (5.0, 1.5))
    assert [policy.command[stage, near_exit, fast] for stage in range(3)] == [1, 1, 0]
    assert [policy.command[stage, near_exit, slow] for stage in range(3)] == [0, -1, -1]
    problem = LayoutProblem((case,), SENSORS, COARSE)
    ((tuned,),) = problem.judged((-5.0, 10.0, 20.0)).tuned
    figure = plan_map("22 t", policy, tuned)
    shown = [axes for axes in figure.axes if axes.images]
    assert len(shown) == 3
    assert all(len(axes.collections) > 0 for axes in shown)  # the passages


def test_what_is_shown_of_a_plan(plant_22t: Plant) -> None:
    problem = LayoutProblem((LayoutCase(plant_22t, AIMS),), SENSORS, COARSE)
    told: list[str] = []
    found = layout_results(problem, ("light",), (3,), None, 1, told.append)
    assert len(told) == steps_of_plan([2]) + 1 == 5  # as many as the command counts
    (chapter,) = COMMAND.show(found)
    layouts, cases = (each for each in chapter.exhibits if isinstance(each, Table))
    assert [row["layout"] for row in layouts.rows] == ["planned", "equal sections", "by the rule", "radar"]
    assert [len(row["path_m"]) for row in layouts.rows[:-1]] == [row["sensors"] for row in layouts.rows[:-1]]
    for row in layouts.rows:
        of_cases = [case["rms_m_s"] for case in cases.rows if case["layout"] == row["layout"]]
        assert row["rms_m_s"] == pytest.approx(math.sqrt(np.mean(np.square(of_cases))))
    assert found.wanted_rms_m_s == pytest.approx(1.1 * layouts.rows[-1]["rms_m_s"])
    (limit,) = COMMAND.limits(found)
    assert f"an rms of at most {found.wanted_rms_m_s:.4f} m/s" in limit.sentence
    assert limit.kept == (layouts.rows[0]["rms_m_s"] <= found.wanted_rms_m_s)
    files = [each for each in chapter.exhibits if isinstance(each, File)]
    assert len(files) == limit.kept
