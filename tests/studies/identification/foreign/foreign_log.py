"""Logs and exit speeds of many passes of foreign plants."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays
from tests.studies.identification.foreign.foreign_draws import foreign_draw
from tests.studies.identification.foreign.foreign_pass import ForeignPass, foreign_pass
from tests.studies.identification.foreign.foreign_plant import ForeignPlant
from tuning_tables import ControllerTable
from tuning_tables.pass_log.pass_log import PassLog

HEADWAY_S = (15.0, 40.0)
"""From the end of a pass to the first row of the next."""

FEWEST_ROWS = 2
"""Of a pass in a log."""


@frozen_arrays
@dataclass(frozen=True, eq=False)
class ForeignExits:
    """True exits of n passes, (n,): speed (0 where stalled), whether the cut stalled, number of commands."""

    speed_m_s: NDArray[np.float64]
    stalled: NDArray[np.bool_]
    switchings: NDArray[np.int64]

    def rms_m_s(self, target_m_s: float) -> float:
        """Root mean square of the exit error; a stall counts as speed 0."""
        return float(np.sqrt(np.mean((self.speed_m_s - target_m_s) ** 2)))


def foreign_exits(table: ControllerTable, plant: ForeignPlant, passes: int, seed: int) -> ForeignExits:
    """Exits of passes 0 ... `passes` - 1 of `seed`: the same cuts for every table, and those of `foreign_log`."""
    ran = [foreign_pass(table, plant, foreign_draw(plant, seed, number)) for number in range(passes)]
    return ForeignExits(
        np.array([each.exit_speed_m_s for each in ran]),
        np.array([each.stalled for each in ran], dtype=np.bool_),
        np.array([each.switchings for each in ran], dtype=np.int64),
    )


def foreign_log(
    tables_by_class: Mapping[str, ControllerTable], plants: Mapping[str, ForeignPlant], passes: int, seed: int
) -> PassLog:
    """The log of `passes` passes of each class, in a random order, rows of all on one clock, as a yard would keep it.

    Both mappings have the same keys. The cut id is 'CLASS-NUMBER': pass NUMBER of `foreign_exits` with this seed.
    Times are whole sampling periods of the first plant. Raises `ValueError` where keys or periods differ.
    """
    labels = sorted(tables_by_class)
    periods = {plant.sensor.period_s for plant in plants.values()}
    if labels != sorted(plants) or len(periods) != 1:
        raise ValueError("a log needs one table a plant, and one sampling period.")
    rng, period = np.random.default_rng((seed, 0)), periods.pop()
    order = [(labels[i % len(labels)], i // len(labels)) for i in rng.permutation(passes * len(labels))]
    ran = [
        foreign_pass(tables_by_class[label], plants[label], foreign_draw(plants[label], seed, number))
        for label, number in order
    ]
    for (label, number), each in zip(order, ran, strict=True):
        if len(each.time_s) < FEWEST_ROWS:
            raise ValueError(f"pass {label}-{number} is over after fewer than {FEWEST_ROWS} samples.")
    cuts = [(tables_by_class[label], plants[label].cut) for label, _ in order]
    return PassLog(
        time_s=_clock_s(ran, rng.uniform(*HEADWAY_S, len(ran)), period),
        path_m=np.concatenate([each.path_m for each in ran]),
        speed_m_s=np.concatenate([each.speed_m_s for each in ran]),
        pressure_kpa=np.concatenate([each.pressure_kpa for each in ran]),
        stage=np.concatenate([each.stage for each in ran]),
        first_row=np.cumsum([0, *(len(each.time_s) for each in ran)]),
        cut_id=tuple(f"{label}-{number}" for label, number in order),
        mass_t=np.array([cut.mass_t for _, cut in cuts]),
        axles=np.array([len(cut.axle_offsets_m) for _, cut in cuts]),
        category=tuple(cut.category for _, cut in cuts),
        target_m_s=np.array([table.target_speed_m_s for table, _ in cuts]),
        stopped_by_hand=np.zeros(len(ran), dtype=np.bool_),
    )


def _clock_s(ran: list[ForeignPass], headway_s: NDArray[np.float64], period_s: float) -> NDArray[np.float64]:
    """Times of all rows on one clock that ticks once a period."""
    ticks, tick = [], 0
    for each, headway in zip(ran, headway_s, strict=True):
        ticks.append(tick + np.arange(len(each.time_s)))
        tick += math.ceil((each.end_s + headway) / period_s)
    return np.concatenate(ticks).astype(np.float64) * period_s
