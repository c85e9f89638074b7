"""Passes and logs of the foreign plant: locked, delayed, repeatable, the same cuts for every table."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest

from plant_models import Plant
from synth.retarder.estimation.estimator_design import estimator_of
from tests.studies.identification.foreign.foreign_draws import LONGEST_PASS_S, foreign_draw
from tests.studies.identification.foreign.foreign_log import foreign_exits, foreign_log
from tests.studies.identification.foreign.foreign_pass import STEP_S, foreign_pass
from tests.studies.identification.foreign.foreign_plant import SHORTEST_LAG_S, ForeignPlant, ForeignSensor
from tuning_tables import Approach, ControllerTable, ValidRange
from tuning_tables.estimator import begin
from tuning_tables.rule import decide_for, speed_for

Plants = Mapping[str, ForeignPlant]
Tables = Mapping[str, ControllerTable]

OPEN_GAUGE = ForeignSensor(gauge_noise_kpa=0.0)
"""A gauge without noise."""


def seen_through(plant: ForeignPlant) -> ForeignPlant:
    """The plant with a gauge that shows the true pressure nearly at once, so that rows tell what the drive does."""
    return replace(plant, sensor=OPEN_GAUGE, drive=replace(plant.drive, gauge_lag_s=SHORTEST_LAG_S))


@pytest.mark.long
@pytest.mark.parametrize("label", ["empty", "half"])
def test_the_table_decides_and_only_at_rest(label: str, foreign_plants: Plants, assumed_tables: Tables) -> None:
    plant, table = seen_through(foreign_plants[label]), assumed_tables[label]
    stages_kpa, band, commands, held_back = np.array(plant.stage_pressures_kpa), plant.drive.band_kpa, 0, 0
    for number in range(20):
        ran = foreign_pass(table, plant, foreign_draw(plant, 5, number))
        before = np.concatenate(([0], ran.stage[:-1]))
        decided = [
            decide_for(table, int(k), s, v) - k if s >= 0 else 0
            for k, s, v in zip(before, ran.path_m, ran.speed_m_s, strict=True)
        ]
        at_rest = np.abs(ran.pressure_kpa - stages_kpa[before]) <= band
        step = ran.stage - before
        assert at_rest[step != 0].all()
        assert (step[step != 0] == np.array(decided)[step != 0]).all()
        held_back += int(np.sum((np.array(decided) != 0) & (step == 0)))
        # With a rest of a whole period behind it, what the rule says is done.
        settled = at_rest & np.concatenate(([False], at_rest[:-1])) & np.concatenate(([False], step[:-1] == 0))
        assert (step[settled] == np.array(decided)[settled]).all()
        commands += int(np.sum(step != 0))
        assert ran.switchings == np.sum(step != 0)
    assert commands > 80
    assert held_back > 20


@pytest.mark.long
def test_a_command_reaches_the_brake_after_computing_and_valve_delay(
    foreign_plants: Plants, assumed_tables: Tables
) -> None:
    plant = seen_through(foreign_plants["half"])
    shortest = plant.sensor.computing_delay_s + plant.drive.fill_delay_s - plant.drive.delay_jitter_s
    assert 0.1 < shortest < 0.2
    late = replace(plant, sensor=replace(OPEN_GAUGE, computing_delay_s=0.09))
    for each, rows in ((plant, 1), (late, 2)):
        for number in range(10):
            ran = foreign_pass(assumed_tables["half"], each, foreign_draw(each, 5, number))
            first = int(np.argmax(ran.stage > 0))
            assert (ran.pressure_kpa[: first + rows + 1] == 0.0).all()
            assert ran.pressure_kpa[first + rows + 1] > 1.0


@pytest.mark.long
def test_the_same_seed_gives_the_same_bits_and_another_other_cuts(
    foreign_plants: Plants, assumed_tables: Tables
) -> None:
    log, again, other = (foreign_log(assumed_tables, foreign_plants, 6, seed) for seed in (1, 1, 2))
    assert log.cut_id == again.cut_id
    assert log.time_s.tobytes() == again.time_s.tobytes()
    assert log.speed_m_s.tobytes() == again.speed_m_s.tobytes()
    assert log.pressure_kpa.tobytes() == again.pressure_kpa.tobytes()
    assert log.speed_m_s.tobytes() != other.speed_m_s.tobytes()


def test_a_log_is_the_passes_whose_exits_are_told(foreign_plants: Plants, assumed_tables: Tables) -> None:
    log = foreign_log(assumed_tables, foreign_plants, 8, 4)
    assert sorted(log.cut_id) == sorted(f"{label}-{i}" for label in foreign_plants for i in range(8))
    assert list(log.cut_id) != sorted(log.cut_id)  # classes come mixed
    exits = {label: foreign_exits(assumed_tables[label], foreign_plants[label], 8, 4) for label in foreign_plants}
    period = foreign_plants["half"].sensor.period_s
    for number, cut_id in enumerate(log.cut_id):
        label, _, which = cut_id.rpartition("-")
        rows, plant = log.rows(number), foreign_plants[label]
        assert log.mass_t[number] == plant.cut.mass_t
        assert log.path_m[rows][0] < 0.0
        assert np.diff(log.time_s[rows]) == pytest.approx(period, abs=1e-9)
        # Less than a period before the exit the true speed is next to that of the exit.
        assert plant.exit_m - log.path_m[rows][-1] < period * 7.0
        assert abs(log.speed_m_s[rows][-1] - exits[label].speed_m_s[int(which)]) < 0.4
    assert (np.diff(log.time_s) > 0.0).all()
    assert log.time_s / period == pytest.approx(np.rint(log.time_s / period), abs=1e-6)


def test_without_gauge_the_log_has_no_pressure_and_all_else_is_the_same(
    foreign_plants: Plants, assumed_tables: Tables
) -> None:
    blind = {
        label: replace(plant, sensor=replace(plant.sensor, has_gauge=False)) for label, plant in foreign_plants.items()
    }
    log, without = (foreign_log(assumed_tables, plants, 3, 4) for plants in (foreign_plants, blind))
    assert log.has_gauge
    assert not without.has_gauge
    assert log.speed_m_s.tobytes() == without.speed_m_s.tobytes()


def test_the_radar_is_noisy_and_rounded_and_the_path_has_its_own_error(
    foreign_plants: Plants, assumed_tables: Tables
) -> None:
    plant = replace(foreign_plants["half"], sensor=replace(ForeignSensor(), path_noise_m=0.02))
    table = assumed_tables["half"]
    ran = [foreign_pass(table, plant, foreign_draw(plant, 6, number)) for number in range(20)]
    error = np.concatenate([each.speed_m_s - each.true_speed_m_s for each in ran])
    counts = np.concatenate([each.speed_m_s for each in ran]) / 0.04
    assert counts == pytest.approx(np.rint(counts), abs=1e-9)
    assert np.std(error) == pytest.approx(np.hypot(0.06, 0.04 / np.sqrt(12.0)), rel=0.1)
    draws = [foreign_draw(plant, 6, number).path_z for number in range(20)]
    exact = [foreign_pass(table, foreign_plants["half"], foreign_draw(plant, 6, number)) for number in range(20)]
    shift = np.array([a.path_m[:5] - b.path_m[:5] for a, b in zip(ran, exact, strict=True)])  # ahead of any command
    assert shift == pytest.approx(0.02 * np.array(draws)[:, :5], abs=1e-9)


def test_cuts_differ_as_their_laws_say(foreign_plants: Plants) -> None:
    plant = foreign_plants["half"]
    draws = [foreign_draw(plant, 7, number) for number in range(2000)]
    friction, resistance = (np.array([getattr(d, name) for d in draws]) for name in ("friction", "resistance"))
    assert friction.mean() == pytest.approx(1.0, abs=4 * 0.18 / 2000**0.5)
    assert friction.std() == pytest.approx(0.18, rel=0.1)
    assert np.log(friction).std() == pytest.approx(np.sqrt(np.log(1 + 0.18**2)), rel=0.08)
    assert resistance.std() == pytest.approx(0.35, rel=0.1)
    assert abs(np.corrcoef(friction, resistance)[0, 1]) < 0.1
    entry = np.array([d.entry_m_s for d in draws])
    assert entry.min() >= 5.0
    assert entry.max() <= 6.5
    places, amplitude = np.linspace(0.0, 30.0, 31), plant.brake.path_std * np.sqrt(2.0 / plant.brake.waves)
    eta = np.array([amplitude * np.cos(np.outer(places, d.wave_numbers_per_m) + d.phases).sum(axis=1) for d in draws])
    assert eta.std() == pytest.approx(0.12, rel=0.05)
    assert eta.min() > -1.0


def test_a_cut_that_is_braked_to_a_stand_has_stalled(foreign_plants: Plants, assumed_tables: Tables) -> None:
    plant, table = foreign_plants["empty"], assumed_tables["empty"]
    grip = replace(plant, brake=replace(plant.brake, friction=1.8, path_std=0.0))
    found = foreign_exits(table, grip, 10, 1)
    assert found.stalled.any()
    assert (found.speed_m_s[found.stalled] == 0.0).all()
    uphill = replace(plant, track=replace(plant.track, grades_permille=(-60.0, -60.0, -60.0)))
    ran = foreign_pass(table, uphill, foreign_draw(uphill, 1, 0))
    assert ran.stalled
    assert 0.0 < ran.end_s < LONGEST_PASS_S
    assert ran.time_s[-1] <= ran.end_s <= ran.time_s[-1] + plant.sensor.period_s


def test_the_step_of_the_integration_does_not_show_in_the_exits(foreign_plants: Plants, assumed_tables: Tables) -> None:
    plant, table = foreign_plants["half"], assumed_tables["half"]
    for number in range(10):
        draw = foreign_draw(plant, 8, number)
        coarse, fine = (foreign_pass(table, plant, draw, step).exit_speed_m_s for step in (STEP_S, 0.25 * STEP_S))
        assert abs(coarse - fine) < 1e-5  # none of these passes has a reading on the edge of a line


def test_tables_for_the_assumed_plant_work_there_but_not_as_well_as_they_claim(
    foreign_plants: Plants, assumed_tables: Tables
) -> None:
    exits = foreign_exits(assumed_tables["half"], foreign_plants["half"], 100, 9)
    assert not exits.stalled.any()
    assert 0.03 < exits.rms_m_s(3.0) < 0.2


def test_a_table_with_approach_acts_ahead_of_the_entrance(foreign_plants: Plants, assumed_tables: Tables) -> None:
    plant, table = foreign_plants["half"], assumed_tables["half"]
    ahead = replace(table, approach=Approach(3.0, 1), valid=ValidRange((-3.0, plant.exit_m), table.valid.v_m_s))
    ran = [foreign_pass(ahead, plant, foreign_draw(plant, 5, number)) for number in range(10)]
    before = np.concatenate([each.stage[each.path_m < 0.0] for each in ran])
    assert before.max() == 1
    assert all((each.stage[each.path_m < -3.0] == 0).all() for each in ran)
    far = replace(table, approach=Approach(5.0, 1), valid=ValidRange((-5.0, plant.exit_m), table.valid.v_m_s))
    with pytest.raises(ValueError, match="sees less far"):
        foreign_pass(far, plant, foreign_draw(plant, 5, 0))


def test_the_estimator_of_a_table_sees_every_sample_and_the_gauge(
    foreign_plants: Plants, assumed_tables: Tables, plant_52t: Plant
) -> None:
    plant = seen_through(foreign_plants["half"])
    estimator = estimator_of(plant_52t)
    table = replace(assumed_tables["half"], estimator=estimator)
    commands = 0
    for number in range(10):
        ran, state, passed = foreign_pass(table, plant, foreign_draw(plant, 5, number)), begin(), 0.0
        stage = 0
        for i in range(len(ran.time_s)):
            over = max(0.0, ran.pressure_kpa[i] - estimator.touch_pressure_kpa)
            if ran.path_m[i] >= 0.0:
                mean = 0.5 * (over + passed)
                speed = speed_for(table, state, ran.path_m[i], ran.speed_m_s[i], mean)
                if ran.stage[i] != stage:
                    assert ran.stage[i] == decide_for(table, stage, ran.path_m[i], speed)
                    commands += 1
            passed, stage = over, int(ran.stage[i])
        assert ran.exit_speed_m_s == pytest.approx(3.0, abs=0.5)
    assert commands > 20


def test_a_table_of_other_stages_is_refused(foreign_plants: Plants, assumed_tables: Tables) -> None:
    plant = replace(foreign_plants["half"], stage_pressures_kpa=(0.0, 150.0, 300.0))
    with pytest.raises(ValueError, match="the table has 5 stages, the plant 3"):
        foreign_pass(assumed_tables["half"], plant, foreign_draw(plant, 1, 0))
