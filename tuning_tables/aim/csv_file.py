"""An aim table as CSV (RFC 4180), for spreadsheets and for controllers that read nothing else. Export only.

    record,key,value0,value1,value2,value3,value4,value5,value6,value7
    text,format,aim-table,,,,,,,
    number,axes.cars,1,2,3,5,8,,,
    names,node,cars,free_distance_m,resistance_n_per_kn,exit_speed_m_s,p_overspeed,...
    node,0,1,20.0,,1.4,0.099,...

A rectangle under one header line. `text` and `number` hold what stands beside the nodes, by the dotted key of the JSON
table. Then there is a row a node, in the order of the JSON table, numbered from 0, its values as `names` tells them; a
cell is empty where there is no number. Numbers have the shortest form that reads back exactly. The checksum is that of
the JSON table.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from typing import Final

import numpy as np

from tuning_tables.aim.aim_table import AimTable
from tuning_tables.aim.document import to_aim_document
from tuning_tables.aim.reported import FIGURES
from tuning_tables.atomic_file import write_atomically
from tuning_tables.csv_rows import property_rows, rectangle

COLUMNS: Final = ("cars", "free_distance_m", "resistance_n_per_kn", "exit_speed_m_s", *FIGURES)


def to_aim_csv(table: AimTable) -> bytes:
    """The CSV text of `table`, UTF-8, CR LF line ends; equal tables give equal bytes.

    Raises `InvalidTable` for a text that a spreadsheet would take for a formula and compute.
    """
    document = to_aim_document(table)
    del document["exit_speed_m_s"]
    document["reported"] = {"passes": table.reported.passes}
    return rectangle([*property_rows(document, "", ()), ["names", "node", *COLUMNS], *_node_rows(table)])


def write_aim_csv(table: AimTable, path: str | os.PathLike[str]) -> None:
    """Write `to_aim_csv(table)` to the file at `path`, complete or not at all; raises `OSError`, and as that."""
    write_atomically(path, to_aim_csv(table))


def _node_rows(table: AimTable) -> Iterator[list[str]]:
    axes, reported = table.axes, table.reported
    values = [table.exit_speed_m_s, *(getattr(reported, name) for name in FIGURES)]
    for number, place in enumerate(np.ndindex(axes.shape)):
        resistance = "" if axes.resistance_n_per_kn is None else repr(float(axes.resistance_n_per_kn[place[2]]))
        told = ["" if np.isnan(each[place]) else repr(float(each[place])) for each in values]
        distance = repr(float(axes.free_distance_m[place[1]]))
        yield ["node", str(number), str(int(axes.cars[place[0]])), distance, resistance, *told]
