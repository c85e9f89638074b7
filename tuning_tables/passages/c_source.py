"""Tables for point sensors as C99 source: tracker, rule and step, the data, the choice, and a self-test."""

from __future__ import annotations

from collections.abc import Mapping

from tuning_tables.c_source import c_texts
from tuning_tables.controller_code.passage_code import passage_code
from tuning_tables.export_prefix import RETARDER, ExportPrefix
from tuning_tables.golden_csv import golden_csv_of_tables
from tuning_tables.passages.golden_passages import golden_passages
from tuning_tables.passages.passage_book import PassageBook
from tuning_tables.self_test_size import FULL, SelfTestSize


def passage_c_files(
    book: PassageBook, prefix: ExportPrefix = RETARDER, self_test: SelfTestSize = FULL
) -> Mapping[str, bytes]:
    """The files of the export by name: four of C99, ASCII, and all golden rows as CSV for other languages.

    Equal books give equal bytes. Raises `InvalidTable` for a category without number.
    """
    golden = [golden_passages(table) for table in book.tables]
    rows = {
        "golden_stages.csv": [each.stages for each in golden],
        "golden_pairs.csv": [each.pairs for each in golden],
        "golden_pulses.csv": [each.pulses for each in golden],
    }
    csv = {}
    for name, golden_rows in rows.items():
        columns = [{field: each[field] for field in each.dtype.names or ()} for each in golden_rows]
        csv[prefix.data_file(name)] = golden_csv_of_tables([table.id for table in book.tables], columns)
    return {**c_texts(passage_code(book, self_test), prefix), **csv}
