"""Tables for point sensors of many shapes, made by hand: the speed from which a cut just leaves with the target."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from tests.controller_code.sample_book import FOUR_AXLES, SIX_AXLES
from tuning_tables import CutId, Generator, Predicted, RetarderId
from tuning_tables.decisions import Approach
from tuning_tables.passages.passage_book import PassageBook
from tuning_tables.passages.passage_row import PassageRow
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.sensor_layout import DecidesOn, PlausibleMotion, SensorLayout

BUNCH = (-4.0, 2.0, 10.65, 14.0, 21.25, 30.0, 39.0)
"""The third one stands two axles of a four-axle car behind the second: their pairs come together. The last one stands
behind the exit and logs."""

MOTION = PlausibleMotion((0.3, 12.0), 0.6, 2.5, 0.06, 0.25)


def passage_table(
    name: str = "bunch",
    category: str = "Л",
    axles: tuple[float, ...] = FOUR_AXLES,
    target_m_s: float = 2.5,
    stages: int = 5,
    places_m: tuple[float, ...] = BUNCH,
    decides_on: DecidesOn = DecidesOn.FIRST_AXLE,
    motion: PlausibleMotion = MOTION,
    entrance_stage: int | None = None,
    exit_m: float = 37.45,
) -> PassageTable:
    """A table whose stage is the higher the more work is still to be done; some speeds are infinite."""
    sensors = SensorLayout(places_m, 0.2, 0.002, 1e-4, 1e-4, 0.02, 0.02, decides_on)
    rows = tuple(
        PassageRow(sensor, axle, path_m, switching_rows(target_m_s, stages, exit_m - path_m, index))
        for index, (sensor, axle, path_m) in enumerate(sensors.passages(axles, exit_m))
    )
    return PassageTable(
        id=name,
        created="2026-11-21T08:00:00Z",
        generator=Generator("retarder-synth", "0.1.0", "0123456789abcdef" * 4),
        retarder=RetarderId("КНП-5 /* bunch */ ??/", ((0.0, 12.475), (14.475, 26.95)), exit_m, 15.0),
        cut=CutId(category, 23.0, axles),
        target_speed_m_s=target_m_s,
        pressure_kpa=tuple(150.0 * k for k in range(stages)),
        sensors=sensors,
        approach=Approach(-places_m[0], stages // 2 if entrance_stage is None else entrance_stage),
        initial_stage=0,
        passages=rows,
        plausible=motion,
        valid_v_m_s=(0.3, 9.0),
        predicted=Predicted(0.05, -0.001, 0.01, 4.1),
    )


def switching_rows(target_m_s: float, stages: int, left_m: float, index: int) -> tuple[tuple[float, ...], ...]:
    """Rows of float32 numbers that do not fall; every third passage never raises to the top or lowers to 0."""
    shares = [(j + 0.5) / stages for j in range(stages - 1)]
    middle = [math.sqrt(target_m_s**2 + 2.0 * 0.9 * share * max(left_m, 0.1)) for share in shares]
    rows = []
    for stage in range(stages):
        moved = [float(np.float32(v + (0.04 if j >= stage else -0.04))) for j, v in enumerate(middle)]
        if index % 3 == 1 and stage < stages - 1:
            moved[-1] = math.inf
        if index % 3 == 2 and stage > 0:
            moved[0] = -math.inf
        rows.append(tuple(moved))
    return tuple(rows)


def odd_table(decides_on: DecidesOn = DecidesOn.FIRST_AXLE) -> PassageTable:
    """Two stages and extreme numbers: 0, the smallest and the largest float32, wide and narrow limits."""
    largest, smallest = float(np.finfo(np.float32).max), float(np.finfo(np.float32).smallest_subnormal)
    made = passage_table(
        "odd", "Т", FOUR_AXLES, 3.0, 2, BUNCH, decides_on,
        PlausibleMotion((0.01, 40.0), 10.0, 0.001, 0.9, 0.0), 1,
    )  # fmt: skip
    speeds = [((0.0,), (0.0,)), ((smallest,), (largest,)), ((math.inf,), (-math.inf,))]
    rows = tuple(
        PassageRow(row.sensor, row.axle, row.path_m, speeds[index % 3]) for index, row in enumerate(made.passages)
    )
    return replace(made, passages=rows)


def passage_tables() -> tuple[PassageTable, ...]:
    """Those of both books: usual ones on the first and on every axle, then the odd ones."""
    first, every = passage_book().tables, every_axle_book().tables
    return (first[0], *every[:2], first[4], first[1], first[2], first[3], first[5], every[2])


def passage_book() -> PassageBook:
    """Two targets of a class, between them one lighter; six axles; many stages; odd numbers. On the first axle."""
    return PassageBook(
        (
            passage_table("to 2.5"),
            replace(passage_table("shadow", target_m_s=3.0), cut=CutId("Л", 22.0, FOUR_AXLES)),
            passage_table("to 3.5", target_m_s=3.5, entrance_stage=4),
            passage_table("six axles", "С", SIX_AXLES, 2.0, entrance_stage=0),
            passage_table("many stages", "СТ", stages=9),
            odd_table(),
        )
    )


def every_axle_book() -> PassageBook:
    """Tables that decide on every axle."""
    every = DecidesOn.EVERY_AXLE
    return PassageBook(
        (
            passage_table("four axles", decides_on=every),
            passage_table("six axles", "С", SIX_AXLES, 2.0, decides_on=every, entrance_stage=0),
            odd_table(every),
        )
    )
