"""Landing tables of stage changes against scipy's integration of the motion under the continuous pressure."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from plant_models import Plant, PressingForce
from synth.problem.resolution import Resolution
from synth.solver.chain.chain import Chain, persistent_chain
from synth.solver.chain.decisions import steps_of

Array = NDArray[np.float64]

STALLED = -1.0

RESOLUTION = Resolution(
    path_step_m=0.5, speed_step_m_s=0.1, transient_substeps=5, friction_nodes=1, path_levels=1, resistance_nodes=1
)
"""Every edge of N(s) of the small plant (1.5, 4.0, 5.5 m) lies on a node."""


def pressure_pieces(plant: Plant, start_kpa: float, wanted: int) -> list[tuple[float, float, float]]:
    """(end of piece s, asymptote kPa, time constant s) since the sample, from the definition."""
    p = plant.position.pneumatics
    goal = plant.position.stage_pressures_kpa[wanted]
    rest = (math.inf, start_kpa, 1.0)
    if goal > start_kpa:
        touch = p.touch_delay_s if start_kpa <= plant.position.force.touch_pressure_kpa else 0.0
        wait, asymptote, constant = p.brake_delay_s + touch, p.supply_pressure_kpa, p.fill_time_constant_s
        end = goal - p.dead_band_kpa
    else:
        wait, asymptote, constant = p.release_delay_s, p.exhaust_pressure_kpa, p.exhaust_time_constant_s
        end = goal + p.dead_band_kpa
    opens = plant.sensor.computing_delay_s + wait
    closes = opens + constant * math.log((start_kpa - asymptote) / (end - asymptote))
    return [(opens, *rest[1:]), (closes, asymptote, constant), (math.inf, end, 1.0)]


def ride(
    plant: Plant, factor: float, s: float, v: float, start_kpa: float, wanted: int, duration_s: float
) -> tuple[float, float]:
    """(path travelled, v²/2) after the transient, or at S_exit if that comes first; travelled −1 for a stall."""
    cut, force = plant.cut, plant.position.force
    assert isinstance(force, PressingForce)
    (zone,) = plant.position.zones_m
    breaks = sorted({edge + x for edge in zone for x in cut.axle_offsets_m})
    free = cut.reduced_gravity_m_s2 * 1e-3
    free *= plant.profile.grades_permille[0] - plant.resistance.mean_n_per_kn
    start, time, pressure = s, 0.0, start_kpa
    for end, asymptote, constant in pressure_pieces(plant, start_kpa, wanted):
        opened, at_opening = time, pressure

        def kpa(
            t: float, a: float = asymptote, c: float = constant, t0: float = opened, p: float = at_opening
        ) -> float:
            return a + (p - a) * math.exp(-(t - t0) / c)

        while time < min(end, duration_s) - 1e-12:
            ahead = min(b for b in breaks if b > s + 1e-9)
            axles = sum(zone[0] <= s + 1e-9 - x < zone[1] for x in cut.axle_offsets_m)
            k = axles * force.slope_kn_per_kpa(cut, axles) / cut.inertia_t if axles else 0.0

            def slope(t: float, y: Array, k: float = k) -> list[float]:
                return [float(y[1]), free - factor * k * max(0.0, kpa(t) - force.touch_pressure_kpa)]

            def at_break(t: float, y: Array, ahead: float = ahead) -> float:
                return float(y[0]) - ahead

            def at_rest(t: float, y: Array) -> float:
                return float(y[1])

            at_break.terminal = at_rest.terminal = True  # type: ignore[attr-defined]  # as scipy wants it
            part = solve_ivp(
                slope, (time, min(end, duration_s)), [s, v], events=[at_break, at_rest], rtol=1e-9, atol=1e-11,
                max_step=0.02,
            )  # fmt: skip
            time, (s, v) = float(part.t[-1]), (float(y) for y in part.y[:, -1])
            assert part.t_events is not None
            if part.t_events[1].size:
                return STALLED, 0.0
            if part.t_events[0].size:
                s = ahead
                if s == breaks[-1]:
                    return s - start, 0.5 * v * v
        pressure = kpa(time)
    return s - start, 0.5 * v * v


def commands_of(t: Chain) -> list[tuple[int, int, int]]:
    """(transient, mode before, stage wanted) of all changes, of several stages too."""
    found = []
    for command, chains in enumerate(t.landings.change_chain):
        for mode, stage in enumerate(t.actuator.mode_stage):
            if chains[mode] >= 0:
                found.append((int(chains[mode]), mode, int(stage) + steps_of(command)))
    return found


Case = tuple[int, int, int, int, int]  # node, transient, friction node, speed node; then the stage wanted


def outcomes(t: Chain, nodes: list[int], speeds_m_s: list[float]) -> dict[Case, tuple[float, float]]:
    """What scipy says, for the lowest, a middle and the highest friction factor of the tables."""
    found = {}
    speeds = [int(np.argmin(np.abs(t.grid.speed_m_s - v))) for v in speeds_m_s]
    frictions = (0, len(t.landings.factors) // 2, len(t.landings.factors) - 1)
    for (c, mode, wanted), n, f, j in itertools.product(commands_of(t), nodes, frictions, speeds):
        duration = t.landings.samples[c] * t.plant.sensor.sample_period_s
        found[n, c, f, j, wanted] = ride(
            t.plant, float(t.landings.factors[f]), float(t.grid.path_m[n]), float(t.grid.speed_m_s[j]),
            float(t.actuator.mode_pressure_kpa[mode]), wanted, duration,
        )  # fmt: skip
    return found


def errors(t: Chain, expected: dict[Case, tuple[float, float]], leaving: bool) -> tuple[float, float]:
    """Largest error of travel (m) and of energy (m²/s²) over cases that end inside, or that leave."""
    worst = np.zeros(2)
    for (n, c, f, j, _), (travel, energy) in expected.items():
        if travel == STALLED or (n * t.grid.path_step_m + travel >= t.plant.exit_m - 1e-9) != leaving:
            continue
        got = t.landings.travel_m[n, c, f, j], t.landings.energy_m2_s2[n, c, f, j]
        worst = np.maximum(worst, np.abs(np.subtract(got, (travel, energy))))
    return float(worst[0]), float(worst[1])


def refined(plant: Plant, substeps: tuple[int, ...]) -> list[Chain]:
    """The plant's transitions for several numbers of transient sub-steps."""
    return [persistent_chain(plant, replace(RESOLUTION, transient_substeps=m)) for m in substeps]


@pytest.fixture(scope="module")
def longer_plant(plant_with: Callable[..., Plant]) -> Plant:
    """One axle group needs 9.5 m, so that many transients end inside; N(s) = 1, 2, 1 with steps on nodes."""
    return plant_with(zones_m=((0.0, 8.0),))


def test_landing_is_second_order_in_the_substeps(longer_plant: Plant) -> None:
    """Inside the position: errors fall as 1/m² (1.5 asserted: the largest of many errors wanders).

    At 4 sub-steps of 25 ms: under 0.3 mm and 4e-3 m²/s²; the reference is good to 1e-8.
    """
    series = refined(longer_plant, (2, 4, 8))
    expected = outcomes(series[0], nodes=[0, 2, 9, 13], speeds_m_s=[1.0, 2.0, 3.2, 4.4])
    assert sum(travel >= 0 for travel, _ in expected.values()) > 100
    table = np.array([errors(t, expected, leaving=False) for t in series])
    order = np.log2(table[:-1] / table[1:])
    print("landing inside: errors", table, "orders", order)
    assert order.min() > 1.5
    assert table[1, 0] < 3e-4
    assert table[1, 1] < 4e-3


def test_landing_at_the_exit_is_second_order_too(longer_plant: Plant) -> None:
    """The energy at S_exit, crossed inside a sub-step: errors fall as 1/m², and at 8 are under 2e-3 m²/s².

    Braking by the mean of a sub-step that reaches beyond the exit would be first order, and 0.02 m²/s² off.
    """
    series = refined(longer_plant, (2, 4, 8))
    expected = outcomes(series[0], nodes=[16, 17, 18], speeds_m_s=[1.5, 2.0, 2.6, 3.2, 3.8, 4.4])
    leaves = [n * 0.5 + travel >= 9.5 - 1e-9 for (n, *_), (travel, _) in expected.items()]
    assert sum(leaves) > 100
    error = np.array([errors(t, expected, leaving=True)[1] for t in series])
    order = np.log2(error[:-1] / error[1:])
    print("landing at the exit: errors", error, "orders", order)
    assert order.min() > 1.5
    assert error[-1] < 2e-3


def test_landing_knows_stalls(longer_plant: Plant) -> None:
    """A cut that stops within a transient is told from one that does not."""
    (t,) = refined(longer_plant, (5,))
    expected = outcomes(t, nodes=[0, 4, 9], speeds_m_s=[0.35, 0.5, 0.6, 0.8, 1.0])
    stalls = [travel == STALLED for travel, _ in expected.values()]
    assert 20 < sum(stalls) < len(stalls) - 20
    assert [bool(t.landings.travel_m[case[:4]] < 0) for case in expected] == stalls


def test_landing_between_the_nodes(plant_with: Callable[..., Plant]) -> None:
    """Steps of N(s) inside a quantum: the work is kept, its place is smeared over a quarter quantum.

    Measured largest energy error at ΔS = 0.5, 0.25, 0.125 m: 17, 1.0, 0.19 (1e-3 m²/s²).
    """
    plant = plant_with(zones_m=((0.0, 8.13),), axles_m=(0.0, 1.67))
    worst = []
    for step in (0.5, 0.25, 0.125):
        t = persistent_chain(plant, replace(RESOLUTION, path_step_m=step, transient_substeps=20))
        nodes = [0, round(2.0 / t.grid.path_step_m), round(7.0 / t.grid.path_step_m)]
        worst.append(errors(t, outcomes(t, nodes, [1.0, 2.0, 3.2, 4.4]), leaving=False)[1])
    print("landing between the nodes: errors", worst)
    assert worst[0] > 2 * worst[1] > 4 * worst[2]
    assert worst[1] < 3e-3
