"""Small sound logs: cuts that roll at a known speed while a gauge follows the stage."""

from __future__ import annotations

import numpy as np

from tuning_tables.pass_log.pass_log import PassLog


def sample_log(passes: int = 6, rows: int = 40, first: int = 0, gauge: bool = True) -> PassLog:
    """`passes` passes of `rows` rows, 0.1 s apart, at 4 to 5 m/s; the first is number `first` of an endless row."""
    number = np.repeat(np.arange(first, first + passes), rows)
    sample = np.tile(np.arange(rows), passes)
    speed = 5.0 - sample / rows
    stage = (sample // 10) % 3
    noise = np.random.default_rng(first).normal(size=len(sample))
    return PassLog(
        time_s=np.round(number * (rows * 0.1 + 30.0) + sample * 0.1, 9).astype(np.float64),
        path_m=5.0 * sample * 0.1 - sample**2 * 0.05 / rows,
        speed_m_s=np.round(speed + 0.02 * noise, 2),
        pressure_kpa=150.0 * stage + 2.0 * noise if gauge else np.full(len(sample), np.nan),
        stage=stage,
        first_row=np.arange(passes + 1) * rows,
        cut_id=tuple(f"cut-{each:05d}" for each in range(first, first + passes)),
        mass_t=np.linspace(22.0, 80.0, passes),
        axles=np.full(passes, 4),
        category=tuple("ЛСТ"[each % 3] for each in range(passes)),
        target_m_s=np.where(np.arange(passes) % 4 == 3, np.nan, 2.0),
        stopped_by_hand=np.arange(passes) % 5 == 4,
    )
