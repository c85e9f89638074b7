"""Other criteria than the mean square: their gradients, multipliers and certificates, on a small plant with everything
random."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from plant_models import EntrySpeed, Plant, PlantError, PressingForce, RetarderPosition, RollingResistance
from synth.frame.faults import InputError
from synth.problem.criterion import (
    AsymmetricSquare,
    Criterion,
    PenalisedOverspeed,
    SquaredError,
    TerminalCost,
    share_above,
)
from synth.problem.problem import Aim, Problem
from synth.problem.requirement import FrictionRange, OverspeedLimit, OverspeedLimitFound
from synth.problem.resolution import Resolution, finer_for_check
from synth.retarder.checked_design import required_lines
from synth.retarder.configuration.config_file import default_config_toml, parse_config
from synth.simulation.closed_loop import LineController, simulate
from synth.simulation.exit_statistics import clopper_pearson, exit_statistics
from synth.simulation.random_passes import random_passes
from synth.solver.backward_induction import Solution, solve
from synth.solver.chain.chain import Chain, check_chain, finer_in_speed, known_factors, persistent_chain
from synth.solver.evaluation import Evaluation, exit_density, scenario_densities
from synth.solver.kept_requirement import FACTORS, guard_worst_case, keep_overspeed_limit, predicted_density
from synth.solver.switching_lines import PolynomialLines, SwitchingLines
from synth.solver.tuned_lines import Fit, fitted, polished, whitening

COARSE = Resolution(path_step_m=0.5, speed_step_m_s=0.05, friction_nodes=3, resistance_nodes=1)
TARGET_M_S = 3.0
DEGREE = 2
RANGE = FrictionRange(0.75, 1.25)
ASYMMETRIC = AsymmetricSquare(4.0)


@pytest.fixture(scope="module")
def plant(plant_of: Callable[[float], Plant]) -> Plant:
    """The 22 t car at a short retarder, its running resistance known: 16 m to the exit."""
    whole = plant_of(22.0)
    position = replace(whole.position, zones_m=((0.0, 5.5),))
    return replace(whole, position=position, resistance=RollingResistance(1.75, 0.0), entry=EntrySpeed(3.6, 4.2))


@pytest.fixture(scope="module")
def design(plant: Plant) -> Chain:
    return persistent_chain(plant, COARSE)


@pytest.fixture(scope="module")
def check(plant: Plant) -> Chain:
    return check_chain(plant, replace(finer_for_check(COARSE), friction_nodes=7))


@pytest.fixture(scope="module")
def fit(design: Chain) -> Fit:
    return fitted(solved(design, Criterion()), DEGREE)


@pytest.fixture(scope="module")
def start(design: Chain, fit: Fit) -> PolynomialLines:
    return polished(solved(design, Criterion()), fit).best


def solved(design: Chain, criterion: Criterion) -> Solution:
    return solve(design, Aim(TARGET_M_S, criterion))


def test_costs_by_hand() -> None:
    """Grid speeds even in energy; the target falls between nodes 1 and 2, the limit into the cell of node 3."""
    speed = np.sqrt(2.0 * np.arange(5.0))
    target = 1.7
    error = speed - target
    assert np.array_equal(SquaredError().at_exit(speed, target), error**2)
    expected = np.array([target**2, error[1] ** 2, 4 * error[2] ** 2, 4 * error[3] ** 2, 4 * error[4] ** 2])
    assert ASYMMETRIC.at_exit(speed, target) == pytest.approx(expected)
    limit = np.sqrt(2.0 * 3.2)  # the cell of node 3 reaches from 2.5 to 3.5: 0.3 of it lie above
    penalised = PenalisedOverspeed(10.0, limit - target).at_exit(speed, target)
    assert penalised - error**2 == pytest.approx([0.0, 0.0, 0.0, 3.0, 10.0])
    assert Criterion(0.5, 0.0, terminal=ASYMMETRIC).exit_costs(speed, target)[1] == pytest.approx(target**2 + 0.5)


def test_a_penalised_overspeed_costs_its_price_times_the_probability(design: Chain, start: PolynomialLines) -> None:
    lines = start.at(design.grid.path_m)
    density = exit_density(design, lines)
    free = Criterion(1.0, 0.0)
    priced = replace(free, terminal=PenalisedOverspeed(2.0, 0.02))
    dear, cheap = (Evaluation(design, Aim(TARGET_M_S, each)).cost(lines) for each in (priced, free))
    assert density.p_overspeed(TARGET_M_S + 0.02) > 0.02
    ramp = share_above(density.speed_m_s, TARGET_M_S + 0.02)
    assert dear - cheap == pytest.approx(2.0 * float(density.probability @ ramp), rel=1e-6)


@pytest.mark.parametrize("terminal", [SquaredError(), ASYMMETRIC, PenalisedOverspeed(0.05, 0.05)])
def test_gradient_is_the_slope_of_the_cost(design: Chain, start: PolynomialLines, terminal: TerminalCost) -> None:
    """Every scenario by itself: central difference over ±3e-5 m/s along a random direction of the line values."""
    criterion = Criterion(1.0, 3e-5, terminal=terminal)
    lines, h = start.at(design.grid.path_m), 3e-5
    direction = np.random.default_rng(1).standard_normal((2, *lines.lower_m_s.shape))

    def costs(by: float) -> np.ndarray:
        moved = SwitchingLines(lines.nodes_m, lines.lower_m_s + by * direction[0], lines.upper_m_s + by * direction[1])
        return Evaluation(design, Aim(TARGET_M_S, criterion)).scenario_costs(moved).cost

    found = Evaluation(design, Aim(TARGET_M_S, criterion)).scenario_costs(lines)
    along = (found.by_lines * direction[:, :, :-1].transpose(0, 2, 1)).sum((1, 2, 3))
    size = np.abs(found.by_lines).sum((1, 2, 3))
    assert np.abs(along).max() > 1e-4
    # Commands that are next to impossible are cut off, so the cost has steps of some 1e-10 where one comes or goes.
    steps = 1.5e-10 / (2 * h)
    assert np.all(np.abs(along - (costs(h) - costs(-h)) / (2 * h)) < 1e-5 * size + 1e-9 + steps)


def test_an_asymmetric_table_is_best_by_its_own_cost_and_slower(design: Chain, start: PolynomialLines) -> None:
    asymmetric = Criterion(terminal=ASYMMETRIC)
    solution = solved(design, asymmetric)
    policies = [each.at(design.grid.path_m) for each in (polished(solution, fitted(solution, DEGREE)).best, start)]
    own, other = (Evaluation(design, solution.aim).cost(policy) for policy in policies)
    assert own < 0.95 * other
    slower, default = (exit_density(design, policy) for policy in policies)
    assert slower.bias_m_s(TARGET_M_S) < default.bias_m_s(TARGET_M_S) - 0.005
    assert slower.rms_m_s(TARGET_M_S) > default.rms_m_s(TARGET_M_S)


def test_a_factor_of_one_is_the_squared_error_to_the_bit(design: Chain) -> None:
    one, default = (solve(design, Aim(TARGET_M_S, c)) for c in (Criterion(terminal=AsymmetricSquare(1.0)), Criterion()))
    assert np.array_equal(one.values, default.values)
    assert np.array_equal(one.lines.upper_m_s, default.lines.upper_m_s)


def test_scenario_costs_are_those_of_simulated_passes(plant: Plant, check: Chain, start: PolynomialLines) -> None:
    """Each friction factor by itself against 8 000 passes: within the interval and the 6 % of the coarse grid."""
    factors = np.array([0.75, 1.0, 1.25])
    known = replace(check, scenarios=known_factors(plant, factors, 1))
    densities = scenario_densities(known, start.at(known.grid.path_m))
    controller = LineController(start.at(np.linspace(0.0, plant.exit_m, 401)))
    passes = random_passes(5, 0, 8000)
    for i, factor in enumerate(factors):
        found = exit_statistics(simulate(plant, controller, passes, float(factor)), TARGET_M_S)
        low, high = found.rms_ci95_m_s
        predicted = densities[i].rms_m_s(TARGET_M_S)
        print(f"ξ {factor}: predicted {predicted:.5f}, simulated {found.rms_m_s:.5f} [{low:.5f}, {high:.5f}]")
        assert 0.94 * low < predicted < 1.06 * high


def test_an_inactive_limit_has_no_multiplier_and_changes_nothing(
    design: Chain, check: Chain, fit: Fit, start: PolynomialLines
) -> None:
    limit = OverspeedLimit(0.2, 0.5)
    kept = required_lines(solved(design, Criterion(requirement=limit)), check, fit)
    found = kept.finding
    assert isinstance(found, OverspeedLimitFound)
    assert (found.multiplier_m2_s2, found.met, found.rounds) == (0.0, True, 0)
    assert np.array_equal(kept.lines.coefficients, start.coefficients)
    assert "not active" in found.sentence


def test_an_active_limit_is_met_where_lagrangian_and_limit_meet(
    plant: Plant, design: Chain, check: Chain, fit: Fit, start: PolynomialLines
) -> None:
    """KKT: the limit holds with equality within 20 %, the multiplier is positive, and a Newton step on the Lagrangian
    promises less than 3 % of it. The probability is that of simulated passes within 20 % for the coarse grid."""
    free = predicted_density(finer_in_speed(check, 3.0, check.scenarios), start).p_overspeed(TARGET_M_S + 0.05)
    limit = OverspeedLimit(0.05, 0.5 * free)  # for 0.4 the lines change their kind, and P leaps to 0.3
    lines, found = keep_overspeed_limit(solved(design, Criterion()), check, fit, start, limit)
    print(found.sentence, found.rounds)
    assert found.met
    assert found.multiplier_m2_s2 > 0.0
    assert 0.8 * limit.highest_probability < found.probability <= limit.highest_probability
    assert found.rms_m_s > 0.98 * found.rms_without_m_s
    ground = finer_in_speed(design, 2.0, check.scenarios)
    priced = Criterion(terminal=PenalisedOverspeed(found.multiplier_m2_s2, 0.05))
    cost, by_lines = Evaluation(ground, Aim(TARGET_M_S, priced)).gradient(lines.at(ground.grid.path_m))
    by_lower, by_upper = (each.T for each in by_lines)
    matrix, free_lines = lines.basis(ground.grid.path_m[:-1]), np.nonzero(lines.has_line)
    gradient = np.stack([by_lower @ matrix, by_upper @ matrix], axis=1)[free_lines] / cost
    step = np.einsum("lab,la->lb", whitening(fit.curvature[free_lines], matrix, cost), gradient)
    print("promised", 0.5 * float((step**2).sum()))
    assert 0.5 * float((step**2).sum()) < 0.03
    controller = LineController(lines.at(np.linspace(0.0, plant.exit_m, 401)))
    sample = simulate(plant, controller, random_passes(7, 0, 10_000))
    low, high = clopper_pearson(int((sample.exit_speed_m_s > TARGET_M_S + 0.05).sum()), len(sample))
    print(f"simulated {low:.4f} to {high:.4f}")
    assert 0.8 * low < found.probability < 1.2 * high


def test_a_limit_that_no_price_meets_is_said_to_be_so(
    plant: Plant, design: Chain, check: Chain, fit: Fit, start: PolynomialLines
) -> None:
    """Cuts that the top stage cannot stop are too fast whatever the lines: friction at a third of the nominal."""
    weak = replace(plant, friction=replace(plant.friction, common_cv=0.01), position=weakened(plant))
    coarse = persistent_chain(weak, COARSE)
    solution = solved(coarse, Criterion())
    own = fitted(solution, DEGREE)
    begin = polished(solution, own).best
    fine = check_chain(weak, finer_for_check(COARSE))
    _, found = keep_overspeed_limit(solution, fine, own, begin, OverspeedLimit(0.1, 0.01))
    print(found.sentence, found.rounds)
    assert not found.met
    assert found.probability > 0.01
    assert found.sentence.startswith("P(exit > target + 0.1 m/s) cannot be brought to 0.01: no multiplier")


def weakened(plant: Plant) -> RetarderPosition:
    """The position with a third of its braking force."""
    force = plant.position.force
    assert isinstance(force, PressingForce)
    return replace(plant.position, force=replace(force, slope_kn_per_kpa_per_pair=force.slope_kn_per_kpa_per_pair / 3))


def test_the_worst_case_is_lowered_and_certified(design: Chain, check: Chain, fit: Fit, start: PolynomialLines) -> None:
    """Equaliser: scenarios of positive weight cost the same within 3 %, the others less; the bound is independent of
    how the lines were found."""
    lines, found = guard_worst_case(solved(design, Criterion()), check, fit, start, RANGE)
    print(found.sentence, np.round(found.weights, 3))
    ground = finer_in_speed(design, 2.0, known_factors(design.plant, RANGE.factors(FACTORS), 1))

    def costs(of: PolynomialLines) -> np.ndarray:
        return Evaluation(ground, Aim(TARGET_M_S)).scenario_costs(of.at(ground.grid.path_m)).cost

    after, before, weights = costs(lines), costs(start), np.array(found.weights)
    assert after.max() < 0.98 * before.max()
    assert weights.sum() == pytest.approx(1.0)
    assert after[weights > 0.05].min() > 0.97 * after.max()
    assert found.gap >= 1.0 - weights @ after / after.max() - 1e-9
    assert found.worst_rms_m_s < found.worst_rms_without_m_s
    assert found.certified


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("p_overspeed = 0.01\noverspeed_factor = 4", "criterion.overspeed_factor is 4 and p_overspeed is 0.01, but"),
        ("worst_friction_low = 0.2", "criterion.worst_friction_low is 0.2; the friction of this cut is modelled from"),
        ("worst_friction_high = 0.7", "criterion.worst_friction_low is 1.0; it must be below worst_friction_high"),
    ],
)
def test_each_fault_is_one_sentence(text: str, sentence: str) -> None:
    with pytest.raises(InputError) as caught:
        parse_config(f"[criterion]\n{text}\n", "my.toml")
    assert str(caught.value).startswith(f"my.toml: {sentence}")
    assert "\n" not in str(caught.value)


def test_the_file_chooses_the_criterion() -> None:
    def chosen(text: str) -> Criterion:
        return parse_config(f"[regulator]\nestimator = false\n[criterion]\n{text}\n", "my.toml").criterion

    assert chosen("") == Criterion()
    assert chosen("overspeed_factor = 4").terminal == AsymmetricSquare(4.0)
    assert chosen("p_overspeed = 0.02").requirement == OverspeedLimit(0.1, 0.02)
    assert chosen("worst_friction_low = 0.7\nworst_friction_high = 1.3").requirement == FrictionRange(0.7, 1.3)
    assert parse_config(default_config_toml(), "x").criterion == Criterion()


def test_a_requirement_goes_with_the_squared_error_only(plant: Plant) -> None:
    with pytest.raises(PlantError, match="squared error only"):
        Criterion(terminal=ASYMMETRIC, requirement=RANGE)
    with pytest.raises(PlantError, match="worst_friction_high is 2"):
        Problem(plant, Aim(TARGET_M_S, Criterion(requirement=FrictionRange(0.9, 2.0))))
