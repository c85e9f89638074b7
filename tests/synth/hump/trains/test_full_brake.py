"""The full brake of a position beside the closed loop whose regulator raises at every decision."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from plant_models import RollingResistance, couple
from plant_models.approach import Approach
from plant_models.brake_power import FullBrake
from plant_models.library.catalogue import load_car, load_position
from plant_models.plant import Plant
from synth.simulation.closed_loop import close_loop
from synth.simulation.controllers import full_brake
from synth.simulation.random_passes import random_passes
from tests.effort import every

GONDOLA = load_car("gondola-4").car


def taken_head_m(name: str, cars: int, ahead_m: float, closed: bool, entry_m_s: float) -> tuple[float, float]:
    """Energy head that the closed loop's brake takes at mean friction, and that of the full brake."""
    entry, mass_t = load_position(name), 94.0 * cars
    cut, top = couple((GONDOLA,) * cars, mass_t, "С", 4), entry.position.top_stage
    plant = Plant(
        entry.position, cut, entry.profile, replace(entry.friction, path_std=0.0), RollingResistance(1.3, 0.0),
        entry.sensor, entry.entry, Approach(ahead_m, top, top if closed else 0),
    )  # fmt: skip
    loop = close_loop(plant, plant.top_stage + 1)
    drawn = loop.draws(random_passes(1, 0, 1), cut_factor=1.0)
    start = plant.start_speed_m_s(np.array([entry_m_s]), 1.3)
    drawn = drawn._replace(entry_m_s=start)
    braked = loop.run(full_brake(loop.stages, plant.start_m, plant.exit_m), drawn).exit_speed_m_s[0]
    none = drawn._replace(brake_m_s2_per_kpa=np.zeros_like(drawn.brake_m_s2_per_kpa))
    free = loop.run(full_brake(loop.stages, plant.start_m, plant.exit_m), none).exit_speed_m_s[0]
    assert braked > 0.5
    taken = (free**2 - braked**2) / (2.0 * cut.reduced_gravity_m_s2)
    head = FullBrake(entry.position, GONDOLA).head_m(np.array([mass_t]), np.array([cut.axles]), np.array([4]))
    return float(taken), float(head[0])


@pytest.mark.parametrize(("name", "entry_m_s"), [("knp-5-bunch", 7.0), ("kv-3-bunch", 7.0), ("rnz-2m-park", 5.5)])
@pytest.mark.parametrize("cars", every(2, [3, 1]))
def test_a_brake_closed_before_the_entrance_takes_it_all(name: str, entry_m_s: float, cars: int) -> None:
    """The top stage stands from the cut ahead, as it is reached from below."""
    taken, head = taken_head_m(name, cars, 0.0, True, entry_m_s)
    assert taken == pytest.approx(head, rel=1e-6)


@pytest.mark.parametrize(("name", "entry_m_s"), [("knp-5-bunch", 7.0), ("rnz-2m-park", 5.5)])
@pytest.mark.parametrize("cars", [1, 3])
def test_rising_pressure_costs_a_part_of_it(name: str, entry_m_s: float, cars: int) -> None:
    """The top stage is commanded 4 m ahead of the entrance: 0.995 of it for one car, 0.998 for 3; at 5.5 m/s all."""
    taken, head = taken_head_m(name, cars, 4.0, False, entry_m_s)
    assert 0.99 * head < taken <= head * (1.0 + 1e-9)
