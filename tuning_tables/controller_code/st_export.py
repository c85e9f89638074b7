"""A controller code as an export of Structured Text, whatever form it is laid out in."""

from __future__ import annotations

from tuning_tables.controller_code.c_self_test import test_stem
from tuning_tables.controller_code.code import ControllerCode
from tuning_tables.controller_code.st_code import head, st_units
from tuning_tables.controller_code.st_self_test import self_test_head, st_test_units
from tuning_tables.export_prefix import ExportPrefix
from tuning_tables.language.st_unit import Export, Part, retold


def st_export(code: ControllerCode, prefix: ExportPrefix, line_checks: int = 0) -> Export:
    """The tables with their blocks, and the self-test, with all names as `prefix` makes them.

    `line_checks`: how many choices the self-test compares by every number.
    """
    tables = Part(f"retarder_{code.stem}", head(code), tuple(st_units(code)))
    test_units = tuple(st_test_units(code, line_checks))
    self_test = Part(f"retarder_{test_stem(code)}", self_test_head(code), test_units, is_test=True)
    return tuple(
        Part(
            prefix.renamed(part.stem),
            tuple(map(prefix.renamed, part.head)),
            tuple(retold(unit, prefix.renamed) for unit in part.units),
            part.is_test,
        )
        for part in (tables, self_test)
    )
