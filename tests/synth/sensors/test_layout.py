"""Layouts of point sensors: the rule, exhaustive search, and that a plan is never worse than equal sections; and nodes
of passages on the path of a chain: each its own, next to its place, and none where the cut has left.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plant_models import Plant, PointSensors, every_axle, first_axle
from plant_models.point_sensors import Axles, Passage, deciding_passages
from scripts.studies.point_sensors.sites import plan_layouts
from synth.frame.exhibits import File, Table
from synth.problem.criterion import Criterion
from synth.problem.problem import Aim
from synth.problem.resolution import Resolution
from synth.retarder.configuration.config_file import default_sensors_toml, parse_config, source_of_text
from synth.retarder.sensors.layout import (
    CandidatePlaces,
    LayoutCase,
    candidate_places,
    equal_layout,
    fastest_m_s,
    first_sensor_m,
    longest_change_s,
    policy_anywhere,
    rule_layout,
)
from synth.retarder.sensors.layout_plan import LayoutProblem, fewest_for, plan_passes
from synth.retarder.sensors.layout_results import AskedLayouts, layout_results
from synth.retarder.sensors.layout_search import LayoutSearch
from synth.retarder.sensors.passage_table import passage_chains
from synth.retarder.sensors.plan_command import COMMAND
from synth.retarder.sensors.plan_pictures import plan_map
from synth.solver.backward_induction import solve
from synth.solver.chain.chain import persistent_chain
from synth.solver.chain.sampling import SensorPassages, nodes_of, with_point_sensors
from synth.solver.evaluation import Evaluation
from synth.solver.passage_speeds import SMALLEST_GAP_M_S, PassageSpeeds, ordered, passage_speeds
from synth.solver.resolved_density import resolved_density
from tests.synth.conftest import pilot_plant

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
    *_, found = fresh.best_layouts(3)
    assert len(fresh.known) < 0.4 * len(every)
    assert fresh.known[found] <= min(costs) * (1.0 + 1e-3)


def test_a_search_ends_no_worse_than_equal_sections_and_one_more_sensor_costs_no_more(places: CandidatePlaces) -> None:
    search = LayoutSearch((places,), tuple(np.arange(-9.0, 36.0, 1.5).tolist()), -8.0, 37.0)
    costs = [search.known[found] for found in search.best_layouts(5)]
    assert all(each <= search.known[search.equal(count + 1)] for count, each in enumerate(costs))
    assert costs == sorted(costs, reverse=True)


def test_of_plans_the_fewest_sensors_are_chosen_whatever_the_threads(plant_22t: Plant) -> None:
    """To the bit; and a candidate that is better by its tables is taken, wherever it stands."""
    problem = LayoutProblem((LayoutCase(plant_22t, AIMS),), SENSORS, COARSE)
    passes = plan_passes(1, 1000)
    plans, again = (plan_layouts(problem, (4, 2), passes, threads) for threads in (1, 3))
    assert [plan.deciding for plan in plans] == [2, 4]
    for one, other in zip(plans, again, strict=True):
        assert one.deciding_m == other.deciding_m
        assert np.array_equal(one.errors.error_m_s, other.errors.error_m_s)
    assert fewest_for(plans, plans[1].chosen_by_m_s) is plans[1]
    assert fewest_for(plans, 0.0) is None
    equal = equal_layout(problem.first_m, problem.exit_m, 2)
    assert problem.judged([equal, plans[0].deciding_m], passes).deciding_m == plans[0].deciding_m


def test_nothing_is_told_of_the_passes_that_were_chosen_on() -> None:
    passes = plan_passes(7, 1000)
    assert not np.isin(passes.final.cut_z, passes.choosing.cut_z).any()


def test_prediction_and_simulation_of_a_table_agree(plant_of: Callable[[float], Plant]) -> None:
    """The exported table in the closed loop, 20 000 passes: predicted rms within 5 %, bias within 0.01 m/s."""
    from synth.retarder.sensors.passage_table import passage_table, tuned_passages
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
    (table,) = problem.judged([(-5.0, 10.0, 20.0)], plan_passes(1, 1000)).tables
    figure = plan_map("22 t", policy, table)
    shown = [axes for axes in figure.axes if axes.images]
    assert len(shown) == 3
    assert all(len(axes.collections) > 0 for axes in shown)  # the passages


def test_what_is_shown_of_a_plan(plant_22t: Plant) -> None:
    """Each figure has its interval and follows from those of the cases; each layout is a configuration."""
    problem = LayoutProblem((LayoutCase(plant_22t, AIMS),), SENSORS, COARSE)
    source = source_of_text(default_sensors_toml(), "yard.toml")
    told: list[str] = []
    asked = AskedLayouts(source, problem, ("light",), (3,), None, 1, 1000)
    found = layout_results(asked, 2, told.append)
    assert len(told) == asked.steps == 5  # as many as the command counts
    exhibits = [each for chapter in COMMAND.show(found) for each in chapter.exhibits]
    layouts, cases = (each for each in exhibits if isinstance(each, Table))
    assert [row["layout"] for row in layouts.rows] == ["planned", "by the rule", "radar"]
    for row in layouts.rows:
        of_cases = [case["rms_m_s"].value for case in cases.rows if case["layout"] == row["layout"]]
        assert row["rms_m_s"].value == pytest.approx(math.sqrt(np.mean(np.square(of_cases))))
        assert row["rms_m_s"].n == 1000
    assert found.wanted_rms_m_s == pytest.approx(1.1 * layouts.rows[-1]["rms_m_s"].value)
    (limit,) = COMMAND.limits(found)
    assert f"an rms of at most {found.wanted_rms_m_s:.4f} m/s" in limit.sentence
    assert limit.kept is (False if found.chosen is None else found.is_reached(found.chosen))
    files = {each.name: each.content.decode() for each in exhibits if isinstance(each, File)}
    for row in layouts.rows[:-1]:
        sensors = parse_config(files[row["file"]], row["file"]).sensors
        assert sensors is not None
        assert sensors.sensors.path_m == tuple(row["path_m"])
        assert len(row["path_m"]) == row["sensors"]


@given(
    places=st.lists(st.floats(0.0, 40.0), min_size=1, max_size=20).map(sorted),
    spare=st.integers(1, 40),
)
def test_nodes_rise_and_stay_on_the_path(places: list[float], spare: int) -> None:
    steps = len(places) + spare
    place_m, step_m = np.array(places), 40.0 / steps
    node = nodes_of(place_m, step_m, steps)
    assert (np.diff(node) > 0).all()
    assert node[0] >= 0
    assert node[-1] < steps
    alone = np.diff(place_m, prepend=-100.0, append=100.0).min() > 2.0 * step_m
    if alone and places[-1] < 40.0 - step_m:
        assert (np.abs(place_m - node * step_m) <= 0.5 * step_m + 1e-9).all()


def test_a_passage_right_before_the_exit_is_decided_there() -> None:
    # The last axles of a 6-axle car pass a sensor 0.3 m before the exit, nearer to the last node than to any other.
    config = parse_config(default_sensors_toml().replace('"first_axle"\n', '"every_axle"\n'), "x.toml")
    assert config.sensors is not None
    sensors, (_, six) = config.sensors.sensors, config.plants()[1]
    assert sensors.axles is every_axle
    plant = config.sensors.serving(six)
    met = deciding_passages(sensors, plant.cut, plant.exit_m)
    epochs = SensorPassages(sensors)
    grid = epochs.grid(plant, config.resolution)
    node = epochs.decisions(plant, grid).node
    assert plant.exit_m - met[-1].path_m < 0.5
    assert len(node) == len(met)
    assert node[-1] < len(grid.path_m) - 1
    epochs.measurement(plant, grid)  # looks up the brake at every node


@pytest.mark.parametrize("axles", [first_axle, every_axle])
def test_passages_are_nodes_and_the_figures_hardly_depend_on_the_path_step(axles: Axles) -> None:
    sensors = PointSensors((-5.0, 1.3, 6.1, 9.2, 14.7, 21.4), axles=axles)
    plant = with_point_sensors(pilot_plant(22.0), sensors)
    met = deciding_passages(sensors, plant.cut, plant.exit_m)
    rms = []
    for step_m in (0.5, 0.125):
        grid = Resolution(path_step_m=step_m, speed_step_m_s=0.015, friction_nodes=7, resistance_nodes=1)
        chain = persistent_chain(plant, grid, SensorPassages(sensors))
        at_nodes = chain.grid.path_m[chain.decisions.node]
        assert at_nodes == pytest.approx([each.path_m for each in met], abs=1e-9)
        assert np.diff(chain.grid.path_m).min() > 0.0
        speeds = hard_rule(met, plant.exit_m, plant.top_stage)
        rms.append(resolved_density(chain, speeds, 3.0).rms_m_s(3.0))
    assert rms[0] == pytest.approx(rms[1], rel=0.005)  # 0.1 with the passages at the nodes next to them


def hard_rule(met: Sequence[Passage], exit_m: float, top: int) -> PassageSpeeds:
    """Stage j + 1 where v² > v_t² + 2·a_j·(S_exit − s), a_j in steps of 0.22 m/s²."""
    left_m = np.array([exit_m - max(each.path_m, 0.0) for each in met])
    speeds = np.sqrt(9.0 + 2.0 * 0.22 * (np.arange(top) + 0.4) * left_m[:, None])
    return PassageSpeeds(ordered(np.repeat(speeds[:, None, :], top + 1, axis=1)))


def test_passages_at_one_place_have_nodes_of_their_own() -> None:
    sensors = PointSensors((-5.0, 3.65, 12.3), axles=every_axle)  # two axles of a gondola are 8.65 m apart
    plant = with_point_sensors(pilot_plant(22.0), sensors)
    epochs = SensorPassages(sensors)
    grid = epochs.grid(plant, Resolution())
    place = epochs.decisions(plant, grid).place_m
    assert np.diff(place).min() == pytest.approx(1e-3)
    assert np.diff(grid.path_m).min() > 0.0


def test_infinite_switching_speeds_keep_their_order() -> None:
    infinite = np.inf
    speeds = np.array([[[2.0, infinite], [infinite, infinite], [-infinite, 3.0]]])
    found = ordered(speeds)  # numpy's warnings are errors here
    assert found[0, 1].tolist() == [infinite, infinite]
    close = ordered(np.array([[[2.0, infinite], [2.0, 2.0], [1.0, 3.0]]]))
    assert close[0, 1, 1] - close[0, 1, 0] >= SMALLEST_GAP_M_S
