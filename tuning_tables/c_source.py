"""Tables as C99 source: the rules, the data, the choice, and a self-test with golden vectors and tracks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np

from tuning_tables.controller_code.c_code import c_header, c_source
from tuning_tables.controller_code.c_self_test import c_test_header, c_test_source, test_stem
from tuning_tables.controller_code.code import ControllerCode
from tuning_tables.controller_code.line_code import line_code
from tuning_tables.export_prefix import RETARDER, ExportPrefix
from tuning_tables.golden_csv import golden_csv, golden_csv_of_tables
from tuning_tables.golden_tracks import GoldenTrack, golden_tracks
from tuning_tables.golden_vectors import GoldenVectors, golden_vectors
from tuning_tables.self_test_size import FULL, SelfTestSize
from tuning_tables.table_book import TableBook

VECTORS_FILE: Final = "golden_vectors.csv"
TRACKS_FILE: Final = "golden_tracks.csv"


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


def vectors_csv(book: TableBook, vectors: Sequence[GoldenVectors]) -> bytes:
    """All golden vectors: stage, path, speed, the pressure if a table of the book has a gauge, and the answer."""
    left_out = set() if any(table.has_gauge for table in book.tables) else {"pressure_kpa"}
    columns = [{name: array for name, array in vars(each).items() if name not in left_out} for each in vectors]
    return golden_csv_of_tables([table.id for table in book.tables], columns)


def tracks_csv(book: TableBook, tracks: Sequence[GoldenTrack]) -> bytes:
    """All golden tracks: number of the track, number and id of its table, reading, estimate, unseen samples, alarms.

    A track begins with a cut of which nothing is known.
    """
    lengths = [len(track) for track in tracks]
    numbers = [track.number for track in tracks]
    told = {"track": range(len(tracks)), "table": numbers, "id": [book.tables[number].id for number in numbers]}
    s_m, v_m_s, kpa, estimate_m_s, unseen, alarms = map(np.concatenate, zip(*(t.samples for t in tracks), strict=True))
    return golden_csv(
        {
            **{name: np.repeat(np.array(column), lengths) for name, column in told.items()},
            "s_m": s_m,
            "v_m_s": v_m_s,
            "overpressure_kpa": kpa,
            "estimate_m_s": estimate_m_s,
            "unseen_samples": unseen.astype(np.int64),
            "alarms": alarms.astype(np.int64),
        }
    )


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
