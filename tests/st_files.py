"""Exports as Structured Text, bare: the tables with their blocks, and the self-test, by the names of their files."""

from __future__ import annotations

from collections.abc import Mapping

from tuning_tables.aim.aim_tables import AimTables
from tuning_tables.aim.exports import aim_export
from tuning_tables.correction import Correction
from tuning_tables.export_names import RETARDER, ExportPrefix
from tuning_tables.exports import correction_export, line_export
from tuning_tables.language.st_layout import part_files
from tuning_tables.passages.exports import passage_export
from tuning_tables.passages.passage_book import PassageBook
from tuning_tables.self_test_size import FULL, SelfTestSize
from tuning_tables.table_book import TableBook

Files = Mapping[str, bytes]


def st_files(book: TableBook, prefix: ExportPrefix = RETARDER, self_test: SelfTestSize = FULL) -> Files:
    """Of tables with lines."""
    return part_files(line_export(book, prefix, self_test))


def passage_st_files(book: PassageBook, prefix: ExportPrefix = RETARDER, self_test: SelfTestSize = FULL) -> Files:
    """Of tables for point sensors."""
    return part_files(passage_export(book, prefix, self_test))


def aim_st_files(aims: AimTables, prefix: ExportPrefix = RETARDER, self_test: SelfTestSize = FULL) -> Files:
    """Of aim tables."""
    return part_files(aim_export(aims, prefix, self_test))


def correction_st_files(correction: Correction, prefix: ExportPrefix = RETARDER) -> Files:
    """Of the on-line correction."""
    return part_files(correction_export(correction, prefix))
