"""One trial of a reader: it refuses an input as it promises, or gives a table that is exactly what was read."""

from __future__ import annotations

import json
from pathlib import Path

import h5py
import numpy as np

from tests.tuning_tables.damaged_inputs import Attempt
from tuning_tables import TableError, from_json, read_book, to_json, write_book
from tuning_tables.book_layout import book_layout
from tuning_tables.canonical import canonical_json

LONGEST_MESSAGE = 1000


class Finding(AssertionError):
    """The reader broke its promise."""


def outcome_of(attempt: Attempt, folder: Path) -> str:
    """The name of the error class, or "read"; raises `Finding`. Books are put into `folder`."""
    try:
        if attempt.reader == "json":
            _require_exact_text(attempt.content)
        else:
            _require_exact_book(attempt.content, folder)
    except TableError as refusal:
        message = str(refusal)
        if len(message) > LONGEST_MESSAGE or not message.isprintable():
            raise Finding(f"no sentence to print: {message!r:.300}") from refusal
        return type(refusal).__name__
    except Finding:
        raise
    except Exception as escaped:
        raise Finding(f"{type(escaped).__name__} instead of a TableError: {escaped}") from escaped
    return "read"


def _require_exact_text(content: bytes) -> None:
    table = from_json(content)
    if content not in (to_json(table), canonical_json(json.loads(to_json(table)))):
        raise Finding("a table was read from a text that is none of the two for it")


def _require_exact_book(content: bytes, folder: Path) -> None:
    path = folder / "attempt.h5"
    path.write_bytes(content)
    tables = read_book(path)
    again = folder / "again.h5"
    write_book(tables, again, tables[0].generator)
    with h5py.File(path) as one, h5py.File(again) as other:
        for column in book_layout(tables).columns:
            if not np.array_equal(one[column.name], other[column.name], equal_nan=column.dtype in ("<f4", "<f8")):
                raise Finding(f"{column.name} of the book is not that of the tables read from it")
