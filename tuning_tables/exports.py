"""Tables with lines as controller code, in C99 and in IEC 61131-3 Structured Text: the rules, the data, the
choice, and a self-test with golden vectors and tracks, which are also CSV for controllers in other languages. And
the on-line correction likewise: a library text beside that of the tables.

Tables as IEC 61131-3 Structured Text: the types, the rules, the data, the choice, and a self-test. How it is used
stands in docs/reference/structured-text.md.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from typing import Any, Final, TypeAlias

import numpy as np
import numpy.typing as npt

from tuning_tables.controller_code.c_code import c_header, c_source
from tuning_tables.controller_code.c_self_test import c_test_header, c_test_source, test_stem
from tuning_tables.controller_code.code import ControllerCode
from tuning_tables.controller_code.correction_code import correction_code
from tuning_tables.controller_code.line_code import line_code
from tuning_tables.controller_code.st_self_test import st_export
from tuning_tables.correction import NUMBERS, Correction, golden_exits
from tuning_tables.errors import InvalidTable
from tuning_tables.export_names import RETARDER, ExportPrefix
from tuning_tables.golden_tracks import GoldenTrack, golden_tracks
from tuning_tables.golden_vectors import GoldenVectors, golden_vectors
from tuning_tables.language.st_layout import unit_files
from tuning_tables.language.st_unit import Export
from tuning_tables.self_test_size import FULL, SelfTestSize
from tuning_tables.table_book import TableBook

Columns: TypeAlias = Mapping[str, npt.NDArray[Any]]
"""Arrays (n,) by name: texts, whole numbers, or float32."""


def golden_csv(columns: Columns) -> bytes:
    """n rows below the names of their columns, CR LF.

    In the place of a column NAME of float32 are its bits, as NAME_bits; its numbers are behind all columns, as NAME.
    """
    exact: dict[str, Sequence[object]] = {}
    numbers: dict[str, Sequence[object]] = {}
    for name, column in columns.items():
        if column.dtype == np.float32:
            exact[f"{name}_bits"] = [f"{word:08x}" for word in column.view(np.uint32)]
            numbers[name] = [f"{value:.9g}" for value in column]
        else:
            exact[name] = column.tolist()
    text = io.StringIO(newline="")
    writer = csv.writer(text)
    writer.writerow([*exact, *numbers])
    writer.writerows(zip(*exact.values(), *numbers.values(), strict=True))
    return text.getvalue().encode("utf-8")


def golden_csv_of_tables(ids: Sequence[str], golden: Sequence[Columns]) -> bytes:
    """The golden rows of each table, behind its number and id."""
    lengths = [len(next(iter(each.values()))) for each in golden]
    told = {"table": np.arange(len(ids)), "id": np.array(ids)}
    rows = {name: np.concatenate([each[name] for each in golden]) for name in golden[0]}
    return golden_csv({**{name: np.repeat(column, lengths) for name, column in told.items()}, **rows})


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


MOST_TABLES: Final = 500
"""In one text: the choice has arrays of that length, and compilers set limits of their own."""

TABLE_FILE: Final = "retarder_table.st"
SELF_TEST_FILE: Final = "retarder_self_test.st"


def line_export(book: TableBook, prefix: ExportPrefix = RETARDER, self_test: SelfTestSize = FULL) -> Export:
    """The tables with their blocks, and the self-test, to be laid out in any form.

    Raises `InvalidTable` for more than `MOST_TABLES` tables, and for a category without number.
    """
    if len(book.tables) > MOST_TABLES:
        raise InvalidTable(
            f"the book has {len(book.tables)} tables, but Structured Text holds at most {MOST_TABLES}: "
            "export fewer classes or targets at a time."
        )
    return st_export(line_code(book, self_test), prefix, self_test.line_checks)


EXITS_FILE: Final = "golden_exits.csv"


def correction_c_files(correction: Correction, prefix: ExportPrefix = RETARDER) -> Mapping[str, bytes]:
    """The files by name: four of C99, ASCII, and all golden exits as CSV. Equal corrections give equal bytes."""
    exits = golden_exits(correction)
    columns = {"credible": exits["credible"].astype(int), **{name: exits[name] for name in NUMBERS}}
    return {**c_texts(correction_code(correction), prefix), prefix.data_file(EXITS_FILE): golden_csv(columns)}


def correction_export(correction: Correction, prefix: ExportPrefix = RETARDER) -> Export:
    """The blocks and the self-test, to be laid out in any form."""
    return st_export(correction_code(correction), prefix)


def correction_st_unit_files(correction: Correction, prefix: ExportPrefix = RETARDER) -> Mapping[str, bytes]:
    """The same units, a file each; by their names in the order in which they need each other."""
    # Behind the name, so that they sort beside, not among, the numbered units of the tables.
    units = unit_files(correction_export(correction, prefix))
    return {f"correction_{name}": text for name, text in units.items()}
