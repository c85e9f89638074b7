"""The coarse simulation against closed forms, the production simulator, and itself; and its false alarms."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path
from random import Random

import pytest

from plant_models import Pneumatics
from synth.checker.brake_drive import BrakeDrive
from synth.checker.claims import Honesty, simulated_faults
from synth.checker.coarse_simulation import Passes, friction_row, ground_of, simulate
from synth.checker.entry import Uniform
from synth.checker.plant import Drive, Plant, config_sha256
from synth.checker.statistics import FALSE_ALARM, binomial_tail, figures_of
from synth.checker.summary import Summary, read_summary
from synth.checker.table_reading import Table, read_table

DRIVE = Drive(700.0, 0.0, 0.1, 0.2, 0.1, 0.3, 0.25, 15.0, 0.0, 50.0)


@pytest.fixture(scope="module")
def summary(tuned_once: Path) -> Summary:
    return read_summary(tuned_once / "summary.json")


@pytest.fixture(scope="module")
def table(tuned_once: Path) -> Table:
    return read_table(max((tuned_once / "tables").glob("*.json")).read_bytes())


@pytest.fixture(scope="module")
def plant(summary: Summary, table: Table) -> Plant:
    return summary.plant(table)


def test_configuration_hashes_as_the_tables_say(summary: Summary, table: Table) -> None:
    assert config_sha256(summary.config) == summary.config_sha256 == table.config_sha256


@pytest.mark.parametrize("closing_delay_s", [0.0, 0.03])
@pytest.mark.parametrize(
    ("start", "goal"), [(15.0, 150.0), (15.0, 600.0), (585.0, 450.0), (165.0, 0.0), (150.0, 150.0)]
)
def test_pressure_moves_as_the_documented_drive(start: float, goal: float, closing_delay_s: float) -> None:
    """Against the plant's own history, in closed form: the end, its time, and the integral within coarseness."""
    drive = BrakeDrive(dataclasses.replace(DRIVE, closing_delay_s=closing_delay_s), start)
    history = Pneumatics(700.0, 0.0, 0.1, 0.2, 0.1, 0.3, 0.25, 15.0, closing_delay_s).respond(start, goal, 50.0)
    drive.command(goal, 0.02)
    time, area, step = 0.0, 0.0, 0.005
    while not drive.resting:
        area += drive.overpressure(step) * step
        time += step
    assert time == pytest.approx(0.02 + history.duration_s, abs=step + 1e-6)
    assert drive.pressure_kpa == pytest.approx(history.end_kpa, abs=1e-6)
    import numpy as np

    before = 0.02 * max(0.0, start - 50.0)
    exact = before + float(history.overpressure_integral(np.array([time - 0.02]), 50.0)[0])
    assert area == pytest.approx(exact, rel=2e-3, abs=0.02)


def deterministic(plant: Plant) -> Plant:
    """No chance left but the first sample."""
    return dataclasses.replace(
        plant,
        friction_cv=0.0,
        axle_cv=0.0,
        path_std=0.0,
        noise_m_s=0.0,
        resistance_n_kn=(plant.resistance_n_kn[0], 0.0),
        entry=Uniform(3.0, 3.0),
    )


def test_a_cut_that_is_never_braked_rolls_as_energy_says(plant: Plant, table: Table) -> None:
    line = (20.0, *[0.0] * table.degree)
    free = dataclasses.replace(table, lines=((None, line), (line, None), *[(line, None)] * (len(table.lines) - 2)))
    passes = simulate(deterministic(plant), free, 5, 1)
    reduced = 9.81 * plant.mass_t / (plant.mass_t + 0.42 * 4) * 1e-3
    exact = math.sqrt(9.0 + 2.0 * reduced * (plant.grades[0][1] - plant.resistance_n_kn[0]) * plant.exit_m)
    assert passes.exit_m_s == pytest.approx([exact] * 5, rel=1e-9)
    assert passes.switchings == (0,) * 5


def test_a_cut_that_is_always_braked_stalls(plant: Plant, table: Table) -> None:
    zero = (0.0,) * (table.degree + 1)
    lines = ((None, zero), *[(None, zero)] * (len(table.lines) - 2), (None, None))
    stuck = simulate(deterministic(plant), dataclasses.replace(table, lines=lines), 3, 1)
    assert stuck.stalled == (True,) * 3
    assert stuck.exit_m_s == (0.0,) * 3


def test_friction_has_the_stated_spread_and_memory(plant: Plant) -> None:
    varied = dataclasses.replace(plant, friction_cv=0.0, axle_cv=0.0, path_std=0.1)
    ground, random = ground_of(varied), Random(5)
    rows = [friction_row(varied, ground, 0.0, random) for _ in range(3000)]
    first = [row[0] - 1.0 for row in rows]
    lag = round(varied.correlation_m / ground.noise_cell_m)
    later = [row[lag] - 1.0 for row in rows]
    variance = sum(x * x for x in first) / len(first)
    assert math.sqrt(variance) == pytest.approx(0.1, rel=0.05)
    memory = math.exp(-lag * ground.noise_cell_m / varied.correlation_m)
    assert sum(a * b for a, b in zip(first, later, strict=True)) / len(first) / variance == pytest.approx(
        memory, abs=0.06
    )


def test_same_seed_same_passes(plant: Plant, table: Table) -> None:
    assert simulate(plant, table, 20, 3) == simulate(plant, table, 20, 3)
    assert simulate(plant, table, 20, 3) != simulate(plant, table, 20, 4)


@pytest.fixture(scope="module")
def many(plant: Plant, table: Table) -> Passes:
    return simulate(plant, table, 4000, 9)


def test_agrees_with_the_production_simulator(many: Passes, table: Table) -> None:
    """Two samples of 4 000 passes: within four standard errors and one percent of coarseness."""
    found = figures_of(many, table.target_m_s)
    assert table.validated_rms_m_s is not None
    assert table.validated_ci95_m_s is not None
    own = found.square_std / found.mean_square / 2.0 / math.sqrt(found.passes)
    stated = math.log(table.validated_ci95_m_s[1] / table.validated_ci95_m_s[0]) / 2.0 / 1.96
    difference = math.log(found.rms_m_s / table.validated_rms_m_s)
    assert abs(difference) < 4.0 * math.hypot(own, stated) + 0.01


def test_true_claims_are_not_doubted(many: Passes, table: Table) -> None:
    """1 000 samples of 300 passes: none is doubted; five would be too many for a chance of 1e-3 (5e-3 at the level)."""
    random, doubted = Random(2), 0
    for _ in range(1000):
        chosen = [random.randrange(4000) for _ in range(300)]
        sample = Passes(*(tuple(column[i] for i in chosen) for column in vars(many).values()))
        doubted += any(simulated_faults(table, figures_of(sample, table.target_m_s), Honesty(0.8, 1.25)))
    assert binomial_tail(doubted, 1000, FALSE_ALARM) > 5e-3


@pytest.mark.parametrize(
    ("hits", "n", "p"), [(0, 10, 0.2), (3, 10, 0.2), (10, 10, 0.9), (7, 300, 0.01), (40, 20_000, 1e-3)]
)
def test_binomial_tail_is_that_of_scipy(hits: int, n: int, p: float) -> None:
    from scipy.stats import binom

    assert binomial_tail(hits, n, p) == pytest.approx(float(binom.sf(hits - 1, n, p)), rel=1e-9)
