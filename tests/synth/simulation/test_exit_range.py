"""The range of exit speeds holds every regulator, pass by pass; the unavoidable error is less than every rms."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from plant_models import Approach, EntrySpeed, Plant
from synth.retarder.comparison.baselines import FAMILIES
from synth.retarder.configuration.config_file import parse_config
from synth.simulation.closed_loop import LineController, TableController
from synth.simulation.common_passes import CommonPasses, common_passes, released
from synth.simulation.controllers import Regulator
from synth.simulation.exit_statistics import excess_and_lack_m_s, unavoidable_error
from synth.simulation.passes import ExitSample
from synth.simulation.stratified_passes import stratified_passes
from synth.solver.switching_lines import PolynomialLines, SwitchingLines
from synth.solver.tabulate import UNPREDICTED, tabulate
from tuning_tables import Decisions, Generator

ROUNDING_M_S = 1e-6
PLACES = 40
APPROACHES = [
    Approach(),
    Approach(4.0),
    Approach(4.0, entrance_stage=2),
    Approach(4.0, entrance_stage=2, initial_stage=1),
]


def passes_of(plant: Plant, count: int = 400) -> CommonPasses:
    return common_passes(plant, stratified_passes(5, 0, count))


def random_commands(passes: CommonPasses, rng: np.random.Generator, decisions: Decisions) -> LineController:
    """At every place along the path a stage drawn by chance is wanted, and is gone to from any other in one go."""
    plant = passes.plant
    stages, length_m = plant.top_stage + 1, plant.exit_m - plant.start_m
    # Twenty nodes a place: the lines are level but where the stage changes.
    nodes = np.linspace(plant.start_m, plant.exit_m, 20 * PLACES + 1)
    place = np.minimum(((nodes - plant.start_m) / length_m * PLACES).astype(int), PLACES - 1)
    weights = rng.dirichlet(np.full(stages, 0.7))
    wanted = rng.choice(stages, PLACES, p=weights)[place]
    stage = np.arange(stages)[:, None]
    lower, upper = np.where(stage > wanted, 1e3, -1e3), np.where(stage < wanted, -1e3, 1e3)
    lower[0], upper[-1] = -np.inf, np.inf
    return LineController(SwitchingLines(nodes, lower, upper), decisions=decisions)


@pytest.mark.parametrize("approach", APPROACHES, ids=repr)
def test_no_sequence_of_commands_leaves_the_range(plant_of: Callable[[float], Plant], approach: Approach) -> None:
    """Drawn by chance, at rest and at any time; more of them braked than released and the other way round."""
    passes = passes_of(replace(plant_of(85.0), approach=approach))
    found, rng = passes.exit_range, np.random.default_rng(1)
    nearest = np.full(len(passes), np.inf)
    for turn in range(120):
        decisions = Decisions.AT_REST if turn % 2 else Decisions.AT_ANY_TIME
        speed = passes.run(random_commands(passes, rng, decisions)).exit_speed_m_s
        assert (speed >= found.slowest.exit_speed_m_s - ROUNDING_M_S).all()
        assert (speed <= found.fastest.exit_speed_m_s + ROUNDING_M_S).all()
        nearest = np.minimum(nearest, speed - found.slowest.exit_speed_m_s)
    assert np.median(nearest) < 1.0  # they were no idle commands


def rules(passes: CommonPasses, target_m_s: float) -> list[tuple[str, Regulator]]:
    """Classical laws with parameters from their grids, a table, and release."""
    plant, loop = passes.plant, passes.loop(passes.plant.top_stage + 1)
    found: list[tuple[str, Regulator]] = []
    for family in FAMILIES:
        for decisions in Decisions:
            values = [grid[len(grid) // 2] for grid in family.grids]
            found.append((family.name, family.deciding(decisions).build(loop, target_m_s, plant.top_stage, *values)))
    stages = plant.top_stage + 1
    has_line = np.ones((stages, 2), dtype=bool)
    has_line[0, 0] = has_line[-1, 1] = False
    coefficients = np.zeros((stages, 2, 2))
    coefficients[:, 0], coefficients[:, 1] = (target_m_s + 0.4, -0.8), (target_m_s + 1.0, -0.8)
    lines = PolynomialLines(plant.start_m, plant.exit_m, coefficients, has_line)
    table = tabulate(plant, lines, target_m_s, UNPREDICTED, Generator("t", "0", "0" * 64), "t", "2000-01-01T00:00:00Z")
    return [*found, ("table", TableController(table)), ("released", released(stages, plant.start_m, plant.exit_m))]


@pytest.mark.requirement("PRED-08")
@pytest.mark.parametrize("mass_t", [22.0, 52.0, 85.0])
def test_no_rule_leaves_the_range_and_none_has_less_than_the_unavoidable_error(
    plant_of: Callable[[float], Plant], mass_t: float
) -> None:
    passes, target = passes_of(replace(plant_of(mass_t), approach=Approach(4.0, entrance_stage=1)), 2000), 2.0
    found = passes.exit_range
    least = unavoidable_error(found.slowest, found.fastest, target).rms_m_s
    assert least > 0.0
    samples = {name: passes.run(rule) for name, rule in rules(passes, target)} | {"full brake": passes.at_full_brake}
    for name, sample in samples.items():
        assert (sample.exit_speed_m_s >= found.slowest.exit_speed_m_s - ROUNDING_M_S).all(), name
        assert (sample.exit_speed_m_s <= found.fastest.exit_speed_m_s + ROUNDING_M_S).all(), name
        error = sample.exit_speed_m_s - target
        assert np.sqrt(np.average(error**2, weights=sample.weight)) > least, name


def test_where_any_stage_may_be_commanded_at_once_the_bound_is_a_regulator_of_the_position(
    plant_of: Callable[[float], Plant],
) -> None:
    """Of whoever waits, the later is the faster, and the first of them is the bound."""
    passes = passes_of(replace(plant_of(85.0), approach=Approach(4.0)))
    slowest = passes.exit_range.slowest
    assert (slowest.switchings == 1).all()
    before = slowest.exit_speed_m_s
    for begins_m in (-2.0, 0.0, 3.0):
        nodes = np.linspace(passes.plant.start_m, passes.plant.exit_m, 2001)
        stages = passes.plant.top_stage + 1
        upper = np.tile(np.where(nodes < begins_m, 1e3, -1e3), (stages, 1))
        upper[-1] = np.inf
        waits = LineController(SwitchingLines(nodes, np.full((stages, nodes.size), -1e3), upper))
        speed = passes.run(waits).exit_speed_m_s
        assert (speed >= before - ROUNDING_M_S).all()
        assert (speed > before).any()
        before = speed


def exits(speeds_m_s: np.ndarray, weight: float = 1.0) -> ExitSample:
    n = len(speeds_m_s)
    return ExitSample(speeds_m_s, speeds_m_s == 0.0, np.zeros(n, np.int32), np.ones(n), np.full(n, weight))


def test_the_unavoidable_error_of_a_sample() -> None:
    slowest, fastest = np.tile([0.0, 2.5, 3.1, 3.4], 100), np.tile([2.8, 4.0, 5.0, 5.0], 100)
    excess, lack = excess_and_lack_m_s(exits(slowest), exits(fastest), 3.0)
    assert excess[:4] == pytest.approx([0.0, 0.0, 0.1, 0.4])
    assert lack[:4] == pytest.approx([0.2, 0.0, 0.0, 0.0])
    found = unavoidable_error(exits(slowest), exits(fastest), 3.0)
    assert found.rms_m_s == pytest.approx(np.sqrt((0.04 + 0.01 + 0.16) / 4.0))
    assert found.obstacle == "brake saturated"
    assert unavoidable_error(exits(slowest), exits(fastest), 4.5).obstacle == "leaves too slow"
    none = unavoidable_error(exits(slowest - 3.0), exits(fastest + 3.0), 3.0)
    assert (none.rms_m_s, none.forbids(0.1), none.undecided(0.1)) == (0.0, False, False)


@pytest.mark.parametrize(
    ("low", "high", "forbids", "undecided"),
    [(0.05, 0.09, False, False), (0.09, 0.11, False, True), (0.1, 0.11, False, True), (0.101, 0.11, True, False)],
)
def test_a_limit_is_forbidden_by_the_whole_interval(low: float, high: float, forbids: bool, undecided: bool) -> None:
    error = replace(
        unavoidable_error(exits(np.full(200, 3.0)), exits(np.full(200, 4.0)), 3.0), rms_ci95_m_s=(low, high)
    )
    assert (error.forbids(0.1), error.undecided(0.1)) == (forbids, undecided)


def test_a_cut_that_stalls_unbraked_leaves_too_slow(plant_of: Callable[[float], Plant]) -> None:
    plant = plant_of(22.0)
    level = replace(plant, profile=type(plant.profile).uniform(-60.0), entry=EntrySpeed(3.0, 3.5))
    found = passes_of(level).exit_range
    assert (found.fastest.exit_speed_m_s == 0.0).all()
    error = unavoidable_error(found.slowest, found.fastest, 2.0)
    assert error.rms_m_s == pytest.approx(2.0)
    assert error.obstacle == "leaves too slow"


SHORT = '[[cut]]\ncar = "gondola-4"\nmass_t = 85\n[targets]\nexit_speeds_m_s = [2.0]\n'
LONG = '[[cut]]\ncar = "gondola-4"\ncars = 10\nmass_t = 520\n[targets]\nexit_speeds_m_s = [3.0]\n'


@pytest.mark.parametrize(("text", "forbids"), [(SHORT, True), (LONG, False)], ids=["85 t to 2 m/s", "520 t to 3 m/s"])
def test_what_the_position_of_the_default_book_can_do(text: str, forbids: bool) -> None:
    """Ten gondolas of 52 t can be braked, if not by a cubic; one of 85 t cannot."""
    config = parse_config(text, "cut")
    ((label, plant),) = config.plants()
    found = passes_of(plant, 6000).exit_range
    error = unavoidable_error(found.slowest, found.fastest, config.targets_of(label)[0])
    assert error.forbids(config.acceptance.rms_m_s) is forbids
    assert not error.undecided(config.acceptance.rms_m_s)
