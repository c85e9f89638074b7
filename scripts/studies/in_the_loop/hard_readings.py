"""Readings and commands where a wrong implementation of the rule or the choice shows."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from scripts.studies.in_the_loop.controller_process import COMMAND, READING
from tuning_tables import ControllerTable
from tuning_tables.golden_choices import golden_choices
from tuning_tables.golden_vectors import golden_vectors, line_speeds
from tuning_tables.rule import rises_at
from tuning_tables.table_book import TableBook


def hard_readings(book: TableBook, count: int, seed: int) -> NDArray[np.void]:
    """`count` readings, dtype READING: golden ones, ties and their neighbours, any bits, stages out of range."""
    rng = np.random.default_rng(seed)
    kinds = (golden_readings(book), near_lines(book, count // 2, rng), anything(book, count // 4, rng))
    found = np.concatenate(kinds)
    assert len(found) < count
    return np.concatenate([found, plausible(book, count - len(found), rng)])


def golden_readings(book: TableBook) -> NDArray[np.void]:
    """The vectors that are shipped."""
    parts = []
    for number, table in enumerate(book.tables):
        vectors = golden_vectors(table)
        of = np.full(len(vectors), number)
        parts.append(readings(of, vectors.stage, vectors.s_m, vectors.v_m_s, vectors.pressure_kpa))
    return np.concatenate(parts)


def near_lines(book: TableBook, count: int, rng: np.random.Generator) -> NDArray[np.void]:
    """Speeds on a line or surface, or up to two float32 steps from it; half of the lines are another stage's."""
    parts, lines = [], [
        (number, k, i) for number, t in enumerate(book.tables) for k, i in np.argwhere(t.has_line).tolist()
    ]  # fmt: skip
    each = count // len(lines)
    for number, k, i in lines:
        table = book.tables[number]
        low, high = (float(end) for end in table.valid_range[:2])
        s = rng.uniform(low - 1.0, high + 1.0, each).astype(np.float32)
        kpa = pressures(table, k, each, rng) if table.has_gauge else np.full(each, np.nan, np.float32)
        v = line_speeds(table.coefficients[k, i], np.clip(s, table.valid_range[0], table.valid_range[1]))
        if table.has_gauge:
            v = v + rises_at(table, k, kpa)[:, i]
        steps = rng.integers(-2, 3, each)
        for _ in range(2):
            towards = np.where(steps < 0, -np.inf, np.inf).astype(np.float32)
            v = np.where(steps != 0, np.nextafter(v, towards), v)
            steps -= np.sign(steps)
        stage = np.full(each, k)
        if table.farthest > 1:
            stage = np.where(rng.random(each) < 0.5, rng.integers(0, len(table.stages), each), stage)
        parts.append(readings(np.full(each, number), stage, s, v, kpa))
    return np.concatenate(parts)


def pressures(table: ControllerTable, stage: int, count: int, rng: np.random.Generator) -> NDArray[np.float32]:
    """Within the pressures of a table with slopes, and outside; some beside a bound, some that are none."""
    bounds = table.pressures[[0, table.highest_raised, stage]]
    found = rng.uniform(float(bounds[0]) - 60.0, float(table.pressures[-1]) + 60.0, count).astype(np.float32)
    edges = rng.choice(bounds, count)
    towards = rng.choice(np.array([-np.inf, np.inf], np.float32), count)
    beside = np.where(rng.random(count) < 0.5, np.nextafter(edges, towards), edges)
    found = np.where(rng.random(count) < 0.2, beside, found)
    return np.where(rng.random(count) < 0.1, rng.choice(NO_PRESSURES, count), found).astype(np.float32)


NO_PRESSURES = np.array([np.nan, np.inf, -np.inf, 3.4028235e38, -3.4028235e38, 1e-45, -0.0], dtype=np.float32)
"""What is no pressure, and what only just is one."""


def anything(book: TableBook, count: int, rng: np.random.Generator) -> NDArray[np.void]:
    """Any bits as path and speed: NaN of every kind, infinities, denormals; any stage."""
    bits = rng.integers(0, 2**32, (2, count), dtype=np.uint32)
    special = rng.integers(0, 4, (2, count))
    edged = bits & np.uint32(0x807FFFFF) | rng.choice(EXPONENTS, (2, count))
    bits = np.where(special == 0, edged, np.where(special == 1, edged & np.uint32(0xFF800000), bits)).astype(np.uint32)
    s, v = bits.view(np.float32)
    ordinary = rng.random(count) < 0.5
    s = np.where(ordinary, rng.uniform(-5.0, 45.0, count).astype(np.float32), s)
    s = np.where(rng.random(count) < 0.1, rng.choice(AT_THE_ENTRANCE, count), s)
    stage = np.where(rng.random(count) < 0.1, rng.integers(-(2**31), 2**31, count), rng.integers(-2, 11, count))
    number = rng.integers(0, len(book.tables), count)
    return readings(number, stage, s, v, any_pressures(book, count, rng))


def any_pressures(book: TableBook, count: int, rng: np.random.Generator) -> NDArray[np.float32]:
    """Any bits, half of them of usual pressures; NaN where no table of the book has slopes."""
    if not any(table.has_gauge for table in book.tables):
        return np.full(count, np.nan, np.float32)
    wild = rng.integers(0, 2**32, count, dtype=np.uint32).view(np.float32)
    usual = rng.uniform(-50.0, 1300.0, count).astype(np.float32)
    return np.where(rng.random(count) < 0.5, usual, wild).astype(np.float32)


EXPONENTS = np.array([0x00000000, 0x7F800000, 0x7F000000, 0x00800000], dtype=np.uint32)
"""Of denormals and zeros, of NaN and infinity, of the largest and of the smallest normal numbers."""


AT_THE_ENTRANCE = np.array([-1e-3, -1.1754944e-38, -1e-45, -0.0, 0.0, 1e-45, 1e-3], dtype=np.float32)
"""On either side of the place from which on any stage may be commanded."""


def plausible(book: TableBook, count: int, rng: np.random.Generator) -> NDArray[np.void]:
    """What a cut really gives, from before the approaches on."""
    begins = [float(table.valid_range[0]) for table in book.tables]
    s, v = rng.uniform(min(begins) - 1.0, 39.0, count), rng.uniform(0.0, 9.0, count)
    number, stage = rng.integers(0, len(book.tables), count), rng.integers(0, 5, count)
    return readings(number, stage, s, v, any_pressures(book, count, rng))


def readings(
    table: NDArray[Any], stage: NDArray[Any], s: NDArray[Any], v: NDArray[Any], pressure_kpa: NDArray[np.float32]
) -> NDArray[np.void]:
    """As an array of READING."""
    found = np.empty(len(table), READING)
    found["table"], found["stage"], found["s_m"], found["v_m_s"] = table, stage, s, v
    found["pressure_kpa"] = pressure_kpa
    return found


def hard_commands(book: TableBook, count: int, seed: int) -> NDArray[np.void]:
    """Commands for a choice, dtype COMMAND: the golden ones, and random ones with a third of them senseless."""
    rng = np.random.default_rng(seed)
    found = np.empty(count, COMMAND)
    numbers = [book.number_of(category) for category in book.category_numbers]
    found["category"] = rng.choice([*numbers, 0, -1, max(numbers) + 1], count)
    found["axles"] = rng.choice([4, 6, 8], count)
    targets = np.array([table.target_speed_m_s for table in book.tables], dtype=np.float32)
    speed = rng.uniform(1.0, 5.0, count).astype(np.float32)
    speed = np.where(rng.random(count) < 0.2, rng.choice(targets, count), speed)
    wild = rng.integers(0, 2**32, count, dtype=np.uint32).view(np.float32)
    found["speed_m_s"] = np.where(rng.random(count) < 0.3, wild, speed)
    golden = np.array([(c.category, c.axles, c.commanded_m_s) for c in golden_choices(book)], COMMAND)
    return np.concatenate([golden, found])
