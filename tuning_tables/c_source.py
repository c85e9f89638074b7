"""Tables as C99 source: the rules, the data, the choice, and a self-test with golden vectors and tracks."""

from __future__ import annotations

from collections.abc import Mapping

from tuning_tables.controller_code.c_code import c_header, c_source
from tuning_tables.controller_code.c_self_test import c_test_header, c_test_source, test_stem
from tuning_tables.controller_code.code import ControllerCode
from tuning_tables.controller_code.line_code import line_code
from tuning_tables.export_prefix import RETARDER, ExportPrefix
from tuning_tables.golden_csv import TRACKS_FILE, VECTORS_FILE, tracks_csv, vectors_csv
from tuning_tables.golden_tracks import golden_tracks
from tuning_tables.golden_vectors import golden_vectors
from tuning_tables.self_test_size import FULL, SelfTestSize
from tuning_tables.table_book import TableBook


def c_files(book: TableBook, prefix: ExportPrefix = RETARDER, self_test: SelfTestSize = FULL) -> Mapping[str, bytes]:
    """The files of the export by name: four of C99, ASCII, and all golden vectors as CSV for other languages.

    If a table has an estimator, the golden tracks are there as CSV too. Equal books give equal bytes. Raises
    `InvalidTable` for a category without number.
    """
    code = line_code(book, self_test)
    data = {prefix.data_file(VECTORS_FILE): vectors_csv(book, [golden_vectors(table) for table in book.tables])}
    if code.room["breaks"]:
        data[prefix.data_file(TRACKS_FILE)] = tracks_csv(book, golden_tracks(book))
    return {**c_texts(code, prefix), **data}


def c_texts(code: ControllerCode, prefix: ExportPrefix) -> Mapping[str, bytes]:
    """The four files of C99 of any export, by name."""
    test = test_stem(code)
    texts = {
        f"retarder_{code.stem}.h": c_header(code),
        f"retarder_{code.stem}.c": c_source(code),
        f"retarder_{test}.h": c_test_header(code),
        f"retarder_{test}.c": c_test_source(code),
    }
    return {prefix.renamed(name): prefix.renamed(text).encode("ascii") for name, text in texts.items()}
