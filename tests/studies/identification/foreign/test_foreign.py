"""The foreign plant agrees with `solve_ivp`; its passes and logs are repeatable, noisy, and of the same cuts for
every table.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from tests.studies.identification.foreign import foreign_motion as motion
from tests.studies.identification.foreign.foreign_draws import ForeignDraw, foreign_draw
from tests.studies.identification.foreign.foreign_log import foreign_exits, foreign_log
from tests.studies.identification.foreign.foreign_pass import STEP_S, PlantInMotion, foreign_pass, plant_at_rest
from tests.studies.identification.foreign.foreign_plant import ForeignPlant, ForeignSensor, neighbour_of_knp5
from tuning_tables import ControllerTable

Floats = NDArray[np.float64]

PLANT = neighbour_of_knp5(52.0, "С", (0.0, 1.85, 8.65, 10.5))
PROGRAMME = ((0.9, 2), (1.7, 3), (2.6, 2), (3.7, 1), (4.9, 0))
"""Times since the radar saw the cut, and stages that the drive is set to then."""


def level(plant: ForeignPlant) -> ForeignPlant:
    """The same on a track of one grade, 8 permille."""
    return replace(plant, track=replace(plant.track, knots_m=(0.0,), grades_permille=(8.0,)))


def played(plant: ForeignPlant, draw: ForeignDraw, step_s: float) -> tuple[PlantInMotion, int, float]:
    """PROGRAMME played to the end of the pass: (plant there, status, time)."""
    moving, now = plant_at_rest(plant, draw, step_s), 0.0
    for time, stage in PROGRAMME:
        moving.roll(time - now)
        moving.command(plant.stage_pressures_kpa[stage])
        now = time
    status, used = moving.roll(60.0)
    return moving, status, now + used


def eta(place: Floats, plant: ForeignPlant, draw: ForeignDraw) -> Floats:
    """Relative change of the friction along the path, by numpy."""
    waves = np.cos(np.multiply.outer(place, draw.wave_numbers_per_m) + draw.phases)
    return np.asarray(plant.brake.path_std * math.sqrt(2.0 / plant.brake.waves) * waves.sum(axis=-1))


def by_solve_ivp(plant: ForeignPlant, draw: ForeignDraw) -> tuple[Floats, float]:
    """PROGRAMME with scipy's integrator and its events, the valve written once more: (state at the exit, time)."""
    laws, drive = motion.laws_of(plant, draw), plant.drive
    y = np.array([plant.track.seen_from_m, draw.entry_m_s, drive.atmosphere_kpa, laws.main_kpa, 0.0, 0.0])
    stage_kpa, left = [plant.stage_pressures_kpa[stage] for _, stage in PROGRAMME], [time for time, _ in PROGRAMME]
    now = 0.0

    def moved(until: float, direction: float, opening: float, event: Callable[[Floats], float]) -> bool:
        """Integrate to `until`, or to where `event` or the way to the exit falls through 0; whether it did."""
        nonlocal y, now

        def slopes(_: float, state: Floats) -> Floats:
            dy = np.empty(6)
            motion.rates(state, direction, opening, laws, dy)
            return dy

        def at_event(_: float, state: Floats) -> float:
            return event(state)

        def at_exit(_: float, state: Floats) -> float:
            return plant.exit_m - float(state[motion.PATH])

        for each in (at_event, at_exit):
            each.terminal, each.direction = True, -1.0  # type: ignore[attr-defined]  # as scipy asks for it
        found = solve_ivp(slopes, (now, until), y, events=(at_event, at_exit), rtol=1e-9, atol=1e-10, max_step=0.02)
        now, y = float(found.t[-1]), found.y[:, -1].copy()
        return bool(found.status == 1)

    def never(_: Floats) -> float:
        return 1.0

    for opened, (kpa, start) in enumerate(zip(stage_kpa, left, strict=True)):
        moved(start, 1.0, 0.0, never)
        sign = 1.0 if kpa > y[motion.CYLINDER] - drive.atmosphere_kpa else -1.0
        edge = kpa + drive.atmosphere_kpa - sign * drive.band_kpa

        def short(state: Floats, sign: float = sign, edge: float = edge) -> float:
            return sign * (edge - float(state[motion.CYLINDER]))

        delay = drive.fill_delay_s if sign > 0 else drive.exhaust_delay_s
        moved(start + delay + float(draw.valve_jitter_s[opened]), sign, 0.0, never)
        reached = moved(now + drive.opening_s, sign, 1.0 / drive.opening_s, short)
        if not reached:
            y[motion.OPEN] = 1.0
            assert moved(now + 5.0, sign, 0.0, short)
        moved(now + y[motion.OPEN] * drive.closing_s, sign, -1.0 / drive.closing_s, never)
        y[motion.OPEN] = 0.0
    assert moved(60.0, 1.0, 0.0, never)
    return y, now


@pytest.mark.parametrize("number", [0, 1, 2])
def test_the_integration_agrees_with_solve_ivp(number: int) -> None:
    draw = foreign_draw(PLANT, 3, number)
    moving, status, time = played(PLANT, draw, STEP_S)
    y, expected_s = by_solve_ivp(PLANT, draw)
    assert status == motion.GONE
    assert moving.y[motion.SPEED] == pytest.approx(y[motion.SPEED], abs=1e-6)
    assert moving.y[motion.CYLINDER] == pytest.approx(y[motion.CYLINDER], abs=1e-4)
    assert time == pytest.approx(expected_s, abs=5e-6)


Plants = Mapping[str, ForeignPlant]
Tables = Mapping[str, ControllerTable]


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


def test_tables_for_the_assumed_plant_work_there_but_not_as_well_as_they_claim(
    foreign_plants: Plants, assumed_tables: Tables
) -> None:
    exits = foreign_exits(assumed_tables["half"], foreign_plants["half"], 100, 9)
    assert not exits.stalled.any()
    assert 0.03 < exits.rms_m_s(3.0) < 0.2
