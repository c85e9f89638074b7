"""Golden rows as CSV, for controllers in other languages."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

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
