"""Aim tables to test with, in closed form and random ones, and questions that are as hard as numbers can be."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from synth.kernels.aim_speeds import aim_exit_speeds
from tuning_tables.aim import (
    AimAxes,
    AimCategory,
    AimTable,
    AimTables,
    MeasuredResistance,
    ParkPosition,
    Reported,
    Required,
)
from tuning_tables.provenance import Generator

COUPLING_M_S = 1.39
BOUNDS_M_S = (0.5, 7.0)
DISTANCES_M = (20.0, 50.0, 100.0, 150.0, 200.0, 300.0, 400.0)
RESISTANCES = (0.4, 0.9, 1.5, 2.2, 3.0)
CARS = (1, 2, 3, 5, 8)


def exact_speed(distance_m: npt.ArrayLike, resistance_n_per_kn: npt.ArrayLike, grade: float) -> npt.NDArray[np.float64]:
    """The exit speed that just couples at 1.39 m/s: v² = v_c² + 2 g' (w - i) d 10⁻³; NaN where there is none."""
    inertia = 9.81 / 1.05
    square = COUPLING_M_S**2 + 2e-3 * inertia * (np.asarray(resistance_n_per_kn) - grade) * np.asarray(distance_m)
    return np.sqrt(np.where(square > 0.0, square, np.nan))


def bounded(speeds: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Speeds made fit for a table: at most the highest one, none below the lowest."""
    found = np.minimum(speeds, BOUNDS_M_S[1])
    found[~(found >= BOUNDS_M_S[0])] = np.nan
    return found


def reported_of(speeds: npt.NDArray[np.float64], p: float = 0.1) -> Reported:
    """Figures that fit the nodes: about the required share, gaps that grow with the distance."""
    null = np.where(np.isnan(speeds), np.nan, 0.0)
    gap = null + np.arange(float(speeds.shape[1])).reshape((-1, *[1] * (speeds.ndim - 2)))
    return Reported(20_000, null + p - 0.001, null + p - 0.005, null + p + 0.003, gap)


def table_of(axes: AimAxes, speeds: npt.NDArray[np.float64], number: int = 1, name: str = "Л") -> AimTable:
    """A table of the one position that all are for."""
    measured = MeasuredResistance(228.0, 338.0, 0.03)
    kind = "category" if axes.resistance_n_per_kn is None else "measured"
    return AimTable(
        id=f"aim-{number}-{kind}",
        created="2026-11-22T08:00:00Z",
        generator=Generator("retarder-synth", "0.1.0", "0123456789abcdef" * 4),
        position=ParkPosition("rnz-2m-park", 338.0),
        category=AimCategory(number, name),
        required=Required(0.1, COUPLING_M_S),
        measured=None if axes.resistance_n_per_kn is None else measured,
        axes=axes,
        exit_speed_m_s=speeds,
        bounds_m_s=BOUNDS_M_S,
        interpolation_error_m_s=0.012,
        reported=reported_of(speeds),
    )


def category_table(grade: float = 0.6, number: int = 1, name: str = "Л") -> AimTable:
    """By category: a resistance that rises to the mean with the number of cars; on a steep grade falling, then null."""
    cars, distance = np.array(CARS), np.array(DISTANCES_M)
    resistance = 1.6 - 0.9 / np.sqrt(cars)
    speeds = bounded(exact_speed(distance[None, :], resistance[:, None], grade))
    return table_of(AimAxes(cars, distance), speeds, number, name)


def measured_table(grade: float = 1.0, number: int = 1, name: str = "Л") -> AimTable:
    """By measured resistance, less by what the measurement may be wrong by; nulls for resistances below the grade."""
    cars, distance, resistance = np.array(CARS), np.array(DISTANCES_M), np.array(RESISTANCES)
    margin = 0.3 / np.sqrt(cars)
    known = resistance[None, None, :] - margin[:, None, None]
    speeds = bounded(exact_speed(distance[None, :, None], known, grade))
    return table_of(AimAxes(cars, distance, resistance), speeds, number, name)


def random_table(seed: int, measured: bool) -> AimTable:
    """A table of any shape with hard numbers: uneven axes, equal and nearly equal speeds, nulls, both bounds."""
    random = np.random.default_rng(seed)
    cars = np.sort(random.choice(np.arange(1, 40), random.integers(1, 7), replace=False))
    distance = np.cumsum(random.choice([0.002, 0.3, 1.0 / 3.0, 12.345, 250.0], random.integers(1, 12)))
    resistance = np.cumsum(random.choice([0.002, 0.1, 1.0 / 7.0, 2.5], random.integers(1, 9))) - 1.0
    shape = (len(cars), len(distance), len(resistance) if measured else 1)
    start = random.choice([0.5, 1.4, 1.4000001, 2.0, 6.3], (*shape[:2], 1))
    rises = random.choice([0.0, 1e-7, 0.01, 0.7], shape)
    speeds = np.minimum(start + rises.cumsum(2), 7.0)
    speeds[random.random(shape) < random.choice([0.0, 0.1])] = np.nan
    axes = AimAxes(cars, distance, resistance if measured else None)
    return replace(table_of(axes, speeds.reshape(axes.shape)), id=f"random-{seed}-{'m' if measured else 'c'}")


QUESTION = np.dtype([("table", "u4"), ("cars", "i4"), ("distance", "f4"), ("resistance", "f4")])


def sample_set() -> AimTables:
    """Tables of many shapes: in closed form, with nulls, of the user's own categories, random ones."""
    made: list[AimTable] = [category_table(1.0), measured_table(), category_table(1.5, 4, "СТ")]
    for number in range(16, 24):
        for measured in (False, True):
            source = random_table(number, measured)
            made.append(replace(source, category=replace(source.category, number=number, name=f"own {number}")))
    return AimTables(tuple(made))


def hard_questions(aims: AimTables, count: int, seed: int) -> npt.NDArray[np.void]:
    """(count,) of `QUESTION`: a third at or beside nodes, a third within the axes, the rest any bit patterns."""
    random = np.random.default_rng(seed)
    asked = np.zeros(count, QUESTION)
    asked["table"] = random.integers(0, len(aims.tables), count)
    for number, table in enumerate(aims.tables):
        here = np.flatnonzero(asked["table"] == number)
        listed = random.choice(table.axes.cars, len(here)) + random.integers(-1, 3, len(here))
        odd = random.integers(-(2**31), 2**31, len(here)) >> random.integers(0, 31, len(here))
        asked["cars"][here] = np.where(random.random(len(here)) < 0.9, listed, odd)
        for name, nodes in (("distance", table.held.distance_m), ("resistance", table.held.resistance_n_per_kn)):
            kind = random.random(len(here))
            with np.errstate(all="ignore"):
                beside = np.nextafter(
                    random.choice(nodes, len(here)), np.float32(np.inf) * random.choice([-1, 1], len(here))
                )
            at = np.where(random.random(len(here)) < 0.5, random.choice(nodes, len(here)), beside)
            span = nodes[-1] - nodes[0]
            within = random.uniform(nodes[0] - 0.02 * span, nodes[-1] + 0.02 * span, len(here))
            bits = random.integers(0, 2**32, len(here), dtype=np.uint32).view(np.float32)
            bits[::7] = random.choice(np.array([np.nan, np.inf, -np.inf, 0.0, -0.0, 1e-45, 3.4028235e38], np.float32))
            asked[name][here] = np.where(kind < 0.3, at, np.where(kind < 0.95, within, bits))
    return asked


def answers(aims: AimTables, asked: npt.NDArray[np.void]) -> npt.NDArray[np.float32]:
    """What the reference says, -1 for no answer."""
    found = np.full(len(asked), np.float32(-1.0))
    for number, table in enumerate(aims.tables):
        here = asked["table"] == number
        speeds = aim_exit_speeds(table.held, asked["cars"][here], asked["distance"][here], asked["resistance"][here])
        found[here] = np.where(np.isnan(speeds), np.float32(-1.0), speeds)
    return found
