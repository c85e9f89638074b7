"""What the studies `limits` and `estimator-wrong` change is what they say, and nothing else."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import fields, is_dataclass, replace
from typing import Any

import pytest

from plant_models import Plant
from scripts.studies.any_time.study import quicker
from scripts.studies.estimator.wrong import wrongs
from scripts.studies.limits.change import FREE_DEGREE, QUIET_M_S, changes
from scripts.studies.sensor_fault import no_fault


def differences(one: Any, other: Any, name: str = "") -> Iterator[tuple[str, Any, Any]]:
    """(dotted name, value in one, value in the other) of every leaf that differs."""
    if is_dataclass(one) and type(one) is type(other):
        for field in fields(one):
            yield from differences(getattr(one, field.name), getattr(other, field.name), f"{name}.{field.name}")
    elif one != other:
        yield name.lstrip("."), one, other


VALVES = [
    f"position.pneumatics.{name}"
    for name in ("brake_delay_s", "touch_delay_s", "release_delay_s", "fill_time_constant_s", "exhaust_time_constant_s")
]

CHANGED = {
    "as it is": {},
    f"lines of degree {FREE_DEGREE}": {},
    "no spread of friction between cuts": {"friction.common_cv": 0.01},
    "no friction noise along the path": {"friction.path_std": 0.0},
    "no spread of rolling resistance": {"resistance.std_n_per_kn": 0.0},
    "sampled twice as often": {"sensor.sample_period_s": 0.05},
    "no computing delay": {"sensor.computing_delay_s": 0.0},
    "measured speed with 0.02 m/s of noise": {"sensor.noise_m_s": 0.02, "sensor.resolution_m_s": 0.0},
    "valves four times as fast": dict(zip(VALVES, (0.025, 0.05, 0.025, 0.075, 0.075), strict=True)),
}


def test_limits_switch_off_one_source_at_a_time(plant_52t: Plant) -> None:
    found = {each.name: each for each in changes(plant_52t, 3)}
    assert set(found) == set(CHANGED)
    for name, expected in CHANGED.items():
        changed = {leaf: new for leaf, _, new in differences(plant_52t, found[name].plant)}
        assert changed == pytest.approx(expected), name
        assert found[name].degree == (FREE_DEGREE if name.startswith("lines") else 3)
        assert (found[name].speed_step_m_s is None) == ("measured" not in name)
    quiet = found[f"measured speed with {QUIET_M_S:g} m/s of noise"]
    assert quiet.speed_step_m_s is not None
    assert quiet.speed_step_m_s < QUIET_M_S


SLOPE = "position.force.slope_kn_per_kpa_per_pair"

WRONG: dict[str, tuple[str, float]] = {
    "friction × 0.7": (SLOPE, 0.7),
    "friction × 0.8": (SLOPE, 0.8),
    "friction × 0.9": (SLOPE, 0.9),
    "friction × 1.1": (SLOPE, 1.1),
    "friction × 1.2": (SLOPE, 1.2),
    "friction × 1.3": (SLOPE, 1.3),
    "friction CV × 1.7": ("friction.common_cv", 1.7),
    "path noise × 2": ("friction.path_std", 2.0),
    "mass + 15 %": ("cut.mass_t", 1.15),
    "mass − 15 %": ("cut.mass_t", 0.85),
    "sensor noise × 2": ("sensor.noise_m_s", 2.0),
}


def test_an_estimator_is_wrong_about_one_thing_at_a_time(plant_52t: Plant) -> None:
    found = {each.name: each for each in wrongs(plant_52t, 1)}
    for name, wrong in found.items():
        changed = [(leaf, new / old) for leaf, old, new in differences(plant_52t, wrong.plant)]
        assert changed == ([(WRONG[name][0], pytest.approx(WRONG[name][1]))] if name in WRONG else []), name
        assert (wrong.fault is not no_fault) == ("lost" in name)
        assert wrong.gauge == {"gauge + 15 %": 1.15, "gauge − 15 %": 0.85}.get(name, 1.0)
    assert len(found) == len(WRONG) + 4


def test_quicker_valves_are_the_same_but_for_their_times(plant_of: Callable[[float], Plant]) -> None:
    plant = plant_of(22.0)
    changed = {leaf: old / new for leaf, old, new in differences(plant, quicker(plant, 4.0))}
    assert changed == dict.fromkeys(VALVES, pytest.approx(4.0))
    slow = replace(plant.position.pneumatics, closing_delay_s=0.02)
    closing = replace(plant, position=replace(plant.position, pneumatics=slow))
    assert quicker(closing, 2.0).position.pneumatics.closing_delay_s == 0.01
