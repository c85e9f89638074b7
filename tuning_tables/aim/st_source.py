"""Aim tables as IEC 61131-3 Structured Text: the type, the choice, the rule, the data, and a self-test."""

from __future__ import annotations

from tuning_tables.aim.aim_tables import AimTables
from tuning_tables.controller_code.aim_code import aim_code
from tuning_tables.controller_code.st_export import st_export
from tuning_tables.export_prefix import AIM, RETARDER, ExportPrefix
from tuning_tables.language.st_unit import Export
from tuning_tables.self_test_size import FULL, SelfTestSize


def aim_export(aims: AimTables, prefix: ExportPrefix = RETARDER, self_test: SelfTestSize = FULL) -> Export:
    """The tables with their blocks, and the self-test, to be laid out in any form.

    There are 490 tables at most, two for each number of a category.
    """
    return st_export(aim_code(aims, self_test), prefix.of_kind(AIM))
