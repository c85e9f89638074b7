"""Tables for point sensors as C99 source: tracker, rule and step, the data, the choice, and a self-test."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from tuning_tables.c_source import c_texts
from tuning_tables.controller_code.passage_code import passage_code
from tuning_tables.export_prefix import RETARDER, ExportPrefix
from tuning_tables.passages.golden_passages import golden_passages
from tuning_tables.passages.passage_book import PassageBook
from tuning_tables.passages.passage_table import PassageTable
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
    csv = {prefix.data_file(name): rows_csv(book.tables, each) for name, each in rows.items()}
    return {**c_texts(passage_code(book, self_test), prefix), **csv}


def rows_csv(tables: Sequence[PassageTable], golden: Sequence[npt.NDArray[np.void]]) -> bytes:
    """Golden rows of all tables, CR LF: number and id of the table, whole numbers, others as bits and as numbers."""
    kind = golden[0].dtype
    names = kind.names or ()
    reals = [name for name in names if kind[name].kind == "f"]
    lines = [",".join(("table", "id", *(f"{name}_bits" if name in reals else name for name in names), *reals))]
    for number, (table, rows) in enumerate(zip(tables, golden, strict=True)):
        head = f'{number},"{table.id.replace(chr(34), 2 * chr(34))}"'
        for row in rows:
            exact = [f"{row[name].view(np.uint32):08x}" if name in reals else str(row[name]) for name in names]
            lines.append(",".join([head, *exact, *(f"{row[name]:.9g}" for name in reals)]))
    return ("\r\n".join(lines) + "\r\n").encode("utf-8")
