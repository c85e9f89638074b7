"""The laws of the foreign plant as compiled functions, and their integration in time.

Classical Runge-Kutta with a fixed step; a step ends early where a valve changes, at the exit and at a standstill, found
to rounding. `test_foreign_motion` holds it against scipy's `solve_ivp`. All that is compiled stands in
this one file, so that numba notices every change of it.

A state is (6,): path s of the first axle in m, speed v in m/s, absolute pressures of cylinder and supply line, pressure
at the gauge (gauge), in kPa, and how far the valve is open, 0 to 1.
A valve is (5,): mode, direction (+1 fills, -1 exhausts), time left in the mode, pressure of the stage, openings so far.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from tests.studies.identification.foreign.foreign_draws import ForeignDraw
from tests.studies.identification.foreign.foreign_plant import GRAVITY_M_S2, ForeignPlant

Floats = NDArray[np.float64]

PATH, SPEED, CYLINDER, LINE, GAUGE, OPEN = range(6)
MODE, DIRECTION, LEFT_S, STAGE_KPA, OPENINGS = range(5)
SHUT, WAITING, OPENING, OPENED, CLOSING = range(5)
MOVING, GONE, STANDING = range(3)

GAMMA = 1.4
CRITICAL = (2.0 / (GAMMA + 1.0)) ** (GAMMA / (GAMMA - 1.0))
"""Ratio of pressures, 0.528, below which the flow is choked."""
CHOKED = math.sqrt(GAMMA) * (2.0 / (GAMMA + 1.0)) ** (0.5 * (GAMMA + 1.0) / (GAMMA - 1.0))
LAMINAR = 0.99
"""Above this ratio the flow is taken as linear: the root would have no finite slope at equal pressures."""

BISECTIONS = 60


class Laws(NamedTuple):
    """Numbers of a plant and of one drawn cut; units as in `foreign_plant`, rates in 1/s, pressures absolute."""

    zones_m: Floats
    flare_m: float
    exit_m: float
    offsets_m: Floats
    knots_m: Floats
    grades_permille: Floats
    weight_kn: float
    inertia_t: float
    resistance_n_per_kn: float
    resistance_n_per_kn_per_m2_s2: float
    clamp_kn_per_kpa: float
    touch_kpa: float
    softness_kpa: float
    friction: float
    friction_rise_m_s: float
    friction_speed_m_s: float
    wave_numbers_per_m: Floats
    phases: Floats
    amplitude: float
    main_kpa: float
    atmosphere_kpa: float
    main_rate: float
    line_rate: float
    fill_rate: float
    exhaust_rate: float
    gauge_lag_s: float
    opening_s: float
    closing_s: float
    fill_delay_s: float
    exhaust_delay_s: float
    band_kpa: float
    valve_jitter_s: Floats


def laws_of(plant: ForeignPlant, draw: ForeignDraw) -> Laws:
    """The numbers of this pass."""
    track, cut, brake, drive = plant.track, plant.cut, plant.brake, plant.drive
    return Laws(
        np.array(track.zones_m), brake.flare_m, plant.exit_m, np.array(cut.axle_offsets_m),
        np.array(track.knots_m), np.array(track.grades_permille),
        GRAVITY_M_S2 * cut.mass_t, cut.inertia_t,
        draw.resistance * cut.resistance_n_per_kn, draw.resistance * cut.resistance_n_per_kn_per_m2_s2,
        draw.friction * brake.clamp_kn_per_kpa, brake.touch_kpa, brake.softness_kpa,
        brake.friction, brake.friction_rise_m_s, brake.friction_speed_m_s,
        draw.wave_numbers_per_m.copy(), draw.phases.copy(), brake.path_std * math.sqrt(2.0 / brake.waves),
        drive.main_kpa + drive.atmosphere_kpa, drive.atmosphere_kpa,
        drive.rate_per_s(drive.line_orifice_mm2, drive.line_litres),
        drive.rate_per_s(drive.fill_orifice_mm2, drive.line_litres),
        drive.rate_per_s(drive.fill_orifice_mm2, drive.cylinder_litres),
        drive.rate_per_s(drive.exhaust_orifice_mm2, drive.cylinder_litres),
        drive.gauge_lag_s, drive.opening_s, drive.closing_s, drive.fill_delay_s, drive.exhaust_delay_s,
        drive.band_kpa, draw.valve_jitter_s.copy(),
    )  # fmt: skip


@njit(cache=True, error_model="numpy")
def flow_kpa(up_kpa: float, down_kpa: float) -> float:
    """psi p_up of an isentropic flow through an orifice, absolute pressures; none against the pressure."""
    ratio = down_kpa / up_kpa
    if ratio >= 1.0:
        return 0.0
    if ratio <= CRITICAL:
        return float(CHOKED * up_kpa)
    r = min(ratio, LAMINAR)
    psi = math.sqrt(2.0 * GAMMA / (GAMMA - 1.0) * (r ** (2.0 / GAMMA) - r ** ((GAMMA + 1.0) / GAMMA)))
    return up_kpa * psi * ((1.0 - ratio) / (1.0 - r) if ratio > LAMINAR else 1.0)


@njit(cache=True, error_model="numpy")
def clamp_kn(overhead_kpa: float, laws: Laws) -> float:
    """Normal force on an axle at `overhead_kpa` beyond the touch pressure, kN: 0, a parabola, a line."""
    soft = laws.softness_kpa
    if overhead_kpa <= -soft:
        return 0.0
    if overhead_kpa >= soft:
        return laws.clamp_kn_per_kpa * overhead_kpa
    return laws.clamp_kn_per_kpa * (overhead_kpa + soft) ** 2 / (4.0 * soft)


@njit(cache=True, error_model="numpy")
def engagement(place_m: float, laws: Laws) -> float:
    """Share of the clamp force that an axle at `place_m` feels: 0 beside the beams, 1 behind their flares."""
    share = 0.0
    for zone in range(laws.zones_m.shape[0]):
        into, ahead = place_m - laws.zones_m[zone, 0], laws.zones_m[zone, 1] - place_m
        if into > 0.0 and ahead > 0.0:
            x, y = min(1.0, into / laws.flare_m), min(1.0, ahead / laws.flare_m)
            share += x * x * (3.0 - 2.0 * x) * y * y * (3.0 - 2.0 * y)
    return share


@njit(cache=True, error_model="numpy")
def grade_permille(place_m: float, laws: Laws) -> float:
    """Grade at `place_m`, downhill positive."""
    knots, grades = laws.knots_m, laws.grades_permille
    if place_m <= knots[0]:
        return float(grades[0])
    for i in range(1, knots.shape[0]):
        if place_m < knots[i]:
            part = (place_m - knots[i - 1]) / (knots[i] - knots[i - 1])
            return float(grades[i - 1] + (grades[i] - grades[i - 1]) * part)
    return float(grades[-1])


@njit(cache=True, error_model="numpy")
def force_kn(s: float, v: float, pressure_kpa: float, laws: Laws) -> float:
    """Sum of all forces on the cut in the direction of travel, kN."""
    clamp = clamp_kn(pressure_kpa - laws.touch_kpa, laws)
    grade, braked = 0.0, 0.0
    for axle in range(laws.offsets_m.shape[0]):
        place = s - laws.offsets_m[axle]
        grade += grade_permille(place, laws)
        share = engagement(place, laws) if clamp > 0.0 else 0.0
        if share > 0.0:
            eta = 0.0
            for wave in range(laws.phases.shape[0]):
                eta += math.cos(laws.wave_numbers_per_m[wave] * place + laws.phases[wave])
            braked += share * (1.0 + laws.amplitude * eta)
    mu = laws.friction * (1.0 + laws.friction_rise_m_s / (v + laws.friction_speed_m_s))
    resistance = laws.resistance_n_per_kn + laws.resistance_n_per_kn_per_m2_s2 * v * v
    drive = grade / laws.offsets_m.shape[0] - resistance
    return float(1e-3 * laws.weight_kn * drive - clamp * mu * braked)


@njit(cache=True, error_model="numpy")
def rates(y: Floats, direction: float, opening_per_s: float, laws: Laws, dy: Floats) -> None:
    """d(state)/dt into `dy`; of the two valves that of `direction` is open."""
    pressure = y[CYLINDER] - laws.atmosphere_kpa
    filling = y[OPEN] * flow_kpa(y[LINE], y[CYLINDER]) if direction > 0.0 else 0.0
    leaving = y[OPEN] * flow_kpa(y[CYLINDER], laws.atmosphere_kpa) if direction < 0.0 else 0.0
    dy[PATH] = y[SPEED]
    dy[SPEED] = force_kn(y[PATH], y[SPEED], pressure, laws) / laws.inertia_t
    dy[CYLINDER] = laws.fill_rate * filling - laws.exhaust_rate * leaving
    dy[LINE] = laws.main_rate * flow_kpa(laws.main_kpa, y[LINE]) - laws.line_rate * filling
    dy[GAUGE] = (pressure - y[GAUGE]) / laws.gauge_lag_s
    dy[OPEN] = opening_per_s


@njit(cache=True, error_model="numpy")
def stepped(y: Floats, h: float, direction: float, opening_per_s: float, laws: Laws, work: Floats) -> None:
    """One step of classical Runge-Kutta from `y`, into work[0]; `work` (6, 6)."""
    rates(y, direction, opening_per_s, laws, work[1])
    work[5] = y + 0.5 * h * work[1]
    rates(work[5], direction, opening_per_s, laws, work[2])
    work[5] = y + 0.5 * h * work[2]
    rates(work[5], direction, opening_per_s, laws, work[3])
    work[5] = y + h * work[3]
    rates(work[5], direction, opening_per_s, laws, work[4])
    work[0] = y + h / 6.0 * (work[1] + 2.0 * work[2] + 2.0 * work[3] + work[4])


@njit(cache=True, error_model="numpy")
def happened(y: Floats, valve: Floats, laws: Laws) -> int:
    """The first thing that ends a step: 1 exit, 2 standstill, 3 the pressure is in the band; 0 nothing."""
    if y[PATH] >= laws.exit_m:
        return 1
    if y[SPEED] <= 0.0:
        return 2
    short = valve[DIRECTION] * (valve[STAGE_KPA] + laws.atmosphere_kpa - y[CYLINDER])
    is_open = valve[MODE] == OPENING or valve[MODE] == OPENED
    return 3 if is_open and short <= laws.band_kpa else 0


@njit(cache=True, error_model="numpy")
def next_mode(y: Floats, valve: Floats, laws: Laws) -> float:
    """Changes of mode that are due now; returns the speed at which the valve opens, 1/s."""
    short = valve[STAGE_KPA] + laws.atmosphere_kpa - y[CYLINDER]
    if valve[MODE] == SHUT and abs(short) > laws.band_kpa * (1.0 + 1e-9):
        valve[MODE], valve[DIRECTION] = WAITING, 1.0 if short > 0.0 else -1.0
        delay = laws.fill_delay_s if short > 0.0 else laws.exhaust_delay_s
        valve[LEFT_S] = delay + laws.valve_jitter_s[int(valve[OPENINGS]) % laws.valve_jitter_s.shape[0]]
        valve[OPENINGS] += 1.0
    if valve[MODE] == WAITING and valve[LEFT_S] <= 0.0:
        valve[MODE], valve[LEFT_S] = OPENING, laws.opening_s
    if valve[MODE] == OPENING and valve[LEFT_S] <= 0.0:
        valve[MODE], y[OPEN] = OPENED, 1.0
    if happened(y, valve, laws) == 3:
        valve[MODE], valve[LEFT_S] = CLOSING, y[OPEN] * laws.closing_s
    if valve[MODE] == CLOSING and valve[LEFT_S] <= 0.0:
        valve[MODE], y[OPEN] = SHUT, 0.0
    if valve[MODE] == OPENING:
        return 1.0 / laws.opening_s
    return -1.0 / laws.closing_s if valve[MODE] == CLOSING else 0.0


@njit(cache=True, error_model="numpy")
def advance(y: Floats, valve: Floats, laws: Laws, duration_s: float, step_s: float) -> Any:
    """Move `y` and `valve` in place for `duration_s`; returns (MOVING, GONE or STANDING, time used)."""
    work, used = np.empty((6, 6)), 0.0
    while used < duration_s:
        opening = next_mode(y, valve, laws)
        timed = valve[MODE] == WAITING or valve[MODE] == OPENING or valve[MODE] == CLOSING
        rest = duration_s - used
        h = min(step_s, rest)
        if timed:
            h = min(h, valve[LEFT_S])
        stepped(y, h, valve[DIRECTION], opening, laws, work)
        event = happened(work[0], valve, laws)
        if event != 0:
            low, high = 0.0, h
            for _ in range(BISECTIONS):
                middle = 0.5 * (low + high)
                stepped(y, middle, valve[DIRECTION], opening, laws, work)
                found = happened(work[0], valve, laws)
                if found != 0:
                    high, event = middle, found
                else:
                    low = middle
            h = high
            stepped(y, h, valve[DIRECTION], opening, laws, work)
        y[:] = work[0]
        valve[LEFT_S] = valve[LEFT_S] - h if timed else 0.0
        if event == 1 or event == 2:
            y[PATH if event == 1 else SPEED] = laws.exit_m if event == 1 else 0.0
            return (GONE if event == 1 else STANDING), used + h
        used = duration_s if h == rest else used + h
    return MOVING, duration_s
