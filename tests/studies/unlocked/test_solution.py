"""What the sweep promises: against simulation, against the stage-locked solver, against itself with less freedom."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from plant_models import Plant, Pneumatics
from synth.problem.aim import Aim
from synth.problem.criterion import Criterion
from synth.problem.resolution import Resolution
from synth.simulation.random_passes import random_passes
from synth.solver.backward_induction import solve
from synth.solver.chain.chain import persistent_chain
from synth.solver.policy_density import exit_density
from synth.studies.unlocked.compact import Compact, Form, cost_of, fit_surfaces
from synth.studies.unlocked.laws import SurfaceController, at_rest_only
from synth.studies.unlocked.loop import unlocked_loop
from synth.studies.unlocked.solution import evaluate_unlocked, only_at_rest, solve_unlocked, unlocked_plant
from synth.studies.unlocked.surfaces import SwitchingSurfaces

TARGET_M_S = 3.0
CRITERION = Criterion()
KNOWN = Resolution(path_step_m=0.15, speed_step_m_s=0.01, friction_nodes=1)
GRID_ERROR = 0.01
"""Of a cost on this grid; halving both steps changes it by less."""


def quicker(plant: Plant, times: float) -> Plant:
    """Valves whose delays and time constants are divided."""
    valves = Pneumatics(700.0, 0.0, 0.1 / times, 0.2 / times, 0.1 / times, 0.3 / times, 0.3 / times, 15.0)
    return replace(plant, position=replace(plant.position, pneumatics=valves))


@pytest.mark.parametrize("locked", [False, True], ids=["unlocked", "locked"])
def test_the_cost_is_what_simulation_finds(plant: Plant, locked: bool) -> None:
    problem = unlocked_plant(plant, KNOWN)
    solved = solve_unlocked(only_at_rest(problem) if locked else problem, TARGET_M_S, CRITERION)
    loop = unlocked_loop(plant)
    sample = loop.run(SurfaceController(solved.surfaces), loop.draws(random_passes(21, 0, 20_000), cut_factor=1.0))
    price = (sample.exit_speed_m_s - TARGET_M_S) ** 2 + CRITERION.switching_tolerance_m2_s2 * sample.switchings
    half = 1.96 * float(price.std(ddof=1)) / np.sqrt(len(price))
    assert not sample.stalled.any()
    assert solved.cost_m2_s2 == pytest.approx(price.mean(), abs=half + GRID_ERROR * price.mean())
    again = evaluate_unlocked(problem, solved.surfaces, TARGET_M_S, CRITERION)
    assert again == pytest.approx(solved.cost_m2_s2, rel=1e-9)


def test_more_freedom_cannot_cost_more(plant: Plant) -> None:
    # One scenario and a sensor without noise: nothing is hidden, so the common policy is the optimum on the grid.
    open_book = replace(
        plant,
        friction=replace(plant.friction, path_std=0.0),
        sensor=replace(plant.sensor, noise_m_s=0.0),
    )
    problem = unlocked_plant(open_book, replace(KNOWN, path_levels=1))
    free = solve_unlocked(problem, TARGET_M_S, CRITERION).cost_m2_s2
    locked = solve_unlocked(only_at_rest(problem), TARGET_M_S, CRITERION).cost_m2_s2
    assert free < locked


def test_stage_locked_lines_cost_what_the_locked_solver_says(plant: Plant) -> None:
    # Two discretisations of one process: transients as one step, or sample by sample with the pressure as a state.
    resolution = replace(KNOWN, transient_substeps=4)
    transitions = persistent_chain(plant, resolution)
    lines = solve(transitions, Aim(TARGET_M_S, CRITERION)).lines
    density = exit_density(transitions, lines)
    theirs = density.rms_m_s(TARGET_M_S) ** 2 + CRITERION.switching_tolerance_m2_s2 * density.switchings
    problem = unlocked_plant(plant, resolution)
    ours = evaluate_unlocked(problem, at_rest_only(lines, problem.modes), TARGET_M_S, CRITERION)
    assert ours == pytest.approx(theirs, rel=GRID_ERROR)


def test_without_transients_there_is_nothing_to_unlock(plant: Plant) -> None:
    problem = unlocked_plant(quicker(plant, 50.0), replace(KNOWN, path_step_m=0.3, speed_step_m_s=0.03))
    assert problem.modes.rests.all()  # every transient ends within its period
    free = solve_unlocked(problem, TARGET_M_S, CRITERION)
    locked = solve_unlocked(only_at_rest(problem), TARGET_M_S, CRITERION)
    assert free.cost_m2_s2 == locked.cost_m2_s2
    assert (free.surfaces.upper_m_s == locked.surfaces.upper_m_s).all()


def test_a_fit_finds_lines_that_are_of_its_form(plant: Plant) -> None:
    modes = unlocked_plant(plant, KNOWN, 20.0).modes
    compact = Compact(plant.exit_m, Form((3, 0)), np.array([[False, True], [True, True], [True, False]]))
    rng = np.random.default_rng(5)
    true = 0.1 * rng.standard_normal((4, 5))
    true[:, 0] += (3.4, 3.2, 3.5, 3.3)
    controller = compact.controller(true.ravel())
    path = np.linspace(0.0, plant.exit_m, 61)
    u = 2.0 * path / plant.exit_m - 1.0
    x = 0.01 * (modes.pressure_kpa - np.asarray(plant.position.stage_pressures_kpa)[modes.stage])
    lines = np.array([-np.inf, np.inf])[:, None, None] * np.ones((2, len(x), len(path)))
    for side, m in np.ndindex(2, len(x)):
        if compact.has_line[modes.stage[m], side]:
            by_power = np.polynomial.polynomial.polyval(u, controller.coefficients[modes.stage[m], side].T)
            lines[side, m] = np.polynomial.polynomial.polyval(x[m], by_power)
    surfaces = SwitchingSurfaces(modes, path, lines[0], lines[1])
    loop, passes = unlocked_loop(plant), random_passes(3, 0, 300)
    assert fit_surfaces(compact, surfaces, loop, passes.part(0, 20)) == pytest.approx(true.ravel(), abs=1e-9)
    # Surfaces and polynomial are then one regulator, written twice, but for the straight lines between nodes.
    draws = loop.draws(passes)
    a, b = (loop.run(law, draws) for law in (controller, SurfaceController(surfaces)))
    assert np.mean(np.abs(a.exit_speed_m_s - b.exit_speed_m_s) < 1e-9) > 0.95
    assert cost_of(a, TARGET_M_S, CRITERION) == pytest.approx(cost_of(b, TARGET_M_S, CRITERION), rel=0.1)
