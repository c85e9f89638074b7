"""From lines to polynomials, fitted and polished: what the optimiser promises, checked against the exact evaluation
itself; and from these to a table: rounding, forbidden stages, prediction of exactly what is exported.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from plant_models import Plant
from synth.problem.criterion import Criterion
from synth.problem.problem import Aim
from synth.problem.resolution import Resolution
from synth.solver.backward_induction import solve
from synth.solver.chain.chain import Chain, persistent_chain
from synth.solver.evaluation import Evaluation, commands_of, density_and_occupancy
from synth.solver.exit_density import ExitDensity
from synth.solver.switching_lines import MINIMUM_GAP_M_S, PolynomialLines, SwitchingLines, gap_of, opened
from synth.solver.tabulate import lines_of, prediction_of, tabulate
from synth.solver.tuned_lines import Evaluate, Fit, carried_back, fit_lines, polish, whitening
from tuning_tables import ControllerTable, Generator, InvalidTable, Predicted, decide_for

COARSE = Resolution(path_step_m=1.0, speed_step_m_s=0.05, friction_nodes=3, resistance_nodes=1)
TARGET_M_S = 3.0
CRITERION = Criterion()
INF = np.inf


@pytest.fixture(scope="module")
def design(plant_of: Callable[[float], Plant]) -> Chain:
    """A coarse grid for the 22 t car."""
    return persistent_chain(plant_of(22.0), COARSE)


@pytest.fixture(scope="module")
def fit(design: Chain) -> Fit:
    """Weighted cubic fit of the solver's lines."""
    solution = solve(design, Aim(TARGET_M_S, CRITERION))
    _, occupancy = density_and_occupancy(design, solution.lines)
    return fit_lines(solution, occupancy.samples, 3)


def evaluate_on(design: Chain) -> Evaluate:
    return lambda lines: Evaluation(design, Aim(TARGET_M_S, CRITERION)).gradient(lines)


def lines_with(lower: float, upper: float) -> PolynomialLines:
    """Two stages with constant lines; stage 0 has only an upper, stage 2 only a lower one."""
    coefficients = np.zeros((3, 2, 2))
    coefficients[:, 0, 0], coefficients[:, 1, 0] = lower, upper
    has_line = np.ones((3, 2), dtype=bool)
    has_line[0, 0] = has_line[-1, 1] = False
    return PolynomialLines(0.0, 30.0, coefficients, has_line)


def test_powers_of_s_are_the_same_polynomial(fit: Fit) -> None:
    s = np.linspace(0.0, fit.lines.exit_m, 50)
    at = fit.lines.at(s)
    powers = fit.lines.powers_of_s()
    for k, side in zip(*np.nonzero(fit.lines.has_line), strict=True):
        line = (at.lower_m_s, at.upper_m_s)[side][k]
        assert np.polynomial.polynomial.polyval(s, powers[k, side]) == pytest.approx(line, abs=1e-10)


def test_missing_lines_are_infinite(fit: Fit) -> None:
    at = fit.lines.at(np.array([0.0, 10.0]))
    assert np.all(at.lower_m_s[0] == -np.inf)
    assert np.all(at.upper_m_s[-1] == np.inf)


@pytest.mark.parametrize(
    ("nodes", "carried"), [(0, (INF, INF, INF, 3.0)), (2, (3.0, 3.0, INF, 3.0)), (9, (3.0, 3.0, 3.0, 3.0))]
)
def test_only_before_the_entrance_a_line_is_carried_back(nodes: int, carried: tuple[float, ...]) -> None:
    assert carried_back(np.array([INF, INF, INF, 3.0, INF, 5.0]), nodes).tolist() == [*carried, INF, 5.0]
    assert carried_back(np.full(3, INF), nodes).tolist() == [INF, INF, INF]


def test_opening_moves_a_pair_apart_symmetrically_and_leaves_others_alone() -> None:
    closed, wide = opened(lines_with(3.0, 3.01)), opened(lines_with(2.0, 3.0))
    assert gap_of(closed) == pytest.approx(MINIMUM_GAP_M_S)
    assert closed.coefficients[1, :, 0].mean() == pytest.approx(3.005)
    assert np.array_equal(wide.coefficients, lines_with(2.0, 3.0).coefficients)


def test_whitening_makes_the_hessian_the_unit_matrix() -> None:
    rng = np.random.default_rng(3)
    matrix, curvature = rng.normal(size=(40, 4)), rng.uniform(0.0, 2.0, (2, 40))
    scale = whitening(curvature, matrix, 0.5)
    loose = matrix.T @ matrix / (40 * 0.3**2)
    for t, weight in zip(scale, curvature, strict=True):
        hessian = matrix.T @ (weight[:, None] * matrix) / 0.5 + loose
        assert t.T @ hessian @ t == pytest.approx(np.eye(4), abs=1e-9)


def test_polish_lowers_the_exact_cost_and_keeps_the_gap(design: Chain, fit: Fit) -> None:
    evaluate = evaluate_on(design)
    result = polish(fit.lines, fit.curvature, design.grid.path_m, evaluate, 25)
    assert result.cost_before == pytest.approx(evaluate(fit.lines.at(design.grid.path_m))[0], rel=1e-12)
    assert result.cost_after < 0.8 * result.cost_before
    assert evaluate(result.best.at(design.grid.path_m))[0] == pytest.approx(result.cost_after, rel=1e-3)
    assert gap_of(result.best) >= MINIMUM_GAP_M_S - 1e-12
    assert result.evaluations <= 40


@pytest.mark.parametrize("error", [-1.0, 1e3])
def test_a_polish_that_opening_spoils_leaves_the_lines_as_they_were(
    design: Chain, fit: Fit, monkeypatch: pytest.MonkeyPatch, error: float
) -> None:
    """On a grid too coarse, lines a hair's breadth from good ones may cost less than nothing."""
    nodes, exact = design.grid.path_m, evaluate_on(design)
    moved = replace(fit.lines, coefficients=fit.lines.coefficients + 0.1)
    at_moved = moved.at(nodes).upper_m_s

    def evaluate(lines: SwitchingLines) -> tuple[float, np.ndarray]:
        cost, by_lines = exact(lines)
        return error if np.array_equal(lines.upper_m_s, at_moved) else cost, by_lines

    monkeypatch.setattr("synth.solver.tuned_lines.opened", lambda lines: moved)
    result = polish(fit.lines, fit.curvature, nodes, evaluate, 25)
    assert result.best is fit.lines
    assert result.cost_after == result.cost_before > 0.0


def test_polish_ends_where_the_projected_gradient_is_small(design: Chain, fit: Fit) -> None:
    """A Newton step along the whitened gradient must not promise more than a few per cent of the cost."""
    evaluate = evaluate_on(design)
    best = polish(fit.lines, fit.curvature, design.grid.path_m, evaluate, 40).best
    gains = []
    for lines in (fit.lines, best):
        cost, by_lines = evaluate(lines.at(design.grid.path_m))
        by_lower, by_upper = (each.T for each in by_lines)
        matrix = np.asarray(np.polynomial.legendre.legvander(2 * design.grid.path_m[:-1] / lines.exit_m - 1, 3), float)
        free = np.nonzero(lines.has_line)
        gradient = np.stack([by_lower @ matrix, by_upper @ matrix], axis=1)[free] / cost
        scale = whitening(fit.curvature[free], matrix, cost)
        gains.append(0.5 * float((np.einsum("lab,la->lb", scale, gradient) ** 2).sum()))
    assert gains[1] < 0.2 * gains[0]


def test_a_higher_degree_fits_no_worse_in_its_own_weights(design: Chain) -> None:
    """Least squares over a larger space; the lowest line of the top stage has no partner to be kept off."""
    solution = solve(design, Aim(TARGET_M_S, CRITERION))
    _, occupancy = density_and_occupancy(design, solution.lines)
    raw = solution.lines.lower_m_s[2, :-1]
    known = np.isfinite(raw)
    misfits = []
    for degree in (1, 3, 6):
        found = fit_lines(solution, occupancy.samples, degree)
        line, curvature = found.lines.at(design.grid.path_m[:-1]).lower_m_s[2], found.curvature[2, 0]
        weight = curvature[known] + 1e-3 * curvature[known].max()
        misfits.append(float((weight * (line - raw)[known] ** 2).sum()))
    assert misfits[0] > misfits[1] > misfits[2]


GENERATOR = Generator("retarder-synth", "0.1.0", "0" * 64)


def cubic(plant: Plant, gap_m_s: float) -> PolynomialLines:
    """Falling lines `gap_m_s` apart for all stages that the plant may use."""
    stages = plant.top_stage + 1
    coefficients = np.zeros((stages, 2, 4))
    coefficients[:, :, 0] = 3.1 + 0.1 * np.arange(stages)[:, None] + np.array([0.0, gap_m_s])
    coefficients[:, :, 1], coefficients[:, :, 3] = -0.3, 0.0123456789
    has_line = np.ones((stages, 2), dtype=bool)
    has_line[0, 0] = has_line[-1, 1] = False
    return PolynomialLines(plant.start_m, plant.exit_m, coefficients, has_line)


def table_of(plant: Plant, gap_m_s: float = 0.3) -> ControllerTable:
    unknown = Predicted(0.0, 0.0, 0.0, 0.0)
    return tabulate(plant, cubic(plant, gap_m_s), 3.0, unknown, GENERATOR, "t", "2026-11-20T00:00:00Z")


def test_lines_survive_rounding_to_single_precision(plant_52t: Plant) -> None:
    s = np.linspace(0.0, plant_52t.exit_m, 77)
    exported, wanted = lines_of(table_of(plant_52t), s), cubic(plant_52t, 0.3).at(s)
    finite = np.isfinite(wanted.upper_m_s)
    assert np.array_equal(np.isfinite(exported.upper_m_s), finite)
    assert exported.upper_m_s[finite] == pytest.approx(wanted.upper_m_s[finite], abs=5e-6)


@pytest.mark.requirement("RULE-09")
def test_a_forbidden_stage_is_left_at_once_and_never_entered(plant_22t: Plant) -> None:
    table = table_of(plant_22t)
    top = plant_22t.top_stage
    assert len(table.stages) == plant_22t.position.top_stage + 1 > top + 1
    assert table.stages[top].upper is None
    for v in (0.5, 3.0, 8.9):
        assert decide_for(table, top, 10.0, v) <= top
        for k in range(top + 1, len(table.stages)):
            assert decide_for(table, k, 10.0, v) <= top


def test_touching_lines_are_refused(plant_52t: Plant) -> None:
    with pytest.raises(InvalidTable):
        table_of(plant_52t, gap_m_s=0.0)


def test_the_staircase_of_the_sensor_is_the_exact_quantisation(plant_of: Callable[[float], Plant]) -> None:
    """P(round((v + noise)/q)·q > line), by the definition of rounding, against the command probabilities."""
    plant = plant_of(52.0)
    design = persistent_chain(
        plant, Resolution(path_step_m=4.0, speed_step_m_s=0.1, friction_nodes=1, resistance_nodes=1)
    )
    nodes = design.grid.path_m
    level = 3.017
    shape = (design.actuator.stages, len(nodes))
    upper = np.full(shape, level)
    upper[-1] = np.inf
    below_top = design.actuator.stages - 2  # all stages have one line: from here a command goes one stage
    found = commands_of(design.quantised(), SwitchingLines(nodes, np.full(shape, -np.inf), upper))[1, 0, below_top]
    q, noise = plant.sensor.resolution_m_s, plant.sensor.noise_m_s
    z = np.random.default_rng(5).normal(size=40_000)
    near = np.abs(design.grid.speed_m_s - level) < 0.15
    for v, p in zip(design.grid.speed_m_s[near], found[near], strict=True):
        simulated = (np.rint((v + noise * z) / q) * q > level).mean()
        assert p == pytest.approx(simulated, abs=4 * np.sqrt(0.25 / len(z)))


@pytest.mark.requirement("PRED-02")
def test_a_stall_counts_as_an_exit_at_rest() -> None:
    """By hand: 0.1 of the cuts stand, the others leave with 1, 2 and 3 m/s."""
    density = ExitDensity(np.arange(4.0), np.array([0.0, 0.25, 0.5, 0.15]), stalled=0.1, escaped=0.0, switchings=1.0)
    exits_m_s = np.repeat([0.0, 1.0, 2.0, 3.0], [10, 25, 50, 15])
    predicted = prediction_of(density, 2.0)
    assert predicted.bias_m_s == pytest.approx((exits_m_s - 2.0).mean())
    assert predicted.rms_m_s == pytest.approx(np.sqrt(((exits_m_s - 2.0) ** 2).mean()))
    assert (predicted.p_stall, predicted.switchings) == (0.1, 1.0)
