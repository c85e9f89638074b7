"""The foreign plant keeps energy, rolls and brakes as closed forms say, and agrees with `solve_ivp`."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from tests.studies.identification.foreign import foreign_motion as motion
from tests.studies.identification.foreign.foreign_draws import ForeignDraw, foreign_draw
from tests.studies.identification.foreign.foreign_pass import STEP_S, PlantInMotion, plant_at_rest
from tests.studies.identification.foreign.foreign_plant import ForeignPlant, neighbour_of_knp5

Floats = NDArray[np.float64]

PLANT = neighbour_of_knp5(52.0, "С", (0.0, 1.85, 8.65, 10.5))
DRAW = foreign_draw(PLANT, 3, 0)
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


@pytest.mark.long
def test_a_free_roll_is_the_closed_form_of_quadratic_resistance() -> None:
    plant = level(PLANT)
    moving = plant_at_rest(plant, DRAW)
    status, _ = moving.roll(60.0)
    cut, g = plant.cut, 9.81 * 52.0 / (52.0 + 4 * 0.42)
    a, b = DRAW.resistance * cut.resistance_n_per_kn, DRAW.resistance * cut.resistance_n_per_kn_per_m2_s2
    settled = (8.0 - a) / b  # square of the speed at which it would roll for ever
    length = plant.exit_m - plant.track.seen_from_m
    square = settled + (DRAW.entry_m_s**2 - settled) * math.exp(-2e-3 * g * b * length)
    assert status == motion.GONE
    assert moving.y[motion.PATH] == plant.exit_m
    assert moving.y[motion.SPEED] == pytest.approx(math.sqrt(square), abs=1e-9)


@pytest.mark.long
def test_a_cut_stops_where_a_constant_force_stops_it() -> None:
    brake = replace(PLANT.brake, friction_rise_m_s=0.0, path_std=0.0)
    plant = replace(level(PLANT), brake=brake, cut=replace(PLANT.cut, resistance_n_per_kn_per_m2_s2=0.0))
    plant = replace(plant, track=replace(plant.track, zones_m=((-50.0, 50.0),)))
    moving = plant_at_rest(plant, DRAW)
    moving.y[motion.CYLINDER] += 450.0
    moving.command(450.0)
    status, time = moving.roll(60.0)
    force = 4 * DRAW.friction * brake.clamp_kn_per_kpa * (450.0 - brake.touch_kpa) * brake.friction
    drive = 9.81e-3 * 52.0 * (8.0 - DRAW.resistance * plant.cut.resistance_n_per_kn)
    slowing = (force - drive) / (52.0 + 4 * 0.42)
    assert status == motion.STANDING
    assert moving.y[motion.SPEED] == 0.0
    assert time == pytest.approx(DRAW.entry_m_s / slowing, abs=1e-9)
    assert moving.y[motion.PATH] == pytest.approx(-4.0 + 0.5 * DRAW.entry_m_s**2 / slowing, abs=1e-9)


def eta(place: Floats, plant: ForeignPlant, draw: ForeignDraw) -> Floats:
    """Relative change of the friction along the path, by numpy."""
    waves = np.cos(np.multiply.outer(place, draw.wave_numbers_per_m) + draw.phases)
    return np.asarray(plant.brake.path_std * math.sqrt(2.0 / plant.brake.waves) * waves.sum(axis=-1))


def brake_force_kn(s: Floats, v: Floats, p: Floats, plant: ForeignPlant, draw: ForeignDraw) -> Floats:
    """The force of the beams as `ForeignBrake` states it, by numpy."""
    brake, soft = plant.brake, plant.brake.softness_kpa
    over = np.clip(p - brake.touch_kpa, -soft, np.inf)
    clamp = brake.clamp_kn_per_kpa * np.where(over < soft, (over + soft) ** 2 / (4.0 * soft), over)
    total = np.zeros_like(s)
    for offset in plant.cut.axle_offsets_m:
        place = s - offset
        for begin, end in plant.track.zones_m:
            x = np.clip(np.minimum(place - begin, end - place) / brake.flare_m, 0.0, 1.0)
            total += x * x * (3.0 - 2.0 * x) * (1.0 + eta(place, plant, draw))
    mu = brake.friction * (1.0 + brake.friction_rise_m_s / (v + brake.friction_speed_m_s))
    return np.asarray(draw.friction * clamp * mu * total)


@pytest.mark.long
def test_the_work_of_all_forces_is_the_change_of_kinetic_energy() -> None:
    draw, plant = DRAW, PLANT
    moving, now, rows = plant_at_rest(plant, draw, 1e-3), 0.0, []
    programme = list(PROGRAMME)
    for i in range(1, 5001):  # five seconds of changing pressure
        rows.append(moving.y.copy())
        moving.roll(1e-3)
        now = i * 1e-3
        if programme and now >= programme[0][0] - 1e-9:
            moving.command(plant.stage_pressures_kpa[programme.pop(0)[1]])
    assert not programme
    s, v, p = np.array(rows)[:, [motion.PATH, motion.SPEED, motion.CYLINDER]].T
    braking = brake_force_kn(s, v, p - plant.drive.atmosphere_kpa, plant, draw)
    cut = plant.cut
    specific = draw.resistance * (cut.resistance_n_per_kn + cut.resistance_n_per_kn_per_m2_s2 * v**2)
    places = s[:, None] - np.array(cut.axle_offsets_m)
    grade = np.interp(places, plant.track.knots_m, plant.track.grades_permille).mean(axis=1)
    force = 9.81e-3 * cut.mass_t * (grade - specific) - braking
    work = np.trapezoid(force * v, dx=1e-3)  # per time, the rows are evenly spaced in it
    kinetic = 0.5 * (cut.mass_t + 0.42 * 4) * (v[-1] ** 2 - v[0] ** 2)
    assert np.trapezoid(braking * v, dx=1e-3) > 200.0
    assert work == pytest.approx(kinetic, rel=1e-6)


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


def test_half_the_step_moves_nothing_and_the_order_is_four_where_forces_are_smooth() -> None:
    for number in range(5):
        draw = foreign_draw(PLANT, 3, number)
        speeds = [played(PLANT, draw, step)[0].y[motion.SPEED] for step in (STEP_S, 0.5 * STEP_S)]
        assert abs(speeds[0] - speeds[1]) < 1e-6
    ends = []
    for step in (0.08, 0.04, 0.02, 0.001):  # one retarder without flares ahead or behind: every force is smooth
        plant = replace(PLANT, track=replace(level(PLANT).track, zones_m=((-50.0, 90.0),)))
        moving = plant_at_rest(plant, DRAW, step)
        moving.y[motion.CYLINDER] += 300.0
        moving.command(300.0)
        moving.roll(1.6)
        ends.append(moving.y[motion.PATH])
    errors = np.abs(np.array(ends[:3]) - ends[3])
    assert (errors[:-1] / errors[1:] > 2.0**3.5).all()
