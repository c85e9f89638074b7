"""The highest stage that a table for point sensors makes use of; nothing here needs a solver."""

from __future__ import annotations

import numpy as np

from tuning_tables.passages.passage_table import PassageTable


def highest_stage(table: PassageTable) -> int:
    """The highest stage that the table ever asks for from a lower one; it has rows for those above, too."""
    top = len(table.pressure_kpa) - 1
    raised = [
        wanted + 1
        for stage in range(top)
        for wanted in range(stage, top)
        if np.isfinite(table.switching_m_s[:, stage, wanted]).any()
    ]
    return max([table.initial_stage, *raised])
