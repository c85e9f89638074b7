"""CSV sheets for people, and the one rule on texts that a spreadsheet would compute.

A spreadsheet takes a cell that begins with one of `FORMULA_MARKS` for a formula, and a formula can run a program or
send what it finds to another machine. Names of cuts, cars and tables come from users and from logs. So in a sheet for
people such a text gets an apostrophe before it, which a spreadsheet shows as text. Files that programs read back keep
every text as it is (logs, events, sorting lists), or refuse such a text (`csv_rows`).
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence
from typing import Final

FORMULA_MARKS: Final = ("=", "+", "-", "@", "\t", "\r", "\n")


def is_formula(text: str) -> bool:
    """Whether a spreadsheet may take `text` for a formula. A written number is none."""
    if not text.startswith(FORMULA_MARKS):
        return False
    try:
        float(text)
    except ValueError:
        return True
    return False


def sheet(head: Sequence[str], rows: Iterable[Sequence[object]]) -> bytes:
    """The rows under the names `head` as CSV of RFC 4180 in UTF-8; no cell is a formula, and numbers stay numbers."""
    text = io.StringIO(newline="")
    writer = csv.writer(text, lineterminator="\r\n")
    writer.writerows([_shown(cell) for cell in row] for row in (head, *rows))
    return text.getvalue().encode()


def _shown(cell: object) -> object:
    return f"'{cell}" if isinstance(cell, str) and is_formula(cell) else cell
