"""The golden vectors and tracks of a book as CSV, for controllers in other languages."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tuning_tables.golden_tracks import GoldenTrack
from tuning_tables.golden_vectors import Floats, GoldenVectors
from tuning_tables.table_book import TableBook

VECTORS_FILE = "golden_vectors.csv"
TRACKS_FILE = "golden_tracks.csv"

VECTOR_COLUMNS = "s_bits,v_bits,s_m,v_m_s"
VECTOR_COLUMNS_OF_GAUGE = "s_bits,v_bits,p_bits,s_m,v_m_s,pressure_kpa"


def vectors_csv(book: TableBook, vectors: list[GoldenVectors]) -> bytes:
    """All golden vectors, CR LF: table number and id, stage, path and speed as bits and as numbers, answer.

    If a table of the book has a gauge, the pressure stands behind the speed, as bits and as a number.
    """
    gauge = any(table.has_gauge for table in book.tables)
    rows = [f"table,id,stage,{VECTOR_COLUMNS_OF_GAUGE if gauge else VECTOR_COLUMNS},answer"]
    for number, (table, each) in enumerate(zip(book.tables, vectors, strict=True)):
        name = '"' + table.id.replace('"', '""') + '"'
        columns = reading_columns(each, gauge)
        bits = zip(*(values.view(np.uint32) for values in columns), strict=True)
        for k, words, values, answer in zip(each.stage, bits, zip(*columns, strict=True), each.answer, strict=True):
            fields = [*(f"{word:08x}" for word in words), *(f"{value:.9g}" for value in values)]
            rows.append(f"{number},{name},{k},{','.join(fields)},{answer}")
    return ("\r\n".join(rows) + "\r\n").encode("utf-8")


def reading_columns(vectors: GoldenVectors, gauge: bool) -> Sequence[Floats]:
    """Path and speed, and the pressure if a table of the book has a gauge."""
    return (vectors.s_m, vectors.v_m_s, *((vectors.pressure_kpa,) if gauge else ()))


def tracks_csv(book: TableBook, tracks: Sequence[GoldenTrack]) -> bytes:
    """All golden tracks, CR LF: track, table number and id, readings and estimate as bits and as numbers.

    Path in m, speeds in m/s, overpressure in kPa; then the number of samples since the last reading that was believed,
    and the alarm word. A track begins with a cut of which nothing is known.
    """
    columns = ("s", "v", "overpressure", "estimate")
    units = ("s_m", "v_m_s", "overpressure_kpa", "estimate_m_s", "unseen_samples", "alarms")
    rows = [",".join(("track", "table", "id", *(f"{name}_bits" for name in columns), *units))]
    for number, track in enumerate(tracks):
        name = '"' + book.tables[track.number].id.replace('"', '""') + '"'
        bits = zip(*(values.view(np.uint32).tolist() for values in track.samples[: len(columns)]), strict=True)
        for words, values in zip(bits, zip(*track.samples, strict=True), strict=True):
            fields = [*(f"{word:08x}" for word in words), *(f"{value:.9g}" for value in values)]
            rows.append(f"{number},{track.number},{name},{','.join(fields)}")
    return ("\r\n".join(rows) + "\r\n").encode("utf-8")
