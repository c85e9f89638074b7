"""The limit of a brake without transients, against an ideal actuator computed on its own.

Valve delays and time constants go to nothing and so does the sampling period. What remains is a brake that, once per
path quantum, goes at once a stage down, holds or goes a stage up: the classical backward induction over path quanta
(zhukovitsky-2002), written here in a dozen lines of numpy. Noise is independent per quantum, so nothing is hidden and
the classical recursion is exact.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from plant_models import DopplerSensor, EntrySpeed, Friction, Plant, Pneumatics, PressingForce
from synth.problem.aim import Aim
from synth.problem.criterion import Criterion
from synth.problem.resolution import Resolution
from synth.solver.backward_induction import solve
from synth.solver.chain.chain import Chain, persistent_chain
from synth.solver.evaluation import Evaluation
from tests.oracles.as_published import as_published

QUANTUM = Resolution(0.5, 0.02, transient_substeps=2, friction_nodes=1, path_levels=1, resistance_nodes=1)

AT_ONCE = Pneumatics(700.0, 0.0, 0.0, 0.0, 0.0, 1e-3, 1e-3, 0.1)


def quick_plant(plant_with: Callable[..., Plant], period_s: float, pneumatics: Pneumatics) -> Plant:
    """No sensor noise, independent friction of 12 % per quantum."""
    return plant_with(
        zones_m=((0.0, 8.0),),
        stages_kpa=(0.0, 150.0, 300.0),
        force=PressingForce(0.08, 50.0),
        pneumatics=pneumatics,
        friction=Friction(0.12, 0.0, 0.0, 1.0),
        sensor=DopplerSensor(0.0, 0.0, period_s, 0.0),
        entry=EntrySpeed(4.0, 5.0),
    )


def ideal_cost(t: Chain, target_m_s: float, criterion: Criterion, with_lines: bool) -> float:
    """Mean cost over the entry of an actuator without transients, one stage a quantum.

    `with_lines`: commands are bounded by one speed each (the best such speeds); otherwise by nothing.
    """
    step = t.grid.path_step_m
    energy = np.linspace(0.0, t.grid.energy_m2_s2[-1], 16 * len(t.grid.energy_m2_s2))  # linear interpolation: fine
    speed = np.sqrt(2 * energy)
    noise, weight = np.polynomial.hermite_e.hermegauss(5)
    weight = weight / weight.sum()
    over = np.maximum(0.0, np.array([0.0, 150.0, 300.0]) - 50.0)
    value = np.tile((speed - target_m_s) ** 2, (3, 1))
    stalled = target_m_s**2 + criterion.stall_cost_m2_s2
    for n in reversed(range(len(t.drive_m_s2))):
        after = np.zeros_like(value)
        for k in range(3):
            for eta, w in zip(noise, weight, strict=True):
                slope = t.drive_m_s2[n] - (1 + 0.12 * eta) * t.brake_m_s2_per_kpa[n] * over[k]
                after[k] += w * np.interp(energy + slope * step, energy, value[k], left=stalled)
        after[:, 0] = stalled
        value = after.copy()
        for k in range(3):
            for q in (k - 1, k + 1):
                if not 0 <= q < 3:
                    continue
                gain = after[k] - after[q]
                goes = after[q] < value[k]
                if with_lines:
                    saved = np.append(0.0, np.cumsum(gain[1:] * np.diff(speed)))  # by going below each speed
                    goes = speed <= speed[np.argmax(saved)] if q < k else speed > speed[np.argmin(saved)]
                value[k] = np.where(goes, after[q], value[k])
    v = t.plant.entry.speed_m_s((np.arange(2000) + 0.5) / 2000)
    return float(np.interp(0.5 * v**2, energy, value[0]).mean())


def solved_cost(t: Chain, target_m_s: float, criterion: Criterion) -> float:
    """Cost of the solver's lines."""
    lines = solve(t, Aim(target_m_s, criterion)).lines
    return Evaluation(t, Aim(target_m_s, criterion)).cost(lines)


def test_cost_tends_to_that_of_an_ideal_actuator(plant_with: Callable[..., Plant]) -> None:
    """Commands executed at once: the cost is that of the ideal actuator with lines, to 2 % of the rms.

    Measured at ΔV = 0.01 m/s: 0.8 %, at 0.005: 0.2 %. An ideal actuator free of lines is the lower bound.
    """
    grid = replace(QUANTUM, speed_step_m_s=0.01)
    t = as_published(persistent_chain(quick_plant(plant_with, 0.01, AT_ONCE), grid))
    criterion = Criterion(1.0, 0.0)
    rms, with_lines, free = (
        math.sqrt(cost)
        for cost in (
            solved_cost(t, 2.5, criterion),
            ideal_cost(t, 2.5, criterion, with_lines=True),
            ideal_cost(t, 2.5, criterion, with_lines=False),
        )
    )
    print(f"at once: solver {rms:.5f}, ideal with lines {with_lines:.5f}, ideal {free:.5f} m/s")
    assert rms == pytest.approx(with_lines, rel=0.02)
    assert rms > 0.99 * free


def test_shrinking_transients_tend_to_the_ideal(plant_with: Callable[..., Plant], drive: Pneumatics) -> None:
    """All times of the drive and the sampling halved again and again: the rms closes in on the ideal one.

    From below: a transient that ends inside a quantum is a finer control than one choice a quantum. Measured at
    shares 1/4, 1/8, 1/16, 1/20 (the shortest period allowed): distance 7.9, 4.0, 2.1, 1.6 of 22.6 mm/s.
    """
    criterion, distances = Criterion(1.0, 0.0), []
    for share in (1 / 4, 1 / 8, 1 / 16, 1 / 20):
        times = ("brake_delay_s", "touch_delay_s", "release_delay_s", "fill_time_constant_s", "exhaust_time_constant_s")
        quick = replace(drive, dead_band_kpa=0.1, **{name: share * getattr(drive, name) for name in times})
        t = as_published(persistent_chain(quick_plant(plant_with, 0.1 * share, quick), QUANTUM))
        ideal = math.sqrt(ideal_cost(t, 2.5, criterion, with_lines=True))
        distances.append(abs(math.sqrt(solved_cost(t, 2.5, criterion)) - ideal))
    print("shrinking transients: distance from the ideal rms, m/s", distances)
    assert all(b < a for a, b in pairwise(distances))
    assert distances[-1] < 0.1 * ideal
