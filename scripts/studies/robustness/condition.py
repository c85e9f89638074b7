"""Named conditions of a retarder in service: wet or oiled, worn, low on air, half out of service, sensor at fault.

Their sizes are assumed, like the values they act on; none was measured.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Final

from plant_models import Plant
from scripts.studies.robustness.perturbation import Perturbation, reach_note
from scripts.studies.robustness.sensor_fault import Bias, DropOut, LostReadings, at_random, before_exit
from synth.configuration.plant_parameter import Parameter, nominal_value
from synth.configuration.plant_values import SLOPES, with_values

SLIVER_M: Final = 1e-6
"""Length of what is left of a zone out of service: it keeps entrance and exit in their places and does no work."""

AIR: Final = "retarder.pneumatics."


def conditions(plant: Plant, mass: Parameter, seed: int) -> tuple[Perturbation, ...]:
    """The named conditions that the nominal `plant` can be in.

    `mass` gives the lightest and heaviest cut of the category, `seed` the random moments of sensor faults.
    """
    return (
        Perturbation("wet: friction × 0.7, CV × 4/3", friction(0.7, 4.0 / 3.0)),
        Perturbation("oiled: friction × 0.5, CV × 5/3", friction(0.5, 5.0 / 3.0)),
        Perturbation("new bars: friction × 1.15", friction(1.15, 1.0)),
        Perturbation("aged valves: delays × 2, time constants × 1.5", aged_valves),
        low_on_air(plant, 0.9, "supply pressure −10 %"),
        low_on_air(plant, 0.8, "supply pressure −20 %"),
        Perturbation("dead band × 2", times(AIR + "dead_band_kpa", 2.0)),
        Perturbation("stage pressures −20 kPa", shifted_stages(-20.0)),
        Perturbation("stage pressures +20 kPa", shifted_stages(20.0)),
        *half_in_service(plant),
        Perturbation(f"lightest cut of the category, {mass.low:g} t", mass_of(mass.low)),
        Perturbation(f"heaviest cut of the category, {mass.high:g} t", mass_of(mass.high)),
        *sensor_at_fault(plant, seed),
    )


def half_in_service(plant: Plant) -> Iterator[Perturbation]:
    """One retarder of several does not brake."""
    if len(plant.position.zones_m) > 1:
        yield Perturbation("first retarder out of service", out_of_service(0))
        yield Perturbation("last retarder out of service", out_of_service(-1))


def sensor_at_fault(plant: Plant, seed: int) -> Iterator[Perturbation]:
    """Biased sensor, single readings missing, drop-outs."""
    if plant.sensor.noise_m_s > 0.0:
        yield Perturbation("sensor bias −0.1 m/s", fault=Bias(-0.1))
        yield Perturbation("sensor bias +0.1 m/s", fault=Bias(0.1))
    for share in (0.1, 0.3):
        yield Perturbation(f"{100 * share:.0f} % of the readings missing", fault=LostReadings(share, seed))
    for duration in (0.2, 0.5, 1.0):
        yield Perturbation(f"drop-out of {duration:g} s, any moment", fault=DropOut(duration, at_random(seed)))
    for duration in (0.2, 0.5, 1.0):
        yield Perturbation(f"drop-out of the last {duration:g} s", fault=DropOut(duration, before_exit(duration)))


def low_on_air(plant: Plant, factor: float, name: str) -> Perturbation:
    """Supply pressure times `factor`."""
    key = AIR + "supply_pressure_kpa"
    return Perturbation(name, times(key, factor), note=reach_note(plant, {key: factor * known(plant, key)}))


def times(key: str, factor: float) -> Callable[[Plant], Plant]:
    """The value under `key` times `factor`."""

    def change(plant: Plant) -> Plant:
        return with_values(plant, {key: factor * known(plant, key)})

    return change


def friction(mean: float, spread: float) -> Callable[[Plant], Plant]:
    """Friction factor with another mean, and its CV per cut times `spread`.

    ξ_cut and the slope K enter the force as their product: another mean of ξ, its floor in proportion, is another K.
    """

    def change(plant: Plant) -> Plant:
        slope = next(key for key in SLOPES if nominal_value(plant, key) is not None)
        cv = spread * plant.friction.common_cv
        return with_values(plant, {slope: mean * known(plant, slope), "friction.common_cv": cv})

    return change


def aged_valves(plant: Plant) -> Plant:
    """All valve delays doubled, filling and exhausting half as slow again."""
    slower = {"brake_delay_s": 2.0, "touch_delay_s": 2.0, "release_delay_s": 2.0}
    slower |= {"fill_time_constant_s": 1.5, "exhaust_time_constant_s": 1.5}
    return with_values(plant, {AIR + name: factor * known(plant, AIR + name) for name, factor in slower.items()})


def shifted_stages(shift_kpa: float) -> Callable[[Plant], Plant]:
    """All stage pressures but the released one moved by `shift_kpa`."""

    def change(plant: Plant) -> Plant:
        released, *braking = plant.position.stage_pressures_kpa
        moved = (released, *(pressure + shift_kpa for pressure in braking))
        return replace(plant, position=replace(plant.position, stage_pressures_kpa=moved))

    return change


def out_of_service(zone: int) -> Callable[[Plant], Plant]:
    """Zone number `zone` does not brake; the path to the exit and the controller stay as they are."""

    def change(plant: Plant) -> Plant:
        zones = list(plant.position.zones_m)
        if len(zones) < 2:
            raise ValueError(f"robustness: {plant.position.name} has one retarder; none can be out of service")
        start, end = zones[zone]
        zones[zone] = (start, start + SLIVER_M) if start == 0.0 else (end - SLIVER_M, end)
        return replace(plant, position=replace(plant.position, zones_m=tuple(zones)))

    return change


def mass_of(mass_t: float) -> Callable[[Plant], Plant]:
    """A cut of another mass under the table of its category."""

    def change(plant: Plant) -> Plant:
        return with_values(plant, {"cut.mass_t": mass_t})

    return change


def known(plant: Plant, key: str) -> float:
    """The value of `plant` under `key`, which it has."""
    value = nominal_value(plant, key)
    assert value is not None, key
    return value
