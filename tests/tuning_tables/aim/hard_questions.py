"""Questions to an aim table that are as hard as numbers can be."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from synth.kernels.aim_speeds import aim_exit_speeds
from tests.tuning_tables.aim.made_tables import category_table, measured_table, random_table
from tuning_tables.aim import AimTable, AimTables

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
