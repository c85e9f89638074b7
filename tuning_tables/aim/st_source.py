"""Aim tables as IEC 61131-3 Structured Text: the axes, the choice, the rule with the data, and a self-test."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping
from itertools import accumulate
from string import Template
from typing import Final

from tuning_tables.aim.aim_table import AimTable
from tuning_tables.aim.aim_tables import AimTables
from tuning_tables.aim.block import aim_block_size, controller_speeds
from tuning_tables.aim.c_source import Ask
from tuning_tables.aim.golden_aims import golden_aims
from tuning_tables.aim.names import origin_lines, with_prefix
from tuning_tables.aim.st_blocks import (
    AXES_TYPE,
    HEAD,
    LOAD_BODY,
    LOAD_CASE,
    LOAD_DECLARATIONS,
    LOAD_RESISTANCES,
    SELECT_BODY,
    SELECT_DECLARATIONS,
    SPEED_BODY,
    SPEED_CASE,
    SPEED_DECLARATIONS,
)
from tuning_tables.aim.st_self_test import SELF_TEST_HEAD, aim_self_test_blocks
from tuning_tables.category_names import category_names, comment_text
from tuning_tables.export_prefix import RETARDER, ExportPrefix
from tuning_tables.st_literals import GREATEST_REAL, LEAST_REAL, bool_array, constants, int_array, real_array
from tuning_tables.st_loops import without_single_turns
from tuning_tables.st_units import unit_files

AIM_FILE: Final = "aim_table.st"
AIM_SELF_TEST_FILE: Final = "aim_self_test.st"


def aim_st_files(aims: AimTables, prefix: ExportPrefix = RETARDER, ask: Ask = golden_aims) -> Mapping[str, bytes]:
    """The files of the export by name, ASCII with LF: the tables with their blocks, and the self-test.

    Equal sets give equal bytes. There are 490 tables at most, two for each number of a category.
    """
    files = {
        AIM_FILE: "\n".join([_head(aims), *_units(aims)]),
        AIM_SELF_TEST_FILE: "\n".join([SELF_TEST_HEAD, *aim_self_test_blocks(aims, ask)]),
    }
    return {with_prefix(prefix, name): with_prefix(prefix, text).encode("ascii") for name, text in files.items()}


def aim_st_unit_files(aims: AimTables, prefix: ExportPrefix = RETARDER, ask: Ask = golden_aims) -> Mapping[str, bytes]:
    """The same units, a file each; by their names in the order in which they need each other. As `aim_st_files`."""
    units = _units(aims)
    texts = ["\n".join([_head(aims), units[0]]), *units[1:], *aim_self_test_blocks(aims, ask)]
    return unit_files([with_prefix(prefix, text) for text in texts])


def _head(aims: AimTables) -> str:
    categories = [
        f"   {each.number:9d}  {each.macro}, in tables {comment_text(each.category)}".rstrip()
        for each in category_names(aims.exported_numbers())
    ]
    origin = (f"   {line}" for line in origin_lines(aims))
    return HEAD.substitute(ORIGIN="\n".join(origin), CATEGORIES="\n".join(categories))


def _units(aims: AimTables) -> list[str]:
    """Type and blocks, each a text of its own, none before one that it needs."""
    size = aim_block_size(aims)
    lengths = {"CARS": size.cars, "DISTANCE": size.distances, "RESISTANCE": size.resistances}
    last = {f"LAST_{name}": length - 1 for name, length in lengths.items()}
    blocks = [_load_block(aims), _select_block(aims), _speed_block(aims)]
    return [Template(AXES_TYPE).substitute(last), *map(without_single_turns, blocks)]


def first_rows(aims: AimTables) -> list[int]:
    """Of every table: the number of the row with the exit speeds for its first number of cars."""
    return [0, *accumulate(len(table.axes.cars) for table in aims.tables)][:-1]


def _load_block(aims: AimTables) -> str:
    tables = aims.tables
    declarations = [
        int_array("ListedOf", [len(table.axes.cars) for table in tables]),
        int_array("DistancesOf", [len(table.distance_nodes) for table in tables]),
        int_array("ResistancesOf", [len(table.resistance_nodes) * table.is_measured for table in tables]),
        int_array("FirstRowOf", first_rows(aims)),
    ]
    cases = []
    for number, table in enumerate(tables):
        declarations += [f"    (* {number}: {comment_text(table.id)} *)", *axis_arrays(table, f"_{number}")]
        text = LOAD_CASE + (LOAD_RESISTANCES if table.is_measured else "")
        last = [len(axis) - 1 for axis in (table.axes.cars, table.distance_nodes, table.resistance_nodes)]
        blanks = {"NUMBER": number, "LAST_CARS": last[0], "LAST_DISTANCE": last[1], "LAST_RESISTANCE": last[2]}
        cases.append(Template(text).substitute(blanks))
    blanks = {"LAST_TABLE": len(tables) - 1}
    body = Template(LOAD_BODY).substitute(blanks, CASES=textwrap.indent("\n".join(cases), " " * 4))
    return Template(LOAD_DECLARATIONS).substitute(blanks) + constants(declarations) + body


def axis_arrays(table: AimTable, ending: str) -> list[str]:
    """Declarations of the axes of a table, their names with `ending`."""
    arrays = [int_array(f"Cars{ending}", table.axes.cars), real_array(f"Distance{ending}", table.distance_nodes)]
    return [*arrays, *([real_array(f"Resistance{ending}", table.resistance_nodes)] if table.is_measured else [])]


def _select_block(aims: AimTables) -> str:
    declarations = [
        int_array("CategoryOf", [table.category.number for table in aims.tables]),
        bool_array("MeasuredOf", [table.is_measured for table in aims.tables]),
    ]
    body = Template(SELECT_BODY).substitute(LAST_TABLE=len(aims.tables) - 1)
    return SELECT_DECLARATIONS + constants(declarations) + body


def _speed_block(aims: AimTables) -> str:
    rows = [row for table in aims.tables for row in controller_speeds(table)]
    declarations = [
        LEAST_REAL,
        GREATEST_REAL,
        *(real_array(f"Speed_{number}", row.ravel(), row.shape[1]) for number, row in enumerate(rows)),
    ]
    cases = "\n".join(Template(SPEED_CASE).substitute(ROW=number) for number in range(len(rows)))
    body = Template(SPEED_BODY).substitute(CASES=textwrap.indent(cases, " " * 8))
    return SPEED_DECLARATIONS + constants(declarations) + body
