"""The loop of passages against an adaptive integrator with its own rule."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from plant_models import PressureHistory, every_axle, first_axle
from plant_models.point_sensors import Axles, deciding_passages
from synth.kernels.loop.passes import Draws
from synth.simulation.passage_controller import PassageController
from synth.simulation.passage_loop import PassageLoop, close_passage_loop
from synth.simulation.random_passes import random_passes
from tests.synth.conftest import pilot_plant
from tests.synth.simulation.passage_cases import SENSORS, braking_rule, with_approach

Floats = NDArray[np.float64]


class IntegratedPass:
    """One pass by `solve_ivp` from event to event: pressure by `PressureHistory`, decisions in plain words."""

    def __init__(self, loop: PassageLoop, rule: PassageController, draws: Draws) -> None:
        plant, path = loop.plant, loop.radar.path
        self.plant, self.sensors, self.rule, self.draws = plant, loop.sensors, rule, draws
        x, before = np.zeros(path.eta_std.size), path.approach_cells
        for j in range(before, x.size):
            x[j] = path.eta_memory[j] * x[j - 1] + path.eta_fresh[j] * draws.path_z[0, j - before]
        self.edges = path.edges_m
        self.free = path.gravity_m_s2 - path.drag_m_s2_per_n_kn * draws.resistance_n_kn[0]
        self.brake = path.brake_m_s2_per_kpa * draws.cut_factor[0] * (1.0 + path.eta_std * x)
        self.touch = plant.position.force.touch_pressure_kpa
        self.met = deciding_passages(loop.sensors, plant.cut, plant.exit_m)
        self.coils = sorted(
            (each.path_m + sign * 0.5 * self.sensors.base_m * self.base_error(each.sensor), number, sign)
            for number, each in enumerate(self.met)
            for sign in (-1, 1)
        )
        initial = plant.approach.initial_stage
        self.stage, self.rests_kpa = initial, plant.position.stage_pressures_kpa[initial] - (15.0 if initial else 0.0)
        self.command: tuple[float, PressureHistory] | None = None
        self.rests_from = -math.inf
        self.first: dict[int, float] = {}
        self.told: list[tuple[float, float, float, bool, int]] = []

    def base_error(self, sensor: int) -> float:
        return 1.0 + self.sensors.base_tolerance * float(self.draws.noise_z[0, 255 - sensor])

    def overpressure(self, t: float) -> float:
        if self.command is None or t <= self.command[0]:
            return max(0.0, self.rests_kpa - self.touch)
        return max(0.0, float(self.command[1].pressure_kpa(np.array(t - self.command[0]))) - self.touch)

    def kinks(self) -> list[float]:
        """Times at which a valve opens or closes or the overpressure leaves 0."""
        if self.command is None:
            return []
        start, history = self.command
        times = [start + t for t in history.starts_s]
        for t, p, end, constant in zip(
            history.starts_s, history.pressures_kpa, history.asymptotes_kpa, history.time_constants_s, strict=True
        ):
            if (p - self.touch) * (end - self.touch) < 0:
                times.append(start + t + constant * math.log((end - p) / (end - self.touch)))
        return times

    def ring(self, number: int, sign: int, t: float) -> None:
        """A coil of passage `number` is passed."""
        if sign < 0:
            self.first[number] = t
            return
        took = t - self.first[number]
        reading = self.sensors.base_m / (took + self.sensors.timer_noise_s * float(self.draws.noise_z[0, number]))
        counts = t - 0.5 * took >= self.rests_from
        if counts:
            self.decide(number, reading, t)
        self.told.append((t, t - 0.5 * took, reading, counts, self.stage))

    def decide(self, number: int, reading: float, t: float) -> None:
        row = self.rule.rule.switching_m_s[number, self.stage].astype(float)
        allowed = self.plant.entrance_stage if self.met[number].path_m < 0 else self.plant.top_stage
        above = int(np.count_nonzero(reading > row))
        wanted = min(above, allowed) if above > self.stage else int(np.count_nonzero(reading >= row))
        if (above > self.stage and wanted <= self.stage) or wanted == self.stage:
            return
        if above <= self.stage and wanted > self.stage:
            return
        position = self.plant.position
        if self.command is not None:
            self.rests_kpa = self.command[1].pressures_kpa[-1]
        history = position.pneumatics.respond(self.rests_kpa, position.stage_pressures_kpa[wanted], self.touch)
        self.command = (t + self.sensors.computing_delay_s, history)
        scans = math.ceil((self.sensors.computing_delay_s + history.duration_s) / self.sensors.scan_period_s - 1e-9)
        self.rests_from, self.stage = t + scans * self.sensors.scan_period_s, wanted

    def run(self) -> float:
        """Exit speed."""
        t, cell, at = 0.0, 0, 0
        state = np.array([self.edges[0], self.draws.entry_m_s[0]])
        while self.coils[at][0] < self.edges[0]:  # rolled backwards
            place, number, sign = self.coils[at]
            self.ring(number, sign, self.leg(0.0, state, -10.0, 0, place)[0])
            at += 1
        while cell < self.free.size:
            until = min([each for each in self.kinks() if each > t + 1e-12], default=t + 100.0)
            coil = self.coils[at][0] if at < len(self.coils) else math.inf
            goal = min(float(self.edges[cell + 1]), coil)
            t, state, there = self.leg(t, state, until, cell, goal)
            if there and goal == coil:
                self.ring(self.coils[at][1], self.coils[at][2], t)
                at += 1
            elif there:
                cell += 1
        return float(state[1])

    def leg(self, t: float, state: Floats, until: float, cell: int, goal: float) -> tuple[float, Floats, bool]:
        """Integrate up to `until` or to the place `goal`."""

        def rate(time: float, y: Floats) -> tuple[float, float]:
            return y[1], self.free[cell] - self.brake[cell] * self.overpressure(time)

        def arrives(_: float, y: Floats) -> float:
            return float(y[0] - goal)

        arrives.terminal = True  # type: ignore[attr-defined]  # as scipy wants it
        if state[0] >= goal and until > t:
            return t, state, True
        first = min(1e-3, 0.5 * abs(until - t))
        solved = solve_ivp(
            rate, (t, until), state, events=arrives, rtol=1e-10, atol=1e-12, first_step=first, max_step=0.3
        )
        there = solved.status == 1
        state = solved.y[:, -1].copy()
        if there:
            state[0] = goal
        return float(solved.t[-1]), state, there


@pytest.mark.requirement("PRED-03")
@pytest.mark.parametrize("axles", [first_axle, every_axle])
@pytest.mark.parametrize(("substeps", "off"), [(None, 2e-4), (10, 5e-6)])
def test_a_pass_agrees_with_an_adaptive_integrator(axles: Axles, substeps: int | None, off: float) -> None:
    commands = unfinished = 0
    for i in range(3):
        plant = with_approach(pilot_plant(52.0), 5.0, entrance_stage=3, initial_stage=i % 2)
        sensors = replace(SENSORS, axles=axles, base_tolerance=5e-3, timer_noise_s=2e-4, timer_resolution_s=0.0)
        loop, rule = close_passage_loop(plant, sensors, 5, substeps), braking_rule(plant, sensors, 3.0)
        draws = loop.draws(random_passes(seed=4, first_pass=i, count=1))
        trace, oracle = loop.follow(rule, draws), IntegratedPass(loop, rule, draws)
        v_exit = oracle.run()
        told = np.array(oracle.told)
        assert trace.exit_speed_m_s == pytest.approx(v_exit, abs=0.5 * off)
        np.testing.assert_allclose(trace.readings.time_s, told[:, 0], atol=off)
        np.testing.assert_allclose(trace.readings.middle_s, told[:, 1], atol=off)
        np.testing.assert_allclose(trace.readings.reading_m_s, told[:, 2], atol=off)
        assert np.array_equal(trace.readings.outcome == 1, told[:, 3] == 1)
        assert list(trace.readings.stage) == list(told[:, 4])
        commands += int(np.count_nonzero(np.diff(trace.stage)))
        unfinished += int(np.count_nonzero(told[:, 3] == 0))
    assert commands >= 6
    assert (unfinished > 0) == (axles is every_axle)
