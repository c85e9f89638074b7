"""Tails by the forward density: the quadrature, and agreement with three ways of simulating a small plant."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.special import ndtr

from plant_models import (
    Cut,
    DopplerSensor,
    EntrySpeed,
    Friction,
    Plant,
    Pneumatics,
    PressingForce,
    RetarderPosition,
    RollingResistance,
    TrackProfile,
)
from synth.problem.resolution import Resolution
from synth.simulation.closed_loop import TableController, close_loop, simulate_many
from synth.simulation.exit_statistics import exit_statistics
from synth.simulation.random_passes import random_passes
from synth.studies.rare_events.adaptive_simpson import adaptive_simpson
from synth.studies.rare_events.cross_entropy import Pilot, learn, mixture_of
from synth.studies.rare_events.importance_sampling import weighted_passes
from synth.studies.rare_events.pass_coordinates import path_work_coordinates
from synth.studies.rare_events.pass_score import exit_error
from synth.studies.rare_events.subset_simulation import SubsetPlan, subset_tails
from synth.studies.rare_events.tail_density import TailGrid, normal_cdf, predicted_tails, tail_integral
from synth.studies.rare_events.tail_probability import crude_tail
from tuning_tables import (
    ControllerTable,
    CutId,
    Generator,
    Predicted,
    RetarderId,
    Stage,
    ValidRange,
    round_coefficients,
)

TARGET_M_S = 3.0
MARGINS_M_S = (0.3, 0.5, 0.7)
DESIGN = Resolution(path_step_m=0.5, speed_step_m_s=0.06, friction_nodes=4, resistance_nodes=1)


def weak_plant() -> Plant:
    """One 12 m retarder, two stages, a short cut: two in a thousand leave too fast by 0.3 m/s."""
    position = RetarderPosition(
        name="weak",
        zones_m=((0.0, 12.0),),
        stage_pressures_kpa=(0.0, 200.0, 400.0),
        force=PressingForce(0.038, 50.0, (1.0, 0.9)),
        pneumatics=Pneumatics(700.0, 0.0, 0.07, 0.12, 0.09, 0.25, 0.2, 15.0),
        max_entry_speed_m_s=7.0,
    )
    return Plant(
        position=position,
        cut=Cut("С", 20.0, (0.0, 1.5), 2),
        profile=TrackProfile.uniform(8.0),
        friction=Friction(0.15, 0.0, 0.10, 2.0),
        resistance=RollingResistance(1.5, 0.5),
        sensor=DopplerSensor(0.05, 0.04, 0.1, 0.02),
        entry=EntrySpeed(4.0, 5.0),
    )


def table_of(plant: Plant) -> ControllerTable:
    """Straight lines that fall along the path, stages 1 and 2 kept apart."""
    pressures, length = plant.position.stage_pressures_kpa, plant.exit_m
    lines = ((None, (3.3, -0.2)), ((3.0, -0.1), (4.0, -0.85)), ((3.6, -0.6), None))

    def rounded(line: tuple[float, float] | None) -> tuple[float, ...] | None:
        return None if line is None else round_coefficients((line[0], line[1] / length))

    return ControllerTable(
        id="weak-3",
        created="2026-11-20T22:46:00Z",
        generator=Generator("test", "0", "ab" * 32),
        retarder=RetarderId("weak", plant.position.zones_m, length, plant.position.pneumatics.dead_band_kpa),
        cut=CutId(plant.cut.category, plant.cut.mass_t, plant.cut.axle_offsets_m),
        target_speed_m_s=TARGET_M_S,
        degree=1,
        stages=tuple(Stage(k, pressures[k], rounded(low), rounded(up)) for k, (low, up) in enumerate(lines)),
        valid=ValidRange((0.0, length), (0.3, 9.0)),
        predicted=Predicted(0.05, 0.0, 0.0, 4.0),
    )


def test_simpson_integrates_a_step_among_smooth_functions() -> None:
    """∫ φ, ∫ φ·Φ((x + 2)/0.05) and a cubic, closed forms; the measured error bounds the true one."""

    def integrand(x: NDArray[np.float64]) -> NDArray[np.float64]:
        density = np.exp(-0.5 * x**2) / math.sqrt(2.0 * math.pi)
        return np.stack([density, density * ndtr(-(x + 2.0) / 0.05), x**3], axis=1)

    found = adaptive_simpson(integrand, -6.0, 6.0, 10, tolerance=1e-4, floor=1e-6)
    exact = np.array([1.0 - 2.0 * float(ndtr(-6.0)), float(ndtr(-2.0 / math.hypot(1.0, 0.05))), 0.0])
    wrong = np.abs(found.value - exact)
    assert (wrong <= found.error + 1e-12).all()
    assert (wrong[:2] < 1e-5 * exact[:2]).all()
    coarse = adaptive_simpson(integrand, -6.0, 6.0, 10, tolerance=1e-2, floor=1e-6)
    assert coarse.points < found.points
    assert coarse.error[1] > found.error[1]


def test_normal_law_far_out() -> None:
    for z in (-8.0, -4.667, 0.0, 3.0):
        assert normal_cdf(z) == pytest.approx(float(ndtr(z)), rel=1e-12)


def test_four_ways_agree_where_plain_simulation_sees_the_event() -> None:
    """At 2e-3 to 2e-4, 100 000 plain passes: no pair of methods is more than 1.7 intervals apart (3.3 σ)."""
    plant = weak_plant()
    table = table_of(plant)
    controller = TableController(table)
    loop = close_loop(plant, controller.stages)
    score, coordinates = exit_error(loop, controller, TARGET_M_S), path_work_coordinates(loop)
    plain = simulate_many(plant, controller, 21, 100_000, threads=2, row=random_passes)
    over = plain.exit_speed_m_s - TARGET_M_S
    learnt = learn(score, coordinates, MARGINS_M_S, 22, Pilot(passes=2000), threads=2)
    weighted = weighted_passes(score, coordinates, mixture_of(learnt), 23, 20_000, threads=2)
    plan = SubsetPlan(replicates=12, particles=500, moves=3)
    subset = subset_tails(score, len(coordinates.direction), MARGINS_M_S, 24, plan, threads=2)
    density = predicted_tails(plant, table, MARGINS_M_S, DESIGN, threads=2)
    for i, margin in enumerate(MARGINS_M_S):
        ways = (
            crude_tail(margin, int(np.count_nonzero(over > margin)), len(over)),
            weighted.tail(margin), subset.tails[i], density.tails[i],
        )  # fmt: skip
        print("; ".join(f"{w.method} {w.probability:.3e} [{w.low:.3e}, {w.high:.3e}]" for w in ways))
        for one, other in itertools.combinations(ways, 2):
            assert one.gap(other) < 1.7, f"over {margin}: {one} against {other}"
    assert 1e-3 < density.tails[0].probability < 4e-3
    assert density.errors[0].bound < 0.05 * density.tails[0].probability
    assert weighted.effective_passes(0.3) > 2000
    rms, figures = weighted.root_mean_square(), exit_statistics(plain, TARGET_M_S)
    spread = [math.log(x[1] / x[0]) / 3.92 for x in (rms.rms_ci95_m_s, figures.rms_ci95_m_s)]
    assert abs(math.log(rms.rms_m_s / figures.rms_m_s)) < 4.0 * math.hypot(*spread)


def test_density_of_known_friction_needs_no_quadrature_and_knows_never_and_always() -> None:
    plant = replace(weak_plant(), friction=Friction(0.0, 0.0, 0.05, 2.0))
    found = predicted_tails(plant, table_of(plant), (-2.0, 2.5), DESIGN, threads=2)
    always, never = found.tails
    assert always.probability == pytest.approx(1.0, abs=1e-6)
    assert always.high == 1.0
    assert never.low == 0.0
    assert never.high < 1e-6
    assert all(errors.quadrature == 0.0 for errors in found.errors)


def test_density_gives_the_same_bytes_for_any_number_of_threads() -> None:
    plant = weak_plant()
    limits, grid = TARGET_M_S + np.array(MARGINS_M_S), TailGrid(DESIGN, 1)
    one, two = (tail_integral(plant, table_of(plant), limits, grid, threads) for threads in (1, 2))
    assert one.probability.tobytes() == two.probability.tobytes()
    assert (one.lost, one.scenarios) == (two.lost, two.scenarios)
