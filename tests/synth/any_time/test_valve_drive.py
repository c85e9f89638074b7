"""The drive at any time: its automaton, its valves, and passes with it.

The automaton of the drive: what it says of a period is what the drive does, up to interpolation in pressure.
The drive commanded at any moment: against the drive commanded at rest, and against valves played in tiny steps.
Passes of the polynomial rule once more, in plain Python from the equations of plant and valves, in small steps.
"""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import permutations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plant_models import Plant, PlantError, Pneumatics
from plant_models.valve_drive import drive_on, wait_after_command
from synth.simulation.closed_loop import close_loop
from synth.simulation.random_passes import random_passes
from synth.solver.any_time.drive_modes import COMMANDS, drive_modes, pressure_grid
from synth.solver.any_time.polynomial_surfaces import CUBIC_AND_SLOPE, PolynomialSurfaces
from tests.synth.any_time.conftest import tabled


def test_every_period_is_that_of_the_drive(plant: Plant) -> None:
    modes = drive_modes(plant, 20.0, 4)
    stages, pressure = plant.position.stage_pressures_kpa, modes.pressure_kpa
    assert modes.waits_s == pytest.approx([0.0, 0.22, 0.12, 0.02])
    assert {(int(k), bool(r)) for k, r in zip(modes.stage, modes.rests, strict=True)} >= {(k, True) for k in range(3)}
    for m in range(len(modes.stage)):
        for a, command in enumerate(COMMANDS):
            if not modes.allowed[m, a]:
                continue
            old, new = stages[modes.stage[m]], stages[modes.stage[m] + command]
            p, wait, early = drive_on(pressure[m], modes.waits_s[modes.wait[m]], old, 0.02, modes.drive)
            p, wait, late = drive_on(p, wait_after_command(p, wait, old, new, modes.drive), new, 0.08, modes.drive)
            assert modes.overpressure_kpa[m, a].mean() * 0.1 == pytest.approx(early + late, abs=1e-9)
            reached, weight = modes.target[m, a], modes.weight[m, a]
            assert weight @ pressure[reached] == pytest.approx(p, abs=1e-9)
            assert weight.sum() == pytest.approx(1.0)
            used = weight != 0.0
            assert (modes.stage[reached[used]] == modes.stage[m] + command).all()
            still = modes.waits_s[modes.wait[reached[used]]]
            assert (modes.rests[reached[used]] | (np.abs(still - wait) < 1e-9)).all()


def test_interpolation_is_cubic_and_stays_within_its_segment(plant: Plant) -> None:
    grid = pressure_grid(plant.position, 2, 12.0)
    for p in np.linspace(15.0, 285.0, 200):
        nodes, weight = grid.weights(float(p))
        if len(nodes) == 4:
            assert weight @ grid.nodes_kpa[nodes] ** 3 == pytest.approx(p**3, rel=1e-9)
        between = (grid.breaks > nodes.min()) & (grid.breaks < nodes.max())
        assert not between.any()


VALVES = Pneumatics(700.0, 5.0, 0.11, 0.2, 0.07, 0.31, 0.4, 15.0)
TOUCH_KPA = 50.0
STAGES_KPA = (0.0, 150.0, 300.0, 450.0, 600.0)
DRIVE = VALVES.valves_shutting_at_once(TOUCH_KPA)


@pytest.mark.parametrize(("begin", "end"), list(permutations((0.0, 150.0, 600.0), 2)))
def test_a_command_at_rest_is_that_of_the_pressure_history(begin: float, end: float) -> None:
    start = begin + 15.0 if begin < end else begin - 15.0
    history = VALVES.respond(start, end, TOUCH_KPA)
    times = np.linspace(0.0, 1.5 * history.duration_s, 83)
    wait = wait_after_command(start, 0.0, begin, end, DRIVE)
    played = [drive_on(start, wait, end, float(t), DRIVE) for t in times]
    assert [p for p, _, _ in played] == pytest.approx(history.pressure_kpa(times), abs=1e-9)
    assert [i for _, _, i in played] == pytest.approx(history.overpressure_integral(times, TOUCH_KPA), abs=1e-9)


ORDERS = st.lists(st.tuples(st.sampled_from(STAGES_KPA), st.floats(0.0, 0.5)), min_size=1, max_size=8)


@given(orders=ORDERS, cut=st.floats(0.0, 1.0))
def test_where_a_time_is_cut_does_not_matter(orders: list[tuple[float, float]], cut: float) -> None:
    once = twice = (15.0, 0.0)
    stage = 0.0
    for wanted, duration in orders:
        once = (once[0], wait_after_command(*once, stage, wanted, DRIVE))
        twice = (twice[0], wait_after_command(*twice, stage, wanted, DRIVE))
        stage = wanted
        pressure, wait, whole = drive_on(*once, stage, duration, DRIVE)
        once = (pressure, wait)
        pressure, wait, first = drive_on(*twice, stage, cut * duration, DRIVE)
        pressure, wait, second = drive_on(pressure, wait, stage, duration - cut * duration, DRIVE)
        twice = (pressure, wait)
        assert once == pytest.approx(twice, abs=1e-8)
        assert whole == pytest.approx(first + second, abs=1e-8)


def played_in_tiny_steps(orders: list[tuple[float, float]], step_s: float) -> tuple[float, float]:
    """(pressure, ∫overpressure) with two valves as machines of their own, each with the time at which it may open."""
    pressure, total, now = 15.0, 0.0, 0.0
    opens = {1: np.inf, -1: np.inf}  # supply, exhaust; inf: no current on its wire
    for stage, duration in orders:
        begun = now
        while now < begun + duration - 0.5 * step_s:
            error = stage - pressure
            wanted = 0 if abs(error) <= 15.0 else (1 if error > 0 else -1)
            for valve in (1, -1):
                if wanted != valve:
                    opens[valve] = np.inf
                elif np.isinf(opens[valve]):
                    extra = 0.2 if pressure <= TOUCH_KPA else 0.0
                    opens[valve] = now + (0.11 + extra if valve == 1 else 0.07)
            before = pressure
            if now >= opens[1] - 1e-9:
                pressure = min(pressure + step_s * (700.0 - pressure) / 0.31, max(stage - 15.0, pressure))
            elif now >= opens[-1] - 1e-9:
                pressure = max(pressure + step_s * (5.0 - pressure) / 0.4, min(stage + 15.0, pressure))
            total += step_s * max(0.0, 0.5 * (before + pressure) - TOUCH_KPA)
            now += step_s
    return pressure, total


REVERSALS = {
    "reversed while waiting": [(150.0, 0.05), (0.0, 0.3)],
    "reversed while filling": [(300.0, 0.45), (0.0, 0.05), (150.0, 0.4)],
    "one stage further while filling": [(150.0, 0.4), (300.0, 0.1), (450.0, 0.3)],
    "one stage further while waiting": [(150.0, 0.1), (300.0, 0.1), (450.0, 0.1), (600.0, 0.5)],
    "back while exhausting": [(450.0, 1.0), (0.0, 0.3), (300.0, 0.25), (150.0, 0.2)],
    "into the band of a stage and out": [(300.0, 0.49), (150.0, 0.02), (300.0, 0.6)],
}


@pytest.mark.parametrize("orders", list(REVERSALS.values()), ids=list(REVERSALS))
def test_commands_in_a_transient_as_two_valves_would_take_them(orders: list[tuple[float, float]]) -> None:
    pressure, wait, total, stage = 15.0, 0.0, 0.0, 0.0
    for wanted, duration in orders:
        wait = wait_after_command(pressure, wait, stage, wanted, DRIVE)
        stage = wanted
        pressure, wait, done = drive_on(pressure, wait, stage, duration, DRIVE)
        total += done
    assert (pressure, total) == pytest.approx(played_in_tiny_steps(orders, 2e-5), abs=0.1)


def test_valves_that_close_late_are_refused() -> None:
    with pytest.raises(PlantError, match="closing_delay_s"):
        replace(VALVES, closing_delay_s=0.01).valves_shutting_at_once(TOUCH_KPA)


STEP_S = 5e-4
SAME_M_S = 0.003
"""Exit speeds of passes with the same commands are as near: the kernel takes the pressure in means of parts."""


class SlowPass:
    """One cut on its way: everything that the plant knows, moved by `go_on`."""

    def __init__(self, plant: Plant, friction: float, resistance: float, entry_m_s: float) -> None:
        self.plant, self.friction, self.resistance = plant, friction, resistance
        self.s, self.v, self.kpa = 0.0, entry_m_s, 15.0  # released: the upper edge of the dead band about 0 kPa
        self.wanted_kpa, self.flow, self.wait_s = 0.0, 0, 0.0

    def command(self, kpa: float) -> None:
        """A command on the wires: the valve that it needs opens after its delay, unless it is open or awaited."""
        valves = self.plant.position.pneumatics
        error = kpa - self.kpa
        flow = 0 if abs(error) <= valves.dead_band_kpa + 1e-9 else (1 if error > 0.0 else -1)
        if flow > 0 and flow != self.flow:
            touching = self.kpa > self.plant.position.force.touch_pressure_kpa
            self.wait_s = valves.brake_delay_s + (0.0 if touching else valves.touch_delay_s)
        elif flow < 0 and flow != self.flow:
            self.wait_s = valves.release_delay_s
        self.wanted_kpa, self.flow = kpa, flow

    def go_on(self, seconds: float) -> None:
        """Pressure and motion for so long, in small steps."""
        count = math.ceil(seconds / STEP_S)
        for _ in range(count):
            if self.s < self.plant.exit_m and self.v > 0.0:
                self.step(seconds / count)

    def step(self, dt: float) -> None:
        """One small step."""
        before, valves = self.kpa, self.plant.position.pneumatics
        flowing = dt - min(self.wait_s, dt) if self.flow else 0.0
        self.wait_s = max(0.0, self.wait_s - dt)
        if self.flow > 0:
            share = -math.expm1(-flowing / valves.fill_time_constant_s)
            filled = self.kpa + (valves.supply_pressure_kpa - self.kpa) * share
            self.kpa = min(filled, self.wanted_kpa - valves.dead_band_kpa)
        elif self.flow < 0:
            share = -math.expm1(-flowing / valves.exhaust_time_constant_s)
            emptied = self.kpa + (valves.exhaust_pressure_kpa - self.kpa) * share
            self.kpa = max(emptied, self.wanted_kpa + valves.dead_band_kpa)
        if abs(self.kpa - self.wanted_kpa) <= valves.dead_band_kpa + 1e-9:
            self.flow = 0
        cut, force = self.plant.cut, self.plant.position.force
        inside = sum(0.0 <= self.s - x <= 8.0 for x in cut.axle_offsets_m)
        pads_kn = inside * 20.0 / 550.0 * max(0.0, 0.5 * (before + self.kpa) - force.touch_pressure_kpa)
        heavy_t = cut.mass_t + 0.42 * len(cut.axle_offsets_m)
        drive = 9.81 * cut.mass_t / heavy_t * 1e-3 * (8.0 - self.resistance)
        a = drive - self.friction * pads_kn / heavy_t
        self.s += self.v * dt + 0.5 * a * dt * dt
        self.v += a * dt


def slow_exit(plant: Plant, surfaces: PolynomialSurfaces, cut: SlowPass, first_s: float, z: np.ndarray) -> list[float]:
    """Exit speed and number of commands of a pass; one command goes one stage."""
    sensor, stage, commands = plant.sensor, 0, 0
    cut.go_on(first_s)
    for sample in range(400):
        if cut.s >= plant.exit_m or cut.v <= 0.0:
            break
        measured = max(0.0, cut.v + sensor.noise_m_s * float(z[sample]))
        u = 2.0 * cut.s / plant.exit_m - 1.0
        x = (cut.kpa - plant.position.stage_pressures_kpa[stage]) / 100.0
        lines = (np.polynomial.legendre.legval(u, c[:4]) + x * c[4] for c in surfaces.coefficients[stage])
        lower, upper = map(float, lines)
        step = int(surfaces.has_line[stage, 1] and measured > upper)
        step -= int(surfaces.has_line[stage, 0] and measured < lower)
        stage, commands = stage + step, commands + abs(step)
        cut.go_on(sensor.computing_delay_s)
        cut.command(plant.position.stage_pressures_kpa[stage])
        cut.go_on(sensor.sample_period_s - sensor.computing_delay_s)
    return [cut.v, commands]


@pytest.fixture(scope="module")
def smooth(plant: Plant) -> Plant:
    """No path noise, and a sensor that does not round: a pass is then a few numbers."""
    sensor = replace(plant.sensor, resolution_m_s=0.0)
    return replace(plant, friction=replace(plant.friction, path_std=0.0), sensor=sensor)


@pytest.mark.requirement("PRED-03")
def test_slow_passes_are_those_of_the_kernel(smooth: Plant) -> None:
    coefficients = np.zeros((3, 2, 5))
    coefficients[:, :, 0] = 3.0 + np.array([0.15, 0.3])
    coefficients[:, :, 1], coefficients[:, :, 2], coefficients[:, :, 4] = -0.25, 0.05, 0.06
    has_line = np.array([[False, True], [True, True], [True, False]])
    stages = np.asarray(smooth.position.stage_pressures_kpa)
    surfaces = PolynomialSurfaces(0.0, smooth.exit_m, stages, CUBIC_AND_SLOPE, coefficients, has_line)
    loop = close_loop(smooth, smooth.position.top_stage + 1)
    draws = loop.draws(random_passes(31, 0, 40))
    found = loop.run(tabled(smooth, surfaces), draws)
    same = 0
    for i in range(40):
        cut = SlowPass(smooth, draws.cut_factor[i], draws.resistance_n_kn[i], draws.entry_m_s[i])
        speed, commands = slow_exit(smooth, surfaces, cut, float(draws.first_sample_s[i]), draws.noise_z[i])
        if commands == found.switchings[i]:
            same += 1
            assert speed == pytest.approx(found.exit_speed_m_s[i], abs=SAME_M_S)
    assert same >= 38  # a speed within a millimetre of a line may fall on either side
    assert found.switchings.mean() > 2.0
