"""The coarse simulation against closed forms, the production simulator, and itself; and its false alarms."""

from __future__ import annotations

import dataclasses
import math
from itertools import pairwise
from pathlib import Path
from random import Random

import pytest

from plant_models import Pneumatics
from synth.checker.brake_drive import BrakeDrive
from synth.checker.claims import PredictionRatio, simulated_faults
from synth.checker.coarse_simulation import (
    Passes,
    decision,
    friction_row,
    ground_of,
    lost_readings,
    simulate,
    start_speed_m_s,
)
from synth.checker.drawn_cuts import Uniform
from synth.checker.estimator_sense import at, work_of
from synth.checker.plant import Drive, Plant, config_sha256
from synth.checker.statistics import FALSE_ALARM, binomial_tail, figures_of
from synth.checker.summary import Summary, read_summary
from synth.checker.table_reading import Table, read_table
from tests.checker.conftest import CONFIG, FROM_THE_ENTRANCE

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


@pytest.mark.parametrize(("share", "burst_s"), [(1.0 / 3.0, 0.6), (0.5, 0.1), (0.1, 2.0)])
def test_lost_readings_come_in_bursts_as_stated(plant: Plant, share: float, burst_s: float) -> None:
    lossy = dataclasses.replace(plant, missed_share=share, missed_burst_s=burst_s)
    losses = lost_readings(lossy, Random(5))
    lost = [next(losses) for _ in range(200_000)]
    mean = burst_s / plant.period_s
    bursts = sum(here and not after for here, after in pairwise([*lost, False]))
    cycles = len(lost) * share / mean
    assert sum(lost) / len(lost) == pytest.approx(share, rel=5.0 / math.sqrt(cycles))
    assert sum(lost) / bursts == pytest.approx(mean, rel=5.0 / math.sqrt(cycles))
    nothing = lost_readings(dataclasses.replace(plant, missed_share=0.0), Random(5))
    assert not any(next(nothing) for _ in range(100))


def test_lost_readings_cost_here_what_they_cost_in_the_simulator(summary: Summary, table: Table, plant: Plant) -> None:
    """Two simulators that know nothing of one another, without and with a third of the readings lost."""
    from synth.retarder.configuration.config_file import parse_config
    from synth.retarder.configuration.plant_values import with_values
    from synth.retarder.served_class import plant_for
    from synth.simulation.closed_loop import TableController
    from synth.simulation.closed_loop import simulate as simulate_passes
    from synth.simulation.exit_statistics import exit_statistics
    from synth.simulation.stratified_passes import stratified_passes
    from tuning_tables import read_json

    exported = read_json(summary.path.parent / "tables" / f"{table.id}.json")
    losses = {"sensor.missed_share": 1.0 / 3.0, "sensor.missed_burst_s": 0.6}
    figures = figures_of(
        simulate(dataclasses.replace(plant, missed_share=1.0 / 3.0, missed_burst_s=0.6), table, 1500, 3),
        table.target_m_s,
    )
    config = parse_config(f"{CONFIG}[regulator]\n{FROM_THE_ENTRANCE}", "x.toml")
    true = with_values(plant_for(exported, config, "x.toml")[1], losses)
    sample = simulate_passes(true, TableController(exported), stratified_passes(3, 0, 4000))
    found = exit_statistics(sample, table.target_m_s)
    assert found.rms_ci95_m_s[0] < figures.rms_ci95_m_s[1]
    assert figures.rms_ci95_m_s[0] < found.rms_ci95_m_s[1]
    without = figures_of(simulate(plant, table, 1500, 3), table.target_m_s)
    assert without.rms_ci95_m_s[1] < figures.rms_m_s


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


@pytest.mark.requirement("VERIFY-06")
def test_agrees_with_the_production_simulator(many: Passes, table: Table) -> None:
    """Two samples of 4 000 passes: within four standard errors and one percent of coarseness."""
    found = figures_of(many, table.target_m_s)
    assert table.validated_rms_m_s is not None
    assert table.validated_ci95_m_s is not None
    own = found.square_std / found.mean_square / 2.0 / math.sqrt(found.passes)
    stated = math.log(table.validated_ci95_m_s[1] / table.validated_ci95_m_s[0]) / 2.0 / 1.96
    difference = math.log(found.rms_m_s / table.validated_rms_m_s)
    assert abs(difference) < 4.0 * math.hypot(own, stated) + 0.01


@pytest.mark.requirement("VERIFY-02")
def test_true_claims_are_not_doubted(many: Passes, table: Table) -> None:
    """1 000 samples of 300 passes: none is doubted; five would be too many for a chance of 1e-3 (5e-3 at the level)."""
    random, doubted = Random(2), 0
    for _ in range(1000):
        chosen = [random.randrange(4000) for _ in range(300)]
        sample = Passes(*(tuple(column[i] for i in chosen) for column in vars(many).values()))
        doubted += any(simulated_faults(table, figures_of(sample, table.target_m_s), PredictionRatio(0.8, 1.25)))
    assert binomial_tail(doubted, 1000, FALSE_ALARM) > 5e-3


@pytest.mark.parametrize(
    ("hits", "n", "p"), [(0, 10, 0.2), (3, 10, 0.2), (10, 10, 0.9), (7, 300, 0.01), (40, 20_000, 1e-3)]
)
def test_binomial_tail_is_that_of_scipy(hits: int, n: int, p: float) -> None:
    from scipy.stats import binom

    assert binomial_tail(hits, n, p) == pytest.approx(float(binom.sf(hits - 1, n, p)), rel=1e-9)


@pytest.fixture(scope="module")
def far_plant(approached_once: Path) -> Plant:
    """With an approach of 4 m."""
    return read_summary(approached_once / "summary.json").plant(far_table_of(approached_once))


@pytest.fixture(scope="module")
def far_table(approached_once: Path) -> Table:
    return far_table_of(approached_once)


def far_table_of(tuned: Path) -> Table:
    return read_table(max((tuned / "tables").glob("*.json")).read_bytes())


def silent(table: Table) -> Table:
    """Lines that never ask for another stage, and no estimator."""
    high, low = (20.0, *[0.0] * table.degree), (-1.0, *[0.0] * table.degree)
    lines = ((None, high), *[(low, high)] * (len(table.lines) - 2), (low, None))
    return dataclasses.replace(table, lines=lines, estimator=None)


def test_a_cut_reaches_the_entrance_with_its_entry_speed(far_plant: Plant, far_table: Table) -> None:
    """Whatever the approach is like: the exit speed follows from the entry speed and the way from the entrance on."""
    steep = dataclasses.replace(deterministic(far_plant), grades=((-10.0, 9.0), (-1.5, -2.0), (6.0, 1.0)))
    count = 40_000
    way = [(i + 0.5) * steep.exit_m / count for i in range(count)]
    grade = math.fsum(map(steep.grade_permille, way)) * steep.exit_m / count
    reduced = 9.81 * steep.mass_t / (steep.mass_t + 0.42 * 4) * 1e-3
    exact = math.sqrt(9.0 + 2.0 * reduced * (grade - steep.resistance_n_kn[0] * steep.exit_m))
    passes = simulate(steep, silent(far_table), 5, 1)
    assert passes.exit_m_s == pytest.approx([exact] * 5, rel=2e-4)  # cells of 5 cm, with changes of grade inside


def test_a_cut_that_comes_from_a_steep_approach_begins_with_the_least_speed(far_plant: Plant, far_table: Table) -> None:
    steep = dataclasses.replace(deterministic(far_plant), grades=((-10.0, 150.0), (0.0, 1.0)))
    ground = ground_of(steep)
    assert start_speed_m_s(ground, 0.0, 2.0) == 0.3
    assert start_speed_m_s(ground, 0.0, 5.0) == pytest.approx(math.sqrt(25.0 - ground.approach_m2_s2), rel=1e-12)
    assert start_speed_m_s(ground_of(dataclasses.replace(steep, approach_m=0.0)), 0.0, 0.1) == 0.1


def test_the_brake_is_at_rest_in_the_initial_stage(far_plant: Plant, far_table: Table) -> None:
    """Entered from below, so at the lower edge of the dead band, from the beginning to the exit."""
    plant = dataclasses.replace(deterministic(far_plant), initial_stage=1, entry=Uniform(6.0, 6.0))
    work = work_of(plant)
    over = plant.stages_kpa[1] - plant.drive.band_kpa - plant.drive.touch_kpa
    square = 36.0 + 2.0 * (work.drive_m2_s2[-1] - at(work.s_m, work.drive_m2_s2, 0.0))
    exact = math.sqrt(square - 2.0 * over * work.brake_m2_s2_per_kpa[-1])
    assert over > 0.0
    assert simulate(plant, silent(far_table), 3, 1).exit_m_s == pytest.approx([exact] * 3, rel=3e-3)  # steps of 0.15 m


def test_before_the_entrance_no_stage_above_the_entrance_stage_is_commanded(far_table: Table) -> None:
    zero = (0.0,) * (far_table.degree + 1)
    top = len(far_table.lines) - 1
    always = dataclasses.replace(far_table, lines=(*[(None, zero)] * top, (None, None)))
    assert [decision(always, stage, -0.01, 3.0) for stage in (0, 1, 2)] == [1, 1, 2]
    assert [decision(always, stage, 0.0, 3.0) for stage in (0, 1, 2)] == [top, top, top]
    # A brake that is always raised fills earlier where it may begin 4 m ahead.
    assert decision(dataclasses.replace(always, entrance_stage=3), 1, -0.01, 3.0) == 3
    at_any_time = dataclasses.replace(always, at_any_time=True)
    assert [decision(at_any_time, stage, 0.0, 3.0) for stage in (0, 1, 2)] == [1, 2, 3]


@pytest.mark.parametrize("unknown_m_s", [-1.0, math.nan])
def test_without_a_speed_the_stage_stays(table: Table, unknown_m_s: float) -> None:
    """As the estimator answers before the first reading that it believes, and as a lost reading is."""
    every = range(len(table.lines))
    assert [decision(table, stage, 1.0, unknown_m_s) for stage in every] == [*every]
    assert decision(table, 1, 1.0, 0.0) == 0


@pytest.mark.long
def test_agrees_with_the_production_simulator_from_before_the_entrance(far_plant: Plant, far_table: Table) -> None:
    test_agrees_with_the_production_simulator(simulate(far_plant, far_table, 4000, 9), far_table)
