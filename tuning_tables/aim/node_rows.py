"""The nodes of an aim table as rows of texts, a row a node, in the order of the JSON table."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from tuning_tables.aim.aim_table import AimTable
from tuning_tables.aim.reported import FIGURES

COLUMNS: Final = ("cars", "free_distance_m", "resistance_n_per_kn", "exit_speed_m_s", *FIGURES)


def node_rows(table: AimTable) -> Iterator[list[str]]:
    """A row of names, then a row a node, numbered from 0; a cell is empty where there is no number."""
    yield ["names", "node", *COLUMNS]
    axes, reported = table.axes, table.reported
    values = [table.exit_speed_m_s, *(getattr(reported, name) for name in FIGURES)]
    for number, place in enumerate(np.ndindex(axes.shape)):
        resistance = "" if axes.resistance_n_per_kn is None else repr(float(axes.resistance_n_per_kn[place[2]]))
        told = ["" if np.isnan(each[place]) else repr(float(each[place])) for each in values]
        distance = repr(float(axes.free_distance_m[place[1]]))
        yield ["node", str(number), str(int(axes.cars[place[0]])), distance, resistance, *told]
