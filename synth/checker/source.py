"""What there is to verify at a path: tables from JSON files and from a book, the order of the book, and whether
its tables agree on the numbers of their weight categories.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, TypeAlias, TypeVar

from synth.checker.aim.table import AIM, Aim, read_aim
from synth.checker.book_reading import SIGNATURE, read_documents
from synth.checker.content import canonical_form, content_of
from synth.checker.document_shape import LINES, LINES_SHAPE, require_shape
from synth.checker.finding import DamagedError, Finding, Kind, NothingToVerifyError, shown
from synth.checker.passages.table import PASSAGES, PASSAGES_SHAPE, PassageTable, passage_table_of, read_passage_table
from synth.checker.table_reading import Table, read_table, table_of


def without_number(tables: Sequence[Table | PassageTable]) -> Iterator[tuple[str, str]]:
    """(id, sentence) for each table whose category no controller code can name."""
    for table in tables:
        if table.category_number is None:
            yield table.id, f"its category {table.category} has no number, so it makes no controller code"


def contradictions(tables: Sequence[Table | PassageTable]) -> Iterator[tuple[str, str]]:
    """(id, sentence) where a name has two numbers, or a number two names."""
    names: dict[str, Table | PassageTable] = {}
    numbers: dict[int, Table | PassageTable] = {}
    for table in tables:
        first = names.setdefault(table.category, table)
        if first.category_number != table.category_number:
            yield table.id, f"its category {table.category} has another number than in {first.id}"
        if table.category_number is not None:
            first = numbers.setdefault(table.category_number, table)
            if first.category != table.category:
                yield table.id, f"the number of its category {table.category} is that of {first.category} in {first.id}"


Kept = TypeVar("Kept", Table, Aim, PassageTable)
Bound: TypeAlias = Table | PassageTable
SHAPES: Final = {LINES: LINES_SHAPE, PASSAGES: PASSAGES_SHAPE}
"""Of the tables that books hold."""
KIND: Final = re.compile(rb'"kind"\s*:\s*"(\w+)"')
"""No text in a JSON document can hold this: its quotes would be escaped."""


@dataclass(frozen=True)
class Source:
    """The tables at `path`, in the order of the book where there is one, else by file name; and those of other kinds.

    `aims` are aim tables, `passages` tables for point sensors.
    `folder` is the directory whose other exports belong to them, None for a single file. `files`: what was read.
    """

    path: Path
    folder: Path | None
    tables: tuple[Table, ...]
    has_book: bool
    files: tuple[str, ...]
    findings: tuple[Finding, ...]
    aims: tuple[Aim, ...] = ()
    passages: tuple[PassageTable, ...] = ()


def read_source(path: Path) -> Source:
    """Everything at `path`; `NothingToVerifyError` where there is nothing."""
    if path.is_dir():
        return read_directory(path)
    if not path.is_file():  # a pipe or device might never end
        what = "this is no regular file" if path.exists() else "there is no such file"
        raise NothingToVerifyError(f"{path}: {what}; give a table (.json), a book (.h5) or a directory")
    try:
        content = content_of(path)
        if content.startswith(SIGNATURE) or path.suffix in (".h5", ".hdf5"):
            bound = tables_of_book(content)
            return Source(path, None, lines_of(bound), True, (str(path),), (), (), points_of(bound))
        kind = kind_in(content)
        if kind == AIM:
            return Source(path, None, (), False, (str(path),), (), (read_aim(content),))
        if kind == PASSAGES:
            return Source(path, None, (), False, (str(path),), (), (), (read_passage_table(content),))
        return Source(path, None, (read_table(content),), False, (str(path),), ())
    except DamagedError as fault:
        return Source(path, None, (), False, (str(path),), (Finding(Kind.DAMAGED, str(path), str(fault)),))


def read_directory(path: Path) -> Source:
    """What a tune left in `path`."""
    folder = path / "tables" if (path / "tables").is_dir() else path
    files = sorted(file for file in folder.glob("*.json") if file.name != "summary.json")
    book_file = path / "book.h5"
    if not files and not book_file.exists():
        raise NothingToVerifyError(
            f"{path}: there are neither tables (.json) nor a book.h5 in it; give what a tune left"
        )
    findings: list[Finding] = []
    single: dict[str, Table] = {}
    aims: dict[str, Aim] = {}
    passages: dict[str, PassageTable] = {}
    for file in files:
        try:
            content = content_of(file)
            kind = kind_in(content)
            if kind == AIM:
                findings += added(read_aim(content), aims, named(file, path))
            elif kind == PASSAGES:
                findings += added(read_passage_table(content), passages, named(file, path))
            else:
                findings += added(read_table(content), single, named(file, path))
        except DamagedError as fault:
            findings.append(Finding(Kind.DAMAGED, named(file, path), str(fault)))
    bound: tuple[Bound, ...] = ()
    if book_file.exists():
        try:
            bound = tables_of_book(content_of(book_file))
        except DamagedError as fault:
            findings.append(Finding(Kind.DAMAGED, "book.h5", str(fault)))
        else:
            findings += differences({**single, **passages}, bound) if files else []
    lines, points = in_order(single, lines_of(bound)), in_order(passages, points_of(bound))
    told = (*contradictions(lines), *contradictions(points))
    findings += [Finding(Kind.DISAGREES, name, sentence) for name, sentence in told]
    names = [named(file, path) for file in files] + (["book.h5"] if book_file.exists() else [])
    return Source(path, path, lines, bool(bound), tuple(names), tuple(findings), tuple(aims.values()), points)


def in_order(single: Mapping[str, Kept], bound: Sequence[Kept]) -> tuple[Kept, ...]:
    """The tables in the order of the book, then those that are not in it; as their JSON files say where there are."""
    known = {table.id for table in bound}
    ordered = [single.get(table.id, table) for table in bound]
    return tuple(ordered + [table for name, table in single.items() if name not in known])


def kind_in(content: bytes) -> str | None:
    """The kind of table that a JSON text says it is; None where it says none, or several."""
    kinds = KIND.findall(content)
    return kinds[0].decode() if len(kinds) == 1 else None


def added(table: Kept, known: dict[str, Kept], file: str) -> list[Finding]:
    """Add a table to the `known` ones, by id; what is wrong with its file if there was one of that id before."""
    before = known.get(table.id)
    known[table.id] = table
    return [] if before is None else [Finding(Kind.DISAGREES, file, f"another file has the id {table.id}, too")]


def named(file: Path, path: Path) -> str:
    """A file as messages call it."""
    return str(file.relative_to(path))


def tables_of_book(content: bytes) -> tuple[Bound, ...]:
    """The tables in a book; `DamagedError` for a book without any, with an id twice, or with what is no table."""
    tables: list[Bound] = []
    for document in read_documents(content, SHAPES):
        kind = document["kind"]
        require_shape({**document, "crc32": "none"}, SHAPES[kind], "")
        tables.append(table_of(document) if kind == LINES else passage_table_of(document))
    ids = [table.id for table in tables]
    if not ids or len(set(ids)) < len(ids):
        raise DamagedError(f"it holds the tables {shown(ids)}, but must hold at least one, and each id once")
    for name, sentence in contradictions(tables):
        raise DamagedError(f"{name}: {sentence}")
    return tuple(tables)


def lines_of(bound: Sequence[Bound]) -> tuple[Table, ...]:
    """Those of the tables of a book that have lines."""
    return tuple(table for table in bound if isinstance(table, Table))


def points_of(bound: Sequence[Bound]) -> tuple[PassageTable, ...]:
    """Those of the tables of a book that are for point sensors."""
    return tuple(table for table in bound if isinstance(table, PassageTable))


def differences(single: Mapping[str, Bound], bound: Sequence[Bound]) -> Iterator[Finding]:
    """Where JSON tables and book do not say the same."""
    in_book = {table.id: table for table in bound}
    for name in sorted(single.keys() | in_book.keys()):
        if name not in in_book:
            yield Finding(Kind.DISAGREES, name, "it has a JSON file, but it is not in book.h5")
        elif name not in single:
            yield Finding(Kind.DISAGREES, name, "it is in book.h5, but has no sound JSON file")
        else:
            one, other = ({**each.document, "exported_by": ""} for each in (single[name], in_book[name]))
            if canonical_form(one) != canonical_form(other):
                yield Finding(Kind.DISAGREES, name, first_difference(one, other, ""))


def first_difference(one: Any, other: Any, path: str) -> str:
    """Where two documents first differ, as a sentence."""
    if isinstance(one, Mapping) and isinstance(other, Mapping) and one.keys() == other.keys():
        pairs = [(f"{path}.{key}".lstrip("."), one[key], other[key]) for key in one]
    elif isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        pairs = [(f"{path}[{i}]", a, b) for i, (a, b) in enumerate(zip(one, other, strict=True))]
    else:
        return f"{path} is {shown(one)} in its JSON file, but {shown(other)} in book.h5"
    return next(first_difference(a, b, key) for key, a, b in pairs if canonical_form(a) != canonical_form(b))
