"""Aim tables as controller code, in C99 and in IEC 61131-3 Structured Text: the rule, the choice, the data, and a
self-test with golden aims.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from tuning_tables.aim.aim_tables import AimTables
from tuning_tables.aim.golden_aims import golden_aims
from tuning_tables.controller_code.aim_code import aim_code
from tuning_tables.controller_code.st_self_test import st_export
from tuning_tables.export_names import AIM, RETARDER, ExportPrefix
from tuning_tables.exports import c_texts, golden_csv_of_tables
from tuning_tables.language.st_unit import Export
from tuning_tables.self_test_size import FULL, SelfTestSize

VECTORS_FILE: Final = "golden_aims.csv"


def aim_c_files(
    aims: AimTables, prefix: ExportPrefix = RETARDER, self_test: SelfTestSize = FULL
) -> Mapping[str, bytes]:
    """The files of the export by name: four of C99, ASCII, and all golden aims as CSV for other languages.

    Equal sets give equal bytes.
    """
    texts = c_texts(aim_code(aims, self_test), prefix.of_kind(AIM))
    golden = [vars(golden_aims(table)) for table in aims.tables]
    return {**texts, prefix.data_file(VECTORS_FILE): golden_csv_of_tables([table.id for table in aims.tables], golden)}


def aim_export(aims: AimTables, prefix: ExportPrefix = RETARDER, self_test: SelfTestSize = FULL) -> Export:
    """The tables with their blocks, and the self-test, to be laid out in any form.

    There are 490 tables at most, two for each number of a category.
    """
    return st_export(aim_code(aims, self_test), prefix.of_kind(AIM))
