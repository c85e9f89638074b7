"""The closed loop, and two controllers that are made by hand.

Two controllers that are made by hand.
Closed loop: common random numbers, traces, and tables against lines.
"""

from __future__ import annotations

import math
import pickle
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from plant_models import Cut, Plant, RollingResistance
from synth.kernels.loop.closed_loop import run_passes
from synth.kernels.loop.passes import Draws
from synth.retarder.comparison.baselines import energy_rule
from synth.simulation.closed_loop import LineController, TableController, close_loop, simulate, simulate_many, trace
from synth.simulation.path_and_drive import cell_edges_m
from synth.simulation.random_passes import PATH_CELLS, RandomPasses
from synth.simulation.stratified_passes import stratified_passes
from synth.solver.switching_lines import SwitchingLines
from tests.synth.case_factory import make_table
from tuning_tables.json_file import read_json, write_json
from tuning_tables.stage import Stage, round_coefficients
from tuning_tables.table import ControllerTable


def energy_controller(plant: Plant, target_m_s: float) -> LineController:
    loop = close_loop(plant, plant.top_stage + 1)
    return energy_rule(loop, target_m_s, plant.top_stage, 0.8, 0.15, 0.0, 0.15)


def constant_lines(plant: Plant, lower: list[float], upper: list[float]) -> LineController:
    nodes = np.linspace(0.0, plant.exit_m, 2)
    return LineController(SwitchingLines(nodes, np.outer(lower, [1.0, 1.0]), np.outer(upper, [1.0, 1.0])))


def test_path_cells_carry_the_correlation_of_the_friction_process(plant_52t: Plant) -> None:
    path = close_loop(plant_52t, 5).path
    middle = 0.5 * (path.edges_m[1:] + path.edges_m[:-1])
    assert np.diff(path.edges_m).max() <= 0.5 + 1e-12
    assert path.eta_memory[0] == 0.0
    np.testing.assert_allclose(np.cumprod(path.eta_memory[1:]), np.exp(-(middle[1:] - middle[0]) / 2.0), rtol=1e-9)
    np.testing.assert_allclose(path.eta_fresh**2 + path.eta_memory**2, 1.0, rtol=1e-12)


@pytest.mark.parametrize("cars", [5, 60])
def test_long_cuts_fit_into_the_random_numbers_of_a_pass(plant_52t: Plant, cars: int) -> None:
    offsets = tuple(round(13.92 * car + x, 6) for car in range(cars) for x in (0.0, 1.85, 8.65, 10.5))
    plant = replace(plant_52t, cut=Cut("С", 52.0 * cars, offsets, 4))
    edges = cell_edges_m(plant)
    assert edges.size <= PATH_CELLS + 1
    assert edges[-1] == plant.exit_m
    assert np.all(np.diff(edges) > 5e-4)


@pytest.mark.requirement("PRED-09")
def test_threads_and_chunks_do_not_change_a_byte(plant_22t: Plant) -> None:
    controller = energy_controller(plant_22t, 2.0)
    whole = simulate_many(plant_22t, controller, seed=1, count=5300)
    threaded = simulate_many(plant_22t, controller, seed=1, count=5300, threads=2)
    later = simulate_many(plant_22t, controller, seed=1, count=3200, first_pass=2100)
    direct = simulate(plant_22t, controller, stratified_passes(1, 0, 5300))
    for name, array in vars(whole).items():
        assert array.tobytes() == getattr(threaded, name).tobytes()
        assert array.tobytes() == getattr(direct, name).tobytes()
        assert array[2100:].tobytes() == getattr(later, name).tobytes()


def test_known_friction_replaces_the_draw(plant_52t: Plant, passes: RandomPasses) -> None:
    controller = energy_controller(plant_52t, 3.0)
    loop = close_loop(plant_52t, 5)
    assert np.all(loop.draws(passes, 0.85).cut_factor == 0.85)
    drawn = loop.draws(passes).cut_factor
    i = int(np.argmin(np.abs(drawn - 0.85)))
    fixed = simulate(plant_52t, controller, passes.part(i, i + 1), cut_factor=float(drawn[i]))
    assert fixed.exit_speed_m_s[0] == simulate(plant_52t, controller, passes).exit_speed_m_s[i]


def test_resistance_follows_its_gamma_law(plant_52t: Plant, passes: RandomPasses) -> None:
    loop = close_loop(plant_52t, 5)
    w = loop.draws(passes).resistance_n_kn
    assert w.mean() == pytest.approx(1.40, abs=0.06)
    assert w.std() == pytest.approx(0.50, abs=0.05)
    known = close_loop(replace(plant_52t, resistance=RollingResistance(1.4, 0.0)), 5)
    assert np.all(known.draws(passes).resistance_n_kn == 1.4)


def test_trace_is_the_simulated_pass(plant_52t: Plant, passes: RandomPasses) -> None:
    controller = energy_controller(plant_52t, 3.0)
    sample = simulate(plant_52t, controller, passes)
    for i in (0, 3, 17):
        followed = trace(plant_52t, controller, passes, i)
        assert followed.exit_speed_m_s == sample.exit_speed_m_s[i]
        assert followed.time_s[-1] == sample.transit_time_s[i]
        assert np.count_nonzero(np.diff(followed.stage)) == sample.switchings[i]
        assert np.all(np.diff(followed.time_s) > 0)
        assert np.all(np.diff(followed.path_m) > 0)
        assert followed.path_m[-1] == plant_52t.exit_m
        measured = ~np.isnan(followed.measured_m_s)
        error = (followed.measured_m_s - followed.speed_m_s)[measured]
        assert 0.02 < error.std() < 0.09
        periods = np.diff(followed.time_s[measured]) / 0.1  # within a transient the regulator does not look
        assert periods == pytest.approx(np.rint(periods), abs=1e-6)
        assert periods.min() == pytest.approx(1.0)


def test_lead_releases_earlier(plant_52t: Plant, passes: RandomPasses) -> None:
    plain = constant_lines(plant_52t, [-math.inf] + [3.2] * 4, [3.2] * 4 + [math.inf])
    released = []
    for controller in (plain, replace(plain, lead_s=0.5)):
        followed = trace(plant_52t, controller, passes, 0)
        release = np.flatnonzero(np.diff(followed.stage) < 0)[0] + 1
        released.append(followed.speed_m_s[release])
    assert released[1] > released[0] + 0.2


def cubic_table(plant: Plant, target_m_s: float) -> ControllerTable:
    """The energy rule's lines as cubics."""
    lines = energy_controller(plant, target_m_s).lines
    cubic = np.polynomial.polynomial.polyfit(
        lines.nodes_m, np.where(np.isfinite(lines.upper_m_s), lines.upper_m_s, 0).T, 3
    )
    stages = []
    for k in range(lines.stages):
        upper = round_coefficients(cubic[:, k]) if k < lines.stages - 1 else None
        lower = round_coefficients(cubic[:, k - 1] - np.array([0.15, 0, 0, 0])) if k > 0 else None
        stages.append(Stage(k, plant.position.stage_pressures_kpa[k], lower, upper))
    return replace(make_table("cubic", plant, target_m_s), stages=tuple(stages))


def test_a_table_read_back_drives_the_loop_like_its_own_lines(
    plant_52t: Plant, passes: RandomPasses, tmp_path: Path
) -> None:
    write_json(cubic_table(plant_52t, 3.0), tmp_path / "table.json")
    table = read_json(tmp_path / "table.json")
    nodes = np.linspace(0.0, plant_52t.exit_m, 4001)
    dense = np.polynomial.polynomial.polyval(nodes, np.moveaxis(table.coefficients.astype(np.float64), -1, 0))
    lines = SwitchingLines(
        nodes,
        np.where(table.has_line[:, :1], dense[:, 0], -np.inf),
        np.where(table.has_line[:, 1:], dense[:, 1], np.inf),
    )
    by_table = simulate(plant_52t, TableController(table), passes)
    by_lines = simulate(plant_52t, LineController(lines), passes)
    # float32 against float64: a sample within 1e-6 m/s of a line may decide otherwise.
    same = by_table.exit_speed_m_s == by_lines.exit_speed_m_s
    assert same.mean() > 0.99
    assert by_table.switchings.mean() > 1.0
    assert np.abs(by_table.exit_speed_m_s - by_lines.exit_speed_m_s).max() < 0.3


def test_one_kernel_runs_whatever_made_the_arrays(plant_52t: Plant, passes: RandomPasses) -> None:
    """Tables of another process, and passes that may be written to: none has it compiled anew."""
    table, loop = cubic_table(plant_52t, 3.0), close_loop(plant_52t, 5)
    draws = loop.draws(passes)
    exits = loop.run(TableController(table), draws).exit_speed_m_s
    compiled = len(run_passes.signatures)
    again = loop.run(TableController(pickle.loads(pickle.dumps(table))), Draws(*map(np.array, draws))).exit_speed_m_s
    assert again.tobytes() == exits.tobytes()
    assert len(run_passes.signatures) == compiled


def test_controller_must_fit_the_loop(plant_52t: Plant, passes: RandomPasses) -> None:
    controller = constant_lines(plant_52t, [-math.inf] * 3, [math.inf] * 3)
    loop = close_loop(plant_52t, 5)
    with pytest.raises(ValueError, match="3 stages, the loop 5"):
        loop.run(controller, loop.draws(passes))
    with pytest.raises(ValueError, match="has 5"):
        close_loop(plant_52t, 6)
