"""What the estimator of a table must know, worked out anew from the configuration of the tune."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

from synth.checker.estimator import Estimator
from synth.checker.plant import GRAVITY_M_S2, Plant

LEAST_NOISE_M_S: Final = 1e-4
"""A sensor without noise counts as having this much: an estimator needs some."""
NUMBER_TOLERANCE: Final = 1e-6
"""Relative."""
REPEATED_BY_CHANCE: Final = 1e-4
NEVER_FROZEN: Final = 10_000
DOUBTED_S: Final = 2.0
LOST_SPEED_STD_M_S: Final = 0.2
UNLIKELY_STDS: Final = 2.4
HIGHEST_CV: Final = 0.6
"""Of cuts at a known N: the spread of the mean friction widens it to this at most."""
CHANCE_TOLERANCE: Final = 1e-9
CHANCE_STEPS: Final = 2000
FAR_STDS: Final = 9.0
WORK_TOLERANCE: Final = 0.002
"""Of the largest work. Round-off apart, only even breaks on a long cut cost something, and breaks that are left out for
being 2 mm apart: 0.02 % each (a cut of 40 cars; 2 mm of a pass of 20 m)."""

Row = Sequence[float]


@dataclass(frozen=True)
class Work:
    """D and W of the plant at every place where N(s) or a grade under an axle changes; straight between."""

    s_m: tuple[float, ...]
    drive_m2_s2: tuple[float, ...]
    brake_m2_s2_per_kpa: tuple[float, ...]
    mean_braked: float


def work_of(plant: Plant) -> Work:
    """The work along the path, exact, piece by piece; and the mean number of braked pairs where any is."""
    marks = [edge for zone in plant.zones_m for edge in zone] + [start for start, _ in plant.grades]
    places = {mark + x for mark in marks for x in plant.axle_offsets_m}
    start = -plant.approach_m
    edges = sorted({start, plant.exit_m, *(s for s in places if start < s < plant.exit_m)})
    reduced = GRAVITY_M_S2 * plant.mass_t / plant.inertia_t * 1e-3
    drive, brake, pairs, length = [0.0], [0.0], 0.0, 0.0
    for a, b in pairwise(edges):
        middle = 0.5 * (a + b)
        n = plant.braked(middle)
        drive.append(drive[-1] + reduced * (plant.grade_permille(middle) - plant.resistance_n_kn[0]) * (b - a))
        slope = n * plant.slope_kn_per_kpa[n - 1] / plant.inertia_t if n else 0.0
        brake.append(brake[-1] + slope * (b - a))
        pairs, length = pairs + n * (b - a), length + (b - a if n else 0.0)
    return Work(tuple(edges), tuple(drive), tuple(brake), pairs / length if length > 0.0 else 1.0)


def estimator_faults(estimator: Estimator | None, plant: Plant, wanted: bool) -> Iterator[str]:
    """Where the estimator is not the one of `plant`; `wanted`: whether the configuration asks for one."""
    if wanted != (estimator is not None):
        yield f"its configuration asks for {'an' if wanted else 'no'} estimator, it has {'none' if wanted else 'one'}"
    if estimator is None:
        return
    work = work_of(plant)
    yield from number_faults(estimator, plant, work.mean_braked)
    yield from count_faults(estimator, plant)
    for name, unit, own, right in (
        ("D", "m²/s²", estimator.drive_m2_s2, work.drive_m2_s2),
        ("W", "m²/s² per kPa", estimator.brake_m2_s2_per_kpa, work.brake_m2_s2_per_kpa),
    ):
        apart, place = farthest(estimator.s_m, own, work.s_m, right)
        if apart > WORK_TOLERANCE * max(map(abs, right)) + 1e-12:
            found, due = at(estimator.s_m, own, place), at(work.s_m, right, place)
            yield f"its estimator's {name} is {found:.6g} {unit} at s = {place:.3f} m, but the plant gives {due:.6g}"


def number_faults(estimator: Estimator, plant: Plant, mean_braked: float) -> Iterator[str]:
    """Sensor, friction, resistance and touch pressure."""
    quantised = plant.resolution_m_s / math.sqrt(12.0)
    of_axles = plant.axle_cv / math.sqrt(max(1.0, mean_braked))
    on_any_day = math.hypot(min(math.hypot(plant.friction_cv, plant.mean_cv), HIGHEST_CV), of_axles)
    reduced = GRAVITY_M_S2 * plant.mass_t / plant.inertia_t * 1e-3
    for name, found, due in (
        ("speed noise", estimator.speed_noise_m_s, max(math.hypot(plant.noise_m_s, quantised), LEAST_NOISE_M_S)),
        ("friction_cv", estimator.friction_cv, math.hypot(plant.friction_cv, of_axles)),
        ("resistance_std", estimator.resistance_std_m_s2, reduced * plant.resistance_n_kn[1]),
        ("path_std", estimator.path_std, plant.path_std),
        ("correlation length", estimator.correlation_length_m, plant.correlation_m),
        ("limit of a lost speed", estimator.lost_speed_std_m_s, LOST_SPEED_STD_M_S),
        ("unlikely deviation", estimator.unlikely_deviation, UNLIKELY_STDS * on_any_day),
        ("touch pressure", estimator.touch_pressure_kpa, plant.drive.touch_kpa),
    ):
        if not math.isclose(found, due, rel_tol=NUMBER_TOLERANCE, abs_tol=1e-9):
            yield f"its estimator's {name} is {found:.6g}, but its configuration gives {due:.6g}"


def count_faults(estimator: Estimator, plant: Plant) -> Iterator[str]:
    """Numbers of readings: those where rounding decides between two may be either."""
    exact = max(1.0, DOUBTED_S / plant.period_s)
    if abs(estimator.doubted_readings - exact) > 0.5 + CHANCE_TOLERANCE * exact:
        yield f"its estimator doubts {estimator.doubted_readings} readings, but {exact:.6g} are {DOUBTED_S:g} s"
    chance = chance_of_equals(plant.noise_m_s, plant.resolution_m_s)
    fewest, most = (frozen_after(chance * (1.0 + off)) for off in (-CHANCE_TOLERANCE, CHANCE_TOLERANCE))
    if not fewest <= estimator.frozen_readings <= most:
        yield f"its estimator calls {estimator.frozen_readings} repetitions frozen, but its configuration gives {most}"


def frozen_after(chance: float) -> int:
    """How often a reading must repeat itself to be more than chance, where two are equal with `chance`."""
    count, left = 1, chance
    while left > REPEATED_BY_CHANCE and count < NEVER_FROZEN:
        count, left = count + 1, left * chance
    return count


def chance_of_equals(noise_m_s: float, resolution_m_s: float) -> float:
    """Chance that two readings of one speed, which lies anywhere in its step, are equal.

    They fall into one step with 1 − |d|/resolution, where their noise differs by d: normal, of √2 noise. The integral
    over d by Simpson's rule, as far as d can be: to the resolution, and to `FAR_STDS` at most.
    """
    if resolution_m_s == 0.0:
        return 0.0
    if noise_m_s == 0.0:
        return 1.0
    steps = resolution_m_s / (math.sqrt(2.0) * noise_m_s)
    end = min(steps, FAR_STDS)
    total, h = 0.0, end / CHANCE_STEPS
    for i in range(CHANCE_STEPS + 1):
        weight = 1.0 if i in (0, CHANCE_STEPS) else 4.0 if i % 2 else 2.0
        total += weight * (1.0 - i * h / steps) * math.exp(-0.5 * (i * h) ** 2)
    return 2.0 / math.sqrt(2.0 * math.pi) * total * h / 3.0


def farthest(places: Row, values: Row, other_places: Row, others: Row) -> tuple[float, float]:
    """Largest distance of two broken lines, and where: at a break of either, for between them both are straight."""
    every = sorted({*places, *other_places})
    return max((abs(at(places, values, s) - at(other_places, others, s)), s) for s in every)


def at(places: Row, values: Row, s: float) -> float:
    """A broken line at `s`, beyond its ends the value there."""
    s = min(max(s, places[0]), places[-1])
    i = min(bisect_right(places, s), len(places) - 1)
    part = (s - places[i - 1]) / (places[i] - places[i - 1])
    return values[i - 1] + part * (values[i] - values[i - 1])
