"""How a book holds its tables, by docs/reference/table-format.md: type, axes, unit of every dataset, fills of gaps."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence, Set
from dataclasses import dataclass
from typing import Any, Final

from synth.checker.document_shape import COUNT, NUMBER, OneOf, OrNull, Pair, Row, Single
from synth.checker.finding import DamagedError, shown

CHECKSUM_BYTES: Final = 4
"""That fletcher32 adds to a chunk."""
HEAD: Final = frozenset({"format", "version", "kind", "exported_by", "crc32"})
"""Of a document, in no dataset: attributes of the book tell it."""
UNITS: Final = (
    ("_m2_s2_per_kpa", "m2/s2 per kPa"), ("_m_s_per_kpa", "m/s per kPa"), ("_m2_s2", "m2/s2"), ("_m_s2", "m/s2"),
    ("_m_s", "m/s"), ("_kpa", "kPa"), ("_m", "m"), ("_s", "s"), ("_t", "t"),
)  # fmt: skip
"""What a name ends with, and its unit: the first that fits."""
SWITCHING: Final = "switching_m_s"
"""Whose null is an infinity in books and CSV."""
LINE_UNIT: Final = "m/s per m^power"


@dataclass(frozen=True)
class Stored:
    """A dataset: its type in numpy's letters ("|S" for text of any length), its axes, its unit, where it comes from.

    `keys`: the keys of the document on the way to it; "*" for every entry of an array, "#" for how many there are.
    """

    dtype: str
    axes: tuple[str, ...]
    unit: str
    keys: tuple[str, ...]

    @property
    def filler(self) -> float:
        """What fills gaps."""
        return math.nan if self.dtype in ("<f4", "<f8") else 0


def datasets_of(shape: Mapping[str, Any], names: Set[str]) -> dict[str, Stored]:
    """The datasets of a book of tables of a shape that has datasets of these `names`.

    Of a section that may be null there are some only if any table has it.
    """
    members = {key: form for key, form in shape.items() if key not in HEAD}
    return dict(_datasets(members, "", ("table",), (), names))


def _datasets(
    members: Mapping[str, Any], prefix: str, axes: tuple[str, ...], keys: tuple[str, ...], names: Set[str]
) -> list[tuple[str, Stored]]:
    found: list[tuple[str, Stored]] = []
    for key, form in members.items():
        name, way = prefix + key, (*keys, key)
        inner = form.form if isinstance(form, OrNull | Row) else form
        if not isinstance(inner, Mapping):
            dtype, further = type_of(form)
            found.append((name, Stored(dtype, (*axes, *further), unit_of(key, dtype), way)))
        elif isinstance(form, Row):
            found.append((name, Stored("<i4", axes, "1", (*way, "#"))))
            found += _datasets(inner, f"{form.axis}_", (*axes, form.axis), (*way, "*"), names)
        else:
            if isinstance(form, OrNull):
                found.append((name, Stored("<i4", axes, "1", (*way, "#"))))
            if not isinstance(form, OrNull) or any(each.startswith(f"{name}_") for each in names):
                found += _datasets(inner, f"{name}_", axes, way, names)
    return found


def type_of(form: Any) -> tuple[str, tuple[str, ...]]:
    """The type in a book of a text, a number or a row of them, and its own axes."""
    match form:
        case OrNull():
            return type_of(form.form)
        case Pair():
            return "<f8", ("end",)
        case Single():
            return "<f4", ()
        case Row():
            dtype, axes = type_of(form.form)
            return "<f4" if form.single else dtype, (form.axis, *axes)
    return {NUMBER: "<f8", COUNT: "<i8"}.get("" if isinstance(form, OneOf) else form, "|S"), ()


def unit_of(key: str, dtype: str) -> str:
    """The unit of the dataset of the member `key`."""
    if key in ("lower", "upper"):
        return LINE_UNIT
    return "1" if dtype == "|S" else next((unit for end, unit in UNITS if key.endswith(end)), "1")


def axes_of(datasets: Mapping[str, Stored]) -> frozenset[str]:
    """The names of all axes."""
    return frozenset(axis for stored in datasets.values() for axis in stored.axes)


def require_stored(name: str, dataset: Any, stored: Stored) -> None:
    """Raise `DamagedError` unless the type, axes, unit and place of `dataset` in the file are those of `stored`."""
    dtype = dataset.dtype.str
    if not (dtype == stored.dtype or (stored.dtype == "|S" and dtype.startswith("|S"))):
        raise DamagedError(f"{name} is of the type {shown(dtype)}, but must be of {stored.dtype}")
    if dataset.ndim != len(stored.axes):
        raise DamagedError(f"{name} has the shape {shown(dataset.shape)}, but its axes are {', '.join(stored.axes)}")
    if dataset.attrs.get("units") != stored.unit or not isinstance(dataset.attrs.get("meaning"), str):
        raise DamagedError(f"{name} has the units {shown(dataset.attrs.get('units'))}, but must have {stored.unit}")
    filters = dataset.fletcher32 and not (dataset.compression or dataset.shuffle or dataset.scaleoffset)
    whole = dataset.chunks == dataset.shape and dataset.id.get_storage_size() == dataset.nbytes + CHECKSUM_BYTES
    if not filters or not whole:
        raise DamagedError(f"{name} is not stored in one unpacked piece with the checksum fletcher32")


def require_axes(book: Any, values: Mapping[str, Any], datasets: Mapping[str, Stored]) -> None:
    """Raise `DamagedError` unless every axis has one length, numbered from 0, in all arrays `values`."""
    lengths: dict[str, int] = {}
    for name, stored in datasets.items():
        if stored.dtype == "|S" and values[name].dtype.itemsize > max(1, *map(len, values[name].tolist())):
            raise DamagedError(f"{name} has room for longer texts than any of its own")
        for axis, length in zip(stored.axes, values[name].shape, strict=True):
            if lengths.setdefault(axis, length) != length or length == 0:
                raise DamagedError(f"{name} has {length} entries along {axis}, but the book {lengths[axis]}")
    for axis, length in lengths.items():
        scale = book[axis]
        plain = scale.dtype.str == "<i4" and scale.shape == (length,) and scale.chunks is None
        if not plain or scale.id.get_storage_size() != scale.nbytes or scale[()].tolist() != list(range(length)):
            raise DamagedError(f"{axis} does not number {length} entries from 0")


def require_filled_up(
    columns: Mapping[str, list[Any]], datasets: Mapping[str, Stored], documents: Sequence[Mapping[str, Any]]
) -> None:
    """Raise `DamagedError` unless NaN or 0 alone stands wherever a table is shorter than the arrays of the book.

    Also where the arrays are longer than the longest table, or there is nothing but what fills gaps.
    """
    told = {name: rows_of(documents, stored) for name, stored in datasets.items() if stored.dtype != "|S"}
    lengths: dict[str, int] = {}
    for name, rows in told.items():
        for axis, length in zip(datasets[name].axes[1:], depth(rows), strict=False):
            lengths[axis] = max(lengths.get(axis, 1), length)
    for name, rows in told.items():
        stored = datasets[name]
        # As text, in which two NaN are alike and the zeros are not.
        own = [len(rows), *(lengths.get(axis, 1) for axis in stored.axes[1:])]
        if repr(padded(rows, own, stored.filler)) != repr(columns[name]):
            raise DamagedError(f"{name} holds values beside those of the tables, or is longer than the longest table")
    for name, stored in datasets.items():
        if stored.keys[-1] == "#" and not any(columns[name]) and any(each.startswith(f"{name}_") for each in datasets):
            raise DamagedError(f"it holds columns of {name}, but none of its tables has one")


def rows_of(documents: Sequence[Mapping[str, Any]], stored: Stored) -> list[Any]:
    """What a dataset must hold of each document, before gaps are filled."""
    rows = [cells_at(document, stored.keys) for document in documents]
    if stored.keys[-1] == SWITCHING:
        return [[with_infinities(speeds) for speeds in passages] for passages in rows]
    return rows


def cells_at(value: Any, keys: Sequence[str]) -> Any:
    """What stands in a document behind `keys`; None where a section on the way is null."""
    if not keys:
        return value
    first, rest = keys[0], keys[1:]
    if first == "#":
        return len(value) if isinstance(value, list) else int(value is not None)
    if first == "*":
        return [cells_at(each, rest) for each in value]
    return None if value is None else cells_at(value[first], rest)


def padded(values: Any, lengths: Sequence[int], filler: float) -> Any:
    """`values` filled up with `filler` to these lengths."""
    if not lengths:
        return filler if values is None else values
    below = [*(values or []), *[None] * (lengths[0] - len(values or []))]
    return [padded(value, lengths[1:], filler) for value in below]


def depth(values: Any) -> list[int]:
    """The greatest length of each axis below the first."""
    if not isinstance(values, list):
        return []
    below = [value for value in values if isinstance(value, list)]
    longest = [depth(value) for value in below]
    ends = [max(each) for each in zip_longest(*longest)]
    return [max((len(value) for value in below), default=0), *ends]


def with_infinities(rows: Sequence[Sequence[float | None]]) -> list[list[float]]:
    """The switching speeds of a passage: null is -inf below the stage in force, inf from it on."""
    return [
        [(-math.inf if j < k else math.inf) if speed is None else speed for j, speed in enumerate(row)]
        for k, row in enumerate(rows)
    ]


def zip_longest(*rows: Sequence[int]) -> list[list[int]]:
    """The entries of all rows that have one, place by place."""
    return [[row[place] for row in rows if len(row) > place] for place in range(max(map(len, rows), default=0))]
